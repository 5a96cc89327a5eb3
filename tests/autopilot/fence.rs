//! A fence stands wherever it was drawn, on whatever path, over a reset, with or without a load
//! that is seen; and nothing is armed outside it.

use autopilot::{Autopilot, Boot, Item, Kind, Memory, Server, Setting};
use controller::{Measured, Mode, State, Uav, Vector3, Vehicle, VehicleParams};
use hil_sim::world::multibody::Multibody;
use link::MavMessage;
use link::dialect::*;
use rig::{ROUTE, parameter};
use witness::plant::VehicleParameters;

use crate::mission::{ACCEPTED, Flight, KEPT, Lossy, NOT_NOW, RELATIVE, fence, upload, waypoint};
use crate::station::{Station, set};
use crate::store::{Torn, open};

const DENIED: u8 = MavResult::MAV_RESULT_DENIED as u8;
const FENCE: MavMissionType = MavMissionType::MAV_MISSION_TYPE_FENCE;
const MISSION: MavMissionType = MavMissionType::MAV_MISSION_TYPE_MISSION;
const IN: MavCmd = MavCmd::MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION;
const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;
const TAKE_OFF: MavCmd = MavCmd::MAV_CMD_NAV_TAKEOFF;
const HOME: link::Home = link::Home { latitude: 53.527, longitude: -113.529, altitude: 668.0 };
const TOO_NEAR: &str = "not armed: too near the fence, or outside";
const NOTICE: &str = "too near the fence: FNC_ACT";

/// In a drive, with the path that it has by default.
fn autopilot(drive: f32) -> Autopilot {
    let memory = Box::leak(Box::new(Memory::<1024>::new()));
    let mut autopilot = Autopilot::new(Boot::default()).with_memory(memory);
    autopilot.settings_mut().unwrap().set(Setting::DRIVE, drive).unwrap();
    autopilot
}

fn configure(station: &mut Station, setting: Setting, value: f32) {
    station.autopilot.settings_mut().unwrap().set(setting, value).unwrap();
}

/// A circle to stay in, m, about a place on the earth, m from home.
fn on_earth(radius: f32, place: [f32; 2]) -> MISSION_ITEM_INT_DATA {
    let [x, y] = HOME.place(place);
    MISSION_ITEM_INT_DATA { frame: RELATIVE, x, y, ..fence(IN, radius, [0.0; 2]) }
}

/// Home, m from [`HOME`].
fn home(place: [f32; 2]) -> MavMessage {
    let [latitude, longitude] = HOME.place(place);
    let altitude = (HOME.altitude * 1e3) as i32;
    MavMessage::SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA {
        latitude,
        longitude,
        altitude,
        ..SET_GPS_GLOBAL_ORIGIN_DATA::DEFAULT
    })
}

fn send(station: &mut Station, kind: MavMissionType, items: &[MISSION_ITEM_INT_DATA]) -> Vec<String> {
    let (result, said) = upload(station, items, kind, &mut Lossy::none());
    assert_eq!(result, KEPT as u8, "{said:?}");
    said
}

/// A circle to stay in, m, that is counted from N's origin.
fn stay_in(station: &mut Station, radius: f32) {
    assert_eq!(send(station, FENCE, &[fence(IN, radius, [0.0, 0.0])]), [""; 0]);
}

impl Flight {
    /// The load is elsewhere now, at rest.
    fn carry(&mut self, place: [f64; 3]) {
        self.body = Multibody::new(VehicleParameters::default(), &State::at_rest(Vector3::from(place)));
    }

    fn try_to_arm(&mut self) -> (u8, Vec<String>) {
        self.step();
        self.command(ARM, 1.0, 0.0)
    }
}

#[test]
fn a_fence_on_the_earth_stands_on_a_path_that_is_no_mission() {
    let mut station = Station::new(autopilot(2.0));
    // Two circles of 30 m, whose centers are 10 m apart: from home it is 20 m to the south.
    let items = [[0.0, 0.0], [10.0, 0.0]].map(|place| on_earth(30.0, place));
    let words = "fence item 0: on the earth, but no home is set";
    assert_eq!(send(&mut station, FENCE, &items), [words]);
    let mut flight = Flight::at(station, [0.0, 0.0, -10.0]);
    assert_eq!(flight.try_to_arm(), (DENIED, vec![words.to_owned()]));
    flight.station.say(&home([0.0, 0.0]));
    flight.arm();
    // In flight half a metre is kept.
    for (n1, mode) in [(-19.0, Mode::Hold), (29.0, Mode::Hold), (-19.6, Mode::Land)] {
        flight.station.autopilot.disarm();
        configure(&mut flight.station, Setting::FENCE_ACTION, 2.0);
        flight.carry([0.0, 0.0, -10.0]);
        flight.arm();
        flight.carry([n1, 0.0, -10.0]);
        flight.fly(0.1);
        assert_eq!(flight.station.autopilot.mode(), mode, "{n1}: {:?}", flight.said);
    }
    assert!(flight.said.iter().any(|text| text == NOTICE), "{:?}", flight.said);

    // About another home N's origin is outside.
    flight.station.autopilot.disarm();
    flight.carry([0.0, 0.0, -10.0]);
    flight.station.say(&home([100.0, 0.0]));
    assert_eq!(flight.try_to_arm(), (NOT_NOW, vec![TOO_NEAR.to_owned()]));
    // The fence is 100 m south of it.
    flight.carry([-95.0, 0.0, -10.0]);
    flight.arm();
}

