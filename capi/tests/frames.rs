//! States of what autopilots report: the same vehicle told in each of the axes is the same state.

use capi::types::{SlungState, SlungUav};
use capi::{Status, slung_state_from_cable, slung_state_from_payload};

/// NED/FRD, ENU/FLU, NWU/FLU.
const FRAMES: [u32; 3] = [0, 1, 2];

/// A vector of north, east, down in the world of `frames`.
fn world(frames: u32, [n, e, d]: [f32; 3]) -> [f32; 3] {
    match frames {
        0 => [n, e, d],
        1 => [e, n, -d],
        _ => [n, -e, -d],
    }
}

/// A vector of forward, right, down in the body of `frames`.
fn body(frames: u32, [x, y, z]: [f32; 3]) -> [f32; 3] {
    if frames == 0 { [x, y, z] } else { [x, -y, -z] }
}

/// Nose 30° from north to east and 10° up.
fn uav(frames: u32) -> SlungUav {
    // A yaw about down is minus a yaw about up, and counts from east in east-north-up. A pitch
    // about right is minus one about left.
    let (yaw, pitch) = match frames {
        0 => (30.0_f32, 10.0_f32),
        1 => (60.0, -10.0),
        _ => (-30.0, -10.0),
    };
    let half = |degrees: f32| (degrees.to_radians() / 2.0).sin_cos();
    let ((sy, cy), (sp, cp)) = (half(yaw), half(pitch));
    SlungUav {
        position_world_m: world(frames, [1.0, 2.0, -12.0]),
        velocity_world_m_s: world(frames, [0.3, -0.2, 0.1]),
        quaternion_body_to_world: [cy * cp, -sy * sp, cy * sp, sy * cp],
        body_rate_rad_s: body(frames, [0.1, 0.2, -0.3]),
    }
}

const NOWHERE: SlungState = SlungState {
    payload_position_ned_m: [0.0; 3],
    payload_velocity_ned_m_s: [0.0; 3],
    rod_ned: [0.0; 3],
    rod_rate_ned_1_s: [0.0; 3],
    attitude_frd_to_ned: [0.0; 9],
    body_rate_frd_rad_s: [0.0; 3],
};

fn with_cable(frames: u32) -> (i32, SlungState) {
    let mut state = NOWHERE;
    let (hook, cable) = (body(frames, [0.05, 0.0, 0.2]), world(frames, [0.6, 0.0, 0.8]));
    let (rate, reported) = (world(frames, [0.08, 0.3, -0.06]), uav(frames));
    // SAFETY: every pointer is to what its name says.
    let status =
        unsafe { slung_state_from_cable(frames, &raw const reported, &hook, 2.0, &cable, &rate, &raw mut state) };
    (status, state)
}

fn numbers(state: &SlungState) -> Vec<f32> {
    let SlungState {
        payload_position_ned_m: p,
        payload_velocity_ned_m_s: v,
        rod_ned: q,
        rod_rate_ned_1_s: w,
        attitude_frd_to_ned: r,
        body_rate_frd_rad_s: o,
    } = state;
    [&p[..], &v[..], &q[..], &w[..], &r[..], &o[..]].concat()
}

#[test]
fn every_frame_tells_the_same_state() {
    let states = FRAMES.map(with_cable);
    let (_, first) = states[0];
    // b1 is where the nose points.
    let nose = [0, 3, 6].map(|index| first.attitude_frd_to_ned[index]);
    let (sin, cos) = 30.0_f32.to_radians().sin_cos();
    let (up, level) = 10.0_f32.to_radians().sin_cos();
    for (found, expected) in nose.into_iter().zip([cos * level, sin * level, -up]) {
        assert!((found - expected).abs() < 1e-6, "{nose:?}");
    }
    for (status, state) in states {
        assert_eq!(status, Status::Ok as i32);
        // A handful of products of numbers up to 12, each rounded to 6e-8 of it.
        for (a, b) in numbers(&state).into_iter().zip(numbers(&first)) {
            assert!((a - b).abs() < 5e-6, "{state:?} {first:?}");
        }
    }
}

#[test]
fn what_makes_no_state_is_found() {
    let status = |uav: SlungUav, position: [f32; 3]| {
        let mut state = NOWHERE;
        let velocity = [0.0; 3];
        // SAFETY: every pointer is to what its name says.
        unsafe { slung_state_from_payload(0, &raw const uav, &position, &velocity, &raw mut state) }
    };
    let good = uav(0);
    assert_eq!(status(good, [1.0, 2.0, -10.0]), Status::Ok as i32);
    // A payload in the UAV's place, a quaternion that is twice as long, a NaN.
    let bad = Status::BadState as i32;
    assert_eq!(status(good, good.position_world_m), bad);
    let long = SlungUav { quaternion_body_to_world: [2.0, 0.0, 0.0, 0.0], ..good };
    assert_eq!(status(long, [1.0, 2.0, -10.0]), bad);
    assert_eq!(status(SlungUav { position_world_m: [f32::NAN; 3], ..good }, [1.0, 2.0, -10.0]), bad);
    // SAFETY: null is refused before it is read.
    let refused = unsafe {
        slung_state_from_payload(0, std::ptr::null(), std::ptr::null(), std::ptr::null(), std::ptr::null_mut())
    };
    assert_eq!(refused, Status::NullPointer as i32);
}
