//! The UAV's own navigation, over the link in either form; take-off and landing as a ground station
//! asks for them; whether it has landed; and files, of which there are none.

use autopilot::{Autopilot, Boot, Server};
use controller::{Measured, Mode, State, Uav, Vector3, Vehicle, VehicleParams};
use link::MavMessage;
use link::dialect::*;

use crate::station::{Station, driven, fly, see, start, texts};

const ACCEPTED: u8 = MavResult::MAV_RESULT_ACCEPTED as u8;
const DENIED: u8 = MavResult::MAV_RESULT_DENIED as u8;
const NOT_NOW: u8 = MavResult::MAV_RESULT_TEMPORARILY_REJECTED as u8;

fn uav_of(state: &State<f32>) -> Uav<f32> {
    Uav::of(state, &Vehicle::new(VehicleParams::paper()).unwrap())
}

/// The `sequence`-th frame, with the UAV, and with the load if it is seen; no two in a row are the
/// same.
fn with_uav(sequence: u32, sees_load: bool) -> LOAD_STATE_DATA {
    let (state, mut uav) = (start(), uav_of(&start()));
    uav.velocity.x += 1e-6 * (sequence % 7) as f32;
    let measured = Measured { state: sees_load.then_some(&state), uav: Some(&uav), specific_force: None };
    LOAD_STATE_DATA { time_usec: 2_000 * u64::from(sequence) + 1, sequence, ..link::measured_frame(&measured) }
}

/// What MAVLink's own messages say of the UAV in `state`.
fn navigation(state: &State<f32>) -> [MavMessage; 3] {
    let uav = uav_of(state);
    [
        MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
            x: uav.position.x,
            y: uav.position.y,
            z: uav.position.z,
            ..LOCAL_POSITION_NED_DATA::DEFAULT
        }),
        MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA { q1: 1.0, ..ATTITUDE_QUATERNION_DATA::DEFAULT }),
        MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
            zacc: -9.81 * 1.2,
            fields_updated: 7,
            ..HIGHRES_IMU_DATA::DEFAULT
        }),
    ]
}

fn landed(autopilot: &Autopilot) -> u8 {
    match Server::landed_state(autopilot) {
        MavMessage::EXTENDED_SYS_STATE(state) => state.landed_state,
        other => panic!("{other:?}"),
    }
}

/// Idle on the ground, with its own navigation.
fn idle() -> Station {
    let mut autopilot = driven(0.0);
    see(&mut autopilot);
    autopilot.arm().unwrap();
    let mut station = Station::new(autopilot);
    station.autopilot.receive(&with_uav(1, true));
    station.autopilot.tick();
    assert_eq!(station.autopilot.mode(), Mode::Idle);
    station
}

#[test]
fn every_part_of_what_is_measured_crosses_bit_by_bit() {
    let state = start();
    let uav = Uav { position: Vector3::new(1.0, f32::from_bits(1), -0.0), ..uav_of(&state) };
    let force = Vector3::new(0.1, -0.2, -9.81);
    for bits in 0..8 {
        let measured = Measured {
            state: (bits & 1 > 0).then_some(&state),
            uav: (bits & 2 > 0).then_some(&uav),
            specific_force: (bits & 4 > 0).then_some(force),
        };
        let frame = link::measured_frame(&measured);
        assert_eq!(link::uav_of(&frame).as_ref(), measured.uav, "{bits}");
        assert_eq!(link::specific_force_of(&frame), measured.specific_force, "{bits}");
        assert_eq!(frame.seen.contains(LoadSeen::LOAD_SEEN_NO_LOAD), measured.state.is_none(), "{bits}");
        if measured.state.is_some() {
            assert_eq!(link::state_of(&frame), state, "{bits}");
        }
    }
    // As a sender of the first form of the dialect has it, whose frames end before.
    assert_eq!(LOAD_STATE_DATA::DEFAULT.seen, LoadSeen::LOAD_SEEN_LOAD_ALONE);
}

