//! The flight program without its hardware: what a board's interrupts call, and what tests call on
//! the host.
//!
//! ```text
//! bytes ──link::Decoder──▶ Server ──parameters, arming, requests──▶ Autopilot ◀── timer (flight) or state frame (lockstep)
//!                                                                      │ Rig: modes, envelope, observers, law, rotors
//!                                                                      ▼
//!                                                   Answer: command, rotors, telemetry
//! ```
//!
//! Where the UAV's own navigation comes as messages of its own, the newest of each is what is
//! measured at the next step; where nothing sees the load, an estimator finds it from those, if
//! `EST_LOAD` has it do so.
//!
//! The controller is a [`Rig`](rig::Rig) made of parameters; here stand only when it is stepped and
//! what the link hears of it.
//!
//! [`Autopilot`] is the control side, which a timer's interrupt calls; [`Server`] is the link side.
//! In lockstep neither reads a clock: the same frames give the same answers, bit by bit, however
//! long they take to arrive.
#![no_std]

mod control;
mod epoch;
mod estimate;
mod failsafe;
mod metadata;
mod mission;
mod report;
mod seen;
mod server;
mod settings;
mod store;

pub use control::{Absence, Answer, ArmRefused, Autopilot, Boot, Counters, Drive, MissionState, Notice};
pub use estimate::Unseen;
pub use failsafe::Loss;
pub use metadata::{File, page as metadata_page};
pub use mission::{
    Course, DEGREES, Fence, ITEMS, Item, Kind, METRES, Mark, Memory, Mission, Plan, Progress, Refusal,
};
pub use server::{Next, Server};
pub use settings::{Setting, Settings, entries};
pub use store::{Flash, FlashFault, NotKept, RECORD, Store};
