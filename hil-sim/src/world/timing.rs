//! The control loop's clock: periods that jitter, and samples that do not come.

use serde::Deserialize;

use super::check;
use crate::describe::input::Invalid;
use crate::world::random::Stream;

/// How regular the loop is.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Timing {
    /// Each period is uniform within this share of the nominal one, either way, 0 to 0.9.
    pub jitter: f64,
    /// Probability that the controller is not called at a sample, 0 to 0.9; the last command goes
    /// on.
    pub missed: f64,
}

impl Timing {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "jitter", self.jitter, 0.0, 0.9)?;
        check(at, "missed", self.missed, 0.0, 0.9)
    }

    /// The length of the coming period as a share of the nominal one.
    pub(crate) fn stretch(&self, stream: &mut Stream) -> f64 {
        if self.jitter > 0.0 { 1.0 + stream.uniform(-self.jitter, self.jitter) } else { 1.0 }
    }

    /// Whether the controller misses this sample.
    pub(crate) fn misses(&self, stream: &mut Stream) -> bool {
        self.missed > 0.0 && stream.unit() < self.missed
    }
}
