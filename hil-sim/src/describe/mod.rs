//! What is to be flown, as text says it: scenarios, paths, formulas, reference numbers.

pub mod course;
pub mod formula;
pub mod input;
pub mod keys;
pub mod mission;
pub mod parameters;
pub mod path;
pub mod reference;
pub mod scenario;
