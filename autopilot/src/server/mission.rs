//! MAVLink's mission protocol: missions and fences up and down, one item a message.
//!
//! An upload is kept when its last item has come and all of them make a route; until then what was
//! kept before is. The controller asks for each item, again where none has come for a while, so
//! that neither a lost question nor a lost item ends the upload. A download has no state here: what
//! is asked for is sent.

use link::dialect::{MissionState as MissionStateNumber, *};
use link::{Address, Home, MavMessage};

use super::{Server, warning};
use crate::control::{Autopilot, MissionState};
use crate::mission::{DEGREES, ITEMS, Item, Kind};

/// After so long without an item it is asked for again, ns; and so many times.
const PATIENCE_NS: u64 = 250_000_000;
const TRIES: u8 = 20;

const NOT_ARMED: &str = "mission: not while armed";

/// The transfer that there is, and what was said last of the mission.
#[derive(Clone, Debug)]
pub struct Transfer {
    upload: Option<Upload>,
    /// Of the last upload that ended: whose, of what, its last item, and the answer, which may get
    /// lost.
    ended: Option<(Address, Kind, u16, MavMissionResult)>,
    /// Waypoints that were told to be reached.
    reached: usize,
    /// The item and state that were told.
    current: (u16, MissionState),
    /// When all was told last, ns.
    told_ns: u64,
    /// What is kept has changed.
    pub(super) has_changed: bool,
    /// How many messages have yet to tell a home that was found.
    untold: usize,
}

/// An upload under way.
#[derive(Clone, Copy, Debug)]
struct Upload {
    from: Address,
    kind: Kind,
    count: u16,
    asked_ns: u64,
    tries: u8,
}

impl Transfer {
    pub const fn new() -> Self {
        Self {
            upload: None,
            ended: None,
            reached: 0,
            current: (0, MissionState::None),
            told_ns: 0,
            has_changed: false,
            untold: 0,
        }
    }
}

impl Upload {
    /// Asks for its next item.
    fn request(&self, autopilot: &Autopilot) -> MavMessage {
        let (target_system, target_component) = self.from;
        MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
            seq: autopilot.mission().coming() as u16,
            target_system,
            target_component,
            mission_type: self.kind.number(),
        })
    }
}

