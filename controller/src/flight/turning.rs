//! Attitude and body rate, where one of them is not measured (14.10), and rates that stand still.

use model::{Channel, Real, State, is_within};
use nalgebra::{Matrix3, Vector3};

/// How fast a body rate follows what the attitude says of it, rad/s.
const FOLLOWING: f64 = 20.0;

/// What stands still to the last bit is not believed once attitude or rod have turned by this much
/// else than their rates say, rad. With a rate that stands this is forgotten over this time, s.
const TURNED: f64 = 0.03;
const FORGOTTEN: f64 = 0.3;
/// What turns faster than this, rad/s, has jumped.
const FASTEST: f64 = 10.0;

/// The watch on a reading that stands still: a driver that gives its last one again, or none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stuck<T> {
    is_stuck: bool,
    reading: Vector3<T>,
    /// What has turned else than the rate says, rad.
    off: Vector3<T>,
}

impl<T: Real> Stuck<T> {
    /// Nothing stands still.
    pub(crate) fn none() -> Self {
        Self { is_stuck: false, reading: Vector3::zeros(), off: Vector3::zeros() }
    }

    /// Whether `rate` is to be left out, when there was a `last` one a `period` (s) ago and what it
    /// is of has `turned`, rad.
    #[inline(never)]
    pub(crate) fn watch_rate(
        &mut self,
        rate: &Vector3<T>,
        last: &Vector3<T>,
        turned: &Vector3<T>,
        period: T,
    ) -> bool {
        let off = turned - rate * period - self.off * (period * T::lit(1.0 / FORGOTTEN));
        self.watch(rate, last, is_turn(turned, period).then_some(off))
    }

    /// Whether `attitude` is to be left out, when there was a `last` one a `period` (s) ago and it
    /// should have turned at `rate`, rad/s.
    #[inline(never)]
    pub(crate) fn watch_attitude(
        &mut self,
        attitude: &Matrix3<T>,
        last: &Matrix3<T>,
        rate: &Vector3<T>,
        period: T,
    ) -> bool {
        // Each axis of the body moves one of them.
        let [reading, last] = [attitude, last].map(|m| Vector3::new(m.m32, m.m31, m.m21));
        let turned = rate * period;
        self.watch(&reading, &last, is_turn(&turned, period).then(|| -turned))
    }

    /// Where the rate says that a reading which is not believed should have been when that showed,
    /// rad from itself; once.
    pub(crate) fn take_lag(&mut self) -> Vector3<T> {
        -core::mem::replace(&mut self.off, Vector3::zeros())
    }

    /// It has turned by so much more else than the rate says, if it has not jumped.
    fn watch(&mut self, reading: &Vector3<T>, last: &Vector3<T>, off: Option<Vector3<T>>) -> bool {
        let is_new = *reading != self.reading || !self.is_stuck && reading != last;
        match off {
            _ if is_new => *self = Self { reading: *reading, ..Self::none() },
            _ if self.is_stuck => {}
            Some(off) => {
                self.off += off;
                self.is_stuck = !is_within(&self.off, T::lit(TURNED * TURNED));
            }
            None => *self = Self { reading: *reading, ..Self::none() },
        }
        self.is_stuck
    }
}

/// Whether something may have `turned` so far in a `period`, rad and s.
fn is_turn<T: Real>(turned: &Vector3<T>, period: T) -> bool {
    let most = period * T::lit(FASTEST);
    is_within(turned, most * most)
}

/// From one attitude to another near it, rad, in body axes.
pub(crate) fn angle<T: Real>(from: &Matrix3<T>, to: &Matrix3<T>) -> Vector3<T> {
    let off = from.transpose() * to;
    Vector3::new(off.m32 - off.m23, off.m13 - off.m31, off.m21 - off.m12) * T::lit(0.5)
}

/// Gives a `state` what is `missing` of its attitude and body rate, from what was `predicted` a
/// `period` (s) ago for now and from the other of the two.
pub(crate) fn mend<T: Real>(state: &mut State<T>, missing: Channel, predicted: &State<T>, period: T) {
    match missing {
        Channel::Attitude => state.attitude = predicted.attitude,
        Channel::BodyRate => {
            let off = angle(&predicted.attitude, &state.attitude);
            state.body_rate = predicted.body_rate + off * (T::one() / period).min(T::lit(FOLLOWING));
        }
        _ => {}
    }
}
