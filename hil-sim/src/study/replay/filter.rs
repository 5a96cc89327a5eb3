//! The payload filter over a log's motion of the UAV.

use controller::{State, Vector3};
use estimator::{Motion, Payload};

use super::logged::UavMotion;
use crate::describe::input::Invalid;
use crate::describe::scenario::Scenario;
use crate::fly::sample::Seen;
use crate::fly::sight::{RotorModel, is_known, payload_filter};

/// The filter, and thrust as its autopilot has it.
pub struct Filter {
    payload: Payload<f32>,
    rotors: RotorModel,
    has_found: bool,
}

/// What it answers.
#[derive(Clone, Copy)]
pub struct Found {
    /// The law's state.
    pub state: State<f64>,
    /// Whether the rod is known, and so the state.
    pub is_known: bool,
    /// For the log.
    pub seen: Seen,
}

impl Filter {
    /// Of `scenario`, with the filters' defaults where it has no `[estimator]`, after a long time
    /// under `thrust`, N.
    ///
    /// # Errors
    /// [`Invalid`] for a number that the filter refuses.
    pub fn new(scenario: &Scenario, thrust: f64) -> Result<Self, Invalid> {
        let payload = payload_filter(&scenario.estimator.unwrap_or_default(), scenario)
            .map_err(|error| Invalid::out_of_range("estimator", error))?;
        Ok(Self { payload, rotors: RotorModel::new(scenario, thrust), has_found: false })
    }

    /// A period under `thrust`, N, that ends in `uav`.
    pub fn step(&mut self, uav: &UavMotion, specific_force: Vector3<f64>, thrust: Option<f64>) -> Found {
        let motion = Motion {
            position: single(&uav.position),
            velocity: single(&uav.velocity),
            attitude: uav.attitude.map(|x| x as f32),
            body_rate: single(&uav.body_rate),
            specific_force: single(&specific_force),
        };
        let thrust = thrust.map(|thrust| self.rotors.pass(thrust) as f32);
        let estimate = self.payload.step(Some(&motion), thrust);
        self.has_found = is_known(estimate.health.validity, self.has_found);
        let seen = Seen {
            specific_force,
            position: estimate.state.position.map(f64::from),
            rod: estimate.state.rod.map(f64::from),
            rod_deviation: estimate.health.rod_deviation.into(),
            position_deviation: None,
            validity: estimate.health.validity,
        };
        Found { state: estimate.state.cast(), is_known: self.has_found, seen }
    }
}

fn single(v: &Vector3<f64>) -> Vector3<f32> {
    v.map(|x| x as f32)
}
