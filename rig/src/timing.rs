//! `CTL_*`: when the law is called and when its commands act, and which law.

use controller::{Real, Sampling, ranges};

use crate::entry::Entry;
use crate::parameter;
use crate::parameters::Parameters;

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::of("CTL_PERIOD", ranges::PERIOD, "s", "Control period."),
    Entry::of(
        "CTL_LATENCY",
        ranges::LATENCY,
        "s",
        "Known time from a state's sample to its command's start; at most 31 periods.",
    ),
    Entry::of("CTL_LAG", ranges::ROTOR_LAG, "s", "Known time constant of the rotors."),
    Entry::switch(
        "CTL_AHEAD",
        "look_ahead",
        true,
        "Evaluate the law for the middle of the coming hold instead of at the sample.",
    ),
    Entry::choice("CTL_LAW", "law", &["follow a path", "track a circle"], 0, "The law."),
];

impl<T: Real> Parameters<T> {
    /// When the law is called and when its commands act.
    #[must_use]
    pub fn sampling(&self) -> Sampling<T> {
        Sampling {
            period: self.get(parameter!("CTL_PERIOD")),
            latency: self.get(parameter!("CTL_LATENCY")),
            rotor_lag: self.get(parameter!("CTL_LAG")),
            look_ahead: self.is_on(parameter!("CTL_AHEAD")),
        }
    }
}
