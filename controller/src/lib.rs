//! Path following for a multirotor that carries a payload on a cable: the payload follows a curve
//! in space, at a speed and with a yaw that the curve prescribes, by dynamic state feedback
//! linearization of the full slung-load model.
//!
//! The law is that of a conference paper of the Applied Nonlinear Controls Lab, University of
//! Alberta. Its closed form, the sampled form, the observers, the approach and the supervision are
//! this project's own. The page [theory] derives all of it; numbers in brackets, such as (4.1), are
//! its equations.
//!
//! Design principles:
//!
//! 1. Parameters are checked once, where they are set; `step` is total, allocation-free and of
//!    constant cost.
//! 2. One source, two scalars: `f32` flies, `f64` measures its rounding ([`Real`]).
//! 3. No chart where it flies: the state lives on R³ × S² × SO(3), and the law takes no sine,
//!    cosine or tangent.
//! 4. Data goes one way: state → [lift](fn@lift) → [path](Path) → [gains](Gains) → 3×3 →
//!    [lower](fn@lower) → [command](Command).
//!
//! Conventions: inertial frame N is NED-like, **n3 points down**; thrust acts along −b3; the rod
//! vector points **from the UAV to the payload**; positions and velocities are the payload's. SI
//! units throughout. The *rod* is the taut cable, which the model takes for rigid and massless.
//!
//! Begin with [`Supervisor`], which answers every input; a [`Controller`] is the bare law at a
//! fixed rate. Parameters are plain structs whose every number the caller states, and whose
//! [ranges] and defaults stand in one table; the enums that will grow are `#[non_exhaustive]`.
//!
//! ```
//! use controller::{Circle, Command, Curve, Follower, Gains, Sampling, State};
//! use controller::{Vector3, Vehicle, VehicleParams};
//!
//! let vehicle = Vehicle::new(VehicleParams::<f32>::paper())?;
//! let path = Circle::new(5.0, -10.0)?.at_speed(1.0)?;
//! let mut follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(0.002))?;
//!
//! // At hover, 1 m outside the circle: take over from the thrust that holds the vehicle, then step
//! // every 2 ms.
//! let state = State::at_rest(Vector3::new(6.0, 0.0, -10.0));
//! follower.take_over(&state, Command::of_thrust(vehicle.hover_thrust()))?;
//! let solution = follower.step(&state);
//! assert!((solution.command.thrust - vehicle.hover_thrust()).abs() < 1e-3);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
#![no_std]
#![warn(clippy::must_use_candidate, clippy::missing_errors_doc)]

mod error;
mod flight;
mod law;
mod path;
pub mod ranges;
mod sampled;
mod sampling;
pub mod theory;

pub use error::{Refused, SetupError};
pub use flight::envelope::{Band, Envelope, EnvelopeParams, Standing};
pub use flight::fence::{Edge as FenceEdge, Region as FenceRegion};
pub use flight::mode::{Fault, Lost, Measured, Mode, Output, Policy, Request};
pub use flight::supervisor::Supervisor;
pub use law::approach::{Approach, ApproachLimits, Pace};
pub use law::compensator::{continuing, propagate};
pub use law::follow::{Follow, Gains, Xi, follow};
pub use law::gains::{GainError, Pole, is_hurwitz, place};
pub use law::lift::{Lift, lift};
pub use law::lower::lower;
pub use law::margins::{Margin, Margins};
pub use law::solution::{Answer, Solution};
pub use law::track::{Reference, Track, TrackGains, TrackXi, track};
pub use law::{Ahead, Law};
pub use model::*;
pub use path::*;
pub use sampled::actuator::{Actuation, ActuatorLimits, MAX_DELAY};
pub use sampled::allocation::{Allocation, Place, RotorParams, Rotors};
pub use sampled::controller::{Controller, Follower, Tracker};
pub use sampled::observer::ObserverParams;
pub use sampled::sampler::Sampler;
pub use sampling::Sampling;

/// The README's example, as it stands there.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
