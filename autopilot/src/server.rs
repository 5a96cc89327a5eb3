//! The link side: what each message does, and what is answered.

use core::fmt::Write;

use link::dialect::*;
use link::{MavMessage, Rejected};

use controller::{Fault, Mode, Request};

use crate::control::{Autopilot, Drive};
use crate::report;
use crate::settings::Settings;

/// What the caller has to do after a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Nothing.
    Nothing,
    /// Lockstep: make the control step of this frame.
    Step(LOAD_STATE_DATA),
    /// Reset the controller.
    Reboot,
}

/// Counts and answers the link's messages.
#[derive(Clone, Debug)]
pub struct Server {
    bad_frames: u32,
    reported: (Mode, Option<Fault>),
    /// The next parameter of a list that was asked for.
    listing: Option<usize>,
}

impl Default for Server {
    fn default() -> Self {
        Self::new()
    }
}

impl Server {
    /// Nothing received, nothing reported.
    #[must_use]
    pub const fn new() -> Self {
        Self { bad_frames: 0, reported: (Mode::Off, None), listing: None }
    }

    /// What the controller says when it has started: it speaks first, since bytes sent to it before
    /// are lost.
    pub fn greet(&self, autopilot: &Autopilot, send: &mut impl FnMut(MavMessage)) {
        send(Self::heartbeat(autopilot));
        let boot = autopilot.boot();
        if boot.by_watchdog {
            send(status(MavSeverity::MAV_SEVERITY_CRITICAL, "reset by the watchdog"));
        }
        if boot.internal_clock {
            send(status(MavSeverity::MAV_SEVERITY_WARNING, "no crystal: on the internal oscillator"));
        }
    }

    /// The sign of life.
    #[must_use]
    pub fn heartbeat(autopilot: &Autopilot) -> MavMessage {
        let mode = autopilot.mode();
        let mut base_mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u8;
        if autopilot.is_armed() {
            base_mode |= MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED as u8;
        }
        if autopilot.drive() == Drive::Lockstep {
            base_mode |= MavModeFlag::MAV_MODE_FLAG_HIL_ENABLED as u8;
        }
        let system_status = match (mode, autopilot.fault()) {
            (Mode::Off, _) => MavState::MAV_STATE_STANDBY,
            (Mode::Fault, _) | (Mode::Hold, Some(_)) => MavState::MAV_STATE_CRITICAL,
            _ => MavState::MAV_STATE_ACTIVE,
        };
        MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: report::mode(mode) as u32,
            mavtype: MavType::MAV_TYPE_QUADROTOR as u8,
            autopilot: MavAutopilot::MAV_AUTOPILOT_GENERIC as u8,
            base_mode,
            system_status: system_status as u8,
            mavlink_version: MINOR_MAVLINK_VERSION,
        })
    }

    /// All counters; `lost_bytes` is the board's.
    #[must_use]
    pub fn counters(&self, autopilot: &Autopilot, lost_bytes: u32) -> MavMessage {
        MavMessage::LOAD_COUNTERS(LOAD_COUNTERS_DATA {
            bad_frames: self.bad_frames,
            lost_bytes,
            ..autopilot.counters_message()
        })
    }

    /// A message that nobody asked for: a new mode or fault, or the next parameter of a list. One
    /// message a call, since a whole list would keep the control step waiting.
    pub fn news(&mut self, autopilot: &Autopilot) -> Option<MavMessage> {
        if let Some(change) = self.change(autopilot) {
            return Some(change);
        }
        let index = self.listing?;
        let answer = value(autopilot, index);
        self.listing = answer.is_some().then_some(index + 1);
        answer
    }

    fn change(&mut self, autopilot: &Autopilot) -> Option<MavMessage> {
        let now @ (mode, fault) = (autopilot.mode(), autopilot.fault());
        if now == self.reported {
            return None;
        }
        self.reported = now;
        let severity = match now {
            (_, None) => MavSeverity::MAV_SEVERITY_INFO,
            (Mode::Fault, _) | (_, Some(Fault::PayloadLost)) => MavSeverity::MAV_SEVERITY_CRITICAL,
            _ => MavSeverity::MAV_SEVERITY_WARNING,
        };
        Some(status(severity, &report::text(mode, fault)))
    }

    /// Acts on what the decoder found.
    pub fn handle(
        &mut self,
        received: Result<MavMessage, Rejected>,
        time_ns: u64,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) -> Next {
        let Ok(message) = received else {
            self.bad_frames = self.bad_frames.wrapping_add(1);
            return Next::Nothing;
        };
        match message {
            MavMessage::LOAD_STATE(frame) => {
                if autopilot.drive() == Drive::Lockstep {
                    return Next::Step(frame);
                }
                autopilot.receive(&frame);
            }
            MavMessage::PARAM_REQUEST_READ(request) => {
                let index = usize::try_from(request.param_index)
                    .ok()
                    .or_else(|| Settings::index(link::text_of(&*request.param_id)));
                match index.and_then(|index| value(autopilot, index)) {
                    Some(answer) => send(answer),
                    None => send(status(MavSeverity::MAV_SEVERITY_WARNING, "no such parameter")),
                }
            }
            MavMessage::PARAM_REQUEST_LIST(_) => self.listing = Some(0),
            MavMessage::PARAM_SET(request) => set(&request, autopilot, send),
            MavMessage::COMMAND_LONG(request) => return command(&request, autopilot, send),
            MavMessage::TIMESYNC(request) if request.tc1 == 0 => {
                send(MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: time_ns.cast_signed(), ts1: request.ts1 }));
            }
            _ => {}
        }
        Next::Nothing
    }
}

