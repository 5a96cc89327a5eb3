//! Attitude and body rate, where one of them is not measured (14.10).

use model::{Channel, Real, State};
use nalgebra::Vector3;

/// How fast a body rate follows what the attitude says of it, rad/s.
const FOLLOWING: f64 = 20.0;
/// For how long an attitude is led by body rates alone, s: they drift.
pub(crate) const LED: f64 = 5.0;

/// What is `measured`, with its attitude or body rate, if this is the `channel` that is missing,
/// from what was `predicted` a `period` (s) ago for now and from the other of the two.
pub(crate) fn mended<T: Real>(
    measured: &State<T>,
    channel: Channel,
    predicted: &State<T>,
    period: T,
) -> Option<State<T>> {
    let mut state = *measured;
    match channel {
        Channel::Attitude => state.attitude = predicted.attitude,
        Channel::BodyRate => {
            let off = predicted.attitude.transpose() * measured.attitude;
            let angle = Vector3::new(off.m32 - off.m23, off.m13 - off.m31, off.m21 - off.m12) * T::lit(0.5);
            state.body_rate = predicted.body_rate + angle * (T::one() / period).min(T::lit(FOLLOWING));
        }
        _ => return None,
    }
    state.check().is_ok().then_some(state)
}
