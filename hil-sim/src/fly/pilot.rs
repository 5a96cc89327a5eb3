//! The controller as it flies everywhere, behind the face of whatever answers readings, in either
//! scalar, with its numbers as f64 for recording.

use controller::{Actuation, Command, Fault, Margins, Measured, Mode, Real, Request, State, Uav, Vector3};
use rig::{Actuators, Parameters, Rig};

use crate::describe::course::{FlownPath, PathSpec, ReferenceSpec, RouteSpec};
use crate::describe::input::Invalid;
use crate::describe::parameters::without_path;
use crate::describe::scenario::{ControllerSpec, Law};
use crate::world::{Order, Reading};

/// Whatever answers readings with commands: a controller in this program, or a target at the other
/// end of a link.
pub trait Answers {
    /// Starts from a stated ζ, with integrals at zero.
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]);

    /// Takes over from whatever applied `applied` until now, without a bump in thrust.
    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>);

    /// Wishes for another factor of the path's speed, where that can be had.
    fn set_speed_factor(&mut self, _factor: f64) {}

    /// Whether its route has ended where it is to land, so that it lands whatever it was asked for.
    fn lands(&self) -> bool {
        false
    }

    /// Whether somebody else says what it does: then neither the scenario's requests nor its path
    /// count, and no landing ends the flight.
    fn is_commanded(&self) -> bool {
        false
    }

    /// Whether it finds the state itself, from what is [aboard](Reading::aboard).
    fn finds_its_state(&self) -> bool {
        false
    }

    /// The command for the hold that begins at `t_s`, from what is read then and what is asked for;
    /// `None` if there will be no more.
    fn step(&mut self, read: &Reading, request: Request, t_s: f64) -> Option<&Decision>;
}

/// A controller at work in the scalar `T`.
pub struct Pilot<T: Real, A = Actuators<T>> {
    rig: Box<Rig<T, FlownPath<T>, A>>,
    /// Of the tracking law.
    reference: Option<ReferenceSpec>,
    /// A law alone does not join its path, it flies.
    joins: bool,
    /// It is above a rate loop.
    gives_rates: bool,
    has_telemetry: bool,
    /// The last answer.
    decision: Decision,
}

/// One answer of a pilot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Thrust and torque for the coming hold.
    pub command: Command<f64>,
    /// The same for the rate loop that the law is above, in body axes, rad/s; none: there is none.
    pub body_rate: Option<Vector3<f64>>,
    /// ζ at the sample, m/s²⁺ᵏ.
    pub zeta: [f64; 4],
    /// What the vehicle is doing.
    pub mode: Mode,
    /// Why it is not doing what was asked for; none of a target's, whose link counts them.
    pub fault: Option<Fault>,
    /// Distances from the singularities, where the law flew; of a target they come with telemetry.
    pub margins: Option<Margins<f64>>,
    /// The law's other numbers, where it flew and they are logged; of a target they come with the
    /// samples that are.
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

impl Decision {
    /// Rotors off, with no more to say.
    #[must_use]
    pub fn off() -> Self {
        Self {
            command: Command::zero(),
            body_rate: None,
            zeta: [0.0; 4],
            mode: Mode::Off,
            fault: None,
            margins: None,
            telemetry: None,
        }
    }

    /// What the vehicle is told.
    #[must_use]
    pub fn order(&self) -> Order {
        let Command { thrust, .. } = self.command;
        self.body_rate.map_or(Order::Wrench(self.command), |body_rate| Order::Rates { thrust, body_rate })
    }
}

impl<T: Real> Pilot<T> {
    /// The controller that `spec` describes, rotors off.
    ///
    /// # Errors
    /// [`Invalid`] for a number that a parameter does not take, that rounding to `T` takes out of
    /// range, or gains that it makes unstable.
    pub fn new(spec: &ControllerSpec) -> Result<Self, Invalid> {
        let parameters = without_path(spec).map_err(|unsupported| Invalid::new("controller", unsupported))?;
        Self::of(spec, &parameters)
    }

    /// The same with `parameters` in place of those that `spec` has by itself.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of(spec: &ControllerSpec, parameters: &Parameters<f64>) -> Result<Self, Invalid> {
        Self::with_actuation(spec, parameters, |actuators| actuators)
    }
}

