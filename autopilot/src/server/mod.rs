//! The link side: what each message does, and what is answered.

mod commands;
mod files;
mod mission;
mod modes;
mod parameters;
mod place;
mod receiver;
mod stick;

use controller::{Fault, Margin, Mode};
use link::dialect::*;
use link::{Address, MavMessage, Message as _, Rejected};

use crate::control::{Autopilot, Drive, Notice};
use crate::mission::Refusal;
use crate::report;
use crate::store::NotKept;
use commands::command_int;
use files::Files;
use mission::Transfer;
use place::Place;
use receiver::Receiver;
use stick::Switches;

/// What a ground station says that it is.
const STATION: u8 = MavType::MAV_TYPE_GCS as u8;

/// Ground stations and their tools number themselves from here on, vehicles below.
const STATIONS: u8 = 190;

/// What the caller has to do after a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Nothing.
    Nothing,
    /// Lockstep: make the control step of this frame.
    Step(LOAD_STATE_DATA),
    /// Keep the parameter at this index of [`Settings`](crate::Settings) for after a reset.
    Store(usize),
    /// Keep mission and fence for after a reset.
    StoreMission,
    /// Reset the controller.
    Reboot,
}

/// Counts and answers the link's messages.
#[derive(Clone, Debug)]
pub struct Server {
    bad_frames: u32,
    reported: (Mode, Option<Fault>, Option<Margin>),
    /// The number of the autopilot's last notice that was said.
    noticed: u32,
    /// The next parameter of a list that was asked for.
    listing: Option<usize>,
    /// The next mode likewise.
    modes: Option<usize>,
    /// What the pilot's switches said last, on the stick and on the radio.
    stick: Switches,
    radio: Switches,
    /// The last other vehicle's system whose sensors were not taken for this one's.
    stranger: Option<u8>,
    files: Files,
    transfer: Transfer,
    place: Place,
    receiver: Receiver,
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
        Self {
            bad_frames: 0,
            reported: (Mode::Off, None, None),
            noticed: 0,
            listing: None,
            modes: None,
            stick: Switches::new(),
            radio: Switches::new(),
            stranger: None,
            files: Files::new(),
            transfer: Transfer::new(),
            place: Place::new(),
            receiver: Receiver::new(),
        }
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
            send(warning("no crystal: on the internal oscillator"));
        }
        match boot.forgotten {
            None => {}
            Some(NotKept::NoMemory) => send(warning("this board keeps no parameters: all are defaults")),
            Some(NotKept::Full | NotKept::Flash) => send(status(
                MavSeverity::MAV_SEVERITY_CRITICAL,
                "flash failed: no mission, fence; default parameters",
            )),
        }
        // MAVLink 2's signing is not supported.
        send(status(MavSeverity::MAV_SEVERITY_INFO, "link not signed: whoever is on it may command"));
    }

    /// What to say of a parameter or mission that is not kept for after a reset.
    #[must_use]
    pub fn not_kept(why: NotKept) -> MavMessage {
        warning(match why {
            NotKept::Full => "set, but not kept: flash full until a reset",
            NotKept::Flash => "set, but not kept: flash failed",
            NotKept::NoMemory => "set, but not kept: this board has no memory",
        })
    }

    /// What to say of a mission that was kept, and makes no route any more.
    #[must_use]
    pub fn not_recalled(refusal: &Refusal) -> MavMessage {
        warning(refusal)
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
            mavtype: MavType::MAV_TYPE_GENERIC_MULTIROTOR as u8,
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

    /// All that is said once a second.
    #[must_use]
    pub fn report(&self, autopilot: &Autopilot, lost_bytes: u32) -> [MavMessage; 5] {
        [
            Self::heartbeat(autopilot),
            Self::system_status(autopilot),
            Self::current_mode(autopilot),
            Self::landed_state(autopilot),
            self.counters(autopilot, lost_bytes),
        ]
    }

    /// A message that nobody asked for: a new mode or fault, where the vehicle is, its receiver's
    /// fix. `time_ns` is that of [`handle`](Self::handle).
    pub fn news(&mut self, time_ns: u64, autopilot: &Autopilot) -> Option<MavMessage> {
        if let Some(change) = self.change(autopilot) {
            return Some(change);
        }
        if let Some(news) = self.mission_news(time_ns, autopilot) {
            return Some(news);
        }
        if let Some(place) = self.place_news(time_ns, autopilot) {
            return Some(place);
        }
        self.receiver.news(time_ns)
    }

    /// The next parameter or mode of a list that was asked for: to be called when there is room for
    /// it on the line. One message a call, since a whole list would keep the control step waiting.
    pub fn listed(&mut self, autopilot: &Autopilot) -> Option<MavMessage> {
        if let Some(index) = self.modes {
            let mode = modes::available(index);
            self.modes = mode.is_some().then_some(index + 1);
            if mode.is_some() {
                return mode;
            }
        }
        let index = self.listing?;
        let answer = parameters::value(autopilot.settings(), index);
        self.listing = answer.is_some().then_some(index + 1);
        answer
    }

    fn change(&mut self, autopilot: &Autopilot) -> Option<MavMessage> {
        let (number, notice) = autopilot.notice();
        if number != self.noticed {
            self.noticed = number;
            let severity = match notice {
                Notice::Fixed => MavSeverity::MAV_SEVERITY_INFO,
                Notice::Drifts => MavSeverity::MAV_SEVERITY_WARNING,
                _ => MavSeverity::MAV_SEVERITY_CRITICAL,
            };
            return Some(status(severity, report::notice(notice)));
        }
        let now @ (mode, fault, waits_for) = (autopilot.mode(), autopilot.fault(), autopilot.waits_for());
        if now == self.reported {
            return None;
        }
        self.reported = now;
        let severity = match now {
            (_, None, None) => MavSeverity::MAV_SEVERITY_INFO,
            (Mode::Fault, ..) | (_, Some(Fault::PayloadLost | Fault::Caught), _) => {
                MavSeverity::MAV_SEVERITY_CRITICAL
            }
            _ => MavSeverity::MAV_SEVERITY_WARNING,
        };
        Some(status(severity, &report::text(mode, fault, waits_for, autopilot.absence())))
    }

    /// The mode that it is in, once a second.
    #[must_use]
    pub fn current_mode(autopilot: &Autopilot) -> MavMessage {
        modes::current(autopilot.mode(), autopilot.requested())
    }

    /// Whether it has landed, once a second.
    #[must_use]
    pub fn landed_state(autopilot: &Autopilot) -> MavMessage {
        let landed_state = autopilot.landed_state() as u8;
        MavMessage::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA { vtol_state: 0, landed_state })
    }

    /// Does what the pilot's switches have been turned to since `before`. On the ground they ask for
    /// nothing: a switch always says some mode, and asked for before arming that is taken over in
    /// flight.
    fn switch(&self, before: Switches, now: Switches, autopilot: &mut Autopilot) {
        autopilot.hear_stick(self.stick.kill || self.radio.kill);
        if now.mode != before.mode
            && let Some(mode) = now.mode
            && autopilot.is_armed()
        {
            autopilot.request(mode);
        }
    }

    /// Whether what `sender` senses is of this vehicle: not its own word, which a router may bring
    /// back, nor another vehicle's on the same link.
    fn is_aboard(&mut self, sender: Address, send: &mut impl FnMut(MavMessage)) -> bool {
        let (system, _) = sender;
        let is_stranger = system != link::CONTROLLER.0 && system < STATIONS;
        if is_stranger && self.stranger != Some(system) {
            self.stranger = Some(system);
            send(warning(format_args!("sensors of system {system} not used: not this one's")));
        }
        !is_stranger && sender != link::CONTROLLER
    }

    /// Acts on what the decoder found.
    pub fn handle(
        &mut self,
        received: Result<(MavMessage, Address), Rejected>,
        time_ns: u64,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) -> Next {
        let Ok((message, sender)) = received else {
            self.bad_frames = self.bad_frames.wrapping_add(1);
            return Next::Nothing;
        };
        if !is_for_us(&message) {
            return Next::Nothing;
        }
        if self.mission(&message, sender, time_ns, autopilot, send) {
            let has_changed = core::mem::take(&mut self.transfer.has_changed);
            let is_kept = has_changed && autopilot.drive() == Drive::Flight;
            return if is_kept { Next::StoreMission } else { Next::Nothing };
        }
        match message {
            MavMessage::LOAD_STATE(frame) => {
                if autopilot.drive() == Drive::Lockstep {
                    return Next::Step(frame);
                }
                autopilot.receive(&frame);
            }
            MavMessage::PARAM_REQUEST_READ(request) => send(parameters::read(&request, autopilot)),
            MavMessage::PARAM_REQUEST_LIST(_) => self.listing = Some(0),
            MavMessage::PARAM_SET(request) => return parameters::set(&request, autopilot, send),
            MavMessage::COMMAND_LONG(request) => return self.command(&request, autopilot, send),
            MavMessage::COMMAND_INT(request) => command_int(&request, autopilot, send),
            MavMessage::FILE_TRANSFER_PROTOCOL(request) => {
                self.files.answer(&request, sender).into_iter().for_each(send);
            }
            message if is_sensed(&message) && !self.is_aboard(sender, send) => {}
            MavMessage::LOCAL_POSITION_NED(place) => autopilot.navigation_mut().hear_place(&place),
            MavMessage::ATTITUDE_QUATERNION(attitude) => autopilot.navigation_mut().hear_attitude(&attitude),
            MavMessage::ODOMETRY(odometry) => autopilot.navigation_mut().hear_odometry(&odometry),
            MavMessage::HIGHRES_IMU(imu) => autopilot.navigation_mut().hear_imu(&imu),
            MavMessage::GPS_INPUT(fix) => {
                self.receiver.hear_input(&fix, time_ns);
                autopilot.navigation_mut().instruments_mut().hear_gps_input(&fix);
                self.find_home(autopilot);
            }
            MavMessage::GPS_RAW_INT(fix) => {
                self.receiver.hear_raw(&fix, time_ns);
                autopilot.navigation_mut().instruments_mut().hear_gps_raw(&fix);
                self.find_home(autopilot);
            }
            MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavtype: STATION, .. }) => autopilot.hear_station(),
            MavMessage::BATTERY_STATUS(battery) if battery.battery_remaining >= 0 => {
                autopilot.hear_battery(battery.id, battery.battery_remaining);
            }
            MavMessage::MANUAL_CONTROL(message) => {
                let now = stick::joystick(&message, autopilot.settings());
                let before = core::mem::replace(&mut self.stick, now);
                self.switch(before, now, autopilot);
            }
            MavMessage::RC_CHANNELS_OVERRIDE(message) => {
                let before = self.radio;
                self.radio = stick::radio(&message, autopilot.settings(), before);
                self.switch(before, self.radio, autopilot);
            }
            MavMessage::TIMESYNC(request) if request.tc1 == 0 => {
                send(MavMessage::TIMESYNC(TIMESYNC_DATA {
                    tc1: time_ns.cast_signed(),
                    ts1: request.ts1,
                    ..TIMESYNC_DATA::DEFAULT
                }));
            }
            _ => {}
        }
        Next::Nothing
    }
}

