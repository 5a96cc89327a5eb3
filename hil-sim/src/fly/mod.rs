//! Flights: whatever answers states with commands around a [world](crate::world), and what is kept
//! of it.
//!
//! [`flight`] is the one loop. A watcher sees every period of it: [`judge`] keeps a few numbers, as
//! studies of many flights need, and [`run`] a log and everything that the figures ask for.

pub mod batch;
pub mod deviation;
pub mod fault;
pub mod flight;
pub mod judge;
pub mod metrics;
pub mod pilot;
pub mod run;
pub mod sample;
pub mod sight;
pub mod stops;
pub mod touchdown;
pub mod twin;
