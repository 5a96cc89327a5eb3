//! The control loop's clock: periods that jitter, and samples that do not come.

use serde::Deserialize;

use super::check;
use crate::describe::input::Invalid;
use crate::world::random::Stream;

/// How regular the loop is, and how often it has a state.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Timing {
    /// Each period is uniform within this share of the nominal one, either way, 0 to 0.9.
    pub jitter: f64,
    /// Probability that no state comes to the controller in a period, 0 to 0.9.
    pub missed: f64,
    /// Periods from one state to the next, 1 to 1000; states of a slower estimator.
    pub state_every: u32,
}

impl Default for Timing {
    /// Regular, with a state in every period.
    fn default() -> Self {
        Self { jitter: 0.0, missed: 0.0, state_every: 1 }
    }
}

impl Timing {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "jitter", self.jitter, 0.0, 0.9)?;
        check(at, "missed", self.missed, 0.0, 0.9)?;
        check(at, "state_every", self.state_every.into(), 1.0, 1000.0)
    }

    /// The length of the coming period as a share of the nominal one.
    #[inline]
    pub(crate) fn stretch(&self, stream: &mut Stream) -> f64 {
        if self.jitter > 0.0 { 1.0 + stream.uniform(-self.jitter, self.jitter) } else { 1.0 }
    }

    /// Whether no state comes in this period, the `index`-th after the first.
    pub(crate) fn misses(&self, index: u32, stream: &mut Stream) -> bool {
        let is_lost = self.missed > 0.0 && stream.unit() < self.missed;
        is_lost || !index.is_multiple_of(self.state_every)
    }
}