/// A parameter's current value.
fn value(autopilot: &Autopilot, index: usize) -> Option<MavMessage> {
    let (entry, value) = autopilot.settings().at(index)?;
    Some(MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: value,
        param_count: Settings::COUNT as u16,
        param_index: index as u16,
        param_id: link::name(entry.name.as_str()),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32 as u8,
    }))
}

fn set(request: &PARAM_SET_DATA, autopilot: &mut Autopilot, send: &mut impl FnMut(MavMessage)) {
    let name = link::text_of(&*request.param_id);
    let warn = |reason: &str| {
        let mut text = report::Text::new();
        // What doesn't fit is cut: the reason comes first.
        let _ = write!(text, "{reason}: {name}");
        status(MavSeverity::MAV_SEVERITY_WARNING, &text)
    };
    match autopilot.settings_mut() {
        None => send(warn("not while armed")),
        Some(settings) => match settings.set_by_name(name, request.param_value) {
            Ok(_) => {}
            Err(refused) => send(status(MavSeverity::MAV_SEVERITY_WARNING, &cut(refused))),
        },
    }
    Settings::index(name).and_then(|index| value(autopilot, index)).into_iter().for_each(send);
}

fn command(request: &COMMAND_LONG_DATA, autopilot: &mut Autopilot, send: &mut impl FnMut(MavMessage)) -> Next {
    let mut next = Next::Nothing;
    let mut denied = |reason: &str| {
        send(status(MavSeverity::MAV_SEVERITY_WARNING, reason));
        MavResult::MAV_RESULT_DENIED
    };
    let result = if request.command == MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16 {
        if request.param1 < 0.5 {
            autopilot.disarm();
            MavResult::MAV_RESULT_ACCEPTED
        } else {
            match autopilot.arm() {
                Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
                Err(refused) => denied(&cut(refused)),
            }
        }
    } else if request.command == MavCmd::MAV_CMD_DO_SET_MODE as u16 {
        match wanted(request) {
            None => denied("modes to ask for: idle, follow, hold, land"),
            Some(wanted) if autopilot.request(wanted) => MavResult::MAV_RESULT_ACCEPTED,
            Some(_) => denied("the tracking law only follows"),
        }
    } else if request.command == MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16 {
        if autopilot.is_armed() {
            denied("not while armed")
        } else if request.param1 != 1.0 {
            denied("only to reboot")
        } else {
            next = Next::Reboot;
            MavResult::MAV_RESULT_ACCEPTED
        }
    } else {
        MavResult::MAV_RESULT_UNSUPPORTED
    };
    send(MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command: request.command, result: result as u8 }));
    next
}

/// What `MAV_CMD_DO_SET_MODE` asks for.
fn wanted(request: &COMMAND_LONG_DATA) -> Option<Request> {
    let is_custom = request.param1 as u8 & MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u8 != 0;
    if is_custom { report::request(request.param2) } else { None }
}

fn status(severity: MavSeverity, text: &str) -> MavMessage {
    MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity: severity as u8, text: link::text(text) })
}

/// As much of it as fits.
fn cut(what: impl core::fmt::Display) -> report::Text {
    let mut text = report::Text::new();
    let _ = write!(Cut(&mut text), "{what}");
    text
}

/// Writes as much as fits.
struct Cut<'a>(&'a mut report::Text);

impl Write for Cut<'_> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        for character in text.chars() {
            self.0.push(character).map_err(|_| core::fmt::Error)?;
        }
        Ok(())
    }
}
