//! Flights: a law around a world, its log, its figures.

pub mod batch;
pub mod deviation;
pub mod flight;
pub mod metrics;
pub mod pilot;
pub mod run;
