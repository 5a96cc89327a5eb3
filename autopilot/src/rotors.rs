//! From what the law asks for to what the rotors are told.

use controller::sampled::allocation::Place;
use controller::{Actuation, ActuatorLimits, Command, OutOfRange, RotorParams, Rotors};

use crate::parameters::{Parameter, Parameters};

/// The limits that the pilot sets, and then four rotors, which have the last word.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuators {
    limits: ActuatorLimits<f32>,
    rotors: Rotors<f32, 4>,
    per_max_speed: f32,
}

impl Actuators {
    /// As `parameters` describes them.
    ///
    /// # Errors
    /// A limit or a rotor's number is out of range, or the rotors have no room for torque.
    pub fn new(parameters: &Parameters) -> Result<Self, OutOfRange<f32>> {
        let get = |parameter| parameters.get(parameter);
        let limits = ActuatorLimits {
            min_thrust: get(Parameter::ThrustMin),
            max_thrust: get(Parameter::ThrustMax),
            max_torque: parameters.run(Parameter::TorqueMax1),
        };
        limits.check()?;
        let rotor = RotorParams {
            thrust_coefficient: get(Parameter::RotorThrust),
            torque_coefficient: get(Parameter::RotorTorque),
            min_speed: get(Parameter::RotorSpeedMin),
            max_speed: get(Parameter::RotorSpeedMax),
        };
        let arm = get(Parameter::RotorArm);
        let place = |x, y, counter_clockwise| Place { x, y, counter_clockwise };
        // The order of most autopilots: front right, rear left, front left, rear right.
        let places =
            [place(arm, arm, true), place(-arm, -arm, true), place(arm, -arm, false), place(-arm, arm, false)];
        Ok(Self { limits, rotors: Rotors::new(rotor, &places)?, per_max_speed: 1.0 / rotor.max_speed })
    }

    /// The limits without the rotors.
    pub(crate) fn limits(&self) -> ActuatorLimits<f32> {
        self.limits
    }

    /// Rotor speeds as shares of the largest, 0 to 1. A command of nothing at all stops them, where the least thrust has them idle.
    #[must_use]
    pub fn duties(&self, command: &Command<f32>) -> [f32; 4] {
        if *command == Command::zero() {
            return [0.0; 4];
        }
        // Rounding alone can lead outside.
        self.rotors.allocate(command).speeds.map(|speed| (speed * self.per_max_speed).min(1.0))
    }

    /// Whether `wanted` is more than can be given.
    #[must_use]
    pub fn limit(&self, wanted: &Command<f32>) -> bool {
        self.apply(wanted) != *wanted
    }
}

impl Actuation<f32> for Actuators {
    /// Always: they were checked when they were made.
    fn check(&self) -> Result<(), OutOfRange<f32>> {
        Ok(())
    }

    #[inline]
    fn apply(&self, command: &Command<f32>) -> Command<f32> {
        self.rotors.apply(&self.limits.apply(command))
    }

    fn least_thrust(&self) -> f32 {
        self.apply(&Command::zero()).thrust
    }
}