/// Whether a message says what sensors of some vehicle have sensed.
fn is_sensed(message: &MavMessage) -> bool {
    matches!(
        message,
        MavMessage::LOCAL_POSITION_NED(_)
            | MavMessage::ATTITUDE_QUATERNION(_)
            | MavMessage::ODOMETRY(_)
            | MavMessage::HIGHRES_IMU(_)
            | MavMessage::GPS_INPUT(_)
            | MavMessage::GPS_RAW_INT(_)
            | MavMessage::BATTERY_STATUS(_)
    )
}

/// Whether a message that names whom it is for is for this program, or for all.
fn is_for_us(message: &MavMessage) -> bool {
    let (system, component) = link::CONTROLLER;
    let target = match message {
        MavMessage::MANUAL_CONTROL(stick) => Some(stick.target),
        message => message.target_system_id(),
    };
    target.is_none_or(|target| [0, system].contains(&target))
        && message.target_component_id().is_none_or(|target| [0, component].contains(&target))
}

fn warning(what: impl core::fmt::Display) -> MavMessage {
    status(MavSeverity::MAV_SEVERITY_WARNING, &report::cut(what))
}

fn status(severity: MavSeverity, text: &str) -> MavMessage {
    MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity: severity as u8, text: link::text(text) })
}
