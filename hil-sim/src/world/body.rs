//! What moves: on the paper's rod, or on a cable.

use controller::{Command, Matrix3, State, Vector3};

use super::cable::Cable;
use super::ground::Ground;
use super::multibody::{Acceleration, Loads, Multibody, square};
use super::tethered::Tethered;
use witness::plant::VehicleParameters;

/// Where payload and UAV are and how they move, in N; the body rate in body axes. The cable between
/// them may be slack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// Of the payload, m.
    pub position: Vector3<f64>,
    /// Of the payload, m/s.
    pub velocity: Vector3<f64>,
    /// Of the UAV's centre of mass, m.
    pub uav_position: Vector3<f64>,
    /// Of the UAV's centre of mass, m/s.
    pub uav_velocity: Vector3<f64>,
    /// R, body to N.
    pub attitude: Matrix3<f64>,
    /// ω in body axes, rad/s.
    pub body_rate: Vector3<f64>,
}

impl Bodies {
    /// With the UAV at p − L q, on a rod of `length` (m).
    #[must_use]
    pub fn on_rod(state: &State<f64>, length: f64) -> Self {
        Self {
            position: state.position,
            velocity: state.velocity,
            uav_position: state.position - state.rod * length,
            uav_velocity: state.velocity - state.rod_rate * length,
            attitude: state.attitude,
            body_rate: state.body_rate,
        }
    }

    /// The state as the law takes it: q is the line from the UAV's centre of mass to the payload.
    #[must_use]
    pub fn state(&self) -> State<f64> {
        let (d, apart) = (self.position - self.uav_position, self.velocity - self.uav_velocity);
        let length = square(&d).sqrt();
        // One on top of the other: as if it hung straight down.
        let (rod, rod_rate) = if length <= 1e-9 {
            (Vector3::z(), Vector3::zeros())
        } else {
            let rod = d / length;
            (rod, (apart - rod * rod.dot(&apart)) / length)
        };
        State {
            position: self.position,
            velocity: self.velocity,
            rod,
            rod_rate,
            attitude: self.attitude,
            body_rate: self.body_rate,
        }
    }
}

/// How fast velocities change, and what the cable pulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// v̇ of the payload in N, m/s².
    pub payload: Vector3<f64>,
    /// v̇_Q of the UAV in N, m/s².
    pub uav: Vector3<f64>,
    /// ω̇ in body axes, rad/s².
    pub body: Vector3<f64>,
    /// The cable's tension, N; of a rod, negative while it pushes.
    pub pull: f64,
}

/// A vehicle with its payload.
// A flight has one: a box would cost every step more than a copy's bytes.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// On a massless rigid rod, far from any ground.
    Rod(Multibody),
    /// On a cable, over ground if there is any.
    Cable(Tethered),
}

impl Body {
    /// `vehicle` in `state`.
    #[must_use]
    pub fn new(vehicle: VehicleParameters, cable: Option<Cable>, ground: Option<Ground>, state: &State<f64>) -> Self {
        if cable.is_none() && ground.is_none() {
            return Self::Rod(Multibody::new(vehicle, state));
        }
        Self::apart(vehicle, cable, ground, &Bodies::on_rod(state, vehicle.rod_length))
    }

    /// `vehicle` with its payload anywhere, on a cable.
    #[must_use]
    pub fn apart(vehicle: VehicleParameters, cable: Option<Cable>, ground: Option<Ground>, bodies: &Bodies) -> Self {
        Self::Cable(Tethered::new(vehicle, cable.unwrap_or_default(), ground, bodies))
    }

    /// The vehicle that moves.
    #[must_use]
    pub fn vehicle(&self) -> &VehicleParameters {
        match self {
            Self::Rod(body) => body.vehicle(),
            Self::Cable(body) => body.vehicle(),
        }
    }

