//! The payload filter through the C interface, in every convention of axes: what motion capture sees
//! of both bodies shows the rod, whatever navigation makes of the UAV's place, and where that jumps,
//! the UAV beside the state glides with it.

// Every pointer is to a local that outlives the call, or to room that is large enough; zeros are
// a value of each structure.
#![allow(clippy::undocumented_unsafe_blocks)]

use std::mem::size_of;
use std::ptr::null;

use capi::Status;
use capi::types::{SlungEstimate, SlungUav};

const G: f32 = 9.81;

/// Memory for an instance of at most 4 KiB.
#[repr(C, align(8))]
struct Room([u8; 4096]);

impl Room {
    const fn new() -> Self {
        Self([0; 4096])
    }
    fn pointer<T>(&mut self) -> *mut T {
        (&raw mut self.0).cast()
    }
}

/// A vector of N in the axes of an enum slung_frames, whose second and third pairs have b3 up.
fn world(frames: u32, [x, y, z]: [f32; 3]) -> [f32; 3] {
    match frames {
        0 => [x, y, z],
        1 => [y, x, -z],
        _ => [x, -y, -z],
    }
}

/// The rod after two seconds of hover, n1 component, with navigation half a metre off along n1,
/// behind what `observe` does each period with load and UAV where they are.
fn rod(frames: u32, observe: impl Fn(*mut (), &[f32; 3], &[f32; 3]) -> i32) -> f32 {
    let (mut parameters, mut room) = (Room::new(), Room::new());
    let mut estimate: SlungEstimate = unsafe { std::mem::zeroed() };
    estimate.struct_size = size_of::<SlungEstimate>() as u32;
    assert_eq!(unsafe { capi::slung_parameters_default(parameters.pointer(), capi::PARAMETERS_BYTES) }, 0);
    let created = unsafe {
        let parameters = parameters.pointer();
        capi::slung_estimator_create(room.pointer(), capi::ESTIMATOR_BYTES, parameters, null(), std::ptr::null_mut())
    };
    assert_eq!(created, 0);
    // Level with b1 to the north: in east, north, up that is a quarter turn.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let uav = SlungUav {
        position_world_m: world(frames, [0.5, 0.0, -10.0]),
        velocity_world_m_s: [0.0; 3],
        quaternion_body_to_world: if frames == 1 { [half, 0.0, 0.0, half] } else { [1.0, 0.0, 0.0, 0.0] },
        body_rate_rad_s: [0.0; 3],
    };
    let force = if frames == 0 { [0.0, 0.0, -G] } else { [0.0, 0.0, G] };
    let (load, place) = (world(frames, [0.0, 0.0, -8.0]), world(frames, [0.0, 0.0, -10.0]));
    for _ in 0..400 {
        let (uav, force) = (&raw const uav, &raw const force);
        let step =
            unsafe { capi::slung_estimator_step(room.pointer(), frames, uav, force, 3.0 * G, &raw mut estimate) };
        assert_eq!(step, 0);
        assert_eq!(observe(room.pointer(), &load, &place), 0);
    }
    estimate.state.rod_ned[0]
}

#[test]
fn a_pair_shows_the_rod_whatever_navigation_makes_of_the_place() {
    for frames in 0..3 {
        let pair = rod(frames, |room, load, uav| unsafe {
            capi::slung_estimator_observe_pair(room.cast(), frames, load, uav, 0.001, 0.0)
        });
        // By a millimetre in each place over 2 m of cable; twice that is left.
        assert!(pair.abs() < 0.002, "frames {frames}: {pair}");
        // The load alone is taken against the wrong hook: of 0.25 rad the accelerometer takes most
        // back, but not all but a pair's error.
        let alone = rod(frames, |room, load, _| unsafe {
            capi::slung_estimator_observe(room.cast(), frames, load, 0.001, 0.0)
        });
        assert!(alone < -0.02, "frames {frames}: {alone}");
        // What is no measurement is refused.
        for (uav, deviation) in [([f32::NAN; 3], 0.001), ([0.0; 3], 0.0), ([0.0; 3], f32::INFINITY)] {
            let refused = |room: *mut (), load: &[f32; 3], _: &[f32; 3]| unsafe {
                let status =
                    capi::slung_estimator_observe_pair(room.cast(), frames, load, &raw const uav, deviation, 0.0);
                assert_eq!(status, Status::OutOfRange as i32);
                0
            };
            rod(frames, refused);
        }
    }
}

