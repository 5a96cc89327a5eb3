//! Attitude and body rate, where one of them is not measured (14.10).

use model::{Channel, Real, State};
use nalgebra::Vector3;

/// How fast a body rate follows what the attitude says of it, rad/s.
const FOLLOWING: f64 = 20.0;
/// For how long an attitude is led by body rates alone, s: they drift.
pub(crate) const LED: f64 = 5.0;

/// Gives a `state` what is `missing` of its attitude and body rate, from what was `predicted` a
/// `period` (s) ago for now and from the other of the two.
pub(crate) fn mend<T: Real>(state: &mut State<T>, missing: Channel, predicted: &State<T>, period: T) {
    match missing {
        Channel::Attitude => state.attitude = predicted.attitude,
        Channel::BodyRate => {
            let off = predicted.attitude.transpose() * state.attitude;
            let angle = Vector3::new(off.m32 - off.m23, off.m13 - off.m31, off.m21 - off.m12) * T::lit(0.5);
            state.body_rate = predicted.body_rate + angle * (T::one() / period).min(T::lit(FOLLOWING));
        }
        _ => {}
    }
}
