//! Thrust and torque to the four rotors of an X configuration.

use controller::{Command, Real};

use crate::parameters::{Parameter, Parameters};

/// Signs of each rotor's place along b1 and b2 and of its drag torque about b3 (down: a rotor that turns counter-clockwise seen
/// from above drags the body clockwise, which is positive). Front right, rear left, front left, rear right.
const ROTORS: [[f32; 3]; 4] = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0]];

/// The rotors' geometry, with its reciprocals taken once.
///
/// A rotor at (x, y) with thrust f along −b3 and drag torque ±k f gives τ = (−y f, x f, ±k f); with |x| = |y| = l
///
/// ```text
/// f = (T − sgn(y) τ1/l + sgn(x) τ2/l ± τ3/k)/4
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixer {
    per_arm: f32,
    per_drag: f32,
    per_thrust: f32,
}

impl Mixer {
    /// For the rotors that `parameters` describes.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            per_arm: 1.0 / parameters.get(Parameter::RotorArm),
            per_drag: 1.0 / parameters.get(Parameter::RotorDrag),
            per_thrust: 1.0 / parameters.get(Parameter::RotorThrust),
        }
    }

    /// Rotor commands in [0, 1], and whether one had to be limited. Thrust grows with the square of a rotor's speed, and
    /// its command is the speed.
    #[must_use]
    pub fn mix(&self, command: &Command<f32>) -> ([f32; 4], bool) {
        let roll = command.torque.x * self.per_arm;
        let pitch = command.torque.y * self.per_arm;
        let yaw = command.torque.z * self.per_drag;
        let mut limited = false;
        let duties = ROTORS.map(|[x, y, spin]| {
            let share = 0.25 * (command.thrust - y * roll + x * pitch + spin * yaw) * self.per_thrust;
            let within = Real::clamp(share, 0.0, 1.0);
            limited |= within != share;
            Real::sqrt(within)
        });
        (duties, limited)
    }
}
