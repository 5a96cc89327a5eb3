//! The state of a slung load from an autopilot's own sensors: no sensor on the load is needed.
//!
//! Two filters, each usable alone: [`Payload`] finds the load behind any navigation filter, from
//! how the UAV moves and the thrust it was given; [`Navigation`] is a small navigation filter for
//! those who have none.
//!
//! Conventions are the `model` crate's: n3 points down, thrust acts along −b3, the rod points from
//! the UAV to the payload. SI units throughout. One source, two scalars; no allocation; every step
//! is total and of constant cost.
#![no_std]
// An index over two sides of a symmetric matrix is the plainest way to say so.
#![allow(clippy::needless_range_loop)]

#[cfg(test)]
extern crate std;

mod covariance;
mod drag;
mod lever;
mod motion;
mod navigation;
mod payload;
#[cfg(test)]
mod random;

pub use drag::Drag;
pub use model::{Matrix3, OutOfRange, Real, State, Vector3};
pub use motion::{Motion, attitude_at_rest};
pub use navigation::{Accepted, Fix, Imu, Navigation, NavigationHealth, NavigationNoise, NavigationParams, Refused};
pub use payload::{
    Cable, Estimate, Health, LoadMeasurement, Payload, PayloadNoise, PayloadParams, PayloadState, Validity,
};
