//! Flights on what the UAV itself measures: the simulator's world, its instruments as MAVLink's
//! messages, the flight program with its estimator, and its commands back to the world.

use autopilot::{Absence, ArmRefused, Autopilot, Boot, Setting, Settings, Unseen};
use controller::{Command, Mode, Request, Vector3};
use estimator::Validity;
use hil_sim::describe::parameters::parameters;
use hil_sim::describe::scenario::Scenario;
use hil_sim::world::random::{Purpose, Stream};
use hil_sim::world::sensors::gnss::{FixReading, Solution};
use hil_sim::world::{InstrumentModel, Readings, Seed, World};
use link::MavMessage;
use link::dialect::*;

use crate::station::Station;

const PERIOD_S: f64 = 0.002;

/// The paper's vehicle on the ground with its load beside it.
fn scenario(more: &str) -> Scenario {
    let text = format!(
        r#"
        duration_s = 90.0
        substeps = 1
        path = {{ kind = "circle", radius = 4.0, p3 = -6.0, speed = 1.0 }}
        initial = {{ position = [0.8, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }}
        [ground]
        [sensors]
        imu = {{}}
        gnss = {{ part = "rtk" }}
        magnetometer = {{}}
        barometer = {{}}
        [controller]
        law = "follow"
        rate_hz = 500.0
        rotor_lag_s = 0.03
        poles = [
            [-1.8, -3.6, -5.4, -7.2, -9.0, -10.8],
            [-1.8, -3.6, -5.4, -7.2, -9.0, -10.8],
            [-1.8, -3.6, -5.4, -7.2, -9.0],
            [-2.0, -3.0],
        ]
        observer = {{ payload = 8.0, rod = 8.0, torque = 16.0 }}
        limits = {{ thrust = [1.5, 60.0], torque = [3.0, 3.0, 3.0] }}
        [actuators]
        lag_s = 0.03
        [environment.air]
        {more}
        "#
    );
    Scenario::parse("estimate.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Where the messages' geography has its origin.
const PLACE: [f64; 2] = [47.0, 8.5];

/// Degrees and metres above the sea of a place in N, to the hundred-millionth as MAVLink has it.
fn gps_input(fix: &FixReading) -> MavMessage {
    // WGS 84's radii at the latitude, as in any textbook.
    let (a, e2) = (6_378_137.0, 6.694_379_990_14e-3);
    let sin = PLACE[0].to_radians().sin();
    let w = (1.0 - e2 * sin * sin).sqrt();
    let (meridian, normal) = (a * (1.0 - e2) / (w * w * w), a / w);
    let north = (fix.position.x / meridian).to_degrees();
    let east = (fix.position.y / (normal * PLACE[0].to_radians().cos())).to_degrees();
    let units = |degrees: f64| (degrees * 1e7).round() as i32;
    MavMessage::GPS_INPUT(GPS_INPUT_DATA {
        fix_type: 6,
        lat: units(PLACE[0] + north),
        lon: units(PLACE[1] + east),
        alt: (432.1 - fix.position.z) as f32,
        vn: fix.velocity.x as f32,
        ve: fix.velocity.y as f32,
        vd: fix.velocity.z as f32,
        speed_accuracy: fix.velocity_accuracy[0] as f32,
        horiz_accuracy: fix.position_accuracy[0] as f32,
        vert_accuracy: fix.position_accuracy[1] as f32,
        ..GPS_INPUT_DATA::DEFAULT
    })
}

/// The IMU of every period, with what else is new.
fn highres_imu(readings: &Readings) -> MavMessage {
    let [force, rate] = [readings.imu.specific_force, readings.imu.body_rate].map(|v| v.map(|x| x as f32));
    let field = readings.field.map_or_else(Vector3::zeros, |field| field.map(|x| x as f32));
    let bits = |is_new: bool, bits: u16| if is_new { bits } else { 0 };
    MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
        xacc: force.x,
        yacc: force.y,
        zacc: force.z,
        xgyro: rate.x,
        ygyro: rate.y,
        zgyro: rate.z,
        xmag: field.x,
        ymag: field.y,
        zmag: field.z,
        pressure_alt: readings.height.unwrap_or_default() as f32,
        fields_updated: 0b11_1111
            | bits(readings.field.is_some(), 0b111 << 6)
            | bits(readings.height.is_some(), 1 << 11),
        ..HIGHRES_IMU_DATA::DEFAULT
    })
}

/// Somebody else's navigation, as good as behind an RTK receiver: 1 cm, 3 cm/s, 0.3°.
fn navigation(world: &World, random: &mut Stream) -> [MavMessage; 2] {
    let (state, body) = (world.body().state(), world.body());
    let place = (body.uav_position() + random.normals() * 0.01).map(|x| x as f32);
    let velocity = (body.uav_velocity() + random.normals() * 0.03).map(|x| x as f32);
    let rate = state.body_rate.map(|x| x as f32);
    let turn = nalgebra::Rotation3::new(random.normals() * 0.005);
    let attitude = nalgebra::Rotation3::from_matrix_unchecked(state.attitude) * turn;
    let q = nalgebra::UnitQuaternion::from_rotation_matrix(&attitude);
    let [q1, q2, q3, q4] = [q.w, q.i, q.j, q.k].map(|part| part as f32);
    [
        MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
            x: place.x,
            y: place.y,
            z: place.z,
            vx: velocity.x,
            vy: velocity.y,
            vz: velocity.z,
            ..LOCAL_POSITION_NED_DATA::DEFAULT
        }),
        MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA {
            q1,
            q2,
            q3,
            q4,
            rollspeed: rate.x,
            pitchspeed: rate.y,
            yawspeed: rate.z,
            ..ATTITUDE_QUATERNION_DATA::DEFAULT
        }),
    ]
}

