//! What stands between a law in continuous time and a computer with actuators: a period, what is applied, what disturbs.

pub mod actuator;
pub mod allocation;
pub mod observer;
pub mod sampler;