impl Server {
    /// Acts on a message of the mission protocol, or of home; `false` if it is none.
    pub(super) fn mission(
        &mut self,
        message: &MavMessage,
        sender: Address,
        time_ns: u64,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) -> bool {
        let unsupported = MavMissionResult::MAV_MISSION_UNSUPPORTED;
        match message {
            MavMessage::MISSION_COUNT(count) => self.begin_upload(count, sender, time_ns, autopilot, send),
            MavMessage::MISSION_ITEM_INT(item) => self.take_item(item, sender, time_ns, autopilot, send),
            MavMessage::MISSION_ACK(_) if self.transfer.upload.is_some_and(|upload| upload.from == sender) => {
                // The station gives up.
                self.transfer.upload = None;
            }
            MavMessage::MISSION_REQUEST_LIST(request) => match Kind::of(request.mission_type) {
                Some(kind) => {
                    let count = autopilot.mission().items(kind).len() as u16;
                    send(MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
                        count,
                        target_system: sender.0,
                        target_component: sender.1,
                        mission_type: kind.number(),
                        opaque_id: 0,
                    }));
                }
                None => send(ack(sender, request.mission_type, unsupported)),
            },
            MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA { seq, mission_type, .. })
            | MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA { seq, mission_type, .. }) => {
                let kept = Kind::of(*mission_type).and_then(|kind| Some((kind, autopilot.item(kind, *seq)?)));
                send(match kept {
                    Some((kind, item)) => MavMessage::MISSION_ITEM_INT(item.message(*seq, kind, sender)),
                    None => ack(sender, *mission_type, MavMissionResult::MAV_MISSION_INVALID_SEQUENCE),
                });
            }
            MavMessage::MISSION_CLEAR_ALL(request) => {
                let all = request.mission_type == MavMissionType::MAV_MISSION_TYPE_ALL as u8;
                let kinds =
                    [Kind::Mission, Kind::Fence].map(|kind| (all || kind.number() == request.mission_type, kind));
                let result = match autopilot.mission_mut() {
                    None => {
                        send(warning(NOT_ARMED));
                        MavMissionResult::MAV_MISSION_DENIED
                    }
                    Some(_) if kinds.iter().all(|(is_meant, _)| !is_meant) => unsupported,
                    Some((mission, settings)) => {
                        kinds
                            .iter()
                            .filter(|(is_meant, _)| *is_meant)
                            .for_each(|&(_, kind)| mission.clear(kind, settings));
                        self.transfer.has_changed = true;
                        MavMissionResult::MAV_MISSION_ACCEPTED
                    }
                };
                send(ack(sender, request.mission_type, result));
            }
            MavMessage::MISSION_WRITE_PARTIAL_LIST(MISSION_WRITE_PARTIAL_LIST_DATA { mission_type, .. })
            | MavMessage::MISSION_REQUEST_PARTIAL_LIST(MISSION_REQUEST_PARTIAL_LIST_DATA { mission_type, .. }) => {
                send(warning("mission: no partial lists"));
                send(ack(sender, *mission_type, unsupported));
            }
            MavMessage::MISSION_SET_CURRENT(request) => {
                if let Err(why) = autopilot.set_current_item(request.seq) {
                    send(warning(why));
                }
                send(self.mission_current(autopilot));
            }
            other => match home_in(other) {
                // What is not meant for one vehicle is meant for the one that says it.
                Some((home, is_meant)) if is_meant || sender.0 == link::CONTROLLER.0 => {
                    set_home(home, autopilot, send);
                }
                _ => return false,
            },
        }
        true
    }

    fn begin_upload(
        &mut self,
        &MISSION_COUNT_DATA { count, mission_type, .. }: &MISSION_COUNT_DATA,
        from: Address,
        time_ns: u64,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) {
        use MavMissionResult as R;
        let mut refuse = |text: &dyn core::fmt::Display, result| {
            send(warning(text));
            send(ack(from, mission_type, result));
        };
        let Some(kind) = Kind::of(mission_type) else {
            return refuse(&"mission: routes and fences alone", R::MAV_MISSION_UNSUPPORTED);
        };
        let Some((mission, settings)) = autopilot.mission_mut() else {
            return refuse(&NOT_ARMED, R::MAV_MISSION_DENIED);
        };
        if self.transfer.upload.is_some_and(|upload| upload.from != from) {
            return refuse(&"mission: another station is sending one", R::MAV_MISSION_DENIED);
        }
        if usize::from(count) > ITEMS {
            let text = format_args!("mission: {count} items, at most {ITEMS}");
            return refuse(&text, R::MAV_MISSION_NO_SPACE);
        }
        if let Err(refusal) = mission.begin() {
            return refuse(&refusal, refusal.result);
        }
        self.transfer.upload = None;
        if count == 0 {
            mission.clear(kind, settings);
            self.transfer.has_changed = true;
            send(ack(from, mission_type, R::MAV_MISSION_ACCEPTED));
            return;
        }
        let upload = Upload { from, kind, count, asked_ns: time_ns, tries: 0 };
        self.transfer.upload = Some(upload);
        send(upload.request(autopilot));
    }

    fn take_item(
        &mut self,
        item: &MISSION_ITEM_INT_DATA,
        sender: Address,
        time_ns: u64,
        autopilot: &mut Autopilot,
        send: &mut impl FnMut(MavMessage),
    ) {
        let transfer = &mut self.transfer;
        let Some(upload) = &mut transfer.upload else {
            // The answer to the last item was lost.
            if let Some((from, kind, last, result)) = transfer.ended
                && (from, kind.number(), last) == (sender, item.mission_type, item.seq)
            {
                send(ack(sender, item.mission_type, result));
            }
            return;
        };
        let Upload { from, kind, count, .. } = *upload;
        let number = autopilot.mission().coming();
        // One that was not asked for is asked for again in time: two questions at once would stay
        // two.
        if (from, kind.number(), number) != (sender, item.mission_type, usize::from(item.seq)) {
            return;
        }
        (upload.asked_ns, upload.tries) = (time_ns, 0);
        let upload = *upload;
        let Some((mission, settings)) = autopilot.mission_mut() else { return };
        let taken = mission.take(kind, Item::of(item)).and_then(|()| {
            let is_last = mission.coming() == usize::from(count);
            is_last.then(|| mission.keep(kind, settings)).transpose()
        });
        let result = match taken {
            Ok(None) => {
                send(upload.request(autopilot));
                return;
            }
            Ok(Some(remark)) => {
                if let Some(remark) = remark {
                    send(warning(remark));
                }
                (self.transfer.reached, self.transfer.has_changed) = (0, true);
                MavMissionResult::MAV_MISSION_ACCEPTED
            }
            Err(refusal) => {
                send(warning(&refusal));
                refusal.result
            }
        };
        self.transfer.upload = None;
        self.transfer.ended = Some((sender, kind, item.seq, result));
        send(ack(sender, item.mission_type, result));
    }

    /// After a fix: home may be found by it.
    pub(super) fn find_home(&mut self, autopilot: &mut Autopilot) {
        if autopilot.find_home() {
            self.transfer.untold = 2;
        }
    }

    /// What there is to say of a home that was found, or of a mission, unasked: the next question of an upload, an item that is
    /// reached, another item or state.
    pub(super) fn mission_news(&mut self, time_ns: u64, autopilot: &Autopilot) -> Option<MavMessage> {
        const EVERY_NS: u64 = 1_000_000_000;
        let transfer = &mut self.transfer;
        if let Some(left) = transfer.untold.checked_sub(1) {
            transfer.untold = left;
            let [origin, home] = home_messages(autopilot);
            return if left > 0 { origin } else { home };
        }
        if let Some(mut upload) = transfer.upload
            && time_ns.saturating_sub(upload.asked_ns) > PATIENCE_NS
        {
            if upload.tries >= TRIES || autopilot.is_armed() {
                transfer.upload = None;
                return Some(ack(
                    upload.from,
                    upload.kind.number(),
                    MavMissionResult::MAV_MISSION_OPERATION_CANCELLED,
                ));
            }
            upload.asked_ns = time_ns;
            upload.tries += 1;
            transfer.upload = Some(upload);
            return Some(upload.request(autopilot));
        }
        let passed = autopilot.progress().map_or(0, |progress| progress.passed);
        if autopilot.mode() != controller::Mode::Follow {
            // What is gone past by command is not reached.
            transfer.reached = transfer.reached.max(autopilot.before_run());
        }
        if passed > transfer.reached && autopilot.mode() == controller::Mode::Follow {
            let seq = autopilot.mission().item_of(transfer.reached);
            transfer.reached += 1;
            return seq.map(|seq| MavMessage::MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA { seq }));
        }
        // Another round, another flight; noise about a waypoint is neither.
        if passed == 0 || passed + 1 < transfer.reached {
            transfer.reached = passed;
        }
        let current = (autopilot.current_item(), autopilot.mission_state());
        let is_due = time_ns.saturating_sub(transfer.told_ns) > EVERY_NS && current.1 != MissionState::None;
        if current != transfer.current || is_due {
            (transfer.current, transfer.told_ns) = (current, time_ns);
            return Some(self.mission_current(autopilot));
        }
        None
    }

    /// The item that is flown to, and how the mission stands.
    pub(super) fn mission_current(&self, autopilot: &Autopilot) -> MavMessage {
        let mission_state = match autopilot.mission_state() {
            MissionState::None => MissionStateNumber::MISSION_STATE_NO_MISSION,
            MissionState::NotStarted => MissionStateNumber::MISSION_STATE_NOT_STARTED,
            MissionState::Active => MissionStateNumber::MISSION_STATE_ACTIVE,
            MissionState::Paused => MissionStateNumber::MISSION_STATE_PAUSED,
            MissionState::Complete => MissionStateNumber::MISSION_STATE_COMPLETE,
        };
        MavMessage::MISSION_CURRENT(MISSION_CURRENT_DATA {
            seq: autopilot.current_item(),
            total: autopilot.mission().items(Kind::Mission).len() as u16,
            mission_state: mission_state as u8,
            mission_mode: if autopilot.mission_state() == MissionState::Active { 1 } else { 2 },
        })
    }
}

