//! The pilot's stick and radio: a mode switch and a kill switch, on channels or buttons.

use controller::Request;
use link::dialect::{MANUAL_CONTROL_DATA, RC_CHANNELS_OVERRIDE_DATA};

use crate::settings::{Setting, Settings};

/// Above it a switch is on, and a mode switch at its upper end; below [`LOW`] at its lower end. µs.
const HIGH: u16 = 1700;
const LOW: u16 = 1300;
/// Pulses of a receiver, µs. All else says that the channel has no value, or is given back.
const PULSES: core::ops::RangeInclusive<u16> = 800..=2200;

/// What the switches of a stick or radio say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switches {
    /// The mode that is asked for.
    pub mode: Option<Request>,
    /// Rotors off.
    pub kill: bool,
}

impl Switches {
    /// Nothing.
    pub const fn new() -> Self {
        Self { mode: None, kill: false }
    }
}

/// The switches on a radio's channels; one without a value is as it was `before`.
pub fn radio(message: &RC_CHANNELS_OVERRIDE_DATA, settings: &Settings, before: Switches) -> Switches {
    let m = message;
    let channels = [
        m.chan1_raw,
        m.chan2_raw,
        m.chan3_raw,
        m.chan4_raw,
        m.chan5_raw,
        m.chan6_raw,
        m.chan7_raw,
        m.chan8_raw,
        m.chan9_raw,
        m.chan10_raw,
        m.chan11_raw,
        m.chan12_raw,
        m.chan13_raw,
        m.chan14_raw,
        m.chan15_raw,
        m.chan16_raw,
        m.chan17_raw,
        m.chan18_raw,
    ];
    let value = |setting| {
        let channel = (settings.get(setting) as usize).checked_sub(1)?;
        channels.get(channel).copied().filter(|value| PULSES.contains(value))
    };
    Switches {
        mode: value(Setting::MODE_CHANNEL).map_or(before.mode, |value| {
            Some(match value {
                ..LOW => Request::Land,
                LOW..=HIGH => Request::Hold,
                _ => Request::Follow,
            })
        }),
        kill: value(Setting::KILL_CHANNEL).map_or(before.kill, |value| value > HIGH),
    }
}

/// The switches on a joystick's buttons.
pub fn joystick(message: &MANUAL_CONTROL_DATA, settings: &Settings) -> Switches {
    let buttons = u32::from(message.buttons) | u32::from(message.buttons2) << 16;
    let is_pressed = |setting| {
        let button = settings.get(setting) as u32;
        button > 0 && buttons >> (button - 1) & 1 == 1
    };
    // The calmer wins where several are pressed.
    let modes = [
        (Setting::LAND_BUTTON, Request::Land),
        (Setting::HOLD_BUTTON, Request::Hold),
        (Setting::FOLLOW_BUTTON, Request::Follow),
    ];
    Switches {
        mode: modes.into_iter().find(|(setting, _)| is_pressed(*setting)).map(|(_, request)| request),
        kill: is_pressed(Setting::KILL_BUTTON),
    }
}
