//! The link as MAVLink means it: who is addressed, integers in parameters, arming, modes that are
//! announced, and clocks that restart.

use autopilot::{Autopilot, Drive};
use controller::{Measured, Mode, Request, Uav, Vehicle, VehicleParams};
use link::MavMessage;
use link::dialect::*;

use crate::station::{Station, arm, driven, fly, frame, see, start, texts};

const ARM: u16 = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16;
const DENIED: u8 = MavResult::MAV_RESULT_DENIED as u8;
const NOT_NOW: u8 = MavResult::MAV_RESULT_TEMPORARILY_REJECTED as u8;
const ACCEPTED: u8 = MavResult::MAV_RESULT_ACCEPTED as u8;

fn arming(target_system: u8, target_component: u8) -> MavMessage {
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        param1: 1.0,
        command: ARM,
        target_system,
        target_component,
        ..COMMAND_LONG_DATA::DEFAULT
    })
}

fn setting(name: &str, param_value: f32, param_type: u8) -> MavMessage {
    MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value,
        param_type,
        param_id: link::name(name),
        ..PARAM_SET_DATA::DEFAULT
    })
}

/// The value in the answer to a parameter that is set, and what was said.
fn set(station: &mut Station, message: &MavMessage) -> (Option<f32>, Vec<String>) {
    let replies = station.say(message);
    let value = replies.iter().find_map(|reply| match reply {
        MavMessage::PARAM_VALUE(value) => Some(value.param_value),
        _ => None,
    });
    (value, texts(&replies))
}

#[test]
fn what_is_for_others_changes_nothing_and_is_not_answered() {
    for (system, component) in [(42, 0), (42, 1), (1, 154), (0, 154)] {
        let mut station = Station::new(driven(1.0));
        // What it says unasked, it says before.
        station.messages();
        let before = station.autopilot.settings().clone();
        let others = [
            arming(system, component),
            MavMessage::PARAM_SET(PARAM_SET_DATA {
                param_value: 0.9,
                target_system: system,
                target_component: component,
                param_id: link::name("VEH_M_LOAD"),
                ..PARAM_SET_DATA::DEFAULT
            }),
            MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
                target_system: system,
                target_component: component,
                ..PARAM_REQUEST_READ_DATA::DEFAULT
            }),
            MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA {
                target_system: system,
                target_component: component,
            }),
        ];
        for message in &others {
            assert_eq!(station.say(message), [], "{message:?}");
        }
        assert_eq!(station.messages(), []);
        assert!(!station.autopilot.is_armed());
        assert_eq!(station.autopilot.settings(), &before);
    }
    for (system, component) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let mut station = Station::new(driven(1.0));
        station.say(&arming(system, component));
        assert!(station.autopilot.is_armed(), "{system} {component}");
    }
}

#[test]
fn integers_are_taken_as_their_bytes_or_as_the_float_that_equals_them() {
    for kind in 1..=6_u8 {
        for (name, value) in [("SYS_SIM", 2_u8), ("PATH_KIND", 1), ("TLM_EVERY", 20), ("PATH_YAW_KIND", 0)] {
            for sent in [f32::from_bits(value.into()), value.into()] {
                let (taken, said) = set(&mut Station::new(driven(0.0)), &setting(name, sent, kind));
                assert_eq!((taken, said), (Some(value.into()), vec![]), "{name} {sent} {kind}");
            }
        }
        // -1, in as many bytes as the type has.
        let mask = [0xFF, 0xFF, 0xFFFF, 0xFFFF, u32::MAX, u32::MAX][usize::from(kind - 1)];
        let (kept, said) = set(&mut Station::new(driven(0.0)), &setting("SYS_SIM", f32::from_bits(mask), kind));
        assert_eq!((kept, said.len()), (Some(0.0), 1), "{kind}");
    }
    for kind in [0, 7, 8, 10, 255] {
        let (kept, said) = set(&mut Station::new(driven(0.0)), &setting("SYS_SIM", 1.0, kind));
        assert_eq!((kept, said), (Some(0.0), vec!["type not known: SYS_SIM".to_owned()]));
    }
}

#[test]
fn nothing_but_one_arms_and_in_flight_it_takes_force_to_disarm() {
    let mut autopilot = driven(0.0);
    see(&mut autopilot);
    let mut station = Station::new(autopilot);
    let arm_with = |station: &mut Station, a, b| station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, a, b);
    for value in [f32::NAN, 0.6, 0.5, 2.0, -1.0, f32::INFINITY] {
        assert_eq!(arm_with(&mut station, value, 21196.0).0, DENIED, "{value}");
        assert!(!station.autopilot.is_armed());
    }
    station.ask(LoadMode::LOAD_MODE_HOLD);
    assert_eq!(arm_with(&mut station, 1.0, 0.0), (ACCEPTED, vec![]));
    fly(&mut station.autopilot, 1);
    assert_eq!(station.autopilot.mode(), Mode::Hold);
    for force in [0.0, 1.0, f32::NAN] {
        let (result, said) = arm_with(&mut station, 0.0, force);
        assert_eq!((result, said), (DENIED, vec!["in flight: to disarm, param2 has to be 21196".to_owned()]));
        assert!(station.autopilot.is_armed());
    }
    assert_eq!(arm_with(&mut station, 0.0, 21196.0).0, ACCEPTED);
    assert!(!station.autopilot.is_armed());
}

