//! Routes: the law against the witness, and flights.

mod courses;
mod flight;
mod gusts;
mod laid;
mod law;
