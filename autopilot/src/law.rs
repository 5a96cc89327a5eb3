//! The law that the parameters describe, as it flies: path following under the supervisor, or the tracking law under a least guard.

use controller::{
    Command, Disturbance, Fault, Follower, Margin, Margins, Mode, Request, SetupError, Solution, State, Supervisor,
    Vehicle,
};

use crate::parameters::{Parameter, Parameters};
use crate::path::{AnyPath, path};
use crate::rotors::Actuators;
use crate::setup;
use crate::track::{Tracked, Tracking};

/// Why a law could not be made of the parameters.
pub type SetupRefused = SetupError<f32>;

/// A law with everything it needs.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)]
pub enum Law {
    /// Path following.
    Follow(Supervisor<f32, AnyPath, Actuators>),
    /// Trajectory tracking of a circle.
    Track(Tracking),
}

/// What one step of either law gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Thrust and torque for the coming hold.
    pub command: Command<f32>,
    /// What the vehicle is doing.
    pub mode: Mode,
    /// Why it is not doing what was asked for.
    pub fault: Option<Fault>,
    /// A margin past its warning.
    pub warning: Option<Margin>,
    /// The law's own answer, where it was asked.
    pub answer: Option<LawAnswer>,
}

/// The numbers of a law's answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawAnswer {
    /// The compensator's input, m/s⁶.
    pub u_zeta: f32,
    /// ζ at the next sample.
    pub zeta: [f32; 4],
    /// ξ, padded with zeros to the longer law's 20 numbers.
    pub xi: [f32; 20],
    /// Wanted highest derivatives of the outputs.
    pub nu: [f32; 4],
    /// Distances from the singularities.
    pub margins: Margins<f32>,
    /// It is more than the actuators give.
    pub limited: bool,
}

impl LawAnswer {
    /// `xi`'s parts and ζ belong to a `solution` of which `applied` came.
    fn new<X>(
        solution: &Solution<f32, X>,
        xi: [&[f32]; 4],
        zeta: &[f32; 4],
        applied: &Command<f32>,
        actuators: &Actuators,
    ) -> Self {
        let mut padded = [0.0; 20];
        for (slot, &number) in padded.iter_mut().zip(xi.into_iter().flatten()) {
            *slot = number;
        }
        // After a take-over what is applied differs without being limited; mostly it does not differ, and nothing has to be found out.
        let limited = solution.command != *applied && actuators.limit(&solution.command);
        Self { u_zeta: solution.u_zeta, zeta: *zeta, xi: padded, nu: solution.nu, margins: solution.margins, limited }
    }
}

impl Law {
    /// The law of `parameters`, rotors off.
    ///
    /// # Errors
    /// A parameter that the controller refuses, or gains that make no stable loop.
    pub fn new(parameters: &Parameters) -> Result<Self, SetupRefused> {
        if parameters.is_on(Parameter::Law) {
            return Ok(Self::Track(Tracking::new(parameters)?));
        }
        let vehicle = setup::vehicle(parameters)?;
        let follower =
            Follower::new(vehicle, path(parameters)?, setup::gains(parameters), setup::sampling(parameters))?
                .with_actuation(Actuators::new(parameters)?)?
                .with_observer(&setup::observer(parameters))?;
        let (envelope, approach) = (setup::envelope(parameters), setup::approach(parameters));
        Ok(Self::Follow(Supervisor::new(follower, &envelope, approach, setup::policy(parameters))?))
    }

    /// Starts from a stated ζ, with the integrals at zero.
    pub fn start(&mut self, state: &State<f32>, zeta: [f32; 4]) {
        match self {
            Self::Follow(supervisor) => supervisor.start(state, zeta),
            Self::Track(tracking) => tracking.start(state, zeta),
        }
    }

    /// Takes over a flying vehicle from `applied`, without a bump in thrust.
    pub fn take_over(&mut self, state: &State<f32>, applied: Command<f32>) {
        match self {
            Self::Follow(supervisor) => supervisor.take_over(state, applied),
            Self::Track(tracking) => tracking.take_over(state, applied),
        }
    }

    /// One control step on whatever state there is. The tracking law takes no request, and has a reference, which is at `phase` (rad) now.
    #[inline]
    pub fn step(&mut self, state: &State<f32>, request: Request, phase: f32) -> Step {
        match self {
            Self::Follow(supervisor) => {
                let controller::Output { command, mode, fault, warning } = supervisor.step(state, request);
                let follower = supervisor.follower();
                let (zeta, actuators) = (follower.zeta(), follower.actuation());
                let answer = supervisor.solution().map(|solution| {
                    let xi: [&[f32]; 4] = [&solution.xi.h1, &solution.xi.h2, &solution.xi.h3, &solution.xi.h4];
                    LawAnswer::new(solution, xi, zeta, &command, actuators)
                });
                Step { command, mode, fault, warning, answer }
            }
            Self::Track(tracking) => {
                let Tracked { command, fault, solution } = tracking.step(state, phase);
                let answer = solution.map(|solution| {
                    let [p1, p2, p3] = &solution.xi.position;
                    let xi: [&[f32]; 4] = [p1, p2, p3, &solution.xi.yaw];
                    LawAnswer::new(&solution, xi, tracking.tracker().zeta(), &command, tracking.actuators())
                });
                Step { command, mode: tracking.mode(), fault, warning: None, answer }
            }
        }
    }

    /// What the vehicle has been doing since the last step.
    #[must_use]
    pub fn mode(&self) -> Mode {
        match self {
            Self::Follow(supervisor) => supervisor.mode(),
            Self::Track(tracking) => tracking.mode(),
        }
    }

    /// What turns commands into rotor speeds.
    #[must_use]
    pub fn actuators(&self) -> &Actuators {
        match self {
            Self::Follow(supervisor) => supervisor.follower().actuation(),
            Self::Track(tracking) => tracking.actuators(),
        }
    }

    /// ξ̃ at the next sample; zero for the tracking law, which has none.
    #[must_use]
    pub fn integral(&self) -> [f32; 3] {
        match self {
            Self::Follow(supervisor) => *supervisor.follower().integral(),
            Self::Track(_) => [0.0; 3],
        }
    }

    /// The disturbances found up to the last sample.
    #[must_use]
    pub fn disturbance(&self) -> &Disturbance<f32> {
        match self {
            Self::Follow(supervisor) => supervisor.disturbance(),
            Self::Track(tracking) => tracking.tracker().disturbance(),
        }
    }

    /// The vehicle as the law knows it.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle<f32> {
        match self {
            Self::Follow(supervisor) => supervisor.follower().vehicle(),
            Self::Track(tracking) => tracking.vehicle(),
        }
    }
}
