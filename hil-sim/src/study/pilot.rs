//! A scenario's controller, asked by any other program that has a plant of its own: a JSON state a
//! line, a JSON command a line. What a [plant](super::plant) answers is such a state.

use controller::{Command, Matrix3, Uav, Vector3};
use serde::{Deserialize, Deserializer, Serialize};

use super::json::Unique;
use crate::describe::input::{Invalid, read};
use crate::describe::scenario::{Requests, Scenario};
use crate::fly::fault::describe;
use crate::fly::pilot::{Answers, Pilot};
use crate::world::{Bodies, Reading};

/// What is not measured is NaN here.
#[derive(Deserialize)]
struct Seen {
    #[serde(deserialize_with = "vector")]
    position: [f64; 3],
    #[serde(deserialize_with = "vector")]
    velocity: [f64; 3],
    #[serde(deserialize_with = "vector")]
    uav_position: [f64; 3],
    #[serde(deserialize_with = "vector")]
    uav_velocity: [f64; 3],
    #[serde(deserialize_with = "matrix")]
    attitude: [[f64; 3]; 3],
    #[serde(deserialize_with = "vector")]
    body_rate: [f64; 3],
    specific_force: Option<[f64; 3]>,
}

/// A vector, or `null` in its place or in its numbers'.
fn vector<'de, D: Deserializer<'de>>(text: D) -> Result<[f64; 3], D::Error> {
    Ok(Option::<[Option<f64>; 3]>::deserialize(text)?.unwrap_or_default().map(or_nan))
}

/// Three of them, row by row.
fn matrix<'de, D: Deserializer<'de>>(text: D) -> Result<[[f64; 3]; 3], D::Error> {
    Ok(Option::<[[Option<f64>; 3]; 3]>::deserialize(text)?.unwrap_or_default().map(|row| row.map(or_nan)))
}

fn or_nan(number: Option<f64>) -> f64 {
    number.unwrap_or(f64::NAN)
}

/// What the rotors are to give for the coming period, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// N, along −b3.
    pub thrust: f64,
    /// N·m, in body axes.
    pub torque: [f64; 3],
    /// What the vehicle is doing.
    pub mode: String,
    /// Why it is not doing what was asked for, if it is not.
    pub fault: Option<String>,
}

/// The controller of a scenario at work in f32, on exact states.
pub struct Controller {
    pilot: Pilot<f32>,
    requests: Requests,
    /// A vehicle in flight is taken over from this.
    taken_over_from: Option<Command<f64>>,
    period: f64,
    step: u64,
}

impl Controller {
    /// Before the first state of `scenario`.
    ///
    /// # Errors
    /// [`Invalid`] if its numbers do not survive f32.
    pub fn new(scenario: &Scenario) -> Result<Self, Invalid> {
        let told = &scenario.controller.vehicle;
        let hover = Command::of_thrust((told.payload_mass + told.uav_mass) * told.gravity);
        Ok(Self {
            pilot: Pilot::new(&scenario.controller)?,
            requests: Requests::of(scenario),
            taken_over_from: (!scenario.standing).then_some(hover),
            period: 1.0 / scenario.controller.rate_hz,
            step: 0,
        })
    }

