//! Simulator of a slung load and its path-following law: plant, scenarios, flights, reports, and an independent witness.

pub mod batch;
pub mod check;
pub mod compare;
pub mod course;
pub mod deviation;
pub mod eval;
pub mod fit;
pub mod flight;
pub mod formula;
pub mod hil;
pub mod input;
pub mod integrate;
pub mod jet;
pub mod metrics;
pub mod models;
pub mod multibody;
pub mod pilot;
pub mod plant;
pub mod random;
pub mod reference;
pub mod report;
pub mod route;
pub mod run;
pub mod scenario;
pub mod witness;
pub mod world;
