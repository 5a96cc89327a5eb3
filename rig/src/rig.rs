//! The controller as it flies: a supervised law of either kind, with limits and rotors.

use controller::{
    Actuation, Command, Controller, Disturbance, Fault, Follow, Follower, Margin, Margins, Measured, Mode, Path,
    Real, Refused, Request, Sampling, Solution, State, Supervisor, Vector3, Vehicle, dynamics,
};

use crate::actuators::Actuators;
use crate::error::SetupError;
use crate::parameter;
use crate::parameters::Parameters;
use crate::profile::{AnyPath, path};
use crate::setpoint;

/// A controller made of [`Parameters`]: states and requests in, commands and rotor speeds out.
#[derive(Clone, Debug)]
pub struct Rig<T: Real, P = AnyPath<T>, A = Actuators<T>> {
    law: Law<T, P, A>,
    last: Output<T>,
    /// Of an inner rate loop about each body axis, with the latency to it, s.
    time_constants: Vector3<T>,
    end: End,
}

/// What is done where a route ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Hover,
    /// A landing, once the payload has rested there.
    Land,
    /// It has.
    Landing,
}

/// Either law under its supervisor.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)]
enum Law<T: Real, P, A> {
    Follow(Supervisor<T, Follow<T, P>, A>),
    /// With the circle's radius (m), p3 (m) and rate (rad/s).
    #[cfg(feature = "tracking")]
    Track(Supervisor<T, controller::Track<T>, A>, [T; 3]),
}

macro_rules! either {
    ($law:expr, $supervisor:ident => $value:expr) => {
        match $law {
            Law::Follow($supervisor) => $value,
            #[cfg(feature = "tracking")]
            Law::Track($supervisor, _) => $value,
        }
    };
}

/// What a step answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output<T> {
    /// Thrust and torque for the coming hold: finite, and what limits and rotors give.
    pub command: Command<T>,
    /// What the vehicle is doing.
    pub mode: Mode,
    /// Why it is not doing what was asked for: the last fault since something else was.
    pub fault: Option<Fault>,
    /// A margin past its warning.
    pub warning: Option<Margin>,
    /// The law flew, and asked for more than limits and rotors give.
    pub limited: bool,
}

/// Where a command came from, and what was found of disturbances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Telemetry<T> {
    /// The law's numbers, if it flew.
    pub law: Option<LawNumbers<T>>,
    /// Force on the payload in N, beyond the model's, N; along the rod that on both bodies.
    pub payload_force: [T; 3],
    /// Force on the UAV in N, across the rod, N.
    pub uav_force: [T; 3],
    /// Torque on the UAV in body axes, N·m.
    pub torque: [T; 3],
    /// The payload's mass that would explain the force along the rod in still air, kg.
    pub payload_mass: T,
}

/// The numbers of a law's answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawNumbers<T> {
    /// ξ, padded with zeros to the longer law's 20 numbers.
    pub xi: [T; 20],
    /// Wanted highest derivatives of the outputs.
    pub nu: [T; 4],
    /// The compensator's input, m/s⁶.
    pub u_zeta: T,
    /// Distances from the singularities.
    pub margins: Margins<T>,
}

impl<T: Real> Rig<T> {
    /// The controller that `parameters` describe, rotors off.
    ///
    /// # Errors
    /// A parameter that the controller refuses, by its name, or gains that make no stable loop.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, SetupError<T>> {
        Self::on(path(parameters)?, parameters)
    }
}

impl<T: Real, P: Path<T>> Rig<T, P> {
    /// The same on another `path`.
    ///
    /// # Errors
    /// As [`new`](Rig::new).
    pub fn on(path: P, parameters: &Parameters<T>) -> Result<Self, SetupError<T>> {
        Self::with_actuation(path, parameters, Actuators::new(parameters)?)
    }

    /// The last step's command as rotor speeds, shares of the largest: front right, rear left,
    /// front left, rear right.
    #[must_use]
    pub fn duties(&self) -> [T; 4] {
        self.actuators().duties(&self.last.command)
    }
}

impl<T: Real, P: Path<T>, A: Actuation<T>> Rig<T, P, A> {
    /// The same with another `actuation` between the law and the rotors than `LIM_*` and `ROT_*`
    /// describe.
    ///
    /// # Errors
    /// As [`new`](Rig::new).
    pub fn with_actuation(path: P, parameters: &Parameters<T>, actuation: A) -> Result<Self, SetupError<T>> {
        let (vehicle, sampling) = (parameters.vehicle()?, parameters.sampling());
        let law = if parameters.is_on(parameter!("CTL_LAW")) {
            Self::tracking(vehicle, sampling, parameters, actuation)?
        } else {
            let follower = Follower::new(vehicle, path, parameters.gains(), sampling)?;
            Law::Follow(supervised(follower, parameters, actuation)?)
        };
        let last = Output { command: Command::zero(), mode: Mode::Off, fault: None, warning: None, limited: false };
        Ok(Self { law, last, time_constants: setpoint::time_constants(parameters), end: End::Hover })
    }

