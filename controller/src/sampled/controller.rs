//! A law at a fixed rate: the bare controller, as the paper's figures fly it.

use model::{Command, Disturbance, Real, State, Vehicle};

use crate::error::{Refused, SetupError};
use crate::law::Law;
use crate::law::approach::Pace;
use crate::law::follow::{Follow, Gains};
use crate::law::solution::Solution;
use crate::law::track::{Reference, Track, TrackGains, TrackXi};
use crate::path::Path;
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::observer::ObserverParams;
use crate::sampled::sampler::Sampler;
use crate::sampling::Sampling;

/// A law and the sampled memory it flies with.
///
/// This is the bare law: near its singularities it answers what it must.
/// [`Supervisor`](crate::Supervisor) is total.
///
/// ```
/// use controller::{Command, Reference, Sampling, State, TrackGains, Tracker};
/// use controller::{Vector3, Vehicle, VehicleParams};
///
/// let vehicle = Vehicle::new(VehicleParams::<f32>::paper())?;
/// let mut tracker = Tracker::new(vehicle, TrackGains::spread(1.0)?, Sampling::every(0.002))?;
/// let state = State::at_rest(Vector3::new(0.0, 5.0, -10.0));
/// tracker.take_over(&state, Command::of_thrust(vehicle.hover_thrust()))?;
/// let solution = tracker.track(&state, &Reference::circle(5.0, -10.0, 0.2, 0.0));
/// assert!(solution.command.is_finite());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Controller<T, L, A = ActuatorLimits<T>> {
    law: L,
    sampler: Sampler<T, A>,
    is_started: bool,
}

/// The path-following controller.
pub type Follower<T, P, A = ActuatorLimits<T>> = Controller<T, Follow<T, P>, A>;

/// The trajectory-tracking controller.
pub type Tracker<T, A = ActuatorLimits<T>> = Controller<T, Track<T>, A>;

impl<T: Real, P: Path<T>> Controller<T, Follow<T, P>> {
    /// Path following at hover (ζ = 0), without limits or observers, as the paper's.
    ///
    /// # Errors
    /// A parameter of `sampling` is out of range, or an output's loop is not stable.
    pub fn new(vehicle: Vehicle<T>, path: P, gains: Gains<T>, sampling: Sampling<T>) -> Result<Self, SetupError<T>> {
        let sampler = Sampler::new(vehicle, &sampling)?;
        Ok(Self { law: Follow::new(path, gains, &sampling)?, sampler, is_started: false })
    }
}

impl<T: Real> Controller<T, Track<T>> {
    /// Trajectory tracking at hover (ζ = 0), without limits or observers.
    ///
    /// # Errors
    /// A parameter of `sampling` is out of range, or an output's loop is not stable.
    pub fn new(vehicle: Vehicle<T>, gains: TrackGains<T>, sampling: Sampling<T>) -> Result<Self, SetupError<T>> {
        let sampler = Sampler::new(vehicle, &sampling)?;
        Ok(Self { law: Track::new(gains)?, sampler, is_started: false })
    }
}

impl<T: Real, A: Actuation<T>> Controller<T, Track<T>, A> {
    /// [`step`](Self::step) with the `reference` about now.
    #[inline]
    pub fn track(&mut self, sampled: &State<T>, reference: &Reference<T>) -> Solution<T, TrackXi<T>> {
        self.law.set_reference(reference);
        self.step(sampled)
    }
}

impl<T: Real, L: Law<T>> Controller<T, L> {
    /// With limits on what is commanded.
    ///
    /// # Errors
    /// A limit is out of range, or the vehicle can't hover within them.
    pub fn with_limits(self, limits: ActuatorLimits<T>) -> Result<Self, SetupError<T>> {
        self.with_actuation(limits)
    }
}

