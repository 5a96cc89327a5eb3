//! Whether the payload is still there.

use model::{Real, Vehicle};

/// How long the payload must seem lost, s: longer than a swing's or a gust's unloading.
const UNLOADED: f64 = 0.5;
/// Time, s, before which what the observers find is no sudden change yet, and over which it is
/// averaged.
const LEARNED: f64 = 2.0;
const KNOWN: f64 = 5.0;

/// The watch on the payload: of all mass, what the observers imply, M = M₀ λ/(λ + d·q), against
/// what they implied before. What is implied all the time is another thrust or another mass than
/// was told; a payload is lost suddenly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Payload<T> {
    /// Share of all mass that is left when the payload counts as lost.
    least: T,
    /// For how long the law has flown, s, up to [`KNOWN`], and the share of all mass implied
    /// meanwhile.
    learning: T,
    usual: T,
    /// Time without payload, s.
    unloaded: T,
}

impl<T: Real> Payload<T> {
    /// It counts as lost with less than the share `lost` of it left.
    pub(crate) fn new(vehicle: &Vehicle<T>, lost: T) -> Self {
        let params = vehicle.params();
        let least = (params.uav_mass + params.payload_mass * lost) / vehicle.total_mass();
        Self { least, learning: T::zero(), usual: T::one(), unloaded: T::zero() }
    }

    /// Nothing is known of disturbances.
    pub(crate) fn begin(&mut self) {
        *self = Self { least: self.least, learning: T::zero(), usual: T::one(), unloaded: T::zero() };
    }

    /// The law has been left.
    pub(crate) fn leave(&mut self) {
        self.unloaded = T::zero();
    }

    /// Whether it is lost, a `period` (s) later, from λ without d and d·q along the rod, both m/s².
    #[inline]
    pub(crate) fn is_lost(&mut self, lambda: T, along: T, period: T) -> bool {
        // Of what is no number nothing is implied.
        let implied = (lambda / (lambda + along)).clamp(T::zero(), T::lit(10.0));
        self.learning = (self.learning + period).min(T::lit(KNOWN));
        if self.learning >= T::lit(LEARNED) && implied < self.least * self.usual {
            self.unloaded += period;
        } else {
            self.unloaded = T::zero();
            self.usual += (implied - self.usual) * (period / self.learning);
        }
        self.unloaded > T::lit(UNLOADED)
    }
}
