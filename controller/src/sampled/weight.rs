//! What everything weighs: the mass that the observers imply, fed back slowly.

use model::Real;

/// Time, s, before which what the observers find is not believed yet, and over which it is
/// averaged.
const LEARNED: f64 = 2.0;
const KNOWN: f64 = 5.0;
/// Shares of the mass told that are flown on.
const FLOWN: (f64, f64) = (0.5, 3.0);

/// All mass as a share of what was told, by (12.6) and (12.7): the average of what λ
/// and d·q imply.
///
/// A d along the rod that goes with λ turns with the path; a mass does not. So once it stands in M
/// nothing is left for the observers to follow, be it another payload or another thrust than told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weight<T> {
    /// For how long the law has flown, s, up to [`KNOWN`], and the share implied meanwhile.
    learning: T,
    usual: T,
    /// Implied at the last sample.
    implied: T,
    /// That is flown on.
    flown: T,
}

impl<T: Real> Weight<T> {
    /// As it was told.
    pub(crate) fn told() -> Self {
        Self { learning: T::zero(), usual: T::one(), implied: T::one(), flown: T::one() }
    }

    /// A `period` (s) of the law later, with λ without d and d·q, both m/s²: the share to fly on.
    #[inline]
    pub(crate) fn learn(&mut self, lambda: T, along: T, period: T) -> T {
        self.implied = self.imply(lambda, along);
        self.learning = (self.learning + period).min(T::lit(KNOWN));
        self.usual += (self.implied - self.usual) * (period / self.learning);
        if self.is_known() {
            let (least, most) = FLOWN;
            self.flown = self.usual.clamp(T::lit(least), T::lit(most));
        }
        self.flown
    }

    /// The law has been left: what it has not flown long enough to know is forgotten. What was
    /// implied while it failed is nothing to compare a load with.
    pub(crate) fn leave(&mut self) {
        if !self.is_known() {
            self.learning = T::zero();
        }
    }

    /// The share that λ without d and d·q, both m/s², imply.
    #[inline]
    pub(crate) fn imply(&self, lambda: T, along: T) -> T {
        // Of what is no number nothing is implied.
        (self.flown * lambda / (lambda + along)).clamp(T::zero(), T::lit(10.0))
    }

    /// d·q, m/s², that implies a `share`, of those that are flown on.
    pub(crate) fn along(&self, share: T, lambda: T) -> T {
        let (least, most) = FLOWN;
        lambda * (self.flown / share.clamp(T::lit(least), T::lit(most)) - T::one())
    }

    /// The share implied at the last sample.
    #[inline]
    pub(crate) fn implied(&self) -> T {
        self.implied
    }

    /// Whether the usual share is known.
    #[inline]
    pub(crate) fn is_known(&self) -> bool {
        self.learning >= T::lit(LEARNED)
    }

    /// The share implied at the last sample, over the usual one.
    #[inline]
    pub(crate) fn change(&self) -> T {
        self.implied / self.usual
    }
}
