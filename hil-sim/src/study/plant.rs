//! A scenario's world, stepped from any other program: a JSON command a line, a JSON state a line.
//!
//! What the sensors make of the state, and when the controller misses one, is left out: the answer
//! is the truth.

use controller::{Command, State, Vector3};
use serde::{Deserialize, Serialize};

use super::json::Unique;
use crate::describe::input::{Invalid, all_within, read, within};
use crate::describe::scenario::Scenario;
use crate::world::{Bodies, Seed, World};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    thrust: f64,
    #[serde(default)]
    torque: [f64; 3],
    #[serde(default = "one")]
    periods: u32,
}

fn one() -> u32 {
    1
}

/// The world now; vectors in N but for the body rate, in body axes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// s.
    pub t_s: f64,
    /// Of the payload, m.
    pub position: [f64; 3],
    /// Of the payload, m/s.
    pub velocity: [f64; 3],
    /// Of the UAV's centre of mass, m.
    pub uav_position: [f64; 3],
    /// Of the UAV's centre of mass, m/s.
    pub uav_velocity: [f64; 3],
    /// R by rows, body to N.
    pub attitude: [[f64; 3]; 3],
    /// ω, rad/s.
    pub body_rate: [f64; 3],
    /// The cable's tension, N; of a rod, negative while it pushes.
    pub pull: f64,
    /// Whether payload and UAV are on the ground.
    pub on_ground: [bool; 2],
    /// Kinetic and potential energy, J.
    pub energy: f64,
}

/// The world of a scenario at work.
pub struct Plant {
    world: World,
}

impl Plant {
    /// At the start of `scenario`, the rotors giving nothing.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let (start, seed) = (State::from_paper(&scenario.initial), Seed { batch: scenario.seed, run: 0 });
        Self { world: scenario.begin(&start, Command::zero(), seed) }
    }

    /// The world now.
    #[must_use]
    pub fn now(&self) -> Answer {
        let body = self.world.body();
        let Bodies { position, velocity, uav_position, uav_velocity, attitude, body_rate } = body.bodies();
        Answer {
            t_s: self.world.time_s(),
            position: position.into(),
            velocity: velocity.into(),
            uav_position: uav_position.into(),
            uav_velocity: uav_velocity.into(),
            attitude: attitude.transpose().into(),
            body_rate: body_rate.into(),
            pull: self.world.rates().pull,
            on_ground: body.touching(),
            energy: body.energy(),
        }
    }

    /// Passes the periods that `line` asks for, under its command.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is unknown, missing or out of range; nothing has passed
    /// then.
    pub fn step(&mut self, line: &[u8]) -> Result<Answer, Invalid> {
        let Unique(value) = serde_json::from_slice(line).map_err(|error| Invalid::new("line", error))?;
        let Request { thrust, torque, periods } = read("", value)?;
        let thrust = within("thrust", thrust, 0.0..=1e6)?;
        let torque = Vector3::from(all_within("torque", torque, 1e6)?);
        for _ in 0..within("periods", periods, 1..=1_000_000)? {
            self.world.advance(&Command { thrust, torque });
        }
        Ok(self.now())
    }
}

#[cfg(test)]
mod tests {
    use super::Plant;
    use crate::describe::scenario::Scenario;

    const TEXT: &str = r#"
        duration_s = 1.0
        path = { kind = "circle", radius = 5.0, p3 = -10.0, speed = 1.0 }
        controller = { law = "follow", rate_hz = 500.0 }
        initial = { position = [0.5, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }
        [ground]
        p3 = 3.0
    "#;

    fn plant(text: &str) -> Plant {
        Plant::new(&Scenario::parse("plant.toml", text).unwrap())
    }

    #[test]
    fn what_stands_stays_and_what_is_lifted_leaves_the_ground() {
        let mut plant = plant(TEXT);
        let start = plant.now();
        assert_eq!((start.position[2], start.uav_position[2]), (3.0 + 0.002 - 0.05, 3.0 + 0.002 - 0.15));
        let stood = plant.step(br#"{"thrust": 0, "periods": 500}"#).unwrap();
        assert!((stood.uav_position[2] - start.uav_position[2]).abs() < 1e-9, "{stood:?}");
        assert_eq!(stood.on_ground, [true, true]);
        let lifted = plant.step(br#"{"thrust": 35.0, "torque": [0, 0, 0.001], "periods": 1000}"#).unwrap();
        assert_eq!(lifted.on_ground, [false, false]);
        assert!((lifted.t_s - 3.0).abs() < 1e-9 && lifted.pull > 1.0, "{lifted:?}");
    }

    #[test]
    fn bad_lines_pass_nothing() {
        let mut plant = plant(TEXT);
        for (line, wrong) in [
            (&br#"{"torque": [0, 0, 0]}"#[..], "thrust"),
            (br#"{"thrust": -1}"#, "thrust: -1 is outside"),
            (br#"{"thrust": 1, "torque": [0, 0, 1e9]}"#, "torque[2]"),
            (br#"{"thrust": 1, "periods": 0}"#, "periods"),
            (br#"{"thrust": 1} {"thrust": 1}"#, "trailing"),
            (br#"{"thrust": 1, "thrust": 2}"#, "thrust"),
            (br#"{"thrust": 1, "colour": 2}"#, "colour"),
        ] {
            let error = plant.step(line).unwrap_err().to_string();
            assert!(error.contains(wrong), "{error}");
        }
        assert_eq!(plant.now().t_s, 0.0);
    }

    #[test]
    fn starts_out_of_reach_are_refused() {
        let error = |text: &str| Scenario::parse("plant.toml", text).unwrap_err().to_string();
        assert!(error(&TEXT.replace("[0.5, 0.0", "[2.5, 0.0")).contains("2.502 m from hook to payload"));
        assert!(error(&TEXT.replace("uav_position = [0.0, 0.0, 0.0], ", "")).contains("uav_position"));
        assert!(error(&TEXT.replace("[ground]\n", "[cable]\nea = 5e3\n").replace("p3 = 3.0", "")).contains("ground"));
    }
}