#[test]
fn a_reset_loses_no_fence_and_arms_nothing_that_was_refused() {
    let start = || {
        let mut autopilot = autopilot(2.0);
        set(&mut autopilot, parameter!("PATH_KIND"), f32::from(ROUTE));
        autopilot
    };
    let mut station = Station::new(start());
    stay_in(&mut station, 30.0);
    let route = [[0.0, 0.0, -10.0], [25.0, 0.0, -10.0]].map(waypoint);
    assert_eq!(send(&mut station, MISSION, &route), [""; 0]);
    let kept = |autopilot: &Autopilot, kind| -> Vec<Item> { autopilot.mission().items(kind).to_vec() };
    let debug = |items: &[Item]| format!("{items:?}");
    let mut store = open(Torn::new());
    for kind in Kind::ALL {
        store.keep_items(kind, &kept(&station.autopilot, kind)).unwrap();
    }
    // The margin is widened, and the route does not keep it any more.
    let words = "item 1: the load too near the fence";
    let refused = (DENIED, vec![words.to_owned()]);
    configure(&mut station, Setting::FENCE_MARGIN, 6.0);
    assert_eq!(Flight::at(station, [0.0, 0.0, -10.0]).try_to_arm(), refused);

    let mut autopilot = start();
    autopilot.settings_mut().unwrap().set(Setting::FENCE_MARGIN, 6.0).unwrap();
    let store = open(store.flash().clone());
    assert_eq!(autopilot.recall(&store).unwrap_err().to_string(), words);
    for kind in Kind::ALL {
        let stored: Vec<_> = store.items(kind).collect();
        assert_eq!(debug(&kept(&autopilot, kind)), debug(&stored), "{kind:?}");
        assert!(!stored.is_empty());
    }
    let mut flight = Flight::at(Station::new(autopilot), [0.0, 0.0, -10.0]);
    assert_eq!(flight.try_to_arm(), refused);
    // Another route does not cost the fence.
    let short = [[0.0, 0.0, -10.0], [20.0, 0.0, -10.0]].map(waypoint);
    assert_eq!(send(&mut flight.station, MISSION, &short), [""; 0]);
    assert_eq!(kept(&flight.station.autopilot, Kind::Fence).len(), 1);
    flight.arm();
}

#[test]
fn nothing_is_armed_outside_the_fence() {
    let ready = |station: &Station| {
        let MavMessage::SYS_STATUS(status) = Server::system_status(&station.autopilot) else { panic!() };
        let health = MavSysStatusSensor::from_bits(status.onboard_control_sensors_health).unwrap();
        health.contains(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK)
    };
    let mut station = Station::new(autopilot(2.0));
    stay_in(&mut station, 20.0);
    configure(&mut station, Setting::FENCE_ACTION, 2.0);
    let mut flight = Flight::at(station, [15.0, 0.0, -10.0]);
    flight.arm();
    // Blown out, it comes down there.
    flight.carry([21.0, 0.0, -10.0]);
    flight.fly(0.1);
    assert_eq!(flight.station.autopilot.mode(), Mode::Land);
    flight.station.autopilot.disarm();
    for (n1, may_be_armed) in [(21.0, false), (19.6, false), (19.4, true)] {
        flight.carry([n1, 0.0, -10.0]);
        flight.step();
        assert_eq!(ready(&flight.station), may_be_armed, "{n1}");
        let answer = flight.command(ARM, 1.0, 0.0);
        let expected = if may_be_armed { (ACCEPTED, vec![]) } else { (NOT_NOW, vec![TOO_NEAR.to_owned()]) };
        assert_eq!(answer, expected, "{n1}");
    }
    // What stands on the ground has yet to reach the least height.
    flight.station.autopilot.disarm();
    configure(&mut flight.station, Setting::FENCE_LOW, 15.0);
    assert_eq!(flight.try_to_arm(), (ACCEPTED, vec![]));
}

