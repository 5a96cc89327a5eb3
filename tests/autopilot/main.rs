//! The flight program's decisions: nothing turns unless armed, nothing that is no number gets out,
//! and what the pilot asks for and what goes wrong lead where the supervisor says.

mod bytes;
mod control;
mod estimate;
mod failsafe;
mod fence;
mod ground;
mod link;
mod mission;
mod modes;
mod place;
mod plans;
mod station;
mod store;
