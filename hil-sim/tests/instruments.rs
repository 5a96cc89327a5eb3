//! The flight program on the instruments of a simulated vehicle, over a line: as near to the path
//! as the same filters in the simulator, and told what the scenario says.

use std::io::{self, Read, Write};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use controller::Mode;
use hil_sim::describe::mission::Home;
use hil_sim::describe::scenario::{Scenario, builtin};
use hil_sim::fly::flight::{Control, End};
use hil_sim::fly::run::{Arithmetic, Flight, fly_on, fly_simply};
use hil_sim::hil::{Endpoint, Here, HilError, Options, Target, Wire};
use link::dialect::GPS_INPUT_DATA;
use link::{Decoder, MavMessage};

const TEXT: &str = include_str!("../scenarios/on-instruments.toml");

fn scenario(changes: &[(&str, &str)]) -> Scenario {
    let mut text = TEXT.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    Scenario::parse("on-instruments.toml", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn here() -> Target {
    Target::connect(Endpoint::Here, None, Options::default()).expect("it is in this program")
}

fn flown(scenario: &Scenario, mut target: Target) -> Flight {
    target.prepare(scenario).unwrap_or_else(|error| panic!("{error}"));
    let flight = fly_on(scenario, &mut target, false, Control::alone()).unwrap();
    assert_eq!(flight.end, End::Complete, "{:?}", target.take_failure());
    flight
}

/// By sixteen seeds d_C is 73 mm at most on the target and 70 mm in the simulator, 50 mm and 49 mm
/// in the median; rms of one flight differ by 8 mm at most, since rounding sets the two apart and
/// the receiver's own error is 2 cm.
#[test]
fn the_flight_program_follows_on_its_own_instruments_as_the_simulator_does() {
    for (name, navigation) in [("own", ""), ("other", "\nnavigation = \"other\"")] {
        let scenario = scenario(&[("[estimator]", &format!("[estimator]{navigation}"))]);
        let (there, run) = (flown(&scenario, here()), fly_simply(&scenario, Arithmetic::F32).unwrap());
        let [(most, rms), (run_most, run_rms)] =
            [&there, &run].map(|flight| (flight.results.dc_max_m.unwrap(), flight.results.dc_rms_m.unwrap()));
        println!("{name}: {most:.3} m at most, {rms:.3} m rms; run {run_most:.3} m, {run_rms:.3} m");
        assert!(
            most < 0.1 && (rms - run_rms).abs() < 0.012,
            "{name}: {most} m, {rms} m; run {run_most} m, {run_rms} m"
        );
        let mut modes: Vec<Mode> = there.log.iter().filter_map(|sample| Some(sample.decision?.mode)).collect();
        modes.dedup();
        let begun = if name == "own" { vec![Mode::Off, Mode::Idle] } else { vec![Mode::Idle] };
        let then = [Mode::TakeOff, Mode::Hold, Mode::Join, Mode::Follow];
        assert_eq!(modes, [&begun[..], &then].concat(), "{name}");
        // No state of the simulator's has gone there, nor does its own estimate stand in the log.
        assert!(there.log.iter().all(|sample| sample.seen.is_none()), "{name}");
    }
}

#[test]
fn one_that_flies_from_the_start_goes_by_anothers_navigation() {
    let scenario = Scenario::parse(
        "steady.toml",
        &include_str!("../scenarios/estimate.toml")
            .replace("[estimator]", "[estimator]\nnavigation = \"other\"")
            .replace("duration_s = 60.0", "duration_s = 40.0\nsteady_from_s = 25.0"),
    )
    .unwrap();
    let most = flown(&scenario, here()).results.dc_max_m.unwrap();
    assert!(most < 0.1, "{most} m");
}

#[test]
fn what_no_message_brings_is_refused_in_words() {
    let other = ("[estimator]", "[estimator]\nnavigation = \"other\"");
    for (changes, words) in [
        (
            vec![("initial = { position = [0.8, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }", "")],
            "begins at rest",
        ),
        (vec![("gnss = { part = \"rtk\" }", "")], "[sensors.gnss]"),
        (vec![("magnetometer = {}", "")], "[sensors.magnetometer]"),
        (vec![("barometer = {}", "mocap = {}")], "sensors.mocap"),
        (vec![other, ("barometer = {}", "mocap = {}")], "sensors.mocap.load"),
        (vec![("barometer = {}", "esc = {}")], "sensors.esc"),
        (vec![("[estimator]", "[estimator]\nstart = { rod = 0.1 }")], "estimator.start"),
        (vec![("[ground]", "timing = { missed = 0.1 }\n[ground]")], "timing"),
    ] {
        let refused = here().prepare(&scenario(&changes)).expect_err(words);
        assert!(matches!(&refused, HilError::Unsupported(why) if why.contains(words)), "{words}: {refused}");
    }
}

#[test]
fn the_filters_are_told_what_the_scenario_says() {
    let told = scenario(&[
        ("gnss = { part = \"rtk\" }", "gnss = { part = \"rtk\", delay_s = 0.15, lever = [0.1, -0.2, -0.3] }"),
        ("imu = {}", "imu = { lever = [0.01, 0.02, 0.03] }"),
        ("magnetometer = {}", "magnetometer = { declination = 0.2 }"),
        (
            "[estimator]",
            "[estimator]\nuav_drag_area = 0.07\nuav_rotor_drag = 0.3\nnoise = 1.5\nwind = 6.0\noffset = 0.03",
        ),
    ]);
    let mut target = here();
    target.prepare(&told).unwrap();
    for (name, value) in [
        ("EST_LOAD", 2.0),
        ("EST_FIX_AGE", 0.15),
        ("EST_ANT_X", 0.1),
        ("EST_ANT_Y", -0.2),
        ("EST_ANT_Z", -0.3),
        ("EST_IMU_Z", 0.03),
        ("EST_DECL", 0.2),
        ("EST_CDA_UAV", 0.07),
        ("EST_ROTOR_DRAG", 0.3),
        ("EST_NOISE", 1.5),
        ("EST_WIND", 6.0),
        ("EST_OFFSET", 0.03),
    ] {
        let kept = target.parameter(name).unwrap();
        assert!((kept - value).abs() <= value.abs() * 2.0 * f32::EPSILON, "{name}: {kept}");
    }
    // And of the next flight without an estimator it finds nothing by itself.
    target.prepare(&builtin("fig3a").unwrap().unwrap()).unwrap();
    assert_eq!(target.parameter("EST_LOAD").unwrap(), 0.0);
}

/// The program here behind a line that is listened to.
struct Tapped {
    here: Here,
    decoder: Decoder,
    heard: Arc<Mutex<Vec<GPS_INPUT_DATA>>>,
}

impl Read for Tapped {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.here.read(bytes)
    }
}

impl Write for Tapped {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for &byte in bytes {
            self.decoder.push(byte, |received| {
                if let Ok((MavMessage::GPS_INPUT(fix), _)) = received {
                    self.heard.lock().unwrap().push(fix);
                }
            });
        }
        self.here.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.here.flush()
    }
}

