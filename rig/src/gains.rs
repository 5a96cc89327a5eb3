//! `K*`: the gains of either law, low order first.

use controller::{Gains, Real, TrackGains};

use crate::entry::{Entry, Name};
use crate::parameters::Parameters;
use crate::run;
use crate::table::concatenated;

/// The range is that of a float: the law itself refuses gains that make no stable loop.
const RANGE: (f64, f64) = (-1e9, 1e9);

// The poles -1, -2, … of each chain, spread as they should be in flight.
const SIX: [f64; 6] = [720.0, 1764.0, 1624.0, 735.0, 175.0, 21.0];
const FIVE: [f64; 6] = [120.0, 274.0, 225.0, 85.0, 15.0, 0.0];
const TWO: [f64; 2] = [6.0, 5.0];

/// `K<output>_<order>`, an entry for each of `defaults`.
const fn chain<const N: usize>(output: usize, defaults: [f64; N], text: &'static str) -> [Entry<f64>; N] {
    let mut entries = [Entry::real("K", "gain", "", 0.0, RANGE, text); N];
    let mut order = 0;
    while order < N {
        entries[order].name = Name::new("K").with_digit(output).with("_").with_digit(order);
        entries[order].default = defaults[order];
        order += 1;
    }
    entries
}

/// `KI_<output>`.
const fn integral(name: &str, text: &'static str) -> Entry<f64> {
    Entry::real(name, "integral", "", 0.0, (0.0, RANGE.1), text)
}

pub(crate) const ENTRIES: &[Entry<f64>] = &concatenated::<23>(&[
    &chain(1, SIX, "Gain of h1's derivative of this order; tracking: of the error of p1."),
    &chain(2, SIX, "Gain of h2's derivative of this order; tracking: of the error of p2."),
    &chain(3, FIVE, "Gain of h3's derivative of this order, to 4; tracking: of the error of p3, to 5."),
    &chain(4, TWO, "Gain of the yaw error's derivative of this order."),
    &[
        integral("KI_1", "Integral gain of h1; following only."),
        integral("KI_2", "Integral gain of h2; following only."),
        integral("KI_3", "Integral gain of h3; following only."),
    ],
]);

impl<T: Real> Parameters<T> {
    /// The path-following law's gains.
    #[must_use]
    pub fn gains(&self) -> Gains<T> {
        Gains {
            k1: self.run(run!("K1_0" to "K1_5")),
            k2: self.run(run!("K2_0" to "K2_5")),
            k3: self.run(run!("K3_0" to "K3_4")),
            k4: self.run(run!("K4_0" to "K4_1")),
            integral: self.run(run!("KI_1" to "KI_3")),
        }
    }

    /// The tracking law's gains.
    #[must_use]
    pub fn track_gains(&self) -> TrackGains<T> {
        TrackGains {
            position: [run!("K1_0" to "K1_5"), run!("K2_0" to "K2_5"), run!("K3_0" to "K3_5")]
                .map(|run| self.run(run)),
            yaw: self.run(run!("K4_0" to "K4_1")),
        }
    }
}
