//! What a flight meets beside the slung-load system itself: environment, sensors, actuators. Everything is off unless a scenario
//! switches it on.
//!
//! ```toml
//! [environment]
//! payload_force = [0.3, 0.0, 0.0]   # N, in N; uav_force likewise; torque in body axes, N·m
//! payload_step = { at_s = 20.0, mass = 1.5 }
//!
//! [environment.air]
//! wind = [5.0, 0.0, 0.0]            # m/s, where the air goes
//! gusts = { speed_at_6m = 5.0, height = 10.0 }
//! density = 1.225                   # kg/m³
//! payload_drag_area = 0.01          # Cd A, m²
//! uav_drag_area = 0.05
//!
//! [sensors.position]                # velocity, rod, rod_rate, attitude, body_rate likewise
//! noise = 0.02                      # standard deviation per sample and axis
//! bias = [0.0, 0.0, 0.0]
//! quantum = 0.001
//! jitter_s = 0.001
//! freeze = { at_s = 10.0, for_s = 0.5 }      # drop_out, nan likewise
//!
//! [actuators]
//! lag_s = 0.05
//! latency_s = 0.01
//! thrust_scale = 0.85
//! rotors = { layout = "quad-x", arm_m = 0.3, drag_m = 0.02, max_thrust = 15.0, failure = { rotor = 1, at_s = 9.0, effectiveness = 0.0 } }
//! sag = { max_thrust = 30.9, during = { at_s = 15.0, for_s = 2.0 } }
//!
//! [timing]
//! jitter = 0.1                      # each control period within ±10 %
//! missed = 0.01                     # probability that the controller is not called
//! ```

mod actuators;
mod dryden;
mod environment;
mod rotors;
mod sensors;
mod timing;

pub use actuators::{ActuatorModel, Actuators, Sag};
pub use dryden::{Dryden, Gusts};
pub use environment::{Air, Environment, PayloadStep, drag};
pub use rotors::{Layout, RotorFailure, Rotors};
pub use sensors::{Channel, SensorModel, Sensors, Window};
pub use timing::Timing;

use crate::input::{Invalid, within};

/// `value` in a range, with the field for an error.
fn check(at: &str, field: &str, value: f64, low: f64, high: f64) -> Result<(), Invalid> {
    within(&crate::input::join(at, field), value, low..=high).map(|_| ())
}