/// A world around a flight program.
struct Field {
    world: World,
    instruments: InstrumentModel,
    random: Stream,
    station: Station,
    scenario: Scenario,
    /// Of the flight program's N in the world's: where it is told to be, or where the first fix
    /// was.
    origin: Vector3<f64>,
    /// EST_LOAD.
    source: f32,
    step: u64,
    modes: Vec<Mode>,
    said: Vec<String>,
    /// Of the last command.
    faults: LoadFault,
    /// The receiver gives no fix any more.
    is_jammed: bool,
}

impl Field {
    fn new(scenario: Scenario, source: f32, run: u64) -> Self {
        let seed = Seed { batch: 77, run };
        let rig = parameters(&scenario.controller).expect("the table holds it").cast();
        let mut autopilot = Autopilot::with(Settings::from(rig), Boot::default());
        let settings = autopilot.settings_mut().expect("it is not armed");
        settings.set_by_name("EST_LOAD", source).unwrap();
        settings.set(Setting::TELEMETRY_EVERY, 0.0).unwrap();
        let start = controller::State::from_paper(&scenario.initial);
        let world = scenario.begin(&start, Command::zero(), seed);
        Self {
            origin: if source < 1.5 { Vector3::zeros() } else { world.body().uav_position() },
            world,
            instruments: InstrumentModel::new(&scenario.sensors, PERIOD_S, seed),
            random: seed.stream(Purpose::Told),
            station: Station::new(autopilot),
            scenario,
            source,
            step: 0,
            modes: vec![Mode::Off],
            said: Vec::new(),
            faults: LoadFault::empty(),
            is_jammed: false,
        }
    }

    /// For so long, `watch`ing each period's d_C.
    fn pass(&mut self, time_s: f64, watch: &mut dyn FnMut(f64)) {
        for _ in 0..(time_s / PERIOD_S).round() as u64 {
            let readings = self.instruments.read(&self.world);
            let mut messages = vec![highres_imu(&readings)];
            if let Some(fix) = readings.fix.as_ref().filter(|_| !self.is_jammed) {
                messages.push(gps_input(fix));
            }
            if self.source < 1.5 {
                // Places at 50 Hz, attitudes at 100 Hz.
                let [place, attitude] = navigation(&self.world, &mut self.random);
                let come = [(place, 10), (attitude, 5)];
                messages.extend(
                    come.into_iter()
                        .filter(|(_, every)| self.step.is_multiple_of(*every))
                        .map(|(message, _)| message),
                );
            }
            for message in &messages {
                assert_eq!(self.station.say(message), []);
            }
            let answer = self.station.autopilot.tick();
            self.faults = answer.command.faults;
            let mode = self.station.autopilot.mode();
            if self.modes.last() != Some(&mode) {
                self.modes.push(mode);
            }
            self.said.extend(self.station.news());
            let torque = answer.command.torque.map(f64::from);
            self.world.advance(&Command { thrust: answer.command.thrust.into(), torque: torque.into() });
            let place = self.world.body().state().position - self.origin;
            watch(self.scenario.controller.law.distance(place.into()));
            self.step += 1;
        }
    }