/// Where load and UAV are seen to be, if they are.
struct Seen {
    station: Station,
    sequence: u32,
}

impl Seen {
    /// Armed, where the load is seen at `place` under its UAV.
    fn armed(mut station: Station, place: [f32; 3]) -> Self {
        station.time_ns += 1;
        let mut seen = Self { station, sequence: 0 };
        seen.arm(place);
        seen
    }

    fn arm(&mut self, place: [f32; 3]) {
        self.see(place, true);
        assert_eq!(self.station.command(ARM, 1.0, 0.0), (ACCEPTED, vec![]));
        self.see(place, true);
    }

    fn see(&mut self, place: [f32; 3], sees_load: bool) {
        // Longer than from one look at the fence to the next.
        for _ in 0..20 {
            self.sequence += 1;
            // No two measurements are the same.
            let velocity = Vector3::new(1e-6 * (self.sequence % 7) as f32, 0.0, 0.0);
            let state = State { velocity, ..State::at_rest(Vector3::from(place)) };
            let uav = Uav::of(&state, &Vehicle::new(VehicleParams::paper()).unwrap());
            let measured = Measured { state: sees_load.then_some(&state), uav: Some(&uav), specific_force: None };
            let time_usec = 2_000 * u64::from(self.sequence) + 1;
            let frame = link::measured_frame(&measured);
            self.station.autopilot.receive(&LOAD_STATE_DATA { time_usec, sequence: self.sequence, ..frame });
            self.station.autopilot.tick();
        }
    }

    fn mode(&self) -> Mode {
        self.station.autopilot.mode()
    }
}

#[test]
fn a_take_off_ends_under_the_ceiling() {
    for (action, mode) in [(0.0, Mode::TakeOff), (1.0, Mode::Land), (2.0, Mode::Land)] {
        let mut station = Station::new(autopilot(0.0));
        stay_in(&mut station, 30.0);
        configure(&mut station, Setting::FENCE_HIGH, 3.0);
        // A floor is none to a vehicle that stands.
        configure(&mut station, Setting::FENCE_LOW, 1.0);
        configure(&mut station, Setting::FENCE_ACTION, action);
        let mut seen = Seen::armed(station, [0.0; 3]);
        assert_eq!(seen.station.command(TAKE_OFF, 0.0, 0.0), (ACCEPTED, vec![]));
        // The UAV is 2 m above.
        seen.see([0.0, 0.0, -0.1], true);
        assert_eq!(seen.mode(), Mode::TakeOff);
        assert!(!seen.station.news().contains(&NOTICE.to_owned()));
        seen.see([0.0, 0.0, -0.6], true);
        assert_eq!(seen.mode(), mode, "{action}");
        assert!(seen.station.news().contains(&NOTICE.to_owned()));
    }
}

#[test]
fn each_flight_has_its_own_look_at_the_fence() {
    let mut station = Station::new(autopilot(0.0));
    stay_in(&mut station, 30.0);
    let mut seen = Seen::armed(station, [0.0; 3]);
    for flight in 0..2 {
        // Armed and carried out, it does not stay up.
        assert_eq!(seen.station.command(TAKE_OFF, 0.0, 0.0), (ACCEPTED, vec![]));
        seen.see([40.0, 0.0, 0.0], true);
        assert_eq!(seen.mode(), Mode::Land, "{flight}");
        assert!(seen.station.news().contains(&NOTICE.to_owned()), "{flight}");
        seen.station.autopilot.disarm();
        seen.arm([0.0; 3]);
    }
}

#[test]
fn a_uav_whose_load_is_not_seen_keeps_the_fence_alone() {
    let mut station = Station::new(autopilot(0.0));
    stay_in(&mut station, 30.0);
    configure(&mut station, Setting::FENCE_ACTION, 2.0);
    station.autopilot.request(controller::Request::Hold);
    let mut seen = Seen::armed(station, [0.0, 0.0, -10.0]);
    seen.see([29.0, 0.0, -10.0], false);
    assert_eq!(seen.mode(), Mode::Hold);
    seen.see([29.6, 0.0, -10.0], false);
    assert_eq!(seen.mode(), Mode::Land);
    let news = seen.station.news();
    assert!(news.contains(&NOTICE.to_owned()), "{news:?}");
    // Back again, it is not told twice that what is not seen has left the fence.
    seen.station.ask(LoadMode::LOAD_MODE_HOLD);
    seen.see([29.0, 0.0, -10.0], false);
    seen.see([29.6, 0.0, -10.0], true);
    assert_eq!(seen.mode(), Mode::Hold);
    seen.see([29.0, 0.0, -10.0], true);
    seen.see([29.6, 0.0, -10.0], true);
    assert_eq!(seen.mode(), Mode::Land);
}
