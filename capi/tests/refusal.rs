//! A call that refuses changes nothing: two instances of each kind are stepped alike, but that one of
//! them is asked for what is refused in between, and both answer the same to the bit.

// Every pointer is to a local that outlives the call, or to room that is large enough, but for those
// that are to be refused; zeros are a value of each structure.
#![allow(clippy::undocumented_unsafe_blocks)]

use std::mem::size_of;
use std::ptr::{null, null_mut};

use capi::Status;
use capi::types::{SlungEstimate, SlungNavigated, SlungOutput, SlungState, SlungUav, SlungWrench};

const G: f32 = 9.81;
const FOLLOW: u32 = 2;
const HOLD: u32 = 3;
const HOLDING: u32 = 4;
const JOINING: u32 = 2;

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

/// An answer's room of so many bytes, as a caller's header says.
macro_rules! answer {
    ($type:ty, $bytes:expr) => {{
        let mut answer: $type = unsafe { std::mem::zeroed() };
        answer.struct_size = $bytes as u32;
        answer
    }};
    ($type:ty) => {
        answer!($type, size_of::<$type>())
    };
}

/// Hovering, 1 m beside the default circle.
fn hover() -> SlungState {
    let mut state: SlungState = unsafe { std::mem::zeroed() };
    (state.payload_position_ned_m, state.rod_ned[2]) = ([6.0, 0.0, -10.0], 1.0);
    [0, 4, 8].into_iter().for_each(|diagonal| state.attitude_frd_to_ned[diagonal] = 1.0);
    state
}

fn uav() -> SlungUav {
    SlungUav {
        position_world_m: [6.0, 0.0, -12.0],
        velocity_world_m_s: [0.0; 3],
        quaternion_body_to_world: [1.0, 0.0, 0.0, 0.0],
        body_rate_rad_s: [0.0; 3],
    }
}

/// One byte beyond where a `T` may be.
fn misaligned<T>(pointer: *const T) -> *const T {
    pointer.cast::<u8>().wrapping_add(1).cast()
}

fn controller() -> Room {
    let (mut parameters, mut room) = (parameters(), Room::new());
    let state = hover();
    let applied = SlungWrench { thrust_n: 3.0 * G, torque_frd_n_m: [0.0; 3] };
    unsafe {
        assert_eq!(capi::slung_create(room.pointer(), capi::CONTROLLER_BYTES, parameters.pointer(), null_mut()), 0);
        assert_eq!(capi::slung_take_over(room.pointer(), &raw const state, &raw const applied), 0);
    }
    room
}

#[test]
fn a_step_that_is_refused_flies_nothing() {
    let (mut one, mut other) = (controller(), controller());
    let (state, uav, force) = (hover(), uav(), [0.0, 0.0, -G]);
    let pointers = (&raw const state, &raw const uav, &raw const force);
    let step = |room: &mut Room, request, output: *mut SlungOutput| unsafe {
        let (state, uav, force) = pointers;
        capi::slung_step_measured(room.pointer(), state, 0, uav, force, request, output)
    };
    for period in 0..200 {
        // Each asks for another request than the one that is flown.
        let mut refuse = |status: Status, frames, state, uav, force, output: *mut SlungOutput| {
            let told =
                unsafe { capi::slung_step_measured(other.pointer(), state, frames, uav, force, FOLLOW, output) };
            assert_eq!(told, status as i32);
        };
        let (state, uav, force) = pointers;
        let (mut whole, mut short) = (answer!(SlungOutput), answer!(SlungOutput, size_of::<SlungOutput>() - 1));
        let was = (whole, short);
        refuse(Status::NullPointer, 0, state, uav, force, null_mut());
        refuse(Status::StructSize, 0, state, uav, force, &raw mut short);
        refuse(Status::Misaligned, 0, state, uav, force, misaligned(&raw const short).cast_mut());
        refuse(Status::UnknownEnumerator, 3, state, uav, force, &raw mut whole);
        refuse(Status::Misaligned, 0, misaligned(state), uav, force, &raw mut whole);
        refuse(Status::Misaligned, 0, state, misaligned(uav), force, &raw mut whole);
        refuse(Status::Misaligned, 0, state, uav, misaligned(force), &raw mut whole);
        assert_eq!((whole, short), was);

        let (mut first, mut second) = (answer!(SlungOutput), answer!(SlungOutput));
        // Where the request is unknown, the last one is flown, which no refused call has changed.
        let request = if period % 2 == 0 { HOLD } else { 5 };
        let expected = if period % 2 == 0 { 0 } else { Status::UnknownEnumerator as i32 };
        assert_eq!(step(&mut one, HOLD, &raw mut first), 0);
        assert_eq!(step(&mut other, request, &raw mut second), expected);
        assert_eq!(first, second);
        assert_eq!(second.mode, HOLDING);
    }
    // It is the request that the refused asked for, and it does something.
    let mut output = answer!(SlungOutput);
    assert_eq!(step(&mut other, FOLLOW, &raw mut output), 0);
    assert_eq!(output.mode, JOINING);
}

