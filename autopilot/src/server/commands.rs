//! COMMAND_LONG: arming, modes, reboot, and messages that are asked for.

use core::fmt::{Display, Write as _};

use controller::{Mode, Request};
use link::MavMessage;
use link::dialect::*;

use super::mission;
use super::modes::{self, MODES};
use super::{Next, Server, warning};
use crate::control::Autopilot;
use crate::metadata::File;
use crate::report;

/// The second parameter that has a vehicle disarmed in flight, as all of MAVLink has it.
const FORCE: f32 = 21196.0;

impl Server {
    pub(super) fn command(
        &mut self,
        request: &COMMAND_LONG_DATA,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) -> Next {
        const ARM: u16 = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16;
        const MODE: u16 = MavCmd::MAV_CMD_DO_SET_MODE as u16;
        const STANDARD: u16 = MavCmd::MAV_CMD_DO_SET_STANDARD_MODE as u16;
        const TAKE_OFF: u16 = MavCmd::MAV_CMD_NAV_TAKEOFF as u16;
        const LAND: u16 = MavCmd::MAV_CMD_NAV_LAND as u16;
        const REBOOT: u16 = MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16;
        const MESSAGE: u16 = MavCmd::MAV_CMD_REQUEST_MESSAGE as u16;
        const START: u16 = MavCmd::MAV_CMD_MISSION_START as u16;
        const PAUSE: u16 = MavCmd::MAV_CMD_DO_PAUSE_CONTINUE as u16;
        const SPEED: u16 = MavCmd::MAV_CMD_DO_CHANGE_SPEED as u16;
        const CURRENT: u16 = MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT as u16;
        const HOME: u16 = MavCmd::MAV_CMD_GET_HOME_POSITION as u16;
        let mut next = Next::Nothing;
        let mut refused = |reason: &dyn Display, result| {
            send(warning(reason));
            result
        };
        const DENIED: MavResult = MavResult::MAV_RESULT_DENIED;
        const NOT_NOW: MavResult = MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
        let result = match request.command {
            ARM if request.param1 == 1.0 => match autopilot.arm() {
                Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
                Err(why) => refused(&why, if why.is_for_now() { NOT_NOW } else { DENIED }),
            },
            ARM if request.param1 == 0.0 => {
                if autopilot.is_flying() && request.param2 != FORCE {
                    refused(&"in flight: to disarm, param2 has to be 21196", DENIED)
                } else {
                    autopilot.disarm();
                    MavResult::MAV_RESULT_ACCEPTED
                }
            }
            ARM => refused(&"param1 is 1 to arm, 0 to disarm", DENIED),
            MODE | STANDARD | TAKE_OFF | LAND => match asked(request) {
                None => refused(&"modes: idle, follow, hold, land, take-off", DENIED),
                Some(mode) => match ask(autopilot, mode, request.command == MODE) {
                    Err(reason) => refused(&reason, NOT_NOW),
                    Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
                },
            },
            REBOOT if autopilot.is_armed() => refused(&"not while armed", DENIED),
            REBOOT if request.param1 != 1.0 => refused(&"only to reboot", DENIED),
            REBOOT => {
                next = Next::Reboot;
                MavResult::MAV_RESULT_ACCEPTED
            }
            MESSAGE => self.message(request, autopilot, send),
            HOME => {
                let messages = mission::home_messages(autopilot);
                let is_known = messages.iter().any(Option::is_some);
                messages.into_iter().flatten().for_each(&mut *send);
                if is_known { MavResult::MAV_RESULT_ACCEPTED } else { NOT_NOW }
            }
            START | PAUSE | SPEED | CURRENT => {
                let done = match request.command {
                    START => autopilot.start_mission(),
                    PAUSE if [0.0, 1.0].contains(&request.param1) => autopilot.pause(request.param1 == 0.0),
                    PAUSE => Err("param1 is 0 to pause, 1 to go on"),
                    SPEED => autopilot.change_speed(request.param2),
                    _ => autopilot.set_current_item_by(request.param1),
                };
                match done {
                    Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
                    Err(reason) => refused(&reason, NOT_NOW),
                }
            }
            _ => MavResult::MAV_RESULT_UNSUPPORTED,
        };
        send(MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command: request.command, result: result as u8 }));
        next
    }

    /// Sends what MAV_CMD_REQUEST_MESSAGE asks for; a list comes with the news.
    fn message(
        &mut self,
        request: &COMMAND_LONG_DATA,
        autopilot: &Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) -> MavResult {
        const MODE: f32 = 436.0;
        const AVAILABLE: f32 = 435.0;
        const VERSION: f32 = 148.0;
        const LANDED: f32 = 245.0;
        const METADATA: f32 = 397.0;
        const MISSION: f32 = 42.0;
        const ORIGIN: f32 = 49.0;
        const HOME: f32 = 242.0;
        if request.param1 == MODE {
            send(Self::current_mode(autopilot));
        } else if request.param1 == VERSION {
            send(version());
        } else if request.param1 == LANDED {
            send(Self::landed_state(autopilot));
        } else if request.param1 == METADATA {
            send(metadata());
        } else if request.param1 == MISSION {
            send(self.mission_current(autopilot));
        } else if request.param1 == ORIGIN || request.param1 == HOME {
            let [origin, home] = mission::home_messages(autopilot);
            let asked = if request.param1 == ORIGIN { origin } else { home };
            let Some(asked) = asked else { return MavResult::MAV_RESULT_TEMPORARILY_REJECTED };
            send(asked);
        } else if request.param1 == AVAILABLE && request.param2 == 0.0 {
            self.modes = Some(0);
        } else if request.param1 == AVAILABLE {
            let index = (request.param2 as usize).wrapping_sub(1);
            let Some(mode) = modes::available(index) else { return MavResult::MAV_RESULT_DENIED };
            send(mode);
        } else {
            return MavResult::MAV_RESULT_UNSUPPORTED;
        }
        MavResult::MAV_RESULT_ACCEPTED
    }
}

