//! Many flights, and what is asked of a path or the law without one.

pub mod calibrate;
pub mod campaign;
pub mod check;
pub mod compare;
pub mod estimate;
pub mod eval;
pub mod fit;
mod json;
pub mod pilot;
pub mod plant;
pub mod replay;
pub mod tune;