impl<T: Real, A: Actuation<T>> Pilot<T, A> {
    /// The same with what `of` makes of its actuators in their place.
    ///
    /// # Errors
    /// As [`new`](Pilot::new).
    pub fn with_actuation(
        spec: &ControllerSpec,
        parameters: &Parameters<f64>,
        of: impl FnOnce(Actuators<T>) -> A,
    ) -> Result<Self, Invalid> {
        let refused = |error| Invalid::out_of_range("controller", error);
        let path: FlownPath<T> = match &spec.law {
            Law::Follow { path, .. } => path.build().map_err(refused)?,
            // Never flown: the tables' own.
            Law::Track { .. } => PathSpec::default().build().map_err(refused)?,
        };
        let parameters = parameters.cast();
        let actuation = of(Actuators::new(&parameters).map_err(|error| Invalid::new("controller", error))?);
        let rig =
            Rig::with_actuation(path, &parameters, actuation).map_err(|error| Invalid::new("controller", error))?;
        let lands = spec.law.route().is_some_and(RouteSpec::lands);
        let rig = if lands { rig.landing_at_end() } else { rig };
        let reference = match spec.law {
            Law::Follow { .. } => None,
            Law::Track { reference, .. } => Some(reference),
        };
        Ok(Self {
            rig: Box::new(rig),
            reference,
            joins: spec.supervised,
            gives_rates: spec.rate_loop_s.is_some(),
            has_telemetry: true,
            decision: Decision::off(),
        })
    }

    /// The same where nobody logs its telemetry, which it then does not make.
    #[must_use]
    pub fn without_telemetry(self) -> Self {
        Self { has_telemetry: false, ..self }
    }

    /// What turns its commands into thrust and torque.
    pub fn actuation(&self) -> &A {
        self.rig.actuators()
    }

    /// The command for the hold that begins at `t_s`, from what is read then.
    #[inline]
    pub fn decide(&mut self, read: &Reading, request: Request, t_s: f64) -> &Decision {
        let state: State<T> = read.state.cast();
        let uav = read.uav.as_ref().map(Uav::cast);
        let specific_force = read.specific_force.map(|force| force.map(T::lit));
        let all = Measured { state: read.sees_load.then_some(&state), uav: uav.as_ref(), specific_force };
        let measured = if read.comes { all } else { None.into() };
        let phase = self.reference.map_or(T::zero(), |reference| reference.phase(t_s));
        // Both are those at the sample.
        self.decision.zeta = self.rig.zeta().map(T::cast);
        let integral = self.has_telemetry.then(|| self.rig.integral());
        let rig::Output { command, mode, fault, .. } = *self.rig.step(measured, request, phase);
        self.decision.command = command.cast();
        (self.decision.mode, self.decision.fault) = (mode, fault);
        self.decision.body_rate =
            self.gives_rates.then(|| self.rig.rate_setpoint(measured.body_rate()).body_rate.map(T::cast));
        self.decision.margins = self.rig.margins().map(Margins::cast);
        if let Some(integral) = integral {
            self.decision.telemetry = self.telemetry(integral, &state);
        }
        &self.decision
    }

    /// The last step's, on `state`, with ξ̃ as it was before.
    fn telemetry(&self, integral: [T; 3], state: &State<T>) -> Option<Telemetry> {
        let rig::Telemetry { law, payload_force, uav_force, torque, payload_mass } = self.rig.telemetry(state);
        law.map(|rig::LawNumbers { xi, nu, .. }| Telemetry {
            integral: integral.map(T::cast),
            xi: xi.map(T::cast),
            nu: nu.map(T::cast),
            observed: Observed {
                payload_force: payload_force.map(T::cast),
                uav_force: uav_force.map(T::cast),
                torque: torque.map(T::cast),
                payload_mass: payload_mass.cast(),
            },
        })
    }
}

impl<T: Real, A: Actuation<T>> Answers for Pilot<T, A> {
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]) {
        // A refused state leaves the law as it was, which the flight then shows.
        let _ = self.rig.start(&state.cast(), zeta.map(T::lit));
    }

    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        // A refused state leaves the law as it was, which the flight then shows.
        let (state, applied) = (state.cast(), applied.cast());
        let _ = if self.joins { self.rig.take_over(&state, applied) } else { self.rig.start_from(&state, applied) };
    }

    fn set_speed_factor(&mut self, factor: f64) {
        self.rig.set_speed_factor(T::lit(factor));
    }

    fn lands(&self) -> bool {
        self.rig.is_landing_at_end()
    }

    #[inline]
    fn step(&mut self, read: &Reading, request: Request, t_s: f64) -> Option<&Decision> {
        Some(self.decide(read, request, t_s))
    }
}
