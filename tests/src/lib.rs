//! What the tests of this package share: the golden vectors, as data.

pub mod golden;
