//! The controller for C and C++. `include/slung.h` is the interface and its documentation; here is
//! what stands behind it.
//!
//! Every function checks its pointers and sizes, never panics, allocates nothing and keeps nothing
//! outside the memory that the caller hands it. `object/` makes one relocatable object of it.
#![no_std]

mod controller;
mod estimator;
mod frames;
mod navigation;
mod parameters;
mod path;
mod pointer;
mod route;
mod status;
mod text;
pub mod types;

pub use crate::controller::{
    BYTES as CONTROLLER_BYTES, slung_controller_bytes, slung_create, slung_create_on, slung_go_on, slung_output_in,
    slung_progress_of, slung_set_speed_factor, slung_start, slung_step, slung_step_measured, slung_take_over,
    slung_telemetry_of,
};
pub use crate::estimator::{
    BYTES as ESTIMATOR_BYTES, slung_estimator_bytes, slung_estimator_create, slung_estimator_observe,
    slung_estimator_observe_pair, slung_estimator_step,
};
pub use crate::frames::{slung_state_from_cable, slung_state_from_payload};
pub use crate::navigation::{
    BYTES as NAVIGATION_BYTES, slung_navigation_at_rest, slung_navigation_bytes, slung_navigation_create,
    slung_navigation_defaults, slung_navigation_fix, slung_navigation_heading, slung_navigation_height,
    slung_navigation_magnetic_field, slung_navigation_pose, slung_navigation_step,
};
pub use crate::parameters::{
    BYTES as PARAMETERS_BYTES, slung_parameter_count, slung_parameter_info, slung_parameters_bytes,
    slung_parameters_default, slung_parameters_get, slung_parameters_set,
};
pub use crate::route::{
    BYTES as ROUTE_BYTES, slung_route_build, slung_route_bytes, slung_route_land, slung_route_repeat,
};
pub use crate::status::Status;
pub use crate::text::{slung_fault_text, slung_mode_text, slung_status_text, slung_warning_text};

/// `SLUNG_ABI_VERSION` of the header that this library was built with.
pub const ABI_VERSION: u32 = 1;

/// The version of the interface, to be compared with `SLUNG_ABI_VERSION`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_abi_version() -> u32 {
    ABI_VERSION
}
