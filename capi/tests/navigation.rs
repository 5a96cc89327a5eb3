//! The navigation filter through the C interface: in every convention of axes it finds a motion
//! that is known, and says by name what it refuses.

// Every pointer is to a local that outlives the call, or to room that is large enough; zeros are
// a value of each structure.
#![allow(clippy::undocumented_unsafe_blocks)]

use std::mem::size_of;

use capi::types::{SlungError, SlungFix, SlungNavigated, SlungNavigationSettings, SlungUav};

const G: f32 = 9.81;
const PERIOD: f64 = 0.002;

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

fn parameters() -> Room {
    let mut room = Room::new();
    assert_eq!(unsafe { capi::slung_parameters_default(room.pointer(), capi::PARAMETERS_BYTES) }, 0);
    room
}

fn settings() -> SlungNavigationSettings {
    let mut settings: SlungNavigationSettings = unsafe { std::mem::zeroed() };
    settings.struct_size = size_of::<SlungNavigationSettings>() as u32;
    assert_eq!(unsafe { capi::slung_navigation_defaults(&raw mut settings) }, 0);
    settings
}

const NO_ERROR: SlungError = SlungError {
    struct_size: size_of::<SlungError>() as u32,
    status: 0,
    field: [0; SlungError::FIELD_BYTES],
    value: 0.0,
    min: 0.0,
    max: 0.0,
    waypoint: -1,
};

/// Vectors of N and of B in the axes of an enum slung_frames.
fn world(frames: u32, [x, y, z]: [f64; 3]) -> [f32; 3] {
    match frames {
        0 => [x, y, z],
        1 => [y, x, -z],
        _ => [x, -y, -z],
    }
    .map(|c| c as f32)
}

fn body(frames: u32, [x, y, z]: [f64; 3]) -> [f32; 3] {
    if frames == 0 { [x, y, z] } else { [x, -y, -z] }.map(|c| c as f32)
}

/// Level on a circle of 5 m at 10 m height, facing along it: position, velocity, yaw, yaw rate and
/// specific force in B, at a time.
fn circle(t: f64) -> ([f64; 3], [f64; 3], f64, f64, [f64; 3]) {
    let (radius, rate) = (5.0, 0.4);
    let (s, c) = (rate * t).sin_cos();
    let speed = radius * rate;
    let inward = speed * rate;
    // To the right is inward, as seen from above with n3 down and a yaw that grows.
    (
        [radius * c, radius * s, -10.0],
        [-speed * s, speed * c, 0.0],
        rate * t + std::f64::consts::FRAC_PI_2,
        rate,
        [0.0, inward, -f64::from(G)],
    )
}

#[test]
fn a_known_motion_is_found_in_every_convention() {
    for frames in 0..3 {
        let mut parameters = parameters();
        let mut room = Room::new();
        let (position, velocity, yaw, ..) = circle(0.0);
        let mut uav: SlungUav = unsafe { std::mem::zeroed() };
        let rest = body(frames, [0.0, 0.0, -f64::from(G)]);
        assert_eq!(unsafe { capi::slung_navigation_at_rest(frames, &raw const rest, yaw as f32, &raw mut uav) }, 0);
        uav.position_world_m = world(frames, position);
        uav.velocity_world_m_s = world(frames, velocity);
        // Half a metre off at first.
        uav.position_world_m[0] += 0.5;
        let status = unsafe {
            capi::slung_navigation_create(
                room.pointer(),
                capi::NAVIGATION_BYTES,
                parameters.pointer(),
                std::ptr::null(),
                frames,
                &raw const uav,
                std::ptr::null_mut(),
            )
        };
        assert_eq!(status, 0);
        let mut found: SlungNavigated = unsafe { std::mem::zeroed() };
        found.struct_size = size_of::<SlungNavigated>() as u32;
        for step in 1..=10_000 {
            let t = f64::from(step) * PERIOD;
            let (position, velocity, yaw, rate, force) = circle(t);
            if step % 50 == 0 {
                let fix = SlungFix {
                    position_world_m: world(frames, position),
                    velocity_world_m_s: world(frames, velocity),
                    position_deviation_m: [0.02, 0.03],
                    velocity_deviation_m_s: [0.03, 0.05],
                    age_s: 0.0,
                };
                assert_eq!(unsafe { capi::slung_navigation_fix(room.pointer(), frames, &raw const fix) }, 0);
                assert_eq!(unsafe { capi::slung_navigation_heading(room.pointer(), yaw as f32) }, 0);
                assert_eq!(unsafe { capi::slung_navigation_height(room.pointer(), 10.0) }, 0);
            }
            let (rate, force) = (body(frames, [0.0, 0.0, rate]), body(frames, force));
            let status = unsafe {
                capi::slung_navigation_step(room.pointer(), frames, &raw const rate, &raw const force, &raw mut found)
            };
            assert_eq!(status, 0);
        }
        let (position, velocity, yaw, rate, force) = circle(10_000.0 * PERIOD);
        let off = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        // Sensors are exact: what is left is a fix's latency of no more than the filter's own cycle
        // of 60 ms in what it averages, and rounding at 10 m.
        assert!(off(found.uav.position_world_m, world(frames, position)) < 0.01, "{frames}: {found:?}");
        assert!(off(found.uav.velocity_world_m_s, world(frames, velocity)) < 0.02, "{frames}: {found:?}");
        assert!(off(found.uav.body_rate_rad_s, body(frames, [0.0, 0.0, rate])) < 0.005, "{frames}: {found:?}");
        assert!(off(found.specific_force_body_m_s2, body(frames, force)) < 0.03, "{frames}: {found:?}");
        // Level and by its yaw, from the axes' own zero: east in ENU, and counted upward.
        let turned = match frames {
            0 => yaw,
            1 => std::f64::consts::FRAC_PI_2 - yaw,
            _ => -yaw,
        };
        let expected = [(0.5 * turned).cos(), 0.0, 0.0, (0.5 * turned).sin()];
        let along: f64 = expected.iter().zip(found.uav.quaternion_body_to_world).map(|(a, b)| a * f64::from(b)).sum();
        // A hundredth of a radian: the gyro's bias is known to 0.005 rad/s at first.
        assert!(1.0 - along.abs() < 0.125e-4 * 4.0, "{frames}: {found:?}");
        assert_eq!((found.blind, found.resets), (0, 0));
    }
}