    fn ask(&mut self, request: Request) {
        self.station.autopilot.request(request);
    }

    /// From the ground to the path, and along it to the 45th second. Returns the largest d_C of the
    /// last ten seconds, m.
    fn take_off_and_follow(&mut self) -> f64 {
        self.pass(3.0, &mut |_| {});
        self.station.autopilot.arm().unwrap();
        self.pass(1.0, &mut |_| {});
        self.ask(Request::Follow);
        self.pass(31.0, &mut |_| {});
        let mut worst = 0.0_f64;
        self.pass(10.0, &mut |distance| worst = worst.max(distance));
        worst
    }
}

const GUSTS: &str = "wind = [3.0, 2.0, 0.0]\ngusts = { speed_at_6m = 3.0, height = 10.0 }";

/// Largest d_C on an estimate in gusts, m: half as much again as the worst of `hil-sim estimate`'s
/// sixteen flights, whose air is rougher and which begin on the path.
const ON_THE_PATH_M: f64 = 0.1;

#[test]
fn it_flies_from_the_ground_to_the_ground_with_nothing_that_sees_the_load() {
    for (source, run) in [(1.0, 1), (2.0, 2)] {
        let mut field = Field::new(scenario(GUSTS), source, run);
        let worst = field.take_off_and_follow();
        assert!(worst < ON_THE_PATH_M, "source {source}: {worst} m");
        field.ask(Request::Land);
        field.pass(40.0, &mut |_| {});
        let path =
            [Mode::Off, Mode::Idle, Mode::TakeOff, Mode::Hold, Mode::Join, Mode::Follow, Mode::Land, Mode::Off];
        assert_eq!(field.modes, path, "source {source}: {:?}", field.said);
        let words = [
            "idle",
            "taking off",
            "hold: rod not known yet",
            "hold",
            "joining the path",
            "on the path",
            "landing",
            "off",
        ];
        assert_eq!(field.said, words, "source {source}");
        let bodies = field.world.body().bodies();
        assert!(bodies.velocity.norm() < 0.01 && bodies.uav_velocity.norm() < 0.01, "{bodies:?}");
    }
}

#[test]
fn a_load_that_falls_off_is_held_without_and_landed_without() {
    let dropped = format!("{GUSTS}\n[cable]\nhooked = {{ at_s = 0.0, for_s = 45.0 }}");
    let mut field = Field::new(scenario(&dropped), 2.0, 3);
    field.take_off_and_follow();
    assert_eq!(field.modes.last(), Some(&Mode::Follow));
    let height = |field: &Field| -field.world.body().uav_position().z;
    let before = height(&field);
    field.pass(5.0, &mut |_| {});
    assert_eq!(field.modes.last(), Some(&Mode::Hold), "{:?}", field.said);
    // What was seen first, its loss or the slack cable, is said.
    let said = field.said.last().unwrap();
    assert!(["hold: cable slack", "hold: payload lost"].contains(&said.as_str()), "{said}");
    assert!((height(&field) - before).abs() < 2.0, "{before} {}", height(&field));
    field.ask(Request::Land);
    field.pass(40.0, &mut |_| {});
    assert_eq!(field.modes.last(), Some(&Mode::Off), "{:?}", field.said);
    assert!(field.world.body().bodies().uav_velocity.norm() < 0.01);
}

#[test]
fn a_receiver_that_is_silent_for_longer_than_it_may_be_is_said() {
    let mut field = Field::new(scenario(""), 2.0, 4);
    field.take_off_and_follow();
    field.is_jammed = true;
    field.pass(1.4, &mut |_| {});
    assert_eq!(field.said.last().unwrap(), "on the path");
    assert!(!field.faults.contains(LoadFault::LOAD_FAULT_NO_FIX));
    // After a second and a half it says so, and flies on.
    field.pass(0.3, &mut |_| {});
    assert_eq!(field.said.last().unwrap(), "no fix: position drifts");
    assert!(field.faults.contains(LoadFault::LOAD_FAULT_NO_FIX));
    field.pass(7.3, &mut |_| {});
    assert_eq!(field.modes.last(), Some(&Mode::Follow), "{:?}", field.said);
    field.pass(3.0, &mut |_| {});
    assert_eq!(field.said.last().unwrap(), "fault: no fix (EST_FIX_T)");
    // And with a fix again it holds.
    field.is_jammed = false;
    field.pass(0.5, &mut |_| {});
    assert_eq!(field.modes.last(), Some(&Mode::Hold), "{:?}", field.said);
    assert!(field.said.iter().any(|said| said == "fixes come again"), "{:?}", field.said);
    assert!(!field.faults.contains(LoadFault::LOAD_FAULT_NO_FIX));
}