    #[cfg(feature = "tracking")]
    fn tracking(
        vehicle: Vehicle<T>,
        sampling: Sampling<T>,
        parameters: &Parameters<T>,
        actuation: A,
    ) -> Result<Law<T, P, A>, SetupError<T>> {
        let tracker = controller::Tracker::new(vehicle, parameters.track_gains(), sampling)?;
        let numbers = [parameter!("PATH_RADIUS"), parameter!("PATH_P3"), parameter!("REF_RATE")];
        Ok(Law::Track(supervised(tracker, parameters, actuation)?, numbers.map(|number| parameters.get(number))))
    }

    #[cfg(not(feature = "tracking"))]
    fn tracking(_: Vehicle<T>, _: Sampling<T>, _: &Parameters<T>, _: A) -> Result<Law<T, P, A>, SetupError<T>> {
        Err(controller::OutOfRange { field: "CTL_LAW", value: T::one(), min: T::zero(), max: T::zero() }.into())
    }

    /// Starts on the path, from a stated ζ and with the integrals at zero.
    ///
    /// # Errors
    /// The state or ζ is refused; nothing has changed.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        either!(&mut self.law, supervisor => supervisor.start(state, zeta))
    }

    /// Takes over a flying vehicle from `applied`, without a bump in thrust.
    ///
    /// # Errors
    /// The state or command is refused; nothing has changed.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        either!(&mut self.law, supervisor => supervisor.take_over(state, applied))
    }

    /// Starts on the path at once from where the vehicle flies, continuing what was `applied`.
    ///
    /// # Errors
    /// The state or command is refused; nothing has changed.
    pub fn start_from(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        either!(&mut self.law, supervisor => supervisor.start_from(state, applied))
    }

    /// Wishes for another factor of the path's speed, which changes smoothly: 1 flies the
    /// prescribed speed, 0 stops, less goes back. The tracking law has none.
    pub fn set_speed_factor(&mut self, factor: T) {
        match &mut self.law {
            Law::Follow(supervisor) => supervisor.law_mut().set_speed_factor(factor),
            #[cfg(feature = "tracking")]
            Law::Track(..) => {}
        }
    }

    /// The same, but that [`Request::Follow`] lands the vehicle once its payload has rested at its
    /// route's end, until something else is asked for.
    #[must_use]
    pub fn landing_at_end(self) -> Self {
        Self { end: End::Land, ..self }
    }

    /// Whether it lands because its route is over.
    #[must_use]
    pub fn is_landing_at_end(&self) -> bool {
        self.end == End::Landing
    }

    /// The request that `request` comes to.
    #[cold]
    #[inline(never)]
    fn at_end(&mut self, request: Request) -> Request {
        let is_over = self.mode() == Mode::Follow && self.following().is_some_and(Follow::is_over);
        self.end = match request {
            Request::Follow if is_over => End::Landing,
            Request::Follow | Request::Land => self.end,
            _ => End::Land,
        };
        if self.end == End::Landing { Request::Land } else { request }
    }

    /// One control step on what is measured now: a state if there is one, or all of [`Measured`].
    /// The tracking law's reference is at `phase`, rad, now.
    #[inline]
    pub fn step<'a>(&mut self, measured: impl Into<Measured<'a, T>>, request: Request, phase: T) -> &Output<T> {
        let measured = measured.into();
        let request = if self.end == End::Hover { request } else { self.at_end(request) };
        #[cfg(feature = "tracking")]
        if let Law::Track(supervisor, [radius, p3, rate]) = &mut self.law {
            supervisor.law_mut().set_reference(&controller::Reference::circle(*radius, *p3, *rate, phase));
        }
        #[cfg(not(feature = "tracking"))]
        let _ = phase;
        self.last = either!(&mut self.law, supervisor => {
            let controller::Output { command, mode, fault, warning } = supervisor.step(measured, request);
            let limited = supervisor.answer().is_some() && supervisor.sampler().is_limited();
            Output { command, mode, fault, warning, limited }
        });
        &self.last
    }
}

/// A controller with actuators and observers, under its supervisor.
fn supervised<T: Real, L: controller::Law<T>, A: Actuation<T>>(
    controller: Controller<T, L>,
    parameters: &Parameters<T>,
    actuation: A,
) -> Result<Supervisor<T, L, A>, SetupError<T>> {
    let controller = controller.with_actuation(actuation)?.with_observer(parameters.observer())?;
    let supervisor = Supervisor::new(controller, parameters.envelope(), parameters.approach(), parameters.policy());
    Ok(supervisor.map_err(parameters.naming(&["ENV_", "APP_", "POL_"]))?)
}

impl<T: Real, P: Path<T>, A: Actuation<T>> Rig<T, P, A> {
    /// The last step's answer.
    #[must_use]
    pub fn output(&self) -> &Output<T> {
        &self.last
    }

