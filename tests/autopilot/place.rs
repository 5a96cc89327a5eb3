//! Where a ground station draws the vehicle, and how it stands.

use autopilot::{Autopilot, Boot, Server};
use controller::{Matrix3, State, Vector3};
use hil_sim::world::random::{Purpose, Stream};
use link::MavMessage;
use link::dialect::*;

use crate::station::{Station, armed, driven, fly, frame_of, texts};

const HOME: SET_GPS_GLOBAL_ORIGIN_DATA = SET_GPS_GLOBAL_ORIGIN_DATA {
    latitude: 535_270_000,
    longitude: -1_135_290_000,
    altitude: 668_000,
    ..SET_GPS_GLOBAL_ORIGIN_DATA::DEFAULT
};

/// The bits of what it has to fly by.
fn health(autopilot: &Autopilot) -> MavSysStatusSensor {
    let MavMessage::SYS_STATUS(status) = Server::system_status(autopilot) else { panic!() };
    MavSysStatusSensor::from_bits(status.onboard_control_sensors_health).unwrap()
}

#[test]
fn a_place_on_the_earth_is_the_one_that_it_is_the_place_of() {
    for (seed, (latitude, longitude, altitude)) in
        [(53.527, -113.529, 668.0), (-0.1807, -78.4678, 2850.0), (-54.8, -68.3, 10.0), (60.0, 179.99, 0.0)]
            .into_iter()
            .enumerate()
    {
        let mut random = Stream::new(seed as u64, 0, Purpose::Draw);
        let home = link::Home { latitude, longitude, altitude };
        for _ in 0..200 {
            let [n1, n2] = [0; 2].map(|_| 3500.0 * (random.unit() * 2.0 - 1.0));
            let [lat, lon] = home.place([n1 as f32, n2 as f32]).map(|steps| f64::from(steps) * 1e-7);
            assert!(lat.abs() <= 90.0 && lon.abs() <= 180.0, "{lat}, {lon}");
            let [back1, back2] = home.local([lat, lon], altitude);
            // What it says, and half a step of each, 0.6 cm.
            let off = (back1 - n1).hypot(back2 - n2);
            assert!(off < 0.02 + 0.008, "{off} m off, {n1} and {n2} m from {latitude}, {longitude}");
        }
    }
}

#[test]
fn a_station_is_told_where_the_vehicle_is_ten_times_a_second() {
    // Yaw 120°, then pitch 10°, then roll −20°: R = Rz Ry Rx.
    let (roll, pitch, yaw) = (-20.0_f64.to_radians(), 10.0_f64.to_radians(), 120.0_f64.to_radians());
    let turn = |axis: usize, angle: f64| {
        let (s, c) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut turn = Matrix3::<f64>::identity();
        (turn[(i, i)], turn[(j, j)], turn[(i, j)], turn[(j, i)]) = (c, c, -s, s);
        turn
    };
    let attitude = turn(2, yaw) * turn(1, pitch) * turn(0, roll);
    let state = State {
        velocity: Vector3::new(3.0, -4.0, 0.5),
        attitude: attitude.map(|x| x as f32),
        ..State::at_rest(Vector3::new(100.0, -50.0, -10.0))
    };
    let mut station = Station::new(Autopilot::new(Boot::default()));
    let told = station.messages();
    assert!(matches!(&told[..], [MavMessage::GPS_RAW_INT(_)]), "there is nothing else to be told: {told:?}");
    assert!(health(&station.autopilot).is_empty());
    station.autopilot.receive(&frame_of(&state, 1));
    station.autopilot.tick();

    // Without a home, that is all.
    station.time_ns = 1_000_000_000;
    let told = station.messages();
    let [
        MavMessage::ATTITUDE(euler),
        MavMessage::LOCAL_POSITION_NED(local),
        MavMessage::VFR_HUD(_),
        MavMessage::GPS_RAW_INT(_),
    ] = &told[..]
    else {
        panic!("{told:?}")
    };
    for (told, is) in [(euler.roll, roll), (euler.pitch, pitch), (euler.yaw, yaw)] {
        // Rounding.
        assert!((f64::from(told) - is).abs() < 1e-6, "{told} {is}");
    }
    // The UAV's, a rod of 2 m above the load.
    assert_eq!([local.x, local.y, local.z, local.time_boot_ms as f32], [100.0, -50.0, -12.0, 1000.0]);
    assert!(!health(&station.autopilot).contains(MavSysStatusSensor::MAV_SYS_STATUS_SENSOR_GPS));
    station.say(&MavMessage::SET_GPS_GLOBAL_ORIGIN(HOME));
    assert!(health(&station.autopilot).is_all());

    station.time_ns += 99_000_000;
    assert!(station.messages().is_empty(), "too early");
    station.time_ns += 1_000_000;
    let told = station.messages();
    let [_, _, MavMessage::GLOBAL_POSITION_INT(global), MavMessage::VFR_HUD(hud)] = &told[..] else {
        panic!("{told:?}")
    };
    let home = link::Home { latitude: 53.527, longitude: -113.529, altitude: 668.0 };
    let [n1, n2] = home.local([f64::from(global.lat) * 1e-7, f64::from(global.lon) * 1e-7], 668.0);
    // Half a step of each.
    assert!((n1 - 100.0).hypot(n2 + 50.0) < 0.008, "{n1} {n2}");
    assert_eq!((global.alt, global.relative_alt, global.hdg / 10), (680_000, 12_000, 1_200));
    assert_eq!((global.vx, global.vy, global.vz), (300, -400, 50));
    // The frame's velocity is off by less than 7e-6.
    assert!((hud.groundspeed - 5.0).abs() < 1e-5, "{}", hud.groundspeed);
    assert_eq!((hud.alt, hud.climb, hud.throttle), (680.0, -0.5, 0));
}

