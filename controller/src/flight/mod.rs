//! What flying needs besides a law: joining the path, the envelope, modes and faults.

pub mod approach;
pub mod envelope;
pub mod supervisor;