#[test]
fn without_what_it_needs_it_does_not_arm() {
    for source in [1.0, 2.0] {
        let mut field = Field::new(scenario(""), source, 5);
        // Half a second is for levelling, and then comes the first fix.
        if source > 1.5 {
            field.pass(0.4, &mut |_| {});
        }
        let (why, words) = if source > 1.5 {
            (ArmRefused::Unseen(Unseen::Fix), "not armed: waits for a fix of the receiver")
        } else {
            (ArmRefused::NoState, "not armed: no good state just now")
        };
        assert_eq!(field.station.autopilot.arm(), Err(why), "source {source}");
        let (_, said) = field.station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        assert_eq!(said, [words], "source {source}");
        field.pass(1.0, &mut |_| {});
        assert_eq!(field.station.autopilot.arm(), Ok(()));
    }
    // A number that the filters refuse is named: a control period of 20 ms.
    let mut autopilot = Autopilot::new(Boot::default());
    for (name, value) in [("EST_LOAD", 2.0), ("CTL_PERIOD", 0.02)] {
        autopilot.settings_mut().unwrap().set_by_name(name, value).unwrap();
    }
    autopilot.tick();
    let refused = autopilot.arm().unwrap_err().to_string();
    assert!(refused.contains("period = 0.02"), "{refused}");
}

#[test]
fn a_state_of_the_load_that_is_sent_goes_first() {
    let mut field = Field::new(scenario(""), 1.0, 6);
    field.pass(1.0, &mut |_| {});
    let autopilot = &mut field.station.autopilot;
    autopilot.request(Request::Hold);
    autopilot.arm().unwrap();
    autopilot.receive(&crate::station::frame(1));
    autopilot.tick();
    // It is in flight by the state, and not where the messages have the UAV.
    assert_eq!(autopilot.mode(), Mode::Hold);
    assert_eq!(autopilot.absence(), None);
    autopilot.tick();
    assert_eq!(autopilot.absence(), Some(Absence::Unseen(Unseen::Rod(Validity::Converging))));
}

/// A receiver 30 m north, 40 m west and 5 m above the place, and whose fix that is.
fn fix_aside() -> MavMessage {
    let aside = Vector3::new(30.0, -40.0, -5.0);
    let fix = FixReading {
        position: aside,
        velocity: Vector3::zeros(),
        position_accuracy: [0.01, 0.016],
        velocity_accuracy: [0.03, 0.05],
        age: 0.1,
        solution: Solution::Fixed,
    };
    gps_input(&fix)
}

#[test]
fn n_has_its_origin_at_home_and_without_one_at_the_first_fix() {
    for has_home in [true, false] {
        let mut autopilot = Autopilot::new(Boot::default());
        let settings = autopilot.settings_mut().unwrap();
        settings.set_by_name("EST_LOAD", 2.0).unwrap();
        let mut station = Station::new(autopilot);
        if has_home {
            let [latitude, longitude] = PLACE.map(|degrees| (degrees * 1e7).round() as i32);
            let origin = SET_GPS_GLOBAL_ORIGIN_DATA {
                latitude,
                longitude,
                altitude: 432_100,
                target_system: 1,
                ..SET_GPS_GLOBAL_ORIGIN_DATA::DEFAULT
            };
            station.say(&MavMessage::SET_GPS_GLOBAL_ORIGIN(origin));
        }
        // Level, with the field to the north.
        for _ in 0..300 {
            station.say(&MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
                zacc: -9.81,
                xmag: 0.4,
                zmag: 0.8,
                fields_updated: 0b1_1111_1111,
                ..HIGHRES_IMU_DATA::DEFAULT
            }));
            station.say(&fix_aside());
            station.autopilot.tick();
        }
        let place = station.autopilot.uav().expect("navigation has begun").position;
        let wanted = if has_home { Vector3::new(30.0, -40.0, -5.0) } else { Vector3::zeros() };
        // A unit of the message is 1.1 cm, and home's height above the ellipsoid 7e-5 of a length.
        assert!((place - wanted).amax() < 0.02, "{place}");
    }
}

