//! A scenario's controller, asked by any other program that has a plant of its own: a JSON state a
//! line, a JSON command a line. What a [plant](super::plant) answers is such a state.

use controller::{Command, Matrix3, Uav, Vector3};
use serde::{Deserialize, Serialize};

use super::json::Unique;
use crate::describe::input::{Invalid, read};
use crate::describe::scenario::{Requests, Scenario};
use crate::fly::fault::describe;
use crate::fly::pilot::{Answers, Pilot};
use crate::world::{Bodies, Reading};

#[derive(Deserialize)]
struct Seen {
    position: [f64; 3],
    velocity: [f64; 3],
    uav_position: [f64; 3],
    uav_velocity: [f64; 3],
    attitude: [[f64; 3]; 3],
    body_rate: [f64; 3],
    specific_force: Option<[f64; 3]>,
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

    /// The command for the period that begins at the state in `line`.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is missing or no number; no period has passed then.
    pub fn step(&mut self, line: &[u8]) -> Result<Answer, Invalid> {
        let Unique(value) = serde_json::from_slice(line).map_err(|error| Invalid::new("line", error))?;
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
        if let Some(applied) = self.taken_over_from.take() {
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
