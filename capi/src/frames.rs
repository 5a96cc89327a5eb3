//! States of what autopilots report. The conversion is the model's; here are its pointers.

use controller::{Frames, Matrix3, Real, State, Uav, Vector3};
use estimator::Motion;

use crate::pointer::{exclusive, shared};
use crate::status::{Status, code};
use crate::types::{SlungState, SlungUav};

/// The axes of `slung_frames`.
///
/// # Errors
/// [`Status::UnknownEnumerator`].
pub fn frames(number: u32) -> Result<Frames, Status> {
    match number {
        0 => Ok(Frames::NedFrd),
        1 => Ok(Frames::EnuFlu),
        2 => Ok(Frames::NwuFlu),
        _ => Err(Status::UnknownEnumerator),
    }
}

/// The rotation of a unit quaternion (w, x, y, z). Of one of another length it is the length's
/// square times a rotation, which the state's check finds.
pub fn rotation(quaternion: [f32; 4]) -> Matrix3<f32> {
    let [w, x, y, z] = quaternion;
    let twice = |a: f32| a + a;
    Matrix3::new(
        w * w + x * x - y * y - z * z,
        twice(x * y - w * z),
        twice(x * z + w * y),
        twice(x * y + w * z),
        w * w - x * x + y * y - z * z,
        twice(y * z - w * x),
        twice(x * z - w * y),
        twice(y * z + w * x),
        w * w - x * x - y * y + z * z,
    )
}

/// The unit quaternion (w, x, y, z) of a rotation: from the largest of its four components, so that
/// nothing is divided by a small one.
pub fn quaternion(r: &Matrix3<f32>) -> [f32; 4] {
    // Rows of 4 q qᵀ; the one with the largest diagonal element is a multiple of q.
    let [a, b, c] = [r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12];
    let [d, e, f] = [r.m21 + r.m12, r.m13 + r.m31, r.m32 + r.m23];
    let [w, x, y, z] = [
        1.0 + r.m11 + r.m22 + r.m33,
        1.0 + r.m11 - r.m22 - r.m33,
        1.0 - r.m11 + r.m22 - r.m33,
        1.0 - r.m11 - r.m22 + r.m33,
    ];
    let (largest, row) = [(x, [a, x, d, e]), (y, [b, d, y, f]), (z, [c, e, f, z])]
        .into_iter()
        .fold((w, [w, a, b, c]), |best, next| if next.0 > best.0 { next } else { best });
    let scale = 0.5 / Real::sqrt(largest);
    row.map(|component| component * scale)
}

/// How a filter says that the UAV moves, in the axes of `frames`, each of whose maps is its own
/// inverse.
pub fn reported(frames: Frames, motion: &Motion<f32>) -> SlungUav {
    SlungUav {
        position_world_m: frames.inertial(&motion.position).into(),
        velocity_world_m_s: frames.inertial(&motion.velocity).into(),
        quaternion_body_to_world: quaternion(&frames.attitude(&motion.attitude)),
        body_rate_rad_s: frames.body(&motion.body_rate).into(),
    }
}

/// A UAV that was not reported: a step takes it for none.
pub const NO_UAV: SlungUav = SlungUav {
    position_world_m: [f32::NAN; 3],
    velocity_world_m_s: [f32::NAN; 3],
    quaternion_body_to_world: [f32::NAN; 4],
    body_rate_rad_s: [f32::NAN; 3],
};

/// The UAV in the library's own axes.
pub fn uav(frames: Frames, reported: &SlungUav) -> Uav<f32> {
    Uav {
        position: frames.inertial(&reported.position_world_m.into()),
        velocity: frames.inertial(&reported.velocity_world_m_s.into()),
        attitude: frames.attitude(&rotation(reported.quaternion_body_to_world)),
        body_rate: frames.body(&reported.body_rate_rad_s.into()),
    }
}

impl From<&State<f32>> for SlungState {
    fn from(state: &State<f32>) -> Self {
        let r = &state.attitude;
        Self {
            payload_position_ned_m: state.position.into(),
            payload_velocity_ned_m_s: state.velocity.into(),
            rod_ned: state.rod.into(),
            rod_rate_ned_1_s: state.rod_rate.into(),
            attitude_frd_to_ned: [r.m11, r.m12, r.m13, r.m21, r.m22, r.m23, r.m31, r.m32, r.m33],
            body_rate_frd_rad_s: state.body_rate.into(),
        }
    }
}

impl From<&SlungState> for State<f32> {
    fn from(state: &SlungState) -> Self {
        let [m11, m12, m13, m21, m22, m23, m31, m32, m33] = state.attitude_frd_to_ned;
        Self {
            position: state.payload_position_ned_m.into(),
            velocity: state.payload_velocity_ned_m_s.into(),
            rod: state.rod_ned.into(),
            rod_rate: state.rod_rate_ned_1_s.into(),
            attitude: Matrix3::new(m11, m12, m13, m21, m22, m23, m31, m32, m33),
            body_rate: state.body_rate_frd_rad_s.into(),
        }
    }
}

/// Writes `state`, and says whether the law can be trusted with it.
fn write(state: &State<f32>, target: &mut SlungState) -> Result<(), Status> {
    *target = state.into();
    state.check().map_err(|_| Status::BadState)
}

/// The state of a UAV and its payload; see the header.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_state_from_payload(
    number: u32,
    reported: *const SlungUav,
    payload_position_world_m: *const [f32; 3],
    payload_velocity_world_m_s: *const [f32; 3],
    state: *mut SlungState,
) -> i32 {
    let convert = || {
        // SAFETY: the caller's promise.
        let (reported, position, velocity, state) = unsafe {
            (
                shared(reported)?,
                shared(payload_position_world_m)?,
                shared(payload_velocity_world_m_s)?,
                exclusive(state)?,
            )
        };
        let frames = frames(number)?;
        let inertial = |v: &[f32; 3]| frames.inertial(&Vector3::from(*v));
        write(&uav(frames, reported).with_load(inertial(position), inertial(velocity)), state)
    };
    code(convert())
}

/// The state of a UAV with a taut cable on its hook; see the header.
///
/// # Safety
/// As [`slung_state_from_payload`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_state_from_cable(
    number: u32,
    reported: *const SlungUav,
    hook_body_m: *const [f32; 3],
    cable_length_m: f32,
    cable_world: *const [f32; 3],
    cable_rate_world_1_s: *const [f32; 3],
    state: *mut SlungState,
) -> i32 {
    let convert = || {
        // SAFETY: the caller's promise.
        let (reported, hook, cable, rate, state) = unsafe {
            (
                shared(reported)?,
                shared(hook_body_m)?,
                shared(cable_world)?,
                shared(cable_rate_world_1_s)?,
                exclusive(state)?,
            )
        };
        let frames = frames(number)?;
        let inertial = |v: &[f32; 3]| frames.inertial(&Vector3::from(*v));
        let hook = frames.body(&Vector3::from(*hook));
        write(&uav(frames, reported).with_cable(hook, cable_length_m, inertial(cable), inertial(rate)), state)
    };
    code(convert())
}
