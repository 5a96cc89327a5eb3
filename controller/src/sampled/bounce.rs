//! Whether load and UAV bounce on a cable that stretches, by what the observers imply that all
//! weighs.

use core::f64::consts::PI;

use model::{Real, Vehicle};

/// The implied weight, a share of what was told, bounces when it goes from more than this above its
/// mean over so many seconds to more than it below and back so many times, each at least as fast as
/// on a cable that its load stretches by this share.
const SWING: f64 = 0.03;
const AVERAGED: f64 = 1.0;
const CROSSINGS: u8 = 2;
const STRETCH: f64 = 0.1;

/// What the watch has seen.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Seen<T> {
    /// Less than a bounce.
    Crossing,
    /// A bounce of this frequency, rad/s.
    Bounce(T),
    /// Nothing for half of the slowest bounce.
    Calm,
}

/// The watch on the bounce.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce<T> {
    mean: T,
    averaged: T,
    /// Where it was last: 1 above the mean, −1 below.
    side: T,
    crossings: u8,
    /// Until half of the slowest bounce has passed since the last crossing, and from the first to
    /// it, s.
    left: T,
    lasted: T,
}

impl<T: Real> Bounce<T> {
    /// Nothing of this `vehicle` has bounced.
    pub(crate) fn none(vehicle: &Vehicle<T>) -> Self {
        Self {
            mean: T::one(),
            averaged: T::zero(),
            side: -T::one(),
            crossings: 0,
            left: half_of_slowest(vehicle),
            lasted: T::zero(),
        }
    }

    /// A `period` (s) later, with what is `implied` that all weighs, as a share of what was told:
    /// whether there is something to [see](Self::see).
    #[inline]
    pub(crate) fn look(&mut self, implied: T, period: T) -> bool {
        self.left -= period;
        let off = implied - self.mean;
        self.averaged = (self.averaged + period).min(T::lit(AVERAGED));
        self.mean += off * (period / self.averaged);
        off * self.side < T::lit(-SWING) || self.left < T::zero()
    }

    /// What there is of this `vehicle`'s.
    #[cold]
    pub(crate) fn see(&mut self, vehicle: &Vehicle<T>) -> Seen<T> {
        let longest = half_of_slowest(vehicle);
        let since = longest - core::mem::replace(&mut self.left, longest);
        if since > longest {
            self.crossings = 0;
            return Seen::Calm;
        }
        self.side = -self.side;
        self.lasted = if self.crossings == 0 { T::zero() } else { self.lasted + since };
        self.crossings += 1;
        if self.crossings <= CROSSINGS {
            return Seen::Crossing;
        }
        self.crossings = 0;
        Seen::Bounce(T::lit(PI * f64::from(CROSSINGS)) / self.lasted)
    }

    /// The mean, a share of what was told.
    pub(crate) fn mean(&self) -> T {
        self.mean
    }

    /// Whether the mean is one of enough time.
    pub(crate) fn has_mean(&self) -> bool {
        self.averaged >= T::lit(AVERAGED)
    }
}

/// The slowest frequency that is seen of this `vehicle`, rad/s.
pub(crate) fn slowest<T: Real>(vehicle: &Vehicle<T>) -> T {
    T::lit(PI) / half_of_slowest(vehicle)
}

/// From one side of it to the other, s.
fn half_of_slowest<T: Real>(vehicle: &Vehicle<T>) -> T {
    let params = vehicle.params();
    (params.rod_length * T::lit(STRETCH) / params.gravity).sqrt() * T::lit(PI)
}