#[test]
fn on_the_ground_it_disarms_without_force() {
    let mut autopilot = driven(0.0);
    arm(&mut autopilot);
    fly(&mut autopilot, 1);
    assert_eq!(autopilot.mode(), Mode::Idle);
    let mut station = Station::new(autopilot);
    assert_eq!(station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 0.0, 0.0).0, ACCEPTED);
}

#[test]
fn with_its_rotors_on_it_arms_on_a_fresh_good_state_alone() {
    let refused = "not armed: no good state just now";
    let try_arming = |station: &mut Station| station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    let mut station = Station::new(driven(0.0));
    assert_eq!(try_arming(&mut station), (NOT_NOW, vec![refused.to_owned()]));
    // A bad one does not count.
    station.autopilot.receive(&LOAD_STATE_DATA { rod: [0.0; 3], ..frame(1) });
    station.autopilot.tick();
    assert_eq!(try_arming(&mut station).0, NOT_NOW);
    fly(&mut station.autopilot, 2);
    // Half a second of 2 ms, and as much again.
    for _ in 0..500 {
        station.autopilot.tick();
    }
    assert_eq!(try_arming(&mut station).0, NOT_NOW);
    fly(&mut station.autopilot, 3);
    assert_eq!(try_arming(&mut station).0, ACCEPTED);
    // A simulated vehicle may wait for its states: no rotor turns.
    for simulate in [1.0, 2.0] {
        assert_eq!(try_arming(&mut Station::new(driven(simulate))).0, ACCEPTED);
    }
}

#[test]
fn modes_are_announced_by_the_standard_messages() {
    let mut station = Station::new(driven(0.0));
    let request = MavCmd::MAV_CMD_REQUEST_MESSAGE;
    assert_eq!(station.command(request, 435.0, 0.0).0, ACCEPTED);
    let modes: Vec<_> = station
        .messages()
        .into_iter()
        .filter_map(|message| match message {
            MavMessage::AVAILABLE_MODES(mode) => Some(mode),
            _ => None,
        })
        .collect();
    assert_eq!(modes.len(), 8);
    for (mode, index) in modes.iter().zip(1..) {
        assert_eq!((mode.number_modes, mode.mode_index), (8, index));
        let is_selectable = mode.properties & 2 == 0;
        let number = mode.custom_mode as f32;
        let custom = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u32 as f32;
        let asked = station.command(MavCmd::MAV_CMD_DO_SET_MODE, custom, number).0;
        // Take-off is for a vehicle that stands ready.
        let expected = match mode.custom_mode {
            7 => NOT_NOW,
            _ if is_selectable => ACCEPTED,
            _ => DENIED,
        };
        assert_eq!(asked, expected, "{}", link::text_of(&*mode.mode_name));
    }
    for (index, expected) in [(3.0, ACCEPTED), (9.0, DENIED), (f32::NAN, DENIED), (-1.0, DENIED)] {
        assert_eq!(station.command(request, 435.0, index).0, expected, "{index}");
    }
    assert_eq!(station.command(request, 436.0, 0.0).0, ACCEPTED);
    assert_eq!(station.command(request, 148.0, 0.0).0, ACCEPTED);
    assert_eq!(station.command(request, 1.0, 0.0).0, MavResult::MAV_RESULT_UNSUPPORTED as u8);
    // No stock ground station has modes of its own for this type.
    let MavMessage::HEARTBEAT(heartbeat) = autopilot::Server::heartbeat(&station.autopilot) else { panic!() };
    assert_eq!(heartbeat.mavtype, MavType::MAV_TYPE_GENERIC_MULTIROTOR as u8);
}

/// In hold, on states with these stamps; the mode at the end and how many were refused.
fn stamped(stamps: impl IntoIterator<Item = u64>) -> (Mode, u32) {
    let mut autopilot: Autopilot = driven(2.0);
    assert_eq!(autopilot.drive(), Drive::RealTime);
    autopilot.request(Request::Hold);
    arm(&mut autopilot);
    for (sequence, time_usec) in (1..).zip(stamps) {
        autopilot.receive(&LOAD_STATE_DATA { time_usec, ..frame(sequence) });
        autopilot.tick();
    }
    (autopilot.mode(), autopilot.counters().refused)
}

