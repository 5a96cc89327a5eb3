//! What stands between a law in continuous time and a computer with actuators: a period, what is
//! applied, what disturbs.

pub(crate) mod actuator;
pub(crate) mod allocation;
pub(crate) mod bounce;
pub(crate) mod controller;
pub(crate) mod observer;
pub(crate) mod pull;
pub(crate) mod sampler;
pub(crate) mod weight;
