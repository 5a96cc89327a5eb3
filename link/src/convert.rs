//! Between the dialect's arrays and the controller's types. Every float crosses bit by bit.

use controller::{Matrix3, State, Vector3};
use mavlink_core::types::CharArray;

use crate::dialect::LOAD_STATE_DATA;

/// A frame with `state` and nothing else set.
#[must_use]
pub fn state_frame(state: &State<f32>) -> LOAD_STATE_DATA {
    let r = &state.attitude;
    LOAD_STATE_DATA {
        position: state.position.into(),
        velocity: state.velocity.into(),
        rod: state.rod.into(),
        rod_rate: state.rod_rate.into(),
        attitude: [r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33],
        body_rate: state.body_rate.into(),
        ..LOAD_STATE_DATA::DEFAULT
    }
}

/// The state in a frame.
#[must_use]
pub fn state_of(frame: &LOAD_STATE_DATA) -> State<f32> {
    let [m11, m12, m13, m21, m22, m23, m31, m32, m33] = frame.attitude;
    State {
        position: Vector3::from(frame.position),
        velocity: Vector3::from(frame.velocity),
        rod: Vector3::from(frame.rod),
        rod_rate: Vector3::from(frame.rod_rate),
        attitude: Matrix3::new(m11, m12, m13, m21, m22, m23, m31, m32, m33),
        body_rate: Vector3::from(frame.body_rate),
    }
}

/// A parameter's name as MAVLink has it: 16 bytes, padded with zeros. What is longer is cut.
#[must_use]
pub fn name(text: &str) -> CharArray<16> {
    self::text(text)
}

/// Text padded with zeros, or cut, to `N` bytes.
#[must_use]
pub fn text<const N: usize>(text: &str) -> CharArray<N> {
    let mut bytes = [0; N];
    for (slot, byte) in bytes.iter_mut().zip(text.bytes()) {
        *slot = byte;
    }
    CharArray::new(bytes)
}

/// The text before the first zero; nothing if it is not UTF-8.
#[must_use]
pub fn text_of(bytes: &[u8]) -> &str {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    bytes.get(..end).and_then(|bytes| core::str::from_utf8(bytes).ok()).unwrap_or_default()
}
