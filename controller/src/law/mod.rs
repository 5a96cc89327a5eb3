//! The laws in continuous time: state and ζ to the payload's series and back, path following, tracking, and the law to fall
//! back on.

pub mod compensator;
pub mod follow;
pub mod gains;
pub(crate) mod hold;
pub mod lift;
pub mod lower;
pub mod track;