#[test]
fn home_is_at_the_first_fix_until_one_is_told() {
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.settings_mut().unwrap().set_by_name("EST_LOAD", 2.0).unwrap();
    let mut station = Station::new(autopilot);
    let level = |station: &mut Station, aside: &MavMessage| {
        for _ in 0..300 {
            station.say(&MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
                zacc: -9.81,
                xmag: 0.4,
                zmag: 0.8,
                fields_updated: 0b1_1111_1111,
                ..HIGHRES_IMU_DATA::DEFAULT
            }));
            station.say(aside);
            station.autopilot.tick();
        }
    };
    let place = |station: &mut Station| {
        station.time_ns += 1_000_000_000;
        station.messages().into_iter().find_map(|message| match message {
            MavMessage::GLOBAL_POSITION_INT(global) => {
                Some(([global.lat, global.lon, global.alt], global.relative_alt))
            }
            _ => None,
        })
    };
    let MavMessage::GPS_INPUT(fix) = fix_aside() else { panic!() };
    let at = [fix.lat, fix.lon, (fix.alt * 1e3).round() as i32];
    let home = |messages: Vec<MavMessage>| {
        let homes = messages.into_iter().filter_map(|message| match message {
            MavMessage::HOME_POSITION(home) => Some([home.latitude, home.longitude, home.altitude]),
            _ => None,
        });
        homes.collect::<Vec<_>>()
    };
    station.say(&fix_aside());
    // A float of 437.1 m has steps of 0.03 mm.
    assert_eq!(home(station.messages()), [at]);
    assert_eq!(home(station.messages()), [[0; 3]; 0]);
    level(&mut station, &fix_aside());
    let (found, above) = place(&mut station).expect("the UAV is somewhere");
    // The filter is at rest where its fixes are, to a step of 1.1 cm.
    assert!(found.iter().zip(at).all(|(found, at)| found.abs_diff(at) <= 1), "{found:?} {at:?}");
    assert!(above.abs() <= 1, "{above}");

    // A height above home, 10 m east, as COMMAND_INT has it; and in no frame that it knows.
    let set = |station: &mut Station, param1: f32, frame: MavFrame, [x, y]: [i32; 2], z: f32| {
        let command = MavCmd::MAV_CMD_DO_SET_HOME as u16;
        let frame = frame as u8;
        let request = COMMAND_INT_DATA { command, param1, frame, x, y, z, ..COMMAND_INT_DATA::DEFAULT };
        let replies = station.say(&MavMessage::COMMAND_INT(request));
        let result = replies.iter().find_map(|reply| match reply {
            MavMessage::COMMAND_ACK(ack) => Some(ack.result),
            _ => None,
        });
        (result.expect("it is acknowledged"), home(replies))
    };
    let aside = [at[0] + 1000, at[1] + 1000];
    let denied = (MavResult::MAV_RESULT_DENIED as u8, vec![]);
    let accepted = |home: [i32; 3]| (MavResult::MAV_RESULT_ACCEPTED as u8, vec![home]);
    assert_eq!(set(&mut station, 0.0, MavFrame::MAV_FRAME_LOCAL_NED, aside, 0.0), denied);
    assert_eq!(set(&mut station, 2.0, MavFrame::MAV_FRAME_GLOBAL_INT, aside, 0.0), denied);
    assert_eq!(set(&mut station, 0.0, MavFrame::MAV_FRAME_GLOBAL_INT, aside, f32::NAN), denied);
    let told = [aside[0], aside[1], 400_000];
    assert_eq!(set(&mut station, 0.0, MavFrame::MAV_FRAME_GLOBAL_INT, aside, 400.0), accepted(told));
    // Told, it is not found again.
    level(&mut station, &fix_aside());
    assert_eq!(home(station.messages()), [[0; 3]; 0]);
    let (found, above) = place(&mut station).expect("the UAV is somewhere");
    assert!(found.iter().zip(at).all(|(found, at)| found.abs_diff(at) <= 2), "{found:?} {at:?}");
    assert!((above - (at[2] - 400_000)).abs() <= 2, "{above}");
    let higher = [aside[0], aside[1], 402_500];
    assert_eq!(set(&mut station, 0.0, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, aside, 2.5), accepted(higher));
    // Here; what has to be found again first is nowhere.
    level(&mut station, &fix_aside());
    let (result, homes) = set(&mut station, 1.0, MavFrame::MAV_FRAME_GLOBAL, [0; 2], 0.0);
    assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED as u8);
    assert!(homes[0].iter().zip(at).all(|(home, at)| home.abs_diff(at) <= 2), "{homes:?} {at:?}");
    // Another's navigation has its own origin, and no home but what is told.
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.settings_mut().unwrap().set_by_name("EST_LOAD", 2.0).unwrap();
    let mut station = Station::new(autopilot);
    station.say(&fix_aside());
    assert!(station.autopilot.mission().home().is_some());
    station.autopilot.settings_mut().unwrap().set_by_name("EST_LOAD", 1.0).unwrap();
    station.say(&fix_aside());
    assert_eq!(station.autopilot.mission().home(), None);
    assert_eq!(set(&mut station, 1.0, MavFrame::MAV_FRAME_GLOBAL, [0; 2], 0.0), denied);
    assert_eq!(set(&mut station, 0.0, MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, aside, 0.0), denied);
}

