//! Attitude and body rate, where one of them is not measured (14.10), and rates that stand still.

use model::{Channel, Real, State, is_within};
use nalgebra::{Matrix3, Vector3};

/// How fast a body rate follows what the attitude says of it, rad/s.
const FOLLOWING: f64 = 20.0;
/// For how long an attitude is led by body rates alone, s: they drift.
pub(crate) const LED: f64 = 5.0;

/// A rate that stands still to the last bit is not believed once what it is the rate of has turned
/// by this much else than it says, rad, which is forgotten over this time, s.
const TURNED: f64 = 0.03;
const FORGOTTEN: f64 = 0.3;
/// What turns faster than this, rad/s, has jumped.
const FASTEST: f64 = 10.0;

/// The watch on a rate that stands still: a driver that gives its last reading again, or none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stuck<T> {
    is_stuck: bool,
    rate: Vector3<T>,
    /// What has turned else than by that, rad.
    turned: Vector3<T>,
}

impl<T: Real> Stuck<T> {
    /// Nothing stands still.
    pub(crate) fn none() -> Self {
        Self { is_stuck: false, rate: Vector3::zeros(), turned: Vector3::zeros() }
    }

    /// Whether there is something to [watch](Self::watch): the `rate` is the `last` one again though
    /// something `has_turned`, or was not believed then.
    #[inline]
    pub(crate) fn is_due(&self, rate: &Vector3<T>, last: &Vector3<T>, has_turned: impl FnOnce() -> bool) -> bool {
        self.is_stuck || rate.x == last.x && has_turned()
    }

    /// Whether `rate` is to be left out, when there was a `last` one a `period` (s) ago and what it
    /// is of has `turned`, rad.
    #[inline(never)]
    pub(crate) fn watch(&mut self, rate: &Vector3<T>, last: &Vector3<T>, turned: &Vector3<T>, period: T) -> bool {
        let most = period * T::lit(FASTEST);
        if *rate != self.rate || !self.is_stuck && (rate != last || !is_within(turned, most * most)) {
            *self = Self { rate: *rate, ..Self::none() };
        } else if !self.is_stuck {
            self.turned += turned - rate * period - self.turned * (period * T::lit(1.0 / FORGOTTEN));
            self.is_stuck = !is_within(&self.turned, T::lit(TURNED * TURNED));
        }
        self.is_stuck
    }
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
