//! What flying needs besides a law: the envelope, landing, modes and faults.

pub(crate) mod cable;
pub(crate) mod envelope;
pub(crate) mod fence;
pub(crate) mod footing;
pub(crate) mod landing;
pub(crate) mod mode;
pub(crate) mod motion;
pub(crate) mod payload;
pub(crate) mod supervisor;
pub(crate) mod turning;
