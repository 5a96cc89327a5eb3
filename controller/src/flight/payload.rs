//! Whether the payload is still there.

use model::{Real, Vehicle};

use crate::sampled::weight::Weight;

/// How long the payload must seem lost, s: longer than a swing's or a gust's unloading.
const UNLOADED: f64 = 0.5;
/// How long what seemed lost must pull to count as there, s.
const BACK: f64 = 3.0;
/// It pulls while no more has gone than this share of what a loss takes away.
const GONE: f64 = 0.5;

/// The watch on the payload: of all mass, what the observers imply against what they implied
/// before. What is implied all the time is another thrust or another mass than was told; a payload
/// is lost suddenly, and pulls no more.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Payload<T> {
    /// Share of all mass that is left when the payload counts as lost.
    least: T,
    /// So much less than usual may it pull, N.
    gone: T,
    /// The cable's usual pull before the payload seemed lost, N.
    usual: T,
    /// Time without payload, and for which it has pulled again, s.
    unloaded: T,
    pulling: T,
}

impl<T: Real> Payload<T> {
    /// It counts as lost with less than the share `lost` of it left.
    pub(crate) fn new(vehicle: &Vehicle<T>, lost: T) -> Self {
        let params = vehicle.params();
        let least = (params.uav_mass + params.payload_mass * lost) / vehicle.total_mass();
        let gone = params.payload_mass * params.gravity * (T::one() - lost) * T::lit(GONE);
        Self { least, gone, usual: T::zero(), unloaded: T::zero(), pulling: T::zero() }
    }

    /// The law has been left, or nothing is known.
    pub(crate) fn leave(&mut self) {
        (self.unloaded, self.pulling) = (T::zero(), T::zero());
    }

    /// Whether it is lost, a `period` (s) later, with the `weight` implied then and the `usual`
    /// pull along n3, N.
    #[inline]
    pub(crate) fn is_lost(&mut self, weight: &Weight<T>, usual: T, period: T) -> bool {
        if !(weight.is_known() && weight.change() < self.least) {
            self.unloaded = T::zero();
            return false;
        }
        if self.unloaded == T::zero() {
            self.usual = usual;
        }
        self.unloaded += period;
        self.unloaded > T::lit(UNLOADED)
    }

    /// Whether what seemed lost is there, a `period` (s) later, by its pull along n3 `now`, N.
    #[cold]
    pub(crate) fn is_back(&mut self, now: T, period: T) -> bool {
        self.pulling = if self.usual - now < self.gone { self.pulling + period } else { T::zero() };
        self.pulling > T::lit(BACK)
    }
}
