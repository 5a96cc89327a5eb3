//! Modes and faults as the link has them: numbers for programs, words for the pilot.

use core::fmt::Write;

use controller::state::Channel;
use controller::{Fault, Margin, Mode, Request};
use link::dialect::{LoadFault, LoadMode};

/// As long as a STATUSTEXT can be.
pub type Text = heapless::String<50>;

pub fn mode(mode: Mode) -> LoadMode {
    match mode {
        Mode::Off => LoadMode::LOAD_MODE_OFF,
        Mode::Idle => LoadMode::LOAD_MODE_IDLE,
        Mode::Engage => LoadMode::LOAD_MODE_ENGAGE,
        Mode::Follow => LoadMode::LOAD_MODE_FOLLOW,
        Mode::Hold => LoadMode::LOAD_MODE_HOLD,
        Mode::Land => LoadMode::LOAD_MODE_LAND,
        Mode::Fault => LoadMode::LOAD_MODE_FAULT,
    }
}

/// The request for a mode that can be asked for.
pub fn request(mode: f32) -> Option<Request> {
    let wanted = [
        (LoadMode::LOAD_MODE_IDLE, Request::Idle),
        (LoadMode::LOAD_MODE_FOLLOW, Request::Follow),
        (LoadMode::LOAD_MODE_HOLD, Request::Hold),
        (LoadMode::LOAD_MODE_LAND, Request::Land),
    ];
    wanted.into_iter().find(|(number, _)| *number as u32 as f32 == mode).map(|(_, request)| request)
}

pub fn margin(margin: Margin) -> LoadFault {
    match margin {
        Margin::RodAngle => LoadFault::LOAD_FAULT_ROD_ANGLE,
        Margin::ThrustAngle => LoadFault::LOAD_FAULT_THRUST_ANGLE,
        Margin::Tension => LoadFault::LOAD_FAULT_TENSION,
        Margin::Thrust => LoadFault::LOAD_FAULT_THRUST,
        Margin::Path => LoadFault::LOAD_FAULT_PATH,
        Margin::Reach => LoadFault::LOAD_FAULT_REACH,
        Margin::Yaw => LoadFault::LOAD_FAULT_YAW,
    }
}

/// The bit of a fault that stands. A state's has its bit where the state is found missing or bad, step by step.
pub fn fault(fault: Fault) -> LoadFault {
    match fault {
        Fault::State(_) => LoadFault::empty(),
        Fault::Margin(which) => margin(which),
        Fault::NotFinite => LoadFault::LOAD_FAULT_LAW,
        Fault::NoPath => LoadFault::LOAD_FAULT_NO_PATH,
        Fault::PayloadLost => LoadFault::LOAD_FAULT_PAYLOAD_LOST,
    }
}

/// What to tell the pilot. A state that is `missing` has nothing wrong with it.
pub fn text(mode: Mode, fault: Option<Fault>, missing: bool) -> Text {
    let mode = match mode {
        Mode::Off => "off",
        Mode::Idle => "idle",
        Mode::Engage => "joining the path",
        Mode::Follow => "on the path",
        Mode::Hold => "hold",
        Mode::Land => "landing",
        Mode::Fault => "fault",
    };
    let fault = match fault {
        None => "",
        Some(Fault::State(_)) if missing => "no state",
        Some(Fault::State(channel)) => match channel {
            Channel::Position => "bad position",
            Channel::Velocity => "bad velocity",
            Channel::Rod => "bad rod",
            Channel::RodRate => "bad rod rate",
            Channel::Attitude => "bad attitude",
            Channel::BodyRate => "bad body rate",
        },
        Some(Fault::Margin(margin)) => match margin {
            Margin::RodAngle => "rod too far from vertical",
            Margin::ThrustAngle => "thrust too far from rod",
            Margin::Tension => "rod nearly slack",
            Margin::Thrust => "thrust too small",
            Margin::Path => "path nearly singular",
            Margin::Reach => "out of the path's reach",
            Margin::Yaw => "roll too large for a yaw",
        },
        Some(Fault::NotFinite) => "law's answer not finite",
        Some(Fault::NoPath) => "no point of the path found",
        Some(Fault::PayloadLost) => "payload lost",
    };
    let mut text = Text::new();
    let separator = if fault.is_empty() { "" } else { ": " };
    // The longest pair fits.
    let _ = write!(text, "{mode}{separator}{fault}");
    text
}
