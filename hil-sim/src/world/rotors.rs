//! Four rotors under the thrust and torque of a command: their limits, and one that is weak or
//! lost.
//!
//! A rotor at (x, y) in body axes with thrust f along −b3 gives T = f and τ = (−y f, x f, ±k f),
//! k its drag torque per thrust (the sign that of its spin). Four of them on a square make an
//! invertible map, so a command becomes rotor thrusts, which are limited one by one as a motor is,
//! and those become thrust and torque again.

use controller::{Command, Vector3};
use serde::Deserialize;

use super::check;
use crate::describe::input::{Invalid, join, within};

/// Where the rotors stand.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Front right, rear left, front left, rear right.
    QuadX,
    /// Right, left, front, rear.
    QuadPlus,
}

/// A rotor that does not give what it is told.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct RotorFailure {
    /// Which, 1 to 4, in the layout's order.
    pub rotor: usize,
    /// From when on, s.
    #[serde(default)]
    pub at_s: f64,
    /// Share of its thrust that is left, 0 (lost) to 1.
    pub effectiveness: f64,
}

/// The rotors.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Rotors {
    /// Where they stand.
    pub layout: Layout,
    /// From the centre to a rotor's axis, m, 0.01 to 10.
    pub arm_m: f64,
    /// k, drag torque per thrust, m, 0.001 to 1.
    pub drag_m: f64,
    /// Largest thrust of one rotor, N; the least is 0.
    pub max_thrust: f64,
    /// One of them fails.
    pub failure: Option<RotorFailure>,
}

impl Rotors {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "arm_m", self.arm_m, 0.01, 10.0)?;
        check(at, "drag_m", self.drag_m, 0.001, 1.0)?;
        check(at, "max_thrust", self.max_thrust, 0.01, 1e5)?;
        if let Some(failure) = &self.failure {
            let at = join(at, "failure");
            within(&join(&at, "rotor"), failure.rotor, 1..=4)?;
            check(&at, "at_s", failure.at_s, 0.0, 1e5)?;
            check(&at, "effectiveness", failure.effectiveness, 0.0, 1.0)?;
        }
        Ok(())
    }

    /// (x, y, ±k) of each rotor.
    fn places(&self) -> [[f64; 3]; 4] {
        let (arm, k) = (self.arm_m, self.drag_m);
        match self.layout {
            Layout::QuadX => {
                let l = arm * 0.5_f64.sqrt();
                [[l, l, k], [-l, -l, k], [l, -l, -k], [-l, l, -k]]
            }
            Layout::QuadPlus => [[0.0, arm, k], [0.0, -arm, k], [arm, 0.0, -k], [-arm, 0.0, -k]],
        }
    }

    /// The thrust of each rotor that makes `command`, N. The columns of the map are orthogonal, so
    /// its inverse is its transpose, scaled.
    fn thrusts(&self, command: &Command<f64>) -> [f64; 4] {
        let places = self.places();
        let squares =
            places.iter().fold([0.0; 3], |sum, place| std::array::from_fn(|i| sum[i] + place[i] * place[i]));
        places.map(|[x, y, k]| {
            0.25 * command.thrust - y * command.torque.x / squares[1]
                + x * command.torque.y / squares[0]
                + k * command.torque.z / squares[2]
        })
    }

    fn command(&self, thrusts: [f64; 4]) -> Command<f64> {
        let mut command = Command { thrust: 0.0, torque: Vector3::zeros() };
        for (thrust, [x, y, k]) in thrusts.into_iter().zip(self.places()) {
            command.thrust += thrust;
            command.torque += Vector3::new(-y, x, k) * thrust;
        }
        command
    }

    /// `command` as far as each rotor can give it.
    #[must_use]
    pub fn limit(&self, command: &Command<f64>) -> Command<f64> {
        self.command(self.thrusts(command).map(|thrust| thrust.clamp(0.0, self.max_thrust)))
    }

    /// What rotors told `command` give at `t_s`.
    #[must_use]
    pub fn fail(&self, t_s: f64, command: &Command<f64>) -> Command<f64> {
        match self.failure {
            Some(RotorFailure { rotor, at_s, effectiveness }) if t_s >= at_s => {
                let mut thrusts = self.thrusts(command);
                thrusts[rotor - 1] *= effectiveness;
                self.command(thrusts)
            }
            _ => *command,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROTORS: Rotors =
        Rotors { layout: Layout::QuadX, arm_m: 0.3, drag_m: 0.02, max_thrust: 15.0, failure: None };

    #[test]
    fn commands_survive_the_way_through_the_rotors() {
        let command = Command { thrust: 30.0, torque: Vector3::new(0.3, -0.2, 0.05) };
        for layout in [Layout::QuadX, Layout::QuadPlus] {
            let back = Rotors { layout, ..ROTORS }.limit(&command);
            assert!((back.thrust - 30.0).abs() < 1e-13 && (back.torque - command.torque).amax() < 1e-15, "{back:?}");
        }
    }

    #[test]
    fn a_rotor_gives_no_more_than_it_can() {
        let back = ROTORS.limit(&Command { thrust: 100.0, torque: Vector3::zeros() });
        assert_eq!(back.thrust, 60.0);
        assert_eq!(ROTORS.limit(&Command { thrust: -5.0, torque: Vector3::zeros() }).thrust, 0.0);
    }

    /// The front right rotor lost from hover: its thrust is missing, and the body rolls right and
    /// pitches down.
    #[test]
    fn a_lost_rotor_takes_its_thrust_and_torques_with_it() {
        let failure = Some(RotorFailure { rotor: 1, at_s: 2.0, effectiveness: 0.0 });
        let rotors = Rotors { failure, ..ROTORS };
        let hover = Command { thrust: 28.0, torque: Vector3::zeros() };
        assert_eq!(rotors.fail(1.9, &hover), hover);
        let given = rotors.fail(2.0, &hover);
        let lever = 0.3 * 0.5_f64.sqrt();
        let expected = Vector3::new(7.0 * lever, -7.0 * lever, -7.0 * 0.02);
        assert!((given.thrust - 21.0).abs() < 1e-12 && (given.torque - expected).amax() < 1e-12, "{given:?}");
    }
}
