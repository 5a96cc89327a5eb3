//! What flying needs besides a law: joining the path, the envelope, modes and faults.

pub(crate) mod approach;
pub(crate) mod cable;
pub(crate) mod envelope;
pub(crate) mod landing;
pub(crate) mod mode;
pub(crate) mod payload;
pub(crate) mod speed_factor;
pub(crate) mod supervisor;