/// What it tells of its receiver, half a second after the last time.
fn receiver(station: &mut Station) -> GPS_RAW_INT_DATA {
    station.time_ns += 499_000_000;
    assert_eq!(station.messages(), [], "too early");
    station.time_ns += 1_000_000;
    match &station.messages()[..] {
        [MavMessage::GPS_RAW_INT(fix)] => fix.clone(),
        told => panic!("{told:?}"),
    }
}

#[test]
fn a_station_is_told_what_the_receiver_says_twice_a_second() {
    let mut station = Station::new(Autopilot::new(Boot::default()));
    station.messages();
    let none = receiver(&mut station);
    // No GPS connected; all that is unknown by MAVLink's word for it.
    assert_eq!((none.fix_type, none.lat, none.lon, none.satellites_visible), (0, 0, 0, u8::MAX));
    assert_eq!([none.eph, none.epv, none.vel, none.cog], [u16::MAX; 4]);
    let said = GPS_INPUT_DATA {
        time_usec: 17,
        fix_type: 6,
        lat: 535_270_000,
        lon: -1_135_290_000,
        alt: 668.5,
        hdop: 0.7,
        vdop: 1.2,
        vn: 0.0,
        ve: -2.0,
        vd: 0.5,
        speed_accuracy: 0.05,
        horiz_accuracy: 0.012,
        vert_accuracy: 0.02,
        satellites_visible: 23,
        ..GPS_INPUT_DATA::DEFAULT
    };
    station.say(&MavMessage::GPS_INPUT(said.clone()));
    let fix = receiver(&mut station);
    assert_eq!((fix.time_usec, fix.fix_type, fix.satellites_visible), (17, 6, 23));
    assert_eq!((fix.lat, fix.lon, fix.alt), (535_270_000, -1_135_290_000, 668_500));
    // 2 m/s to the west.
    assert_eq!((fix.eph, fix.epv, fix.vel, fix.cog), (70, 120, 200, 27_000));
    assert_eq!((fix.h_acc, fix.v_acc, fix.vel_acc), (12, 20, 50));
    station.say(&MavMessage::GPS_INPUT(GPS_INPUT_DATA { ignore_flags: 2 | 4 | 8, ..said }));
    let fix = receiver(&mut station);
    assert_eq!([fix.eph, fix.epv, fix.vel, fix.cog], [u16::MAX; 4]);
    // A receiver of its own message, and one that looks for satellites.
    let raw = GPS_RAW_INT_DATA { fix_type: 1, satellites_visible: 3, ..GPS_RAW_INT_DATA::DEFAULT };
    station.say(&MavMessage::GPS_RAW_INT(raw.clone()));
    assert_eq!(receiver(&mut station), raw);
    // What a router brings back of its own is no receiver's.
    let own = MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA { fix_type: 3, ..raw.clone() });
    let bytes = link::Encoder::new(link::CONTROLLER).frame(&own).bytes().to_vec();
    station.hear(&bytes);
    assert_eq!(receiver(&mut station), raw);
    // Silent for a second and a half: a receiver without a fix.
    receiver(&mut station);
    receiver(&mut station);
    let silent = receiver(&mut station);
    assert_eq!((silent.fix_type, silent.satellites_visible), (1, u8::MAX));
}

/// A radio that several vehicles share: what others sense, and what a router brings back of this
/// one's, is nothing to fly by.
#[test]
fn only_its_own_sensors_are_flown_by() {
    let place =
        MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA { z: -3.0, ..LOCAL_POSITION_NED_DATA::DEFAULT });
    let turned =
        MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA { q1: 1.0, ..ATTITUDE_QUATERNION_DATA::DEFAULT });
    for (sender, is_flown_by) in [
        ((1, 1), false),
        ((2, 1), false),
        ((189, 1), false),
        ((1, 2), true),
        ((1, 191), true),
        (link::STATION, true),
        ((245, 190), true),
    ] {
        let mut station = Station::new(driven(0.0));
        let mut encoder = link::Encoder::new(sender);
        let mut said = Vec::new();
        for message in [&place, &turned, &place] {
            let bytes = encoder.frame(message).bytes().to_vec();
            said.extend(texts(&station.hear(&bytes).0));
        }
        station.autopilot.tick();
        let is_placed = station.messages().iter().any(|news| matches!(news, MavMessage::LOCAL_POSITION_NED(_)));
        assert_eq!(is_placed, is_flown_by, "{sender:?}");
        let (system, _) = sender;
        let warning = format!("sensors of system {system} not used: not this one's");
        let expected = if is_flown_by || system == 1 { vec![] } else { vec![warning] };
        assert_eq!(said, expected, "said once");
    }
}

#[test]
fn throttle_is_the_thrust_of_what_the_rotors_give() {
    let mut station = Station::new(armed(2.0));
    let answer = fly(&mut station.autopilot, 1);
    let hud = station.messages().into_iter().find_map(|message| match message {
        MavMessage::VFR_HUD(hud) => Some(hud),
        _ => None,
    });
    let get = |name| station.autopilot.settings().at(autopilot::Settings::index(name).unwrap()).unwrap().1;
    let most = 4.0 * get("ROT_KT") * get("ROT_W_MAX").powi(2);
    let percent = 100.0 * answer.command.thrust / most.min(get("LIM_T_MAX"));
    assert!((f32::from(hud.unwrap().throttle) - percent).abs() < 1.0, "{percent}");
}
