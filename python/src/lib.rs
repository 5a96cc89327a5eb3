//! The controller, the estimator and the simulator for Python: the package `slung`.
//!
//! Here is what the package is made of; `slung/_slung.pyi` says what each of it does. Whatever
//! takes longer than a few microseconds is done without Python's lock.

mod convert;
mod error;
mod estimator;
mod fleet;
mod flight;
mod interrupt;
mod parameters;
mod path;
mod rig;
mod scenario;
mod state;
mod study;
mod world;

use pyo3::prelude::*;

/// What the package `slung` is made of.
#[pymodule]
mod _slung {
    #[pymodule_export]
    use crate::error::Refused;
    #[pymodule_export]
    use crate::estimator::{Estimate, Navigation, PayloadFilter};
    #[pymodule_export]
    use crate::fleet::Fleet;
    #[pymodule_export]
    use crate::flight::{Flight, replay, run};
    #[pymodule_export]
    use crate::parameters::{Entry, Parameters};
    #[pymodule_export]
    use crate::path::Path;
    #[pymodule_export]
    use crate::rig::{Output, Rig};
    #[pymodule_export]
    use crate::scenario::Scenario;
    #[pymodule_export]
    use crate::state::{State, Uav};
    #[pymodule_export]
    use crate::study::{Campaign, compare};
    #[pymodule_export]
    use crate::world::World;
}
