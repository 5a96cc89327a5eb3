//! The modes as MAVLink's standard messages announce them.

use controller::{Mode, Request};
use link::MavMessage;
use link::dialect::*;

use crate::report;

/// Each mode's name, and whether it can be asked for.
pub const MODES: [(Mode, &str, bool); 8] = [
    (Mode::Off, "Off", false),
    (Mode::Idle, "Idle", true),
    (Mode::Join, "Join", false),
    (Mode::Follow, "Follow", true),
    (Mode::Hold, "Hold", true),
    (Mode::Land, "Land", true),
    (Mode::Fault, "Fault", false),
    (Mode::TakeOff, "Take-off", true),
];

/// The mode at an index from 0.
pub fn available(index: usize) -> Option<MavMessage> {
    let (mode, name, can_be_asked_for) = *MODES.get(index)?;
    let mut properties = MavModeProperty::MAV_MODE_PROPERTY_AUTO_MODE;
    properties.set(MavModeProperty::MAV_MODE_PROPERTY_NOT_USER_SELECTABLE, !can_be_asked_for);
    Some(MavMessage::AVAILABLE_MODES(AVAILABLE_MODES_DATA {
        custom_mode: report::mode(mode) as u32,
        properties: properties.bits().into(),
        number_modes: MODES.len() as u8,
        mode_index: index as u8 + 1,
        standard_mode: standard(mode) as u8,
        mode_name: link::text(name),
    }))
}

/// The mode that is a standard one.
pub fn standardized(number: f32) -> Option<Mode> {
    [Mode::Land, Mode::TakeOff].into_iter().find(|&mode| standard(mode) as u32 as f32 == number)
}

/// The mode that is a mode of PX4's, by that program's main mode and sub-mode: MAVSDK asks any
/// vehicle that is not ArduPilot's for these.
pub fn of_px4(main: f32, sub: f32) -> Option<Mode> {
    const AUTO: f32 = 4.0;
    let of = [(2.0, Mode::TakeOff), (3.0, Mode::Hold), (4.0, Mode::Follow), (6.0, Mode::Land)];
    of.into_iter().find(|&(known, _)| main == AUTO && known == sub).map(|(_, mode)| mode)
}

/// The mode that it is in, and the one that was asked for.
pub fn current(mode: Mode, request: Request) -> MavMessage {
    let intended = match request {
        Request::Idle => Mode::Idle,
        Request::Follow => Mode::Follow,
        Request::Hold => Mode::Hold,
        Request::Land => Mode::Land,
        _ => Mode::Off,
    };
    MavMessage::CURRENT_MODE(CURRENT_MODE_DATA {
        custom_mode: report::mode(mode) as u32,
        intended_custom_mode: report::mode(intended) as u32,
        standard_mode: standard(mode) as u8,
    })
}

fn standard(mode: Mode) -> MavStandardMode {
    match mode {
        Mode::Land => MavStandardMode::MAV_STANDARD_MODE_LAND,
        Mode::TakeOff => MavStandardMode::MAV_STANDARD_MODE_TAKEOFF,
        _ => MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD,
    }
}
