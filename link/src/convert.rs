//! Between the dialect's arrays and the controller's types. Every float crosses bit by bit.

use controller::{Matrix3, Measured, State, Uav, Vector3};
use mavlink_core::types::CharArray;

use crate::dialect::{LOAD_STATE_DATA, LoadSeen};

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

/// A frame with all that is `measured`.
#[must_use]
pub fn measured_frame(measured: &Measured<'_, f32>) -> LOAD_STATE_DATA {
    let mut frame = match (measured.state, measured.uav) {
        (Some(state), _) => state_frame(state),
        (None, uav) => {
            let attitude = uav.map_or_else(Matrix3::identity, |uav| uav.attitude);
            let body_rate = uav.map_or_else(Vector3::zeros, |uav| uav.body_rate);
            let unseen = State { attitude, body_rate, ..State::at_rest(Vector3::zeros()) };
            LOAD_STATE_DATA { seen: LoadSeen::LOAD_SEEN_NO_LOAD, ..state_frame(&unseen) }
        }
    };
    if let Some(uav) = measured.uav {
        frame.seen |= LoadSeen::LOAD_SEEN_UAV;
        (frame.uav_position, frame.uav_velocity) = (uav.position.into(), uav.velocity.into());
    }
    if let Some(force) = measured.specific_force {
        frame.seen |= LoadSeen::LOAD_SEEN_FORCE;
        frame.specific_force = force.into();
    }
    frame
}

/// The UAV by its own navigation, where a frame holds it.
#[must_use]
pub fn uav_of(frame: &LOAD_STATE_DATA) -> Option<Uav<f32>> {
    frame.seen.contains(LoadSeen::LOAD_SEEN_UAV).then(|| Uav {
        position: Vector3::from(frame.uav_position),
        velocity: Vector3::from(frame.uav_velocity),
        attitude: attitude(frame),
        body_rate: Vector3::from(frame.body_rate),
    })
}

/// The accelerometer's specific force, m/s² in body axes, where a frame holds it.
#[must_use]
pub fn specific_force_of(frame: &LOAD_STATE_DATA) -> Option<Vector3<f32>> {
    frame.seen.contains(LoadSeen::LOAD_SEEN_FORCE).then(|| Vector3::from(frame.specific_force))
}

fn attitude(frame: &LOAD_STATE_DATA) -> Matrix3<f32> {
    let [m11, m12, m13, m21, m22, m23, m31, m32, m33] = frame.attitude;
    Matrix3::new(m11, m12, m13, m21, m22, m23, m31, m32, m33)
}

/// The load's state in a frame.
#[must_use]
pub fn state_of(frame: &LOAD_STATE_DATA) -> State<f32> {
    State {
        position: Vector3::from(frame.position),
        velocity: Vector3::from(frame.velocity),
        rod: Vector3::from(frame.rod),
        rod_rate: Vector3::from(frame.rod_rate),
        attitude: attitude(frame),
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