impl Wire for Tapped {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.here.set_patience(patience)
    }
}

#[test]
fn fixes_are_those_of_a_receiver_about_home() {
    let heard = Arc::default();
    let wire = Tapped { here: Here::new(), decoder: Decoder::new(), heard: Arc::clone(&heard) };
    let home = Home { latitude: -33.9, longitude: 18.4, altitude: 50.0 };
    let mut scenario = scenario(&[]);
    scenario.duration_s = 20.0;
    let flight = flown(&scenario, Target::over(Endpoint::Here, Box::new(wire), Options::default()).unwrap().at(home));
    let fixes = heard.lock().unwrap();
    // Ten a second, each a tenth of a second late.
    assert_eq!(fixes.len(), 199);
    let sensor = scenario.sensors.gnss.unwrap();
    let deviation = [0, 1].map(|i| sensor.position_noise[i].hypot(sensor.slow[i]));
    for fix in fixes.iter() {
        assert_eq!((fix.fix_type, fix.satellites_visible), (6, u8::MAX));
        let sample = flight.log.iter().min_by(|a, b| {
            let off = |t_s: f64| (t_s - fix.time_usec as f64 * 1e-6).abs();
            off(a.t_s).total_cmp(&off(b.t_s))
        });
        let at = sample.unwrap().uav_position;
        let altitude = f64::from(fix.alt);
        let [north, east] = home.local([fix.lat, fix.lon].map(|unit| f64::from(unit) * 1e-7), altitude);
        // Five deviations, half a unit of the message, and a step of the log at 2 m/s.
        let [across, down] = deviation.map(|deviation| 5.0 * deviation + 0.0056 + 0.01);
        assert!((north - at.x).abs() < across && (east - at.y).abs() < across, "{fix:?}: {north}, {east} of {at}");
        assert!((altitude - home.altitude + at.z).abs() < down, "{fix:?} of {at}");
    }
}

#[test]
fn navigation_that_can_not_begin_is_said() {
    let deaf = scenario(&[("part = \"rtk\"", "part = \"rtk\", drop_out = { at_s = 0.0, for_s = 60.0 }")]);
    let mut target = here();
    target.prepare(&deaf).unwrap();
    let flight = fly_on(&deaf, &mut target, false, Control::alone()).unwrap();
    assert!(matches!(flight.end, End::Unanswered(_)), "{:?}", flight.end);
    let said = target.take_failure().unwrap().to_string();
    assert!(said.contains("navigation has not begun"), "{said}");
}
