//! The payload filter through the C interface: what motion capture sees of both bodies shows the rod
//! in every convention of axes, whatever navigation makes of the UAV's place.

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