fn ack((target_system, target_component): Address, mission_type: u8, result: MavMissionResult) -> MavMessage {
    MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        target_system,
        target_component,
        mavtype: result as u8,
        mission_type,
        opaque_id: 0,
    })
}

/// Latitude and longitude in 1e-7 degrees, altitude in mm, and where in N that is.
type Place = ([i32; 3], [f32; 3]);

/// The home that a message tells, and whether it names whom it is for.
fn home_in(message: &MavMessage) -> Option<(Place, bool)> {
    Some(match message {
        MavMessage::SET_GPS_GLOBAL_ORIGIN(at) => (([at.latitude, at.longitude, at.altitude], [0.0; 3]), true),
        MavMessage::GPS_GLOBAL_ORIGIN(at) => (([at.latitude, at.longitude, at.altitude], [0.0; 3]), false),
        MavMessage::SET_HOME_POSITION(at) => (([at.latitude, at.longitude, at.altitude], [at.x, at.y, at.z]), true),
        MavMessage::HOME_POSITION(at) => (([at.latitude, at.longitude, at.altitude], [at.x, at.y, at.z]), false),
        _ => return None,
    })
}

/// Sets home, and tells it.
fn set_home(
    ([latitude, longitude, altitude], in_n): Place,
    autopilot: &mut Autopilot,
    send: &mut impl FnMut(MavMessage),
) {
    let home = Home {
        latitude: f64::from(latitude) * DEGREES,
        longitude: f64::from(longitude) * DEGREES,
        altitude: f64::from(altitude) * 1e-3,
    };
    let home = if in_n == [0.0; 3] { Ok(home) } else { Err("home: x, y, z other than 0") };
    have_home(home, autopilot, send);
}

