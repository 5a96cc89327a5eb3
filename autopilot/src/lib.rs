//! The flight program without its hardware: what a board's interrupts call, and what tests call on the host.
//!
//! ```text
//! bytes ──link::Decoder──▶ Server ──parameters, arming──▶ Autopilot ◀── timer (flight) or state frame (lockstep)
//!                                                            │
//!                                    Answer: command, rotors, telemetry
//! ```
//!
//! [`Autopilot`] is the control side, which a timer's interrupt calls; [`Server`] is the link side. In lockstep neither reads a
//! clock: the same frames give the same answers, bit by bit, however long they take to arrive.
#![no_std]

mod control;
mod law;
mod mixer;
mod parameters;
mod path;
mod server;

pub use control::{Answer, Autopilot, Boot, Counters, Drive};
pub use law::{Law, SetupRefused, Step};
pub use mixer::Mixer;
pub use parameters::{Entry, Parameter, Parameters, Refused};
pub use path::{AnyPath, HARMONICS};
pub use server::{Next, Server};