#[test]
fn a_refusal_names_the_header_s_field_with_its_value_and_range() {
    let mut parameters = parameters();
    let standing = SlungUav {
        position_world_m: [0.0; 3],
        velocity_world_m_s: [0.0; 3],
        quaternion_body_to_world: [1.0, 0.0, 0.0, 0.0],
        body_rate_rad_s: [0.0; 3],
    };
    let mut create = |settings: &SlungNavigationSettings, start: &SlungUav| {
        let mut room = Room::new();
        let mut error = NO_ERROR;
        let status = unsafe {
            capi::slung_navigation_create(
                room.pointer(),
                capi::NAVIGATION_BYTES,
                parameters.pointer(),
                settings,
                0,
                start,
                &raw mut error,
            )
        };
        // What was refused is no filter.
        if status != 0 {
            assert_eq!(unsafe { capi::slung_navigation_height(room.pointer(), 0.0) }, -5);
        }
        (status, error)
    };
    let mut wrong: [SlungNavigationSettings; 3] = [settings(); 3];
    wrong[0].barometer_m = 500.0;
    wrong[1].antenna_frd_m[1] = f32::NAN;
    wrong[2].start_position_m = 0.0;
    let told = [("barometer_m", 0.01, 100.0), ("antenna_frd_m", -2.0, 2.0), ("start_position_m", 1e-3, 1e5)];
    for (settings, (name, min, max)) in wrong.iter().zip(told) {
        let (status, error) = create(settings, &standing);
        assert_eq!((status, error.status, error.min, error.max), (-7, -7, min, max), "{name}");
        assert_eq!(std::ffi::CStr::from_bytes_until_nul(&error.field).unwrap().to_str(), Ok(name));
    }
    assert_eq!(create(&settings(), &standing).0, 0);
    assert_eq!(create(&SlungNavigationSettings { struct_size: 8, ..settings() }, &standing).0, -3);
    let skewed = SlungUav { quaternion_body_to_world: [1.0, 1.0, 0.0, 0.0], ..standing };
    assert_eq!(create(&settings(), &skewed).0, -10);
}

#[test]
fn an_attitude_at_rest_is_a_unit_quaternion_whichever_way_the_uav_lies() {
    // Each of the four components is the largest in turn: level, then on its side, head and back.
    let ways = [
        ([0.0, 0.0, -G], 0.3),
        ([0.0, 0.0, -G], 3.0),
        ([0.0, -G, 0.1], 0.2),
        ([0.3, 0.2, G], 0.1),
        ([0.3, -0.2, G], 3.0),
        ([0.5 * G, 0.2 * G, -0.7 * G], -2.0),
    ];
    for (force, heading) in ways {
        let mut uav: SlungUav = unsafe { std::mem::zeroed() };
        assert_eq!(unsafe { capi::slung_navigation_at_rest(0, &raw const force, heading, &raw mut uav) }, 0);
        let [w, x, y, z] = uav.quaternion_body_to_world;
        // f32's rounding of some ten operations.
        assert!((w * w + x * x + y * y + z * z - 1.0).abs() < 1e-6, "{uav:?}");
        // Down in B, the third row of the rotation, is against the force.
        let down = [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z];
        let length = force.iter().map(|f| f * f).sum::<f32>().sqrt();
        for (down, force) in down.into_iter().zip(force) {
            assert!((down + force / length).abs() < 1e-6, "{uav:?}");
        }
        // The heading of b1, the first column.
        let found = (2.0 * (x * y + w * z)).atan2(w * w + x * x - y * y - z * z);
        assert!((found - heading).abs() < 1e-5, "{found} is not {heading}");
    }
}
