//! One supervised controller made of named numbers: any path, either law, limits and rotors.
//!
//! ```text
//! Parameters ──▶ vehicle, timing, path, gains, observers, envelope, policy, actuators ──▶ Rig
//!
//! state, request ──▶ Rig::step ──▶ command, rotors
//! ```
//!
//! What flies on a board is this, and so is what the simulator flies, a campaign tries and the
//! bench counts. The [table](Entry) is data: a name that MAVLink can carry, unit, default, range
//! and meaning; the controller's own ranges and defaults stand in it once.
#![no_std]

mod actuators;
mod curve;
mod entry;
mod error;
mod flight;
mod gains;
mod observer;
mod parameters;
mod profile;
mod rig;
mod setpoint;
mod table;
mod timing;
mod vehicle;

pub use actuators::Actuators;
pub use curve::{AnyCurve, Field, HARMONICS, NoFormula, ROUTE, Shape};
pub use entry::{Entry, Kind, Name, Refused};
pub use error::SetupError;
pub use parameters::Parameters;
pub use profile::{AnyPath, AnySpeed, AnyYaw, NoTable, path};
pub use rig::{LawNumbers, Output, Rig, Telemetry};
pub use setpoint::RateSetpoint;
pub use table::{COUNT, Parameter, Run, Tabled, concatenated, index_of, narrowed};