#[test]
fn a_load_that_is_not_seen_is_held_above_by_the_uav_s_navigation() {
    for by_messages in [false, true] {
        let mut autopilot = driven(0.0);
        autopilot.request(controller::Request::Hold);
        see(&mut autopilot);
        autopilot.arm().unwrap();
        let mut station = Station::new(autopilot);
        fly(&mut station.autopilot, 1);
        for sequence in 2..1000 {
            if by_messages {
                // At 50 Hz.
                if sequence % 10 == 0 {
                    navigation(&start()).iter().for_each(|message| assert_eq!(station.say(message), []));
                }
            } else {
                station.autopilot.receive(&with_uav(sequence, false));
            }
            let answer = station.autopilot.tick();
            assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_NO_STATE));
            assert_eq!(station.autopilot.mode(), Mode::Hold, "{by_messages} {sequence}");
        }
        assert_eq!(station.news(), ["hold: no state"]);
        // And without either it sinks.
        for _ in 0..200 {
            station.autopilot.tick();
        }
        assert_eq!(station.autopilot.mode(), Mode::Fault);
    }
}

#[test]
fn an_attitude_that_is_no_rotation_is_no_navigation() {
    for q1 in [0.0, f32::NAN, 2.0] {
        let mut station = idle();
        let [place, ..] = navigation(&start());
        let attitude = ATTITUDE_QUATERNION_DATA { q1, ..ATTITUDE_QUATERNION_DATA::DEFAULT };
        station.say(&place);
        station.say(&MavMessage::ATTITUDE_QUATERNION(attitude));
        fly(&mut station.autopilot, 2);
        assert_eq!(station.command(MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 0.0).0, NOT_NOW, "{q1}");
    }
}

#[test]
fn take_off_and_landing_are_asked_for_as_ground_stations_do() {
    use MavCmd::{MAV_CMD_DO_SET_MODE, MAV_CMD_DO_SET_STANDARD_MODE, MAV_CMD_NAV_LAND, MAV_CMD_NAV_TAKEOFF};
    let take_offs =
        [(MAV_CMD_NAV_TAKEOFF, 0.0, 0.0), (MAV_CMD_DO_SET_STANDARD_MODE, 8.0, 0.0), (MAV_CMD_DO_SET_MODE, 1.0, 7.0)];
    let landings =
        [(MAV_CMD_NAV_LAND, 0.0, 0.0), (MAV_CMD_DO_SET_STANDARD_MODE, 7.0, 0.0), (MAV_CMD_DO_SET_MODE, 1.0, 5.0)];
    for ((off, a, b), (down, c, d)) in take_offs.into_iter().zip(landings) {
        let mut station = idle();
        assert_eq!(station.command(off, a, b), (ACCEPTED, vec![]));
        station.autopilot.receive(&with_uav(2, true));
        let answer = station.autopilot.tick();
        assert_eq!((station.autopilot.mode(), answer.command.mode), (Mode::TakeOff, LoadMode::LOAD_MODE_TAKEOFF));
        assert_eq!(station.news().last().unwrap(), "taking off");
        // Again is no fault.
        assert_eq!(station.command(off, a, b), (ACCEPTED, vec![]));
        assert_eq!(station.command(down, c, d), (ACCEPTED, vec![]));
        station.autopilot.receive(&with_uav(3, true));
        station.autopilot.tick();
        assert_eq!(station.autopilot.mode(), Mode::Land);
        assert_eq!(station.command(off, a, b), (NOT_NOW, vec!["in flight already".to_owned()]));
    }
    // Not armed, and with no navigation of its own.
    let mut station = Station::new(driven(0.0));
    let said = |words: &str| (NOT_NOW, vec![words.to_owned()]);
    assert_eq!(station.command(MAV_CMD_NAV_TAKEOFF, 0.0, 0.0), said("to take off, arm on the ground first"));
    assert_eq!(station.command(MAV_CMD_NAV_LAND, 0.0, 0.0), said("not in flight"));
    let mut station = idle();
    fly(&mut station.autopilot, 2);
    assert_eq!(station.command(MAV_CMD_NAV_TAKEOFF, 0.0, 0.0), said("take-off needs the UAV's own position"));
    assert_eq!(station.command(MAV_CMD_DO_SET_STANDARD_MODE, 6.0, 0.0).0, DENIED);
}

