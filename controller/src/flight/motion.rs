//! Whether load and UAV move as their velocities say.

use model::{Real, State, Uav, is_within};
use nalgebra::Vector3;

/// A position further from where the velocities lead than this, m, for as long as this, s,
/// contradicts them.
const OFF: f64 = 0.3;
const LONG: f64 = 0.1;
/// Time, s, over which a difference is forgotten: a velocity may be wrong by `OFF` in this time,
/// 0.6 m/s, for ever, and a position that has jumped is believed once this has been forgotten.
const FORGOTTEN: f64 = 0.5;

/// The watch on two bodies' positions and velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    period: T,
    /// Time since both were measured, s.
    unseen: T,
    load: Led<T>,
    uav: Led<T>,
}

impl<T: Real> Motion<T> {
    /// Nothing has been measured yet.
    pub(crate) fn new(period: T) -> Self {
        let led = Led { place: Vector3::zeros(), off: T::zero() };
        Self { period, unseen: T::lit(FORGOTTEN), load: led, uav: led }
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
        if passed >= T::lit(FORGOTTEN) {
            self.load = Led { place: state.position, off: T::zero() };
            self.uav = Led { place: uav.position, off: T::zero() };
            return [false; 2];
        }
        [
            self.load.is_off(&state.position, &state.velocity, passed),
            self.uav.is_off(&uav.position, &uav.velocity, passed),
        ]
    }
}

/// Where a velocity has led, m, and for how long the position has been off it, s.
#[derive(Clone, Copy, Debug)]
struct Led<T> {
    place: Vector3<T>,
    off: T,
}

impl<T: Real> Led<T> {
    /// The same a time `passed` (s) later, with what is measured then.
    #[inline(never)]
    fn is_off(&mut self, position: &Vector3<T>, velocity: &Vector3<T>, passed: T) -> bool {
        self.place += velocity * passed;
        let off = position - self.place;
        self.place += off * (passed * T::lit(1.0 / FORGOTTEN));
        self.off = if is_within(&off, T::lit(OFF * OFF)) { T::zero() } else { self.off + passed };
        self.off > T::lit(LONG)
    }
}