/// The estimate in a structure of `bytes` after 500 periods of hover and one more, in which navigation
/// has jumped by a metre to the north, or is not told; and the UAV where it then is.
fn jumped(frames: u32, is_told: bool, bytes: u32) -> (SlungEstimate, SlungUav) {
    let (mut parameters, mut room) = (Room::new(), Room::new());
    assert_eq!(unsafe { capi::slung_parameters_default(parameters.pointer(), capi::PARAMETERS_BYTES) }, 0);
    let created = unsafe {
        let parameters = parameters.pointer();
        capi::slung_estimator_create(room.pointer(), capi::ESTIMATOR_BYTES, parameters, null(), std::ptr::null_mut())
    };
    assert_eq!(created, 0);
    let mut estimate: SlungEstimate = unsafe { std::mem::zeroed() };
    estimate.struct_size = bytes;
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mut uav = SlungUav {
        position_world_m: world(frames, [3.0, 1.0, -10.0]),
        velocity_world_m_s: [0.0; 3],
        quaternion_body_to_world: if frames == 1 { [half, 0.0, 0.0, half] } else { [1.0, 0.0, 0.0, 0.0] },
        body_rate_rad_s: [0.0; 3],
    };
    let force = if frames == 0 { [0.0, 0.0, -G] } else { [0.0, 0.0, G] };
    for period in 0..=500 {
        if period == 500 {
            uav.position_world_m = world(frames, [4.0, 1.0, -10.0]);
        }
        let told = if period < 500 || is_told { &raw const uav } else { null() };
        let step = unsafe {
            capi::slung_estimator_step(room.pointer(), frames, told, &raw const force, 3.0 * G, &raw mut estimate)
        };
        assert_eq!(step, 0);
    }
    (estimate, uav)
}

#[test]
fn the_uav_glides_beside_its_load_in_every_convention() {
    for frames in 0..3 {
        let (estimate, uav) = jumped(frames, true, size_of::<SlungEstimate>() as u32);
        let beside = estimate.uav;
        // In N: each map is its own inverse.
        let place = world(frames, beside.position_world_m);
        let load = estimate.state.payload_position_ned_m;
        let line: Vec<_> = load.iter().zip(place).map(|(load, uav)| load - uav).collect();
        // Rounding at 10 m is 1e-6, and the line's sum has a few; the cable is 2 m.
        let off = line.iter().zip(estimate.state.rod_ned).map(|(line, rod)| (line - 2.0 * rod).abs());
        assert!(off.fold(0.0, f32::max) < 1e-5, "frames {frames}: {line:?}");
        // A period of the glide at 0.5 m/s² has moved it by less than a millimetre.
        assert!((place[0] - 3.0).abs() < 1e-3, "frames {frames}: {place:?}");
        assert_eq!(world(frames, uav.position_world_m)[0], 4.0);
        assert_eq!(beside.quaternion_body_to_world, uav.quaternion_body_to_world);
        assert_eq!(beside.body_rate_rad_s, uav.body_rate_rad_s);
    }
}

#[test]
fn a_uav_that_was_not_told_is_none_beside_the_state() {
    let SlungUav { position_world_m, velocity_world_m_s, quaternion_body_to_world, body_rate_rad_s } =
        jumped(0, false, size_of::<SlungEstimate>() as u32).0.uav;
    let vectors = [position_world_m, velocity_world_m_s, body_rate_rad_s];
    assert!(vectors.iter().flatten().chain(&quaternion_body_to_world).all(|number| number.is_nan()));
}

/// A program that was compiled with the first header has room for an estimate without the UAV.
#[test]
fn an_older_caller_s_estimate_ends_with_the_state() {
    let (whole, older) =
        (jumped(0, true, size_of::<SlungEstimate>() as u32).0, jumped(0, true, SlungEstimate::FIRST).0);
    assert_eq!(older.struct_size, SlungEstimate::FIRST);
    assert_eq!((older.validity, older.state), (whole.validity, whole.state));
    assert_eq!(older.uav, unsafe { std::mem::zeroed() });
}