#[test]
fn a_clock_that_restarts_is_believed_soon_and_a_stray_stamp_never() {
    const UNIX: u64 = 1_700_000_000_000_000;
    let every = |start: u64, count: u64| (0..count).map(move |i| start + 2_000 * i);
    assert_eq!(stamped(every(UNIX, 100).chain(every(5_000_000, 100))), (Mode::Hold, 2));
    assert_eq!(
        stamped(every(10_000_000, 100).chain([UNIX, u64::MAX]).chain(every(10_200_000, 100))),
        (Mode::Hold, 2)
    );
    assert_eq!(stamped(every(10_000_000, 100).chain(every(10_150_000, 100))), (Mode::Hold, 2));
    // Seconds without a state, and then the same clock.
    assert_eq!(stamped(every(10_000_000, 100).chain(every(60_000_000, 100))), (Mode::Hold, 2));
    // A stamp again and again is one state.
    let frozen = stamped(every(10_000_000, 10).chain([10_020_000; 100]));
    assert_eq!(frozen, (Mode::Fault, 99));
}

/// Nor does what it says of the UAV, which hold would fly on for ever.
#[test]
fn an_estimator_that_has_stopped_gives_no_states() {
    let uav = Uav::of(&start(), &Vehicle::new(VehicleParams::paper()).unwrap());
    let both = link::measured_frame(&Measured { state: Some(&start()), uav: Some(&uav), specific_force: None });
    for last in [frame(2), both] {
        let mut station = Station::new(driven(0.0));
        station.autopilot.request(Request::Hold);
        arm(&mut station.autopilot);
        fly(&mut station.autopilot, 1);
        station.news();
        let mut again = |sequence: u32| {
            // The same state at another time.
            let LOAD_STATE_DATA { time_usec, .. } = frame(2 * sequence);
            station.autopilot.receive(&LOAD_STATE_DATA { time_usec, sequence: 2 * sequence, ..last.clone() });
            station.autopilot.tick();
            (station.autopilot.mode(), station.news())
        };
        // The first of them is new; the last two tenths of a second are none, of which the model
        // carries one.
        for sequence in 1..50 {
            assert_eq!(again(sequence), (Mode::Hold, vec![]), "{sequence}");
        }
        let said: Vec<_> = (50..100).flat_map(|sequence| again(sequence).1).collect();
        assert_eq!(said, ["fault: frozen states"]);
        assert_eq!(again(100).0, Mode::Fault);
    }
}

#[test]
fn states_slower_than_the_model_carries_are_refused_with_the_limit() {
    for (every, expected) in [(50, None), (60, Some("not armed: states 0.12 s apart, POL_COAST 0.1"))] {
        let mut station = Station::new(driven(0.0));
        for sequence in 1..4 {
            fly(&mut station.autopilot, sequence);
            for _ in 0..every {
                station.autopilot.tick();
            }
        }
        fly(&mut station.autopilot, 4);
        let (result, said) = station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        assert_eq!((result == ACCEPTED, said.first().map(String::as_str)), (expected.is_none(), expected), "{every}");
    }
}

#[test]
fn two_clocks_at_once_are_never_both_believed() {
    const UNIX: u64 = 1_700_000_000_000_000;
    let both = (0..200).flat_map(|i| [10_000_000 + 2_000 * i, UNIX + 2_000 * i]);
    let (mode, refused) = stamped(both);
    assert_eq!((mode, refused), (Mode::Hold, 200));
}

#[test]
fn what_is_set_for_flight_is_to_be_kept_and_nothing_of_a_simulation() {
    use autopilot::{Next, Server};
    let kept = |autopilot: &mut Autopilot, name, value| {
        let message = setting(name, value, MavParamType::MAV_PARAM_TYPE_REAL32 as u8);
        match Server::new().handle(Ok((message, link::STATION)), 0, autopilot, &mut |_| {}) {
            Next::Store(index) => autopilot.settings().at(index).map(|(entry, _)| entry.name.as_str()),
            _ => None,
        }
    };
    let mut autopilot = driven(0.0);
    assert_eq!(kept(&mut autopilot, "VEH_M_LOAD", 0.7), Some("VEH_M_LOAD"));
    assert_eq!(kept(&mut autopilot, "FS_GCS_T", 7.0), Some("FS_GCS_T"));
    assert_eq!(kept(&mut autopilot, "VEH_M_LOAD", -1.0), None);
    // What drives the step is not: after a reset it is the timer.
    assert_eq!(kept(&mut autopilot, "SYS_SIM", 1.0), None);
    assert_eq!(kept(&mut autopilot, "VEH_M_LOAD", 0.9), None);
}