#[test]
fn whether_it_has_landed_is_true() {
    let [undefined, on_ground, in_air, taking_off, landing] = [0, 1, 2, 3, 4];
    let mut station = Station::new(Autopilot::new(Boot::default()));
    assert_eq!(landed(&station.autopilot), undefined);
    station = idle();
    assert_eq!(landed(&station.autopilot), on_ground);
    station.command(MavCmd::MAV_CMD_NAV_TAKEOFF, 0.0, 0.0);
    station.autopilot.receive(&with_uav(2, true));
    station.autopilot.tick();
    assert_eq!(landed(&station.autopilot), taking_off);
    station.command(MavCmd::MAV_CMD_NAV_LAND, 0.0, 0.0);
    station.autopilot.receive(&with_uav(3, true));
    station.autopilot.tick();
    assert_eq!(landed(&station.autopilot), landing);
    station.ask(LoadMode::LOAD_MODE_HOLD);
    station.autopilot.receive(&with_uav(4, true));
    station.autopilot.tick();
    assert_eq!(landed(&station.autopilot), in_air);
    // It falls.
    station.autopilot.disarm();
    assert_eq!(landed(&station.autopilot), undefined);
    // Disarmed on the ground it stands.
    station = idle();
    station.autopilot.disarm();
    assert_eq!(landed(&station.autopilot), on_ground);
    let replies = {
        let request = MavCmd::MAV_CMD_REQUEST_MESSAGE as u16;
        let ask = COMMAND_LONG_DATA { command: request, param1: 245.0, ..COMMAND_LONG_DATA::DEFAULT };
        station.say(&MavMessage::COMMAND_LONG(ask))
    };
    assert!(matches!(replies[0], MavMessage::EXTENDED_SYS_STATE(_)), "{replies:?}");
}

#[test]
fn lockstep_begins_on_the_ground() {
    let mut autopilot = driven(1.0);
    autopilot.arm().unwrap();
    // What is asked for before is for after.
    autopilot.request(controller::Request::Hold);
    let begin = LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_STAND, ..with_uav(1, true) };
    let answer = autopilot.lockstep(&begin);
    assert_eq!((autopilot.mode(), answer.command.faults), (Mode::Idle, LoadFault::empty()));
    autopilot.lockstep(&with_uav(2, true));
    assert_eq!(autopilot.mode(), Mode::TakeOff);
}

#[test]
fn without_a_state_it_is_not_known_whether_it_stands() {
    let mut autopilot = driven(1.0);
    autopilot.request(controller::Request::Hold);
    autopilot.arm().unwrap();
    // The UAV alone does not say it.
    let begin = LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_ENGAGE, ..with_uav(1, false) };
    assert_eq!(autopilot.lockstep(&begin).command.thrust, 0.0);
    autopilot.lockstep(&LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_ENGAGE, ..with_uav(2, true) });
    assert_eq!(autopilot.mode(), Mode::Hold);
}

#[test]
fn the_kill_pin_stops_the_rotors_and_keeps_them_so() {
    let mut station = idle();
    station.news();
    // A spike is no press.
    for is_high in [false, true, true, false, true, true] {
        station.autopilot.sense_kill_pin(is_high);
        assert!(station.autopilot.is_armed());
    }
    station.autopilot.sense_kill_pin(true);
    assert_eq!(fly(&mut station.autopilot, 2).outputs, [0.0; 4]);
    assert_eq!(station.news()[0], "rotors stopped by the kill switch");
    let arm = |station: &mut Station| station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(arm(&mut station), (NOT_NOW, vec!["not armed: the kill switch is on".to_owned()]));
    station.autopilot.sense_kill_pin(false);
    assert_eq!(arm(&mut station).0, ACCEPTED);
}

#[test]
fn more_load_than_the_rotors_lift_is_refused_in_words() {
    for (load, result) in [(1.0, ACCEPTED), (1.5, DENIED), (3.0, DENIED), (10.0, DENIED)] {
        let mut autopilot = driven(1.0);
        autopilot.settings_mut().unwrap().set_by_name("VEH_M_LOAD", load).unwrap();
        let said = Station::new(autopilot).command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        assert_eq!(said.0, result, "{load} kg: {:?}", said.1);
        assert_eq!(said.1.len(), usize::from(result == DENIED));
    }
}

#[test]
fn commands_with_a_place_have_to_be_sent_without() {
    let command = MavCmd::MAV_CMD_NAV_LAND as u16;
    let replies = idle().say(&MavMessage::COMMAND_INT(COMMAND_INT_DATA { command, ..COMMAND_INT_DATA::DEFAULT }));
    let [MavMessage::COMMAND_ACK(ack)] = &replies[..] else { panic!("{replies:?}") };
    assert_eq!((ack.command, ack.result), (command, MavResult::MAV_RESULT_COMMAND_LONG_ONLY as u8));
}