#[test]
fn what_a_line_brings_twice_counts_once() {
    let moved = |repeats: usize| {
        let mut field = Field::new(scenario(""), 2.0, 7);
        field.pass(1.0, &mut |_| {});
        for step in 0..50_u64 {
            let mut said = vec![MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
                time_usec: 1 + 2_000 * step,
                // Another one each time: twice the one would shift the mean.
                xacc: 0.01 * step as f32,
                zacc: -9.81,
                fields_updated: 0b11_1111,
                ..HIGHRES_IMU_DATA::DEFAULT
            })];
            if step.is_multiple_of(10) {
                let MavMessage::GPS_INPUT(fix) = fix_aside() else { unreachable!() };
                said.push(MavMessage::GPS_INPUT(GPS_INPUT_DATA { time_usec: 1 + 2_000 * step, ..fix }));
            }
            for message in &said {
                field.station.say(message);
            }
            field.station.autopilot.tick();
            // The answer was lost, and all of it comes again.
            (0..repeats).for_each(|_| said.iter().for_each(|message| drop(field.station.say(message))));
        }
        let uav = field.station.autopilot.uav().expect("navigation has begun");
        uav.position.map(f32::to_bits)
    };
    assert_eq!(moved(1), moved(0));
}

#[test]
fn odometry_is_position_and_attitude_in_one() {
    let q = [0.8_f32.sqrt(), 0.0, 0.0, 0.2_f32.sqrt()];
    let place = LOCAL_POSITION_NED_DATA {
        x: 1.0,
        y: 2.0,
        z: -3.0,
        vx: 0.6,
        vy: 0.8,
        vz: 0.1,
        ..LOCAL_POSITION_NED_DATA::DEFAULT
    };
    let attitude =
        ATTITUDE_QUATERNION_DATA { q1: q[0], q4: q[3], yawspeed: 0.2, ..ATTITUDE_QUATERNION_DATA::DEFAULT };
    // The same velocity along the body's axes: yaw is twice the quaternion's angle, cosine 0.6.
    let odometry = |frame_id, child_frame_id, [vx, vy]: [f32; 2]| {
        MavMessage::ODOMETRY(ODOMETRY_DATA {
            frame_id,
            child_frame_id,
            x: 1.0,
            y: 2.0,
            z: -3.0,
            q,
            vx,
            vy,
            vz: 0.1,
            yawspeed: 0.2,
            ..ODOMETRY_DATA::DEFAULT
        })
    };
    let held = |messages: &[MavMessage]| {
        let mut station = Station::new(crate::station::driven(0.0));
        station.autopilot.request(Request::Hold);
        crate::station::arm(&mut station.autopilot);
        crate::station::fly(&mut station.autopilot, 1);
        messages.iter().for_each(|message| assert_eq!(station.say(message), []));
        (0..60).map(|_| station.autopilot.tick()).last().unwrap()
    };
    let expected = held(&[MavMessage::LOCAL_POSITION_NED(place), MavMessage::ATTITUDE_QUATERNION(attitude)]);
    assert_eq!(expected.command.mode, LoadMode::LOAD_MODE_HOLD);
    assert_eq!(held(&[odometry(1, 1, [0.6, 0.8])]), expected);
    let body = held(&[odometry(1, 12, [1.0, 0.0])]);
    assert!((body.command.thrust - expected.command.thrust).abs() < 1e-4, "{body:?} {expected:?}");
    // In a frame that is not N it is none, and the vehicle sinks.
    assert_eq!(held(&[odometry(20, 12, [1.0, 0.0])]).command.mode, LoadMode::LOAD_MODE_FAULT);
}
