//! Either law of the controller behind one face, in either scalar, with its numbers as f64 for
//! recording.

use controller::{
    Command, Disturbance, Fault, Follower, Margins, Mode, Real, SetupError, State, Tracker, Vector3, Vehicle,
};

use crate::describe::course::{FlownPath, ReferenceSpec};
use crate::describe::scenario::{ControllerSpec, Law};

/// Whatever answers states with commands: a law in this program, or a target at the other end of a
/// link.
pub trait Answers {
    /// Starts from a stated ζ, with integrals at zero.
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]);

    /// Takes over from whatever applied `applied` until now, without a bump in thrust.
    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>);

    /// The command for the hold that begins at `t_s`, from the state sampled then; `None` if there
    /// will be no more.
    fn step(&mut self, state: &State<f64>, t_s: f64) -> Option<Decision>;
}

/// A controller at work in the scalar `T`.
pub enum Pilot<T> {
    /// Path following.
    Follow(Box<Follower<T, FlownPath<T>>>),
    /// Trajectory tracking, with its reference.
    Track(Box<Tracker<T>>, ReferenceSpec),
}

/// One answer of a pilot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Thrust and torque for the coming hold.
    pub command: Command<f64>,
    /// ζ at the sample, m/s²⁺ᵏ.
    pub zeta: [f64; 4],
    /// What the vehicle is doing; [`Mode::Follow`] of a law alone.
    pub mode: Mode,
    /// Why it is not doing what was asked for; none of a target's, whose link counts them.
    pub fault: Option<Fault>,
    /// What the observers hold; of a target at the other end of a link it does not come.
    pub disturbance: Option<Disturbance<f64>>,
    /// The law's own numbers, where it was asked; of a target they come with the samples that are
    /// logged.
    pub telemetry: Option<Telemetry>,
}

/// Where an answer came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry {
    /// ξ̃ = ∫(h1, h2, h3) up to the sample; zero for the tracking law, which has none.
    pub integral: [f64; 3],
    /// Outputs and derivatives, padded with zeros to the longer law's 20.
    pub xi: [f64; 20],
    /// Wanted highest derivatives of the outputs.
    pub nu: [f64; 4],
    /// Distances from the singularities.
    pub margins: Margins<f64>,
    /// What the observers have found.
    pub observed: Observed,
}

/// Disturbances as an operator reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observed {
    /// On the payload in N, beyond the model's, N; along the rod that on both bodies.
    pub payload_force: [f64; 3],
    /// On the UAV in N, across the rod, N.
    pub uav_force: [f64; 3],
    /// On the UAV in body axes, N·m.
    pub torque: [f64; 3],
    /// The payload's mass that would explain the force along the rod in still air, kg.
    pub payload_mass: f64,
}

impl Observed {
    /// Of what was `found` for this vehicle, rod and λ.
    pub(crate) fn new<T: Real>(found: &Disturbance<T>, vehicle: &Vehicle<T>, rod: &Vector3<T>, lambda: T) -> Self {
        let numbers = |v: Vector3<T>| v.map(T::to_f64).into();
        Self {
            payload_force: numbers(found.payload_force(vehicle, rod)),
            uav_force: numbers(found.uav_force(vehicle, rod)),
            torque: numbers(found.torque),
            payload_mass: found.implied_payload_mass(vehicle, rod, lambda).to_f64(),
        }
    }
}

impl<T: Real> Pilot<T> {
    /// The controller that `spec` describes, at hover.
    ///
    /// # Errors
    /// [`SetupError`] if rounding to `T` takes a parameter out of range or makes the gains
    /// unstable.
    pub fn new(spec: &ControllerSpec) -> Result<Self, SetupError<T>> {
        let vehicle = Vehicle::new(spec.vehicle.cast())?;
        let sampling = spec.sampling().cast();
        let (observer, limits) = (spec.observer.cast(), spec.limits.cast());
        Ok(match &spec.law {
            Law::Follow { path, gains } => {
                let follower = Follower::new(vehicle, path.build()?, gains.cast(), sampling)?;
                Self::Follow(Box::new(follower.with_observer(observer)?.with_limits(limits)?))
            }
            Law::Track { reference, gains } => {
                let tracker = Tracker::new(vehicle, gains.cast(), sampling)?;
                Self::Track(Box::new(tracker.with_observer(observer)?.with_limits(limits)?), *reference)
            }
        })
    }

    /// The command for the hold that begins at `t_s`, from the state sampled then.
    #[inline]
    pub fn decide(&mut self, state: &State<f64>, t_s: f64) -> Decision {
        let state = state.cast();
        let (zeta, integral) = match self {
            Self::Follow(follower) => (*follower.zeta(), *follower.law().integral()),
            Self::Track(tracker, _) => (*tracker.zeta(), [T::zero(); 3]),
        };
        let (command, xi, nu, margins, found, vehicle) = match self {
            Self::Follow(follower) => {
                let solution = follower.step(&state);
                let xi = padded([&solution.xi.h1, &solution.xi.h2, &solution.xi.h3, &solution.xi.h4]);
                (solution.command, xi, solution.nu, solution.margins, follower.disturbance(), follower.vehicle())
            }
            Self::Track(tracker, reference) => {
                let solution = tracker.track(&state, &reference.at(t_s));
                let [p1, p2, p3] = &solution.xi.position;
                let xi = padded([p1, p2, p3, &solution.xi.yaw]);
                (solution.command, xi, solution.nu, solution.margins, tracker.disturbance(), tracker.vehicle())
            }
        };
        Decision {
            command: command.cast(),
            zeta: zeta.map(T::cast),
            mode: Mode::Follow,
            fault: None,
            disturbance: Some(found.cast()),
            telemetry: Some(Telemetry {
                integral: integral.map(T::cast),
                xi,
                nu: nu.map(T::cast),
                margins: margins.cast(),
                observed: Observed::new(found, vehicle, &state.rod, margins.lambda),
            }),
        }
    }
}

/// ξ's parts one after the other.
pub(crate) fn padded<T: Real>(parts: [&[T]; 4]) -> [f64; 20] {
    let mut xi = [0.0; 20];
    let mut rest = &mut xi[..];
    for part in parts {
        let (slots, left) = rest.split_at_mut(part.len());
        for (slot, &value) in slots.iter_mut().zip(part) {
            *slot = value.cast();
        }
        rest = left;
    }
    xi
}

impl<T: Real> Answers for Pilot<T> {
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]) {
        let (state, zeta) = (state.cast(), zeta.map(T::lit));
        // A refused state leaves the law as it was, which the flight then shows.
        let _ = match self {
            Self::Follow(follower) => follower.start(&state, zeta),
            Self::Track(tracker, _) => tracker.start(&state, zeta),
        };
    }

    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        // A refused state leaves the law as it was, which the flight then shows.
        let _ = match self {
            Self::Follow(follower) => follower.take_over(&state.cast(), applied.cast()),
            Self::Track(tracker, _) => tracker.take_over(&state.cast(), applied.cast()),
        };
    }

    #[inline]
    fn step(&mut self, state: &State<f64>, t_s: f64) -> Option<Decision> {
        Some(self.decide(state, t_s))
    }
}