/// A request for an operation, and the answer's outcome and data.
fn transfer(station: &mut Station, operation: u8, offset: u32, data: &[u8]) -> Option<(u8, Vec<u8>)> {
    let mut payload = [0; 251];
    payload[..6].copy_from_slice(&[0xFF, 0xFF, 9, operation, data.len() as u8, 0]);
    payload[8..12].copy_from_slice(&offset.to_le_bytes());
    payload[12..12 + data.len()].copy_from_slice(data);
    let request = FILE_TRANSFER_PROTOCOL_DATA {
        target_system: 1,
        target_component: 1,
        payload,
        ..FILE_TRANSFER_PROTOCOL_DATA::DEFAULT
    };
    let replies = station.say(&MavMessage::FILE_TRANSFER_PROTOCOL(request));
    let [MavMessage::FILE_TRANSFER_PROTOCOL(answer)] = &replies[..] else {
        assert_eq!(replies, []);
        return None;
    };
    assert_eq!((answer.target_system, answer.target_component), link::STATION);
    // The next number, the same session, and of which operation it is.
    assert_eq!((&answer.payload[..3], answer.payload[5]), (&[0, 0, 9][..], operation));
    let length = usize::from(answer.payload[4]);
    Some((answer.payload[3], answer.payload[12..12 + length].to_vec()))
}

#[test]
fn every_request_for_a_file_is_answered_at_once() {
    let mut station = Station::new(driven(0.0));
    for operation in 0..=255_u8 {
        let answer = transfer(&mut station, operation, 0, b"/etc/passwd");
        let expected = match operation {
            128.. => None,
            // Closing what is not open is no fault.
            1 | 2 => Some((128, vec![])),
            5 | 15 => Some((129, vec![4])),
            3 | 4 | 14 => Some((129, vec![10])),
            _ => Some((129, vec![7])),
        };
        assert_eq!(answer, expected, "{operation}");
    }
    assert_eq!(texts(&station.messages()), Vec::<String>::new());
}

/// A file, as a ground station reads it.
fn fetched(station: &mut Station, name: &[u8], read: u8) -> Vec<u8> {
    let (_, length) = transfer(station, 4, 0, name).unwrap();
    let length = u32::from_le_bytes(length.try_into().unwrap()) as usize;
    let mut file = Vec::new();
    loop {
        match transfer(station, read, file.len() as u32, &[]).unwrap() {
            (128, data) => file.extend(data),
            end => {
                assert_eq!(end, (129, vec![6]));
                break;
            }
        }
    }
    assert_eq!(file.len(), length);
    transfer(station, 1, 0, &[]);
    file
}

#[test]
fn ground_stations_read_what_every_parameter_is() {
    let mut station = Station::new(driven(0.0));
    let command = MavCmd::MAV_CMD_REQUEST_MESSAGE as u16;
    let replies = station.say(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        command,
        param1: 397.0,
        ..COMMAND_LONG_DATA::DEFAULT
    }));
    let MavMessage::COMPONENT_METADATA(metadata) = &replies[0] else { panic!("{replies:?}") };
    assert_eq!(link::text_of(&*metadata.uri), "mftp:///general.json");
    let general = fetched(&mut station, b"/general.json", 15);
    let general: serde_json::Value = serde_json::from_slice(&general).expect("JSON");
    assert_eq!(general["metadataTypes"][0]["uri"], "mftp:///parameters.json");
    let (_, checksum) = transfer(&mut station, 14, 0, b"/parameters.json").unwrap();
    let checksum = u32::from_le_bytes(checksum.try_into().unwrap());
    assert_eq!(general["metadataTypes"][0]["fileCrc"], checksum);

    let file = fetched(&mut station, b"/parameters.json", 5);
    assert!(file == include_bytes!("../../docs/parameters.json"), "docs/parameters.json is not the table's");
    let file: serde_json::Value = serde_json::from_slice(&file).expect("JSON");
    let parameters = file["parameters"].as_array().unwrap();
    assert_eq!(parameters.len(), autopilot::Settings::COUNT);
    for (told, entry) in parameters.iter().zip(autopilot::entries()) {
        let name = entry.name.as_str();
        assert_eq!(told["name"], name);
        for (key, value) in [("default", entry.default), ("min", entry.min), ("max", entry.max)] {
            assert_eq!(told[key].as_f64().map(|number| number as f32), Some(value), "{name} {key}");
        }
        assert_eq!((told["units"].as_str(), told["shortDesc"].as_str()), (Some(entry.unit), Some(entry.text)));
    }
    let mut page = String::new();
    autopilot::metadata_page(&mut page).unwrap();
    assert!(page == include_str!("../../docs/parameters.md"), "docs/parameters.md is not the table's");
}
