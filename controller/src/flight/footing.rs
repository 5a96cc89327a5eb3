//! Whether a landing UAV that sinks no further stands on the ground.
//!
//! Something carries it, or it would be where it should be: the ground, or, where its load has been
//! caught on the way, the cable, from which it then hangs below its load. Where the load is seen
//! elsewhere it stands. Where not, a UAV that stands can't turn: it is asked to, one way and then
//! the other, since a constant torque may stop it in one of them.

use model::Real;

/// How far above its target, m, something must keep a landing UAV for it to be asked, and to have
/// landed: more than hold lags in any descent.
const ASKED: f64 = 0.75;
const CARRIED: f64 = 1.5;
/// Yaw rate that is asked for, and from which on the UAV turns, rad/s.
const TURN: f64 = 0.3;
const TURNING: f64 = 0.1;
/// Time, s, over which the yaw rate is averaged, for which a turn each way is asked for, and after
/// which a UAV that is carried and does not stand hangs.
const AVERAGED: f64 = 0.1;
const EACH_WAY: f64 = 1.0;
const HANGING: f64 = 6.0;

/// What carries the UAV.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Carried {
    /// Its rotors, or it is not known yet.
    Flying,
    /// The ground.
    Standing,
    /// Something on which it does not stand.
    Hanging,
}

/// The UAV's footing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footing<T> {
    yaw_rate: T,
    is_asked: bool,
    /// For how long it has not turned although it was asked to, and for how long it has been
    /// carried, s.
    still: T,
    carried: T,
}

impl<T: Real> Footing<T> {
    /// Nothing carries it.
    pub(crate) fn none() -> Self {
        Self { yaw_rate: T::zero(), is_asked: false, still: T::zero(), carried: T::zero() }
    }

    /// A `period` (s) on, with the UAV `above` (m) where it should be, at its `yaw_rate`, rad/s; it
    /// `may_hang` if the load is not seen elsewhere than above it.
    pub(crate) fn feel(&mut self, above: T, yaw_rate: T, may_hang: bool, period: T) -> Carried {
        self.yaw_rate += (yaw_rate - self.yaw_rate) * (period / T::lit(AVERAGED)).min(T::one());
        let is_still = self.is_asked && self.yaw_rate.abs() < T::lit(TURNING);
        self.is_asked = may_hang && above > T::lit(ASKED);
        self.still = if is_still { self.still + period } else { T::zero() };
        self.carried = if above > T::lit(CARRIED) { self.carried + period } else { T::zero() };
        if self.carried == T::zero() {
            Carried::Flying
        } else if !may_hang || self.still > T::lit(EACH_WAY * 2.0) {
            Carried::Standing
        } else if self.carried > T::lit(HANGING) {
            Carried::Hanging
        } else {
            Carried::Flying
        }
    }

    /// The yaw rate, rad/s, to ask for.
    pub(crate) fn turn(&self) -> T {
        if !self.is_asked {
            T::zero()
        } else if self.still < T::lit(EACH_WAY) {
            T::lit(TURN)
        } else {
            T::lit(-TURN)
        }
    }
}
