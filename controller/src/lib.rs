//! Path following for a multirotor that carries a payload on a cable: the payload follows a closed curve in space, at a
//! speed and with a yaw that the curve prescribes, by dynamic state feedback linearization of the full slung-load model.
//!
//! Design principles:
//!
//! 1. Parameters are checked once, where they are set; `step` is total, allocation-free and of constant cost.
//! 2. One source, two scalars: `f32` flies, `f64` measures its rounding ([`Real`]).
//! 3. No chart where it flies: the state lives on R³ × S² × SO(3), and the law takes no sine, cosine or tangent.
//! 4. Data goes one way: state → [lift](law::lift) → [path](path::Path) → gains → 3×3 → [lower](law::lower) → command.
//!
//! Conventions: inertial frame N is NED-like, **n3 points down**; thrust acts along −b3; the rod vector points **from the
//! UAV to the payload**; positions and velocities are the payload's. SI units throughout.
//!
//! ```
//! use controller::{Circle, Command, Follower, Gains, Pole, Sampling, State, Vector3, Vehicle, VehicleParams, place};
//!
//! let vehicle = Vehicle::new(VehicleParams::<f32>::paper())?;
//! let path = Circle::new(5.0, -10.0)?.at_speed(1.0);
//! let k = place(&[-1.0, -2.0, -3.0, -4.0, -5.0, -6.0].map(Pole::Real))?;
//! let gains = Gains {
//!     k1: k,
//!     k2: k,
//!     k3: place(&[-1.0, -2.0, -3.0, -4.0, -5.0].map(Pole::Real))?,
//!     k4: place(&[-2.0, -3.0].map(Pole::Real))?,
//!     integral: [0.0; 3],
//! };
//! let mut follower = Follower::new(vehicle, path, gains, Sampling::every(0.002))?;
//!
//! // At hover, 1 m outside the circle: take over from the thrust that holds the vehicle, then step every 2 ms.
//! let state = State::at_rest(Vector3::new(6.0, 0.0, -10.0));
//! follower.take_over(&state, Command { thrust: vehicle.hover_thrust(), torque: Vector3::zeros() });
//! let solution = follower.step(&state);
//! assert!((solution.command.thrust - vehicle.hover_thrust()).abs() < 1e-3);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
#![no_std]

pub mod flight;
pub mod law;
pub mod path;
pub mod sampled;
pub mod theory;

pub use flight::approach::ApproachLimits;
pub use flight::envelope::{Band, Envelope, EnvelopeParams, Margin, Margins};
pub use flight::supervisor::{Fault, Lost, Mode, Output, Policy, Request, Supervisor};
pub use law::follow::{Follower, Gains, SetupError, Solution, Xi};
pub use law::gains::{GainError, Pole, place};
pub use law::track::{Reference, TrackGains, TrackXi, Tracker};
pub use model::*;
pub use path::{Circle, Path};
pub use sampled::actuator::{Actuation, ActuatorLimits};
pub use sampled::allocation::{Allocation, Place, RotorParams, Rotors};
pub use sampled::observer::ObserverParams;
pub use sampled::sampler::Sampling;
