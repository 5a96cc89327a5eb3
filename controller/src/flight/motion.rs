//! Whether load and UAV move as their velocities say.

use model::{Real, State, Uav, is_within};
use nalgebra::Vector3;

/// A position further from where the velocities lead than this, m, contradicts them.
const OFF: f64 = 0.3;
/// Time, s, over which a difference is forgotten: a velocity may be wrong by `OFF` in this time,
/// 0.6 m/s, for ever, and a position that has jumped is believed once this has been forgotten.
const FORGOTTEN: f64 = 0.5;

/// The watch on two bodies' positions and velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    period: T,
    /// Time since both were measured, s.
    unseen: T,
    /// Where the velocities have led load and UAV, m.
    load: Vector3<T>,
    uav: Vector3<T>,
}

impl<T: Real> Motion<T> {
    /// Nothing has been measured yet.
    pub(crate) fn new(period: T) -> Self {
        Self { period, unseen: T::lit(FORGOTTEN), load: Vector3::zeros(), uav: Vector3::zeros() }
    }

    /// What is measured next is where both are.
    pub(crate) fn forget(&mut self) {
        self.unseen = T::lit(FORGOTTEN);
    }

    /// A period has passed.
    #[inline]
    pub(crate) fn pass(&mut self) {
        self.unseen += self.period;
    }

    /// Whether load and UAV are measured where their velocities have not led them.
    #[inline(never)]
    pub(crate) fn is_off(&mut self, state: &State<T>, uav: &Uav<T>) -> [bool; 2] {
        let passed = self.unseen;
        self.unseen = T::zero();
        let is_known = passed < T::lit(FORGOTTEN);
        let share = passed * T::lit(1.0 / FORGOTTEN);
        let is_off = |led: &mut Vector3<T>, position: &Vector3<T>, velocity: &Vector3<T>| {
            if !is_known {
                *led = *position;
                return false;
            }
            *led += velocity * passed;
            let off = position - *led;
            *led += off * share;
            !is_within(&off, T::lit(OFF * OFF))
        };
        [
            is_off(&mut self.load, &state.position, &state.velocity),
            is_off(&mut self.uav, &uav.position, &uav.velocity),
        ]
    }
}
