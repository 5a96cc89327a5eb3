//! What only a route's flight has: refused by name and waypoint, and where none is flown.

// Every pointer is to a local that outlives the call, or to room that is large enough; zeros are
// a value of each structure.
#![allow(clippy::undocumented_unsafe_blocks)]

use std::ffi::CStr;
use std::mem::size_of;

use capi::Status;
use capi::types::{SlungError, SlungProgress, SlungState, SlungWaypoint, SlungWrench};
use controller::{Knot, Run};

/// Memory for an instance.
#[repr(C, align(8))]
struct Room([u8; capi::CONTROLLER_BYTES]);

impl Room {
    const fn new() -> Self {
        Self([0; capi::CONTROLLER_BYTES])
    }
    fn pointer<T>(&mut self) -> *mut T {
        (&raw mut self.0).cast()
    }
}

const POINTS: [[f32; 3]; 3] = [[0.0, 0.0, -10.0], [12.0, 0.0, -10.0], [12.0, 9.0, -12.0]];

fn waypoints() -> [SlungWaypoint; 3] {
    POINTS.map(|point_ned_m| SlungWaypoint {
        point_ned_m,
        corner_m: 2.0,
        speed_m_s: 1.5,
        yaw_rad: f32::NAN,
        stop_s: -1.0,
    })
}

/// The status of a build, and what it tells.
fn build(
    waypoints: &[SlungWaypoint],
    route: &mut Room,
    knots: &mut [Knot<f32>],
    runs: &mut [Run<f32>],
) -> (i32, SlungError) {
    let mut error: SlungError = unsafe { std::mem::zeroed() };
    error.struct_size = size_of::<SlungError>() as u32;
    let status = unsafe {
        capi::slung_route_build(
            route.pointer(),
            capi::ROUTE_BYTES,
            waypoints.as_ptr(),
            waypoints.len() as u32,
            0,
            std::ptr::null(),
            knots.as_mut_ptr(),
            knots.len() as u32,
            runs.as_mut_ptr(),
            runs.len() as u32,
            &raw mut error,
        )
    };
    (status, error)
}

#[test]
fn a_refusal_names_the_waypoint() {
    let (mut knots, mut runs) = (vec![Knot::default(); 128], [Run::default(); 2]);
    let mut route = Room::new();
    let mut refuse = |change: fn(&mut [SlungWaypoint; 3])| {
        let mut waypoints = waypoints();
        change(&mut waypoints);
        let (status, error) = build(&waypoints, &mut route, &mut knots, &mut runs);
        let field = CStr::from_bytes_until_nul(&error.field).unwrap().to_str().unwrap().to_owned();
        assert_eq!(status, error.status);
        (status, field, error.value, error.waypoint)
    };
    let range = Status::OutOfRange as i32;
    assert_eq!(refuse(|waypoints| waypoints[2].speed_m_s = -1.0), (range, "speed".to_owned(), -1.0, 2));
    assert_eq!(refuse(|waypoints| waypoints[1].point_ned_m[0] = 2e5), (range, "point".to_owned(), 2e5, 1));
    let turns = refuse(|waypoints| waypoints[2].point_ned_m = [0.0, 0.1, -10.0]);
    assert_eq!(turns, (Status::NoRoute as i32, "turn".to_owned(), 1.0, 1));
}

#[test]
fn a_route_tells_how_far_it_is_and_a_circle_that_it_is_none() {
    let (mut parameters, mut route) = (Room::new(), Room::new());
    assert_eq!(unsafe { capi::slung_parameters_default(parameters.pointer(), capi::PARAMETERS_BYTES) }, 0);
    let (mut knots, mut runs) = (vec![Knot::default(); 128], [Run::default(); 2]);
    let mut points = waypoints();
    points[1].stop_s = f32::INFINITY;
    assert_eq!(build(&points, &mut route, &mut knots, &mut runs).0, 0);
    let mut progress: SlungProgress = unsafe { std::mem::zeroed() };
    progress.struct_size = size_of::<SlungProgress>() as u32;
    for is_route in [true, false] {
        let mut controller = Room::new();
        let on = if is_route { route.pointer() } else { std::ptr::null_mut() };
        let none = std::ptr::null_mut();
        let status = unsafe {
            capi::slung_create_on(controller.pointer(), capi::CONTROLLER_BYTES, parameters.pointer(), on, none)
        };
        assert_eq!(status, 0);
        let mut state: SlungState = unsafe { std::mem::zeroed() };
        (state.payload_position_ned_m, state.rod_ned[2]) = ([0.0, 0.0, -10.0], 1.0);
        [0, 4, 8].into_iter().for_each(|diagonal| state.attitude_frd_to_ned[diagonal] = 1.0);
        let hover = SlungWrench { thrust_n: 29.43, torque_frd_n_m: [0.0; 3] };
        assert_eq!(unsafe { capi::slung_take_over(controller.pointer(), &raw const state, &raw const hover) }, 0);
        let told = unsafe { capi::slung_progress_of(controller.pointer(), &raw mut progress) };
        assert_eq!(told, if is_route { 0 } else { Status::NotNow as i32 });
        assert_eq!(unsafe { capi::slung_go_on(controller.pointer()) }, Status::NotNow as i32);
        for factor in [f32::NAN, 2.5, f32::NEG_INFINITY] {
            let status = unsafe { capi::slung_set_speed_factor(controller.pointer(), factor) };
            assert_eq!(status, Status::OutOfRange as i32, "{factor}");
        }
        assert_eq!(unsafe { capi::slung_set_speed_factor(controller.pointer(), 0.0) }, 0);
    }
    assert_eq!((progress.run, progress.runs, progress.rests, progress.is_over), (0, 2, 0, 0));
    // The spline's weights add up to 1 by rounding.
    let off = progress.nearest_ned_m.iter().zip(POINTS[0]).map(|(nearest, at)| (nearest - at).abs());
    assert!(off.fold(0.0, f32::max) < 1e-5, "{:?}", progress.nearest_ned_m);
}
