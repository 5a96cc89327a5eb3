//! `CTL_*`: when the law is called and when its commands act, and which law.

use controller::{Real, Sampling};

use crate::entry::Entry;
use crate::parameter;
use crate::parameters::Parameters;

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::real("CTL_PERIOD", "period", "s", 0.002, (1e-4, 0.2), "Control period."),
    Entry::real(
        "CTL_LATENCY",
        "latency",
        "s",
        0.0,
        (0.0, 0.5),
        "Known time from a state's sample to its command's start; at most 31 periods.",
    ),
    Entry::real("CTL_LAG", "rotor_lag", "s", 0.0, (0.0, 0.5), "Known time constant of the rotors."),
    Entry::switch(
        "CTL_AHEAD",
        "look_ahead",
        true,
        "Evaluate the law for the middle of the coming hold instead of at the sample.",
    ),
    Entry::choice("CTL_LAW", "law", &["follow a path", "track a circle"], 0, "The law."),
];

pub(crate) fn sampling<T: Real>(parameters: &Parameters<T>) -> Sampling<T> {
    Sampling {
        period: parameters.get(parameter!("CTL_PERIOD")),
        latency: parameters.get(parameter!("CTL_LATENCY")),
        rotor_lag: parameters.get(parameter!("CTL_LAG")),
        look_ahead: parameters.is_on(parameter!("CTL_AHEAD")),
    }
}
