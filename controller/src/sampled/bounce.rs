//! Whether load and UAV bounce on a cable that stretches, by what the observers imply that all
//! weighs.

use core::f64::consts::PI;

use model::{Real, Vehicle};

/// The implied weight, a share of what was told, bounces when it goes from more than this above its
/// mean over so many seconds to more than it below and back so many times, each at least as fast as
/// on a cable that its load stretches by this share.
const SWING: f64 = 0.05;
const AVERAGED: f64 = 1.0;
const CROSSINGS: u8 = 2;
const STRETCH: f64 = 0.1;

/// The watch on the bounce.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce<T> {
    /// Half of the slowest bounce, s.
    slowest: T,
    mean: T,
    averaged: T,
    is_heavy: bool,
    crossings: u8,
    /// Since the last crossing, and from the first to it, s.
    since: T,
    lasted: T,
}

impl<T: Real> Bounce<T> {
    /// Nothing of this `vehicle` has bounced.
    pub(crate) fn none(vehicle: &Vehicle<T>) -> Self {
        let params = vehicle.params();
        let slowest = (params.rod_length * T::lit(STRETCH) / params.gravity).sqrt() * T::lit(PI);
        Self {
            slowest,
            mean: T::one(),
            averaged: T::zero(),
            is_heavy: false,
            crossings: 0,
            since: T::zero(),
            lasted: T::zero(),
        }
    }

    /// A `period` (s) later, with what is `implied` that all weighs, as a share of what was told:
    /// the frequency, rad/s, of a bounce.
    #[inline]
    pub(crate) fn look(&mut self, implied: T, period: T) -> Option<T> {
        self.since += period;
        let off = implied - self.mean;
        self.averaged = (self.averaged + period).min(T::lit(AVERAGED));
        self.mean += off * (period / self.averaged);
        let is_across = if self.is_heavy { off < T::lit(-SWING) } else { off > T::lit(SWING) };
        if is_across { self.cross() } else { None }
    }

    /// The mean, a share of what was told.
    pub(crate) fn mean(&self) -> T {
        self.mean
    }

    #[cold]
    fn cross(&mut self) -> Option<T> {
        self.is_heavy = !self.is_heavy;
        let since = core::mem::replace(&mut self.since, T::zero());
        if self.crossings == 0 || since > self.slowest {
            (self.crossings, self.lasted) = (1, T::zero());
            return None;
        }
        self.crossings += 1;
        self.lasted += since;
        if self.crossings <= CROSSINGS {
            return None;
        }
        let frequency = T::lit(PI * f64::from(CROSSINGS)) / self.lasted;
        self.crossings = 0;
        Some(frequency)
    }
}
