//! A vehicle to try a controller on: the model of the theory page, section 2, by the midpoint rule.
//! The simulator has a better one, with wind, sensors and rotors.

use controller::dynamics::{Acceleration, Model, across, advance, turn};
use controller::{Command, Disturbance, Matrix3, State, Vector3, Vehicle, VehicleParams};

/// Steps of the model in a control period.
const STEPS: usize = 10;

/// A vehicle in flight, in `f64`.
pub struct Plant {
    vehicle: Vehicle<f64>,
    state: State<f64>,
}

impl Plant {
    /// The vehicle of `params` at rest, with the payload at `position` (N, m).
    pub fn at_rest(params: &VehicleParams<f32>, position: Vector3<f64>) -> Self {
        let vehicle = Vehicle::new(params.cast()).expect("the controller has accepted them");
        Self { vehicle, state: State::at_rest(position) }
    }

    /// What an ideal estimator reports.
    pub fn state(&self) -> State<f32> {
        self.state.cast()
    }

    /// Lets `command` act for `period` s.
    pub fn hold(&mut self, command: &Command<f32>, period: f32) {
        let command = Command { thrust: command.thrust.into(), torque: command.torque.map(f64::from) };
        let acceleration =
            |state: &State<f64>| Model::at(&self.vehicle, state).acceleration(&command, &Disturbance::none());
        let dt = f64::from(period) / STEPS as f64;
        for _ in 0..STEPS {
            let middle = moved(&self.state, &acceleration(&self.state), dt / 2.0);
            self.state = moved(&self.state, &acceleration(&middle), dt);
        }
    }
}

/// `state` after `dt` s at constant `acceleration`, back on the sphere and among the rotations.
fn moved(state: &State<f64>, acceleration: &Acceleration<f64>, dt: f64) -> State<f64> {
    let (position, velocity) = advance(&state.position, &state.velocity, &acceleration.payload, dt);
    let (rod, rod_rate) = advance(&state.rod, &state.rod_rate, &acceleration.rod, dt);
    let (rod, rod_rate) = across((unit(rod), rod_rate));
    let (attitude, body_rate) = turn(&state.attitude, &state.body_rate, &acceleration.body, dt);
    let b1 = unit(attitude.column(0).into());
    let b3 = unit(b1.cross(&attitude.column(1)));
    let attitude = Matrix3::from_columns(&[b1, b3.cross(&b1), b3]);
    State { position, velocity, rod, rod_rate, attitude, body_rate }
}

/// `vector` at length 1.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector / vector.dot(&vector).sqrt()
}
