//! Hardware in the loop: the plant here, the controller at the other end of a serial line or a
//! socket.
//!
//! [`Endpoint`] says where the target is, [`Emulator`] starts one in QEMU, [`Target`] speaks with
//! it and [answers states](crate::fly::pilot::Answers) as a law in this program does, so a flight
//! with it is a flight like any other.
//!
//! In lockstep each state frame is one control step, and a frame or its answer may be lost: the
//! same frame is sent again, and the target answers the same number with the same command. So
//! neither a slow host, nor a noisy line, nor a line that was cut and is back changes any result.
//!
//! A scenario with an estimator is flown on the vehicle's `instruments`: they are sent before each
//! state frame, which is then empty, and the target finds navigation and load by itself.
//!
//! A [`Station`] may command the target in place of a scenario's requests: what it says goes to the
//! target, what the target says to it, and here is only what the vehicle would be.

mod command;
mod datagrams;
mod emulator;
mod error;
mod instruments;
mod line;
mod mission;
mod options;
mod soft;
mod station;
mod statistics;
mod target;
mod wire;

pub use command::{Arguments, Flown, HOME, LinkReport, See, fly_all, lateness, table};
pub use emulator::Emulator;
pub use error::HilError;
pub use options::{Options, Pace};
pub use soft::{Here, serve};
pub use station::{Station, USUAL};
pub use statistics::Statistics;
pub use target::Target;
pub use wire::{Endpoint, Listener, Wire};