/// COMMAND_INT: home, which a float would cut to metres. All else is to be sent as a COMMAND_LONG.
pub(super) fn command_int(request: &COMMAND_INT_DATA, autopilot: &mut Autopilot, send: &mut impl FnMut(MavMessage)) {
    let command = request.command;
    let result = if command != MavCmd::MAV_CMD_DO_SET_HOME as u16 {
        MavResult::MAV_RESULT_COMMAND_LONG_ONLY
    } else if mission::have_home(mission::home_of(request, autopilot), autopilot, send) {
        MavResult::MAV_RESULT_ACCEPTED
    } else {
        MavResult::MAV_RESULT_DENIED
    };
    send(MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, result: result as u8 }));
}

/// The mode that a command asks for, if it can be.
fn asked(request: &COMMAND_LONG_DATA) -> Option<Mode> {
    const STANDARD: u16 = MavCmd::MAV_CMD_DO_SET_STANDARD_MODE as u16;
    const TAKE_OFF: u16 = MavCmd::MAV_CMD_NAV_TAKEOFF as u16;
    const LAND: u16 = MavCmd::MAV_CMD_NAV_LAND as u16;
    match request.command {
        TAKE_OFF => Some(Mode::TakeOff),
        LAND => Some(Mode::Land),
        STANDARD => modes::standardized(request.param1),
        _ if request.param3 > 0.0 => modes::of_px4(request.param2, request.param3),
        _ => {
            let is_custom = request.param1 as u8 & MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u8 != 0;
            let is_it = |mode| report::mode(mode) as u32 as f32 == request.param2;
            MODES.into_iter().find(|&(mode, _, can)| is_custom && can && is_it(mode)).map(|(mode, ..)| mode)
        }
    }
}

/// Asks for it; only a mode that is `set` may be asked for before arming.
fn ask(autopilot: &mut Autopilot, mode: Mode, is_set: bool) -> Result<(), &'static str> {
    let request = match mode {
        Mode::TakeOff => return autopilot.take_off(),
        Mode::Land if !is_set => return autopilot.land(),
        Mode::Follow => return autopilot.follow(),
        Mode::Hold => Request::Hold,
        Mode::Land => Request::Land,
        _ => Request::Idle,
    };
    autopilot.request(request);
    Ok(())
}

/// Where what the parameters are can be read.
fn metadata() -> MavMessage {
    let mut uri = report::Text::new();
    // It fits.
    let _ = write!(uri, "mftp://{}", File::General.name());
    MavMessage::COMPONENT_METADATA(COMPONENT_METADATA_DATA {
        time_boot_ms: 0,
        file_crc: File::General.checksum(),
        uri: link::text(&uri),
    })
}

/// What the program is and can do.
fn version() -> MavMessage {
    /// Fences, MAVLink 2, file transfer, integers in PARAM_SET as their bytes, and missions.
    /// Signing would be a bit here.
    const CAPABILITIES: u64 = 16384 | 8192 | 32 | 16 | 4;
    let number = |text: &str| text.parse::<u32>().unwrap_or_default();
    let [major, minor, patch] =
        [env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR"), env!("CARGO_PKG_VERSION_PATCH")]
            .map(number);
    let [a, b, c, d] = link::FINGERPRINT.to_le_bytes();
    MavMessage::AUTOPILOT_VERSION(AUTOPILOT_VERSION_DATA {
        capabilities: CAPABILITIES,
        flight_sw_version: major << 24 | minor << 16 | patch << 8,
        flight_custom_version: [a, b, c, d, 0, 0, 0, 0],
        ..AUTOPILOT_VERSION_DATA::DEFAULT
    })
}
