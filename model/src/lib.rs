//! A multirotor that carries a payload on a cable, in words and numbers: its state, its parameters,
//! its dynamics, and the arithmetic that a law, an estimator or a plant of it share. No law is in
//! here.
//!
//! Conventions: inertial frame N is NED-like, **n3 points down**; thrust acts along −b3; the rod
//! vector points **from the UAV to the payload**; positions and velocities are the payload's. SI
//! units throughout. The *rod* is the taut cable, which the model takes for rigid and massless.
//!
//! One source, two scalars: everything is generic over [`Real`], `f32` on the target and `f64` as
//! the reference.
#![no_std]
#![warn(clippy::must_use_candidate, clippy::missing_errors_doc)]

mod analytic;
mod command;
mod disturbance;
mod dual;
pub mod dynamics;
mod error;
mod frames;
mod range;
mod scalar;
mod series;
mod state;
#[cfg(feature = "trap")]
mod trap;
mod uav;
mod vehicle;
mod yaw;

pub use analytic::Analytic;
pub use command::Command;
pub use disturbance::Disturbance;
pub use dual::{Dual, variables};
pub use error::OutOfRange;
pub use frames::Frames;
pub use nalgebra::{Matrix3, Vector3};
pub use range::Range;
pub use scalar::Real;
pub use series::Series;
pub use state::{Channel, State, is_within};
#[cfg(feature = "trap")]
pub use trap::Trapped;
pub use uav::Uav;
pub use vehicle::{Vehicle, VehicleParams};
pub use yaw::Yaw;

/// The vehicle's parameters' ranges and defaults.
pub mod ranges {
    pub use crate::range::{GRAVITY, INERTIA, PAYLOAD_MASS, ROD_LENGTH, UAV_MASS};
}