    /// What the vehicle is doing: as of the last step, or a take-over since.
    #[must_use]
    pub fn mode(&self) -> Mode {
        either!(&self.law, supervisor => supervisor.mode())
    }

    pub(crate) fn time_constants(&self) -> &Vector3<T> {
        &self.time_constants
    }

    /// Distances from the singularities in the last step, if the law flew.
    #[must_use]
    pub fn margins(&self) -> Option<&Margins<T>> {
        either!(&self.law, supervisor => supervisor.answer().map(|answer| &answer.margins))
    }

    /// The compensator's input, m/s⁶, in the last step, if the law flew.
    #[must_use]
    pub fn u_zeta(&self) -> Option<T> {
        either!(&self.law, supervisor => supervisor.answer().map(|answer| answer.u_zeta))
    }

    /// The law that follows a path, if that is the one that flies.
    #[must_use]
    pub fn following(&self) -> Option<&Follow<T, P>> {
        match &self.law {
            Law::Follow(supervisor) => Some(supervisor.law()),
            #[cfg(feature = "tracking")]
            Law::Track(..) => None,
        }
    }

    /// The same, for what may be changed in flight.
    pub fn following_mut(&mut self) -> Option<&mut Follow<T, P>> {
        match &mut self.law {
            Law::Follow(supervisor) => Some(supervisor.law_mut()),
            #[cfg(feature = "tracking")]
            Law::Track(..) => None,
        }
    }

    /// The path alone, if one is flown.
    #[must_use]
    pub fn into_path(self) -> Option<P> {
        match self.law {
            Law::Follow(supervisor) => Some(supervisor.into_law().into_path()),
            #[cfg(feature = "tracking")]
            Law::Track(..) => None,
        }
    }

    /// What turns commands into thrust and torque.
    #[must_use]
    pub fn actuators(&self) -> &A {
        either!(&self.law, supervisor => supervisor.sampler().actuation())
    }

    /// What the rotors give up to the last step's end, by the model of latency and lag.
    #[must_use]
    pub fn applied(&self) -> &Command<T> {
        either!(&self.law, supervisor => supervisor.sampler().applied())
    }

    /// ζ when the next command begins to act.
    #[must_use]
    pub fn zeta(&self) -> &[T; 4] {
        either!(&self.law, supervisor => supervisor.sampler().zeta())
    }

    /// ξ̃ at the next sample; zero for the tracking law, which has none.
    #[must_use]
    pub fn integral(&self) -> [T; 3] {
        match &self.law {
            Law::Follow(supervisor) => *supervisor.law().integral(),
            #[cfg(feature = "tracking")]
            Law::Track(..) => [T::zero(); 3],
        }
    }

    /// The disturbances found up to the last sample, beyond the vehicle as it was told.
    #[must_use]
    pub fn disturbance(&self) -> Disturbance<T> {
        either!(&self.law, supervisor => supervisor.disturbance())
    }

    /// The vehicle as it was told.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle<T> {
        either!(&self.law, supervisor => supervisor.sampler().vehicle())
    }

    /// The law's numbers in the last step, if it flew.
    #[must_use]
    pub fn numbers(&self) -> Option<LawNumbers<T>> {
        match &self.law {
            Law::Follow(supervisor) => supervisor.solution().map(|solution| {
                let xi = &solution.xi;
                LawNumbers::new(&solution, [&xi.h1, &xi.h2, &xi.h3, &xi.h4])
            }),
            #[cfg(feature = "tracking")]
            Law::Track(supervisor, _) => supervisor.solution().map(|solution| {
                let [p1, p2, p3] = &solution.xi.position;
                LawNumbers::new(&solution, [p1, p2, p3, &solution.xi.yaw])
            }),
        }
    }

    /// Where the last step's command came from and what was found, at the `state` that it was made
    /// on.
    #[must_use]
    pub fn telemetry(&self, state: &State<T>) -> Telemetry<T> {
        let (vehicle, found) = (self.vehicle(), self.disturbance());
        let lambda = dynamics::lambda(vehicle, state, self.last.command.thrust);
        Telemetry {
            law: self.numbers(),
            payload_force: found.payload_force(vehicle, &state.rod).into(),
            uav_force: found.uav_force(vehicle, &state.rod).into(),
            torque: found.torque.into(),
            payload_mass: found.implied_payload_mass(vehicle, &state.rod, lambda),
        }
    }
}

impl<T: Real> LawNumbers<T> {
    fn new<X>(solution: &Solution<T, X>, parts: [&[T]; 4]) -> Self {
        let mut xi = [T::zero(); 20];
        for (slot, &number) in xi.iter_mut().zip(parts.into_iter().flatten()) {
            *slot = number;
        }
        Self { xi, nu: solution.nu, u_zeta: solution.u_zeta, margins: solution.margins }
    }
}
