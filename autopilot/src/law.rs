//! The law that the parameters describe.

use controller::{
    Command, Follower, Gains, Margins, Reference, Sampling, SetupError, State, TrackGains, Tracker, Vehicle,
    VehicleParams,
};

use crate::parameters::{Parameter, Parameters};
use crate::path::{AnyPath, path};

/// Why a law could not be made of the parameters.
pub type SetupRefused = SetupError<f32>;

/// A law with everything it needs.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)]
pub enum Law {
    /// Path following.
    Follow(Follower<f32, AnyPath>),
    /// Trajectory tracking of a circle.
    Track {
        /// The law.
        tracker: Tracker<f32>,
        /// Radius (m), p3 (m) and rate (rad/s) of the reference.
        circle: [f32; 3],
    },
}

/// What one step of either law gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Thrust and torque for the coming hold.
    pub command: Command<f32>,
    /// The compensator's input, m/s⁶.
    pub u_zeta: f32,
    /// ξ, padded with zeros to the longer law's 20 numbers.
    pub xi: [f32; 20],
    /// Wanted highest derivatives of the outputs.
    pub nu: [f32; 4],
    /// Distances from the singularities.
    pub margins: Margins<f32>,
}

impl Law {
    /// The law of `parameters`, at hover.
    ///
    /// # Errors
    /// A parameter the vehicle or path refuses, or gains that make no stable loop.
    pub fn new(parameters: &Parameters) -> Result<Self, SetupRefused> {
        let get = |parameter| parameters.get(parameter);
        let vehicle = Vehicle::new(VehicleParams {
            payload_mass: get(Parameter::PayloadMass),
            uav_mass: get(Parameter::UavMass),
            rod_length: get(Parameter::RodLength),
            inertia: parameters.run(Parameter::Inertia1),
            gravity: get(Parameter::Gravity),
        })?;
        let sampling = Sampling {
            period: get(Parameter::Period),
            latency: get(Parameter::Latency),
            rotor_lag: get(Parameter::RotorLag),
            look_ahead: get(Parameter::LookAhead) > 0.5,
        };
        if get(Parameter::Law) > 0.5 {
            let position = [Parameter::K1D0, Parameter::K2D0, Parameter::K3D0].map(|first| parameters.run(first));
            let gains = TrackGains { position, yaw: parameters.run(Parameter::K4D0) };
            let circle = [get(Parameter::PathRadius), get(Parameter::PathP3), get(Parameter::ReferenceRate)];
            return Ok(Self::Track { tracker: Tracker::new(vehicle, gains, sampling)?, circle });
        }
        let gains = Gains {
            k1: parameters.run(Parameter::K1D0),
            k2: parameters.run(Parameter::K2D0),
            k3: parameters.run(Parameter::K3D0),
            k4: parameters.run(Parameter::K4D0),
            integral: parameters.run(Parameter::KI1),
        };
        Ok(Self::Follow(Follower::new(vehicle, path(parameters)?, gains, sampling)?))
    }

    /// Starts from a stated ζ, with the integrals at zero.
    pub fn start(&mut self, state: &State<f32>, zeta: [f32; 4]) {
        match self {
            Self::Follow(follower) => follower.start(state, zeta),
            Self::Track { tracker, .. } => tracker.start(state, zeta),
        }
    }

    /// Takes over from `applied` without a bump in thrust.
    pub fn engage(&mut self, state: &State<f32>, applied: Command<f32>) {
        match self {
            Self::Follow(follower) => follower.engage(state, applied),
            Self::Track { tracker, .. } => tracker.engage(state, applied),
        }
    }

    /// One control step; `phase` (rad) is where the tracking law's reference is now.
    #[inline]
    pub fn step(&mut self, state: &State<f32>, phase: f32) -> Step {
        let mut xi = [0.0; 20];
        let mut fill = |parts: [&[f32]; 4]| {
            for (slot, &number) in xi.iter_mut().zip(parts.into_iter().flatten()) {
                *slot = number;
            }
        };
        match self {
            Self::Follow(follower) => {
                let solution = follower.step(state);
                fill([&solution.xi.h1, &solution.xi.h2, &solution.xi.h3, &solution.xi.h4]);
                let controller::Solution { command, u_zeta, nu, margins, .. } = solution;
                Step { command, u_zeta, xi, nu, margins }
            }
            Self::Track { tracker, circle: [radius, p3, rate] } => {
                let solution = tracker.step(state, &Reference::circle(*radius, *p3, *rate, phase));
                let [p1, p2, p3] = &solution.xi.position;
                fill([p1, p2, p3, &solution.xi.yaw]);
                let controller::Solution { command, u_zeta, nu, margins, .. } = solution;
                Step { command, u_zeta, xi, nu, margins }
            }
        }
    }

    /// ζ at the next sample.
    #[must_use]
    pub fn zeta(&self) -> [f32; 4] {
        match self {
            Self::Follow(follower) => *follower.zeta(),
            Self::Track { tracker, .. } => *tracker.zeta(),
        }
    }

    /// ξ̃ at the next sample; zero for the tracking law, which has none.
    #[must_use]
    pub fn integral(&self) -> [f32; 3] {
        match self {
            Self::Follow(follower) => *follower.integral(),
            Self::Track { .. } => [0.0; 3],
        }
    }

    /// The thrust that holds the vehicle at rest, N.
    #[must_use]
    pub fn hover_thrust(&self) -> f32 {
        match self {
            Self::Follow(follower) => follower.vehicle().hover_thrust(),
            Self::Track { tracker, .. } => tracker.vehicle().hover_thrust(),
        }
    }
}

impl Step {
    /// Whether the command and what is kept of it are numbers.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let Command { thrust, torque } = &self.command;
        thrust.is_finite() && self.u_zeta.is_finite() && torque.iter().all(|x| x.is_finite())
    }
}