/// Sets home, if there is one, and tells it; `false` if it is refused.
pub(super) fn have_home(
    home: Result<Home, &'static str>,
    autopilot: &mut Autopilot,
    send: &mut impl FnMut(MavMessage),
) -> bool {
    let set = home.and_then(|home| {
        let is_place = home.latitude.abs() <= 90.0 && home.longitude.abs() <= 180.0 && home.altitude.is_finite();
        if is_place { autopilot.set_home(home) } else { Err("home: no place on the earth") }
    });
    match set {
        Ok(()) => home_messages(autopilot).into_iter().flatten().for_each(send),
        Err(why) => send(warning(why)),
    }
    set.is_ok()
}

/// The home of DO_SET_HOME.
pub(super) fn home_of(request: &COMMAND_INT_DATA, autopilot: &Autopilot) -> Result<Home, &'static str> {
    use MavFrame as Frame;
    const GLOBAL: [u8; 2] = [Frame::MAV_FRAME_GLOBAL as u8, Frame::MAV_FRAME_GLOBAL_INT as u8];
    const RELATIVE: [u8; 2] =
        [Frame::MAV_FRAME_GLOBAL_RELATIVE_ALT as u8, Frame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT as u8];
    let above = match (request.param1, autopilot.mission().home()) {
        (1.0, _) => return autopilot.here(),
        (0.0, _) if GLOBAL.contains(&request.frame) => 0.0,
        (0.0, Some(home)) if RELATIVE.contains(&request.frame) => home.altitude,
        (0.0, None) if RELATIVE.contains(&request.frame) => return Err("home: above home, and there is none"),
        (0.0, _) => return Err("home: frames GLOBAL and GLOBAL_RELATIVE_ALT"),
        _ => return Err("home: param1 is 0, or 1 for here"),
    };
    let [latitude, longitude] = [request.x, request.y].map(|steps| f64::from(steps) * DEGREES);
    Ok(Home { latitude, longitude, altitude: above + f64::from(request.z) })
}

/// GPS_GLOBAL_ORIGIN and HOME_POSITION, if there is a home.
pub(super) fn home_messages(autopilot: &Autopilot) -> [Option<MavMessage>; 2] {
    let Some(home) = autopilot.mission().home() else { return [None, None] };
    let [latitude, longitude] = [home.latitude, home.longitude].map(|degrees| libm::round(degrees / DEGREES) as i32);
    let altitude = libm::round(home.altitude * 1e3) as i32;
    [
        Some(MavMessage::GPS_GLOBAL_ORIGIN(GPS_GLOBAL_ORIGIN_DATA { latitude, longitude, altitude, time_usec: 0 })),
        Some(MavMessage::HOME_POSITION(HOME_POSITION_DATA {
            latitude,
            longitude,
            altitude,
            q: [1.0, 0.0, 0.0, 0.0],
            ..HOME_POSITION_DATA::DEFAULT
        })),
    ]
}