impl<T: Real, L: Law<T>, A: Actuation<T>> Controller<T, L, A> {
    /// With `actuation` in place of the one it has: [`Rotors`](crate::Rotors), say.
    ///
    /// # Errors
    /// A parameter of `actuation` is out of range, or the vehicle can't hover with it.
    pub fn with_actuation<B: Actuation<T>>(self, actuation: B) -> Result<Controller<T, L, B>, SetupError<T>> {
        let Self { law, sampler, is_started } = self;
        Ok(Controller { law, sampler: sampler.with_actuation(actuation)?, is_started })
    }

    /// With disturbance observers, reset.
    ///
    /// # Errors
    /// A parameter of `params` is out of range.
    pub fn with_observer(mut self, params: ObserverParams<T>) -> Result<Self, SetupError<T>> {
        self.sampler.set_observer(&params)?;
        Ok(self)
    }

    /// Starts from a stated ζ with integrals and disturbances at zero. Hover is ζ = 0. The first
    /// step does so if nothing else did.
    ///
    /// # Errors
    /// A part of `state` or of `zeta` is not finite or out of any range; nothing has changed.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        self.sampler.start(state, zeta)?;
        self.begin(state);
        Ok(())
    }

    /// Takes over from whatever applied `applied` until now, without a bump: thrust goes on from
    /// there with the payload's vertical acceleration, and the torque's step against it fades.
    /// Integrals and disturbances start at zero.
    ///
    /// # Errors
    /// A part of `state` or of `applied` is not finite or out of any range; nothing has changed.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        self.sampler.take_over(state, applied)?;
        self.begin(state);
        Ok(())
    }

    /// Joins the path from afar at `pace`: [takes over](Self::take_over), and slides the path from
    /// where the payload is to where it belongs.
    ///
    /// # Errors
    /// As [`take_over`](Self::take_over), or no point of the path was found; nothing has changed.
    pub fn join(&mut self, state: &State<T>, applied: Command<T>, pace: &Pace<T>) -> Result<(), Refused> {
        state.check().map_err(Refused::State)?;
        if !applied.is_finite() {
            return Err(Refused::Applied);
        }
        loop {
            match self.law.join(state, pace) {
                Err(Refused::Searching) => {}
                joined => break joined?,
            }
        }
        self.is_started = true;
        self.sampler.take_over(state, applied)
    }

    fn begin(&mut self, state: &State<T>) {
        self.law.restart(state);
        self.is_started = true;
    }

    /// The command for the coming hold where no state was sampled now: from what the model makes of
    /// the last one.
    pub fn carry(&mut self) -> Solution<T, L::Xi> {
        let carried = self.sampler.carry();
        self.step(&carried)
    }

    /// The command for the coming hold, from the state sampled now. Call once every period.
    #[inline]
    pub fn step(&mut self, sampled: &State<T>) -> Solution<T, L::Xi> {
        if !self.is_started {
            self.first(sampled);
        }
        self.sampler.sample(sampled);
        self.sampler.ask(&mut self.law);
        let command = self.sampler.accept(&mut self.law);
        Solution { command, ..self.law.solution() }
    }

    /// From hover, if there is a state to do so.
    #[cold]
    fn first(&mut self, sampled: &State<T>) {
        if self.sampler.start(sampled, [T::zero(); 4]).is_ok() {
            self.begin(sampled);
        }
    }

    /// The law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The law, for what may be changed of it in flight.
    pub fn law_mut(&mut self) -> &mut L {
        &mut self.law
    }

    /// The sampled memory.
    pub fn sampler(&self) -> &Sampler<T, A> {
        &self.sampler
    }

    /// Law and memory, for a supervisor.
    pub(crate) fn into_parts(self) -> (L, Sampler<T, A>) {
        (self.law, self.sampler)
    }

    /// ζ when the next command begins to act (the next sample, without latency and lag).
    pub fn zeta(&self) -> &[T; 4] {
        self.sampler.zeta()
    }

    /// The disturbances found up to the last sample, beyond the vehicle as it was told.
    pub fn disturbance(&self) -> Disturbance<T> {
        self.sampler.disturbance()
    }

    /// The vehicle as it was told.
    pub fn vehicle(&self) -> &Vehicle<T> {
        self.sampler.vehicle()
    }
}
