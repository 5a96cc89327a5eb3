//! Numbers of the header's enumerations, and their texts.

use core::ffi::{CStr, c_char};

use controller::{Channel, Fault, Margin, Mode};

/// `slung_mode`.
pub fn mode_code(mode: Mode) -> u32 {
    match mode {
        Mode::Off => 0,
        Mode::Idle => 1,
        Mode::Join => 2,
        Mode::Follow => 3,
        Mode::Hold => 4,
        Mode::Land => 5,
        Mode::Fault => 6,
        Mode::TakeOff => 7,
        // What a newer controller adds and this interface does not know.
        _ => u32::MAX,
    }
}

/// `slung_warning`: which margin.
pub fn margin_code(margin: Margin) -> u32 {
    match margin {
        Margin::RodAngle => 1,
        Margin::ThrustAngle => 2,
        Margin::Tension => 3,
        Margin::Thrust => 4,
        Margin::Path => 5,
        Margin::Reach => 6,
        Margin::Yaw => 7,
        _ => 0xff,
    }
}

/// `slung_fault`.
pub fn fault_code(fault: Fault) -> u32 {
    match fault {
        Fault::NoState => 1,
        Fault::NotFinite => 2,
        Fault::NoPath => 3,
        Fault::PayloadLost => 4,
        Fault::Slack => 5,
        Fault::Contradiction => 6,
        Fault::Caught => 7,
        Fault::State(channel) => {
            0x100
                + match channel {
                    Channel::Position => 0,
                    Channel::Velocity => 1,
                    Channel::Rod => 2,
                    Channel::RodRate => 3,
                    Channel::Attitude => 4,
                    Channel::BodyRate => 5,
                    Channel::UavPosition => 6,
                    Channel::UavVelocity => 7,
                    _ => 0xff,
                }
        }
        Fault::Margin(margin) => 0x200 + margin_code(margin),
        _ => u32::MAX,
    }
}

/// What a status means.
#[unsafe(no_mangle)]
pub extern "C" fn slung_status_text(status: i32) -> *const c_char {
    let text: &'static CStr = match status {
        0 => c"done",
        -1 => c"a pointer that must not be null is null",
        -2 => c"a pointer is not aligned for what it points to",
        -3 => c"struct_size is smaller than this structure's first version",
        -4 => c"the memory is too small for an instance",
        -5 => c"the memory holds no instance: make it first",
        -6 => c"no such parameter",
        -7 => c"a number is outside its range, or not a number",
        -8 => c"a whole number is needed",
        -9 => c"the gains make no stable loop",
        -10 => c"the state is not finite, or outside the range that the law is trusted with",
        -11 => c"an enumerator has none of its values",
        -12 => c"the waypoints make no route: a leg is too short, or a turn too sharp",
        -13 => c"the measurement is older than the filter remembers, or from the future",
        -14 => c"the measurement is more than ten deviations off",
        -15 => c"not now: no route is flown, or its payload does not rest at a stop that something comes after",
        _ => c"unknown status",
    };
    text.as_ptr()
}

/// What a mode is.
#[unsafe(no_mangle)]
pub extern "C" fn slung_mode_text(mode: u32) -> *const c_char {
    let text: &'static CStr = match mode {
        0 => c"off",
        1 => c"idle",
        2 => c"joining the path",
        3 => c"following the path",
        4 => c"holding",
        5 => c"landing",
        6 => c"fault",
        7 => c"taking off",
        _ => c"unknown mode",
    };
    text.as_ptr()
}

/// Why the vehicle does not do what was asked.
#[unsafe(no_mangle)]
pub extern "C" fn slung_fault_text(fault: u32) -> *const c_char {
    let text: &'static CStr = match fault {
        0 => c"no fault",
        1 => c"no state",
        2 => c"the law's answer is not finite",
        3 => c"no point of the path was found from here",
        4 => c"the payload is gone",
        5 => c"the cable is slack",
        6 => c"load and UAV are measured where no cable of this length could have them",
        7 => c"the UAV hung from its cable while it landed: the load is caught",
        0x100 => c"the payload's position is not finite or out of range",
        0x101 => c"the payload's velocity is not finite or out of range",
        0x102 => c"the rod's direction is not a unit vector",
        0x103 => c"the rod's rate is not finite or out of range",
        0x104 => c"the attitude is not a rotation",
        0x105 => c"the body rate is not finite or out of range",
        0x106 => c"the UAV's position is not finite or out of range",
        0x107 => c"the UAV's velocity is not finite or out of range",
        0x201..=0x207 => return slung_warning_text(fault - 0x200),
        _ => c"unknown fault",
    };
    text.as_ptr()
}

/// Which margin is short.
#[unsafe(no_mangle)]
pub extern "C" fn slung_warning_text(warning: u32) -> *const c_char {
    let text: &'static CStr = match warning {
        0 => c"no warning",
        1 => c"the rod's angle from the vertical",
        2 => c"the angle between thrust axis and rod",
        3 => c"the rod's tension",
        4 => c"the thrust",
        5 => c"the regularity of the path's functions",
        6 => c"the reach of the path",
        7 => c"the roll at which yaw is defined",
        _ => c"unknown warning",
    };
    text.as_ptr()
}
