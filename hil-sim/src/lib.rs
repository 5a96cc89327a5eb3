//! Simulator of a slung load and its path-following law: plant, scenarios, flights, reports, and an
//! independent witness.

pub mod describe;
pub mod fly;
pub mod hil;
pub mod report;
pub mod study;
pub mod world;