#[test]
fn a_filter_that_refuses_has_not_been_stepped() {
    let mut parameters = parameters();
    let (mut loads, mut navigations) = ([Room::new(), Room::new()], [Room::new(), Room::new()]);
    let start = uav();
    for room in &mut loads {
        let parameters = parameters.pointer();
        let created = unsafe {
            capi::slung_estimator_create(room.pointer(), capi::ESTIMATOR_BYTES, parameters, null(), null_mut())
        };
        assert_eq!(created, 0);
    }
    for room in &mut navigations {
        let (parameters, start) = (parameters.pointer(), &raw const start);
        let created = unsafe {
            let bytes = capi::NAVIGATION_BYTES;
            capi::slung_navigation_create(room.pointer(), bytes, parameters, null(), 0, start, null_mut())
        };
        assert_eq!(created, 0);
    }
    let ([one_load, other_load], [one, other]) = (&mut loads, &mut navigations);
    for period in 0..200 {
        // Turning and pushed, so that every step moves the filters.
        let (rate, force) = ([0.1, 0.05, 0.2], [0.3, 0.2, -G + 0.01 * period as f32]);
        let (rate, force, uav) = (&raw const rate, &raw const force, &raw const start);
        let navigate = |room: &mut Room, frames, navigated: *mut SlungNavigated| unsafe {
            capi::slung_navigation_step(room.pointer(), frames, rate, force, navigated)
        };
        let estimate = |room: &mut Room, frames, estimate: *mut SlungEstimate| unsafe {
            capi::slung_estimator_step(room.pointer(), frames, uav, force, 3.0 * G, estimate)
        };
        let mut short = answer!(SlungNavigated, size_of::<SlungNavigated>() - 1);
        let mut shorter = answer!(SlungEstimate, SlungEstimate::FIRST - 1);
        for (frames, status) in [(0, Status::StructSize), (3, Status::UnknownEnumerator)] {
            assert_eq!(navigate(other, frames, &raw mut short), status as i32);
            assert_eq!(estimate(other_load, frames, &raw mut shorter), status as i32);
        }
        assert_eq!(navigate(other, 0, null_mut()), Status::NullPointer as i32);
        assert_eq!(estimate(other_load, 0, null_mut()), Status::NullPointer as i32);
        assert_eq!(short, answer!(SlungNavigated, size_of::<SlungNavigated>() - 1));
        assert_eq!(shorter, answer!(SlungEstimate, SlungEstimate::FIRST - 1));

        let (mut first, mut second) = (answer!(SlungNavigated), answer!(SlungNavigated));
        assert_eq!((navigate(one, 0, &raw mut first), navigate(other, 0, &raw mut second)), (0, 0));
        assert_eq!(first, second);
        let (mut first, mut second) = (answer!(SlungEstimate), answer!(SlungEstimate));
        assert_eq!((estimate(one_load, 0, &raw mut first), estimate(other_load, 0, &raw mut second)), (0, 0));
        assert_eq!(first, second);
    }
}