    /// Another payload mass, kg, from now on, all velocities kept: the mass joins or leaves at the
    /// payload's velocity.
    pub fn set_payload_mass(&mut self, mass: f64) {
        match self {
            Self::Rod(body) => body.set_payload_mass(mass),
            Self::Cable(body) => body.set_payload_mass(mass),
        }
    }

    /// Tells the cable what time it is.
    #[inline]
    pub(super) fn set_time(&mut self, t_s: f64) {
        if let Self::Cable(body) = self {
            body.set_time(t_s);
        }
    }

    /// The state as the law takes it.
    #[inline]
    #[must_use]
    pub fn state(&self) -> State<f64> {
        match self {
            Self::Rod(body) => body.state(),
            Self::Cable(body) => body.state(),
        }
    }

    /// Where both are.
    #[must_use]
    pub fn bodies(&self) -> Bodies {
        match self {
            Self::Rod(body) => Bodies::on_rod(&body.state(), body.vehicle().rod_length),
            Self::Cable(body) => body.bodies(),
        }
    }

    /// Position of the payload in N, m.
    #[must_use]
    pub fn position(&self) -> Vector3<f64> {
        match self {
            Self::Rod(body) => body.position(),
            Self::Cable(body) => body.bodies().position,
        }
    }

    /// Position of the UAV in N, m.
    #[must_use]
    pub fn uav_position(&self) -> Vector3<f64> {
        match self {
            Self::Rod(body) => body.uav_position(),
            Self::Cable(body) => body.bodies().uav_position,
        }
    }

    /// Velocity of the UAV in N, m/s.
    #[must_use]
    pub fn uav_velocity(&self) -> Vector3<f64> {
        match self {
            Self::Rod(body) => body.uav_velocity(),
            Self::Cable(body) => body.bodies().uav_velocity,
        }
    }

    /// Whether the cable pulls; a rod always counts as taut.
    #[must_use]
    pub fn is_taut(&self) -> bool {
        match self {
            Self::Rod(_) => true,
            Self::Cable(body) => body.is_taut(),
        }
    }

    /// Whether the payload, and whether the UAV, is on the ground.
    #[must_use]
    pub fn touching(&self) -> [bool; 2] {
        match self {
            Self::Rod(_) => [false; 2],
            Self::Cable(body) => body.touching(),
        }
    }

    /// Kinetic and potential energy, J.
    #[must_use]
    pub fn energy(&self) -> f64 {
        match self {
            Self::Rod(body) => body.energy(),
            Self::Cable(body) => body.energy(),
        }
    }

    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Rod(body) => body.is_finite(),
            Self::Cable(body) => body.is_finite(),
        }
    }

    /// Accelerations and the cable's pull now, under `command` and `loads`.
    #[must_use]
    pub fn rates(&self, command: &Command<f64>, loads: &Loads) -> Rates {
        match self {
            Self::Rod(body) => {
                let Acceleration { payload, rod, body: turn } = body.acceleration(command, loads);
                let VehicleParameters { payload_mass, rod_length, gravity, .. } = *body.vehicle();
                let mut free = loads.payload_force;
                free.z += payload_mass * gravity;
                let pull = body.state().rod.dot(&(free - payload * payload_mass));
                Rates { payload, uav: payload - rod * rod_length, body: turn, pull }
            }
            Self::Cable(body) => body.rates(command, loads),
        }
    }

    /// The longest step, s, that resolves what moves.
    #[inline]
    pub(super) fn largest_step(&self) -> f64 {
        match self {
            Self::Rod(_) => f64::INFINITY,
            Self::Cable(body) => body.largest_step(),
        }
    }

    /// Moves on by `step` seconds. `command` gives thrust and torque, and `loads` what the
    /// velocities of payload and UAV (N, m/s) bring with them, at a time since the step's start.
    #[inline]
    pub fn advance(
        &mut self,
        step: f64,
        command: impl Fn(f64) -> Command<f64>,
        loads: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Loads,
    ) {
        match self {
            Self::Rod(body) => body.advance(step, command, loads),
            Self::Cable(body) => body.advance(step, &command, &loads),
        }
    }
}
