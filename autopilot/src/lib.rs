//! The flight program without its hardware: what a board's interrupts call, and what tests call on the host.
//!
//! ```text
//! bytes ──link::Decoder──▶ Server ──parameters, arming, requests──▶ Autopilot ◀── timer (flight) or state frame (lockstep)
//!                                                                      │ Supervisor: modes, envelope, observers, law, rotors
//!                                                                      ▼
//!                                                   Answer: command, rotors, telemetry
//! ```
//!
//! The law is the controller's `Supervisor` with all it needs from parameters; here stand only when it is stepped and what the link hears of it.
//!
//! [`Autopilot`] is the control side, which a timer's interrupt calls; [`Server`] is the link side. In lockstep neither reads a
//! clock: the same frames give the same answers, bit by bit, however long they take to arrive.
#![no_std]

mod control;
mod law;
mod parameters;
mod path;
mod report;
mod rotors;
mod server;
mod setup;
mod track;

pub use control::{Answer, Autopilot, Boot, Counters, Drive};
pub use law::SetupRefused;
pub use parameters::{Entry, Parameter, Parameters, Refused};
pub use path::{AnyPath, HARMONICS};
pub use rotors::Actuators;
pub use server::{Next, Server};
