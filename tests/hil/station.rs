//! A ground station commands a vehicle of this program's: what it says reaches the flight program,
//! and what that says reaches it.

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use controller::Mode;
use hil_sim::describe::mission::Home;
use hil_sim::describe::scenario::{FIGURES, STATION, Scenario};
use hil_sim::fly::flight::{Control, End};
use hil_sim::fly::run;
use hil_sim::hil::{Endpoint, Options, Pace, Station, Target};
use link::dialect::*;
use link::{Decoder, Encoder, MavMessage};

use crate::common::{OPTIONS, fly_here, fly_there, scenario};

/// Time of the flight, s: the station's heartbeat comes once a second.
const FLOWN_S: f64 = 3.0;

/// What a station hears until nothing has come for a second; it arms the vehicle when it first
/// hears of it.
fn attend(socket: &UdpSocket) -> Vec<MavMessage> {
    socket.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
    let (mut decoder, mut encoder) = (Decoder::new(), Encoder::new((255, 230)));
    let mut heard = Vec::new();
    let begun = Instant::now();
    let mut bytes = [0; 2048];
    while begun.elapsed() < Duration::from_secs(60) {
        let Ok((count, from)) = socket.recv_from(&mut bytes) else {
            if heard.is_empty() {
                continue;
            }
            break;
        };
        if heard.is_empty() {
            let arm = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
                param1: 1.0,
                command: MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16,
                target_system: 1,
                target_component: 1,
                ..COMMAND_LONG_DATA::DEFAULT
            });
            socket.send_to(encoder.frame(&arm).bytes(), from).unwrap();
        }
        for &byte in &bytes[..count] {
            decoder.push(byte, |received| heard.push(received.expect("whole frames").0));
        }
    }
    heard
}

#[test]
fn a_ground_station_arms_a_vehicle_that_nothing_else_commands() {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let station = Station::open(&socket.local_addr().unwrap().to_string()).unwrap();
    let attended = std::thread::spawn(move || attend(&socket));
    let scenario = scenario(STATION, FLOWN_S);
    let home = Home { latitude: -33.9, longitude: 18.4, altitude: 50.0 };
    let options = Options { pace: Pace::RealTime, ..OPTIONS };
    let mut target = Target::connect(Endpoint::Here, None, options).unwrap().at(home);
    target.leave_to(station, &scenario).unwrap();
    let begun = Instant::now();
    let flight = run::fly_watched(&scenario, &mut target, false, Control::alone(), &mut |_| {}).unwrap();
    assert_eq!(flight.end, End::Complete);
    assert!(begun.elapsed().as_secs_f64() > FLOWN_S - 0.01, "it goes by the clock on the wall");
    // Armed, it idles: nobody has asked for more, whatever the scenario's requests are.
    let modes: Vec<Mode> = flight.log.iter().filter_map(|sample| Some(sample.decision?.mode)).collect();
    assert_eq!((modes.first(), modes.last()), (Some(&Mode::Off), Some(&Mode::Idle)));

    let heard = attended.join().unwrap();
    let has = |accept: &dyn Fn(&MavMessage) -> bool| heard.iter().any(accept);
    assert!(has(&|message| matches!(message, MavMessage::COMMAND_ACK(ack) if ack.command == 400 && ack.result == 0)));
    let armed = MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED as u8;
    assert!(has(&|message| matches!(message, MavMessage::HEARTBEAT(beat) if beat.base_mode & armed != 0)));
    // The UAV stands at home, to its receiver's errors of 1 cm and 2 cm and the step of 1 cm; 0.15 m
    // is the height of its feet.
    let place = heard.iter().find_map(|message| match message {
        MavMessage::GLOBAL_POSITION_INT(place) => Some(place),
        _ => None,
    });
    let place = place.expect("it is told where it is");
    assert!((place.lat + 339_000_000).abs() < 15 && (place.lon - 184_000_000).abs() < 15, "{place:?}");
    assert!((place.alt - 50_150).abs() < 150, "{place:?}");
    assert!(!has(&|message| matches!(message, MavMessage::LOAD_COMMAND(_))), "what rotors alone need");
    // Its receiver's fix, twice a second, from when there is one.
    let fixes: Vec<_> = fixes(&heard).collect();
    assert!(fixes.len() >= FLOWN_S as usize, "{} fixes", fixes.len());
    let last = fixes.last().unwrap();
    assert_eq!((last.fix_type, last.satellites_visible), (6, u8::MAX), "{last:?}");
    assert!((last.lat + 339_000_000).abs() < 15 && (last.lon - 184_000_000).abs() < 15, "{last:?}");
    assert!((last.alt - 50_150).abs() < 150 && last.h_acc == 10, "{last:?}");
}

/// What is told of the receiver.
fn fixes(heard: &[MavMessage]) -> impl Iterator<Item = &GPS_RAW_INT_DATA> {
    heard.iter().filter_map(|message| match message {
        MavMessage::GPS_RAW_INT(fix) => Some(fix),
        _ => None,
    })
}

#[test]
fn without_a_receiver_a_station_is_told_that_there_is_none() {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let station = Station::open(&socket.local_addr().unwrap().to_string()).unwrap();
    let attended = std::thread::spawn(move || attend(&socket));
    let scenario = Scenario { estimator: None, ..scenario(STATION, 2.0) };
    let options = Options { pace: Pace::RealTime, ..OPTIONS };
    let mut target = Target::connect(Endpoint::Here, None, options).unwrap();
    target.leave_to(station, &scenario).unwrap();
    run::fly_watched(&scenario, &mut target, false, Control::alone(), &mut |_| {}).unwrap();
    let heard = attended.join().unwrap();
    assert!(fixes(&heard).count() >= 2);
    assert!(fixes(&heard).all(|fix| (fix.fix_type, fix.lat, fix.lon) == (0, 0, 0)));
    // Where it is it knows all the same.
    assert!(heard.iter().any(|message| matches!(message, MavMessage::GLOBAL_POSITION_INT(_))));
}

#[test]
fn a_flight_on_the_program_here_is_the_same() {
    let mut target = Target::connect(Endpoint::Here, None, OPTIONS).unwrap();
    for (name, _) in FIGURES {
        let scenario = scenario(name, 0.5);
        let (commands, back) = fly_there(&scenario, target);
        assert_eq!(commands.unwrap(), fly_here(&scenario), "{name}");
        target = back;
    }
}
