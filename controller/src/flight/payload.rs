//! Whether the payload is still there.

use model::{Real, Vehicle};

use crate::sampled::weight::Weight;

/// How long the payload must seem lost, s: longer than a swing's or a gust's unloading.
const UNLOADED: f64 = 0.5;
/// The watch on the payload: of all mass, what the observers imply against what they implied before.
/// What is implied all the time is another thrust or another mass than was told; a payload is lost
/// suddenly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Payload<T> {
    /// Share of all mass that is left when the payload counts as lost.
    least: T,
    /// Time without payload, s.
    unloaded: T,
}

impl<T: Real> Payload<T> {
    /// It counts as lost with less than the share `lost` of it left.
    pub(crate) fn new(vehicle: &Vehicle<T>, lost: T) -> Self {
        let params = vehicle.params();
        let least = (params.uav_mass + params.payload_mass * lost) / vehicle.total_mass();
        Self { least, unloaded: T::zero() }
    }

    /// The law has been left, or nothing is known.
    pub(crate) fn leave(&mut self) {
        self.unloaded = T::zero();
    }

    /// Whether it is lost, a `period` (s) later, with the `weight` implied then.
    #[inline]
    pub(crate) fn is_lost(&mut self, weight: &Weight<T>, period: T) -> bool {
        let is_light = weight.is_known() && weight.change() < self.least;
        self.unloaded = if is_light { self.unloaded + period } else { T::zero() };
        self.unloaded > T::lit(UNLOADED)
    }
}