    /// The command for the period that begins at the state in `line`. A vector or number that is not
    /// measured is `null`, or NaN as Python writes it.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is missing or no number; no period has passed then.
    pub fn step(&mut self, line: &[u8]) -> Result<Answer, Invalid> {
        let line = String::from_utf8_lossy(line).replace("NaN", "null");
        let Unique(value) = serde_json::from_str(&line).map_err(|error| Invalid::new("line", error))?;
        let seen: Seen = read("", value)?;
        let bodies = Bodies {
            position: seen.position.into(),
            velocity: seen.velocity.into(),
            uav_position: seen.uav_position.into(),
            uav_velocity: seen.uav_velocity.into(),
            attitude: Matrix3::from(seen.attitude).transpose(),
            body_rate: seen.body_rate.into(),
        };
        let Bodies { uav_position: position, uav_velocity: velocity, attitude, body_rate, .. } = bodies;
        let reading = Reading {
            comes: true,
            state: bodies.state(),
            sees_load: true,
            uav: Some(Uav { position, velocity, attitude, body_rate }),
            specific_force: seen.specific_force.map(Vector3::from),
            aboard: None,
        };
        let (request, factor) = self.requests.at(self.step);
        // The first whole state is the one to go on from.
        if reading.state.check().is_ok()
            && let Some(applied) = self.taken_over_from.take()
        {
            self.pilot.take_over(&reading.state, &applied);
        }
        if let Some(factor) = factor {
            self.pilot.set_speed_factor(factor);
        }
        let decision = self.pilot.decide(&reading, request, self.step as f64 * self.period);
        self.step += 1;
        Ok(Answer {
            thrust: decision.command.thrust,
            torque: decision.command.torque.into(),
            mode: format!("{:?}", decision.mode).to_lowercase(),
            fault: decision.fault.map(describe),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Controller;
    use crate::describe::scenario::Scenario;
    use crate::study::plant::Plant;

    const TEXT: &str = r#"
        duration_s = 60.0
        path = { kind = "circle", radius = 3.0, p3 = -4.0, speed = 1.0 }
        controller = { law = "follow", rate_hz = 250.0, observer = { payload = 4.0, rod = 4.0, torque = 4.0 }, limits = { thrust = [3.0, 60.0], torque = [3.0, 3.0, 1.0] } }
        initial = { position = [0.5, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }
        request = [{ at_s = 0.0, do = "idle" }, { at_s = 0.5, do = "hold" }, { at_s = 14.0, do = "land" }]
        [ground]
    "#;

    /// The controller and the plant, line by line, off the ground and back.
    #[test]
    fn plant_and_pilot_fly_together() {
        let scenario = Scenario::parse("pilot.toml", TEXT).unwrap();
        let (mut plant, mut controller) = (Plant::new(&scenario), Controller::new(&scenario).unwrap());
        let mut modes: Vec<String> = Vec::new();
        let mut seen = plant.now();
        for _ in 0..15_000 {
            let command = controller.step(&serde_json::to_vec(&seen).unwrap()).unwrap();
            if modes.last() != Some(&command.mode) {
                modes.push(command.mode.clone());
            }
            let line = serde_json::json!({ "thrust": command.thrust, "torque": command.torque });
            seen = plant.step(line.to_string().as_bytes()).unwrap();
        }
        assert_eq!(modes, ["idle", "takeoff", "hold", "land", "off"]);
        assert_eq!(seen.on_ground, [true, true], "{seen:?}");
    }

    /// In hold UAV, load, attitude and body rate are each not measured for two seconds, as `null` or as
    /// NaN: the vehicle stays where it is, says what is missing, and lands.
    #[test]
    fn what_is_not_measured_is_null() {
        let scenario = Scenario::parse("pilot.toml", TEXT).unwrap();
        for (fields, fault) in [
            (&["uav_position"][..], "state: rod"),
            (&["uav_velocity"], "state: rodrate"),
            (&["uav_position", "uav_velocity"], "state: rod"),
            (&["position", "velocity"], "state: position"),
            (&["attitude"], "state: attitude"),
            (&["body_rate"], "state: bodyrate"),
        ] {
            let (mut plant, mut controller) = (Plant::new(&scenario), Controller::new(&scenario).unwrap());
            let (mut seen, mut mode, mut height) = (plant.now(), String::new(), 0.0);
            for step in 0..15_000 {
                let mut state = serde_json::to_value(&seen).unwrap();
                let is_missing = (2500..3000).contains(&step);
                for field in fields.iter().filter(|_| is_missing) {
                    state[*field] = if step % 2 == 0 { "NaN".into() } else { serde_json::Value::Null };
                }
                let command = controller.step(state.to_string().replace("\"NaN\"", "NaN").as_bytes()).unwrap();
                if step == 2499 {
                    height = seen.uav_position[2];
                } else if is_missing {
                    assert!((seen.uav_position[2] - height).abs() < 1.0, "{fields:?} at {step}: {seen:?}");
                }
                if step == 2999 {
                    assert_eq!(
                        (command.mode.as_str(), command.fault.as_deref()),
                        ("hold", Some(fault)),
                        "{fields:?}"
                    );
                }
                let line = serde_json::json!({ "thrust": command.thrust, "torque": command.torque });
                mode = command.mode;
                seen = plant.step(line.to_string().as_bytes()).unwrap();
            }
            assert_eq!((mode.as_str(), seen.on_ground), ("off", [true, true]), "{fields:?}");
        }
    }

    #[test]
    fn a_line_that_is_no_state_passes_nothing() {
        let scenario = Scenario::parse("pilot.toml", TEXT).unwrap();
        let (plant, mut controller) = (Plant::new(&scenario), Controller::new(&scenario).unwrap());
        let good = serde_json::to_value(plant.now()).unwrap();
        for field in ["position", "uav_velocity", "attitude"] {
            let mut line = good.clone();
            line.as_object_mut().unwrap().remove(field);
            let error = controller.step(line.to_string().as_bytes()).unwrap_err().to_string();
            assert!(error.contains(field), "{error}");
        }
        assert_eq!(controller.step(good.to_string().as_bytes()).unwrap().mode, "idle");
    }
}
