//! Calibration finds what a flight was made with, from its log alone.

use controller::State;
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::{Control, End};
use hil_sim::fly::judge::judge;
use hil_sim::report::log::{Format, ReadError, Record, Table, write};
use hil_sim::study::calibrate::{Found, Known, LogError, Sample, calibrate, read};
use hil_sim::study::campaign::{self, ApproachFields};
use hil_sim::world::Seed;
use std::path::Path;

/// What is hidden: thrust, areas, noise, cable, wind; the law is told otherwise.
const THRUST: f64 = 0.93;
const PAYLOAD_AREA: f64 = 0.04;
const UAV_AREA: f64 = 0.09;
const NOISE: f64 = 0.022;
const CABLE: f64 = 2.2;
const WIND: [f64; 2] = [1.2, -0.7];

fn scenario(name: &str, path: &str) -> Scenario {
    in_wind(name, path, WIND)
}

fn in_wind(name: &str, path: &str, wind: [f64; 2]) -> Scenario {
    let text = include_str!("../scenarios/estimate.toml")
        .replace("path = { kind = \"circle\", radius = 5.0, p3 = -10.0, speed = 1.0 }", path)
        .replace("[controller]", &format!("[vehicle]\nrod_length = {CABLE}\n\n[controller]\nvehicle = {{ rod_length = 2.2 }}"))
        .replace("[actuators]", &format!("[actuators]\nthrust_scale = {THRUST}"))
        .replace(
            "[environment.air]",
            &format!(
                "[environment.air]\nwind = [{}, {}, 0.0]\npayload_drag_area = {PAYLOAD_AREA}\nuav_drag_area = {UAV_AREA}",
                wind[0], wind[1]
            ),
        )
        .replace("imu = {}", &format!("imu = {{ accelerometer_noise = {NOISE} }}"));
    Scenario::parse(&format!("{name}.toml"), &text).unwrap()
}

/// The log of a flight under the supervised law, written and read, a line every 10 ms; `rod` is its
/// angle at the start, rad.
fn log(scenario: &Scenario, rod: f64) -> Vec<Sample> {
    let mut start = State::from_paper(&scenario.initial);
    start.rod = [libm::sin(rod), 0.0, libm::cos(rod)].into();
    let mut pilot = campaign::pilot(&scenario.controller, &ApproachFields::default()).unwrap();
    let mut records = Vec::new();
    let seed = Seed { batch: 5, run: 0 };
    let outcome = judge(scenario, start, seed, None, Control::alone(), &mut pilot, &mut |moment| {
        if moment.step % 5 == 0 {
            records.push(Record::of_moment(scenario, moment));
        }
    });
    assert_eq!(outcome.unwrap().end, End::Complete, "{}", scenario.name);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calibrate");
    std::fs::create_dir_all(&folder).unwrap();
    write(&folder, &Table::new(&scenario.name, "", &records), &[Format::Csv, Format::Ulog]).unwrap();
    let [csv, ulog] = ["csv", "ulg"]
        .map(|ending| read(&std::fs::read(folder.join(format!("{}.{ending}", scenario.name))).unwrap()).unwrap());
    assert_eq!(csv.len(), ulog.len());
    for (a, b) in csv.iter().zip(ulog) {
        // ULog counts microseconds.
        assert!((a.t_s - b.t_s).abs() < 0.6e-6, "{} and {} s", a.t_s, b.t_s);
        // CSV has the shortest digits of a single: the same numbers once they are one.
        let single = |s: &Sample| {
            [s.specific_force, s.uav_position, s.uav_velocity, s.position, s.velocity].map(|v| v.map(|x| x as f32))
        };
        assert_eq!((single(a), a.thrust as f32), (single(&b), b.thrust as f32));
        // Of a quaternion's four singles.
        assert!((a.attitude - b.attitude).amax() < 4.0 * f64::from(f32::EPSILON), "{} s", a.t_s);
    }
    csv
}

const KNOWN: Known = Known { uav_mass: 2.5, payload_mass: 0.5, gravity: 9.81, density: 1.225, imu_period_s: 0.002 };

fn number<'a>(found: &'a [Found], key: &str) -> &'a Found {
    found.iter().find(|found| found.key == key).unwrap()
}

#[test]
fn what_was_hidden_is_found() {
    let tilted = |speed: f64| {
        format!(
            "path = {{ kind = \"tilted\", center = [0.0, 0.0, -10.0], normal = [0.0, 0.34202, 0.93969], major = [1.0, \
             0.0, 0.0], a = 6.0, b = 6.0, speed = {speed:.1}, yaw = \"tangent\" }}"
        )
    };
    // The third lets the load swing from half a radian.
    let flights = [("slow", 1.0, 0.0), ("fast", 3.0, 0.0), ("swung", 0.5, 0.5)];
    let logs = flights.map(|(name, speed, rod)| log(&scenario(name, &tilted(speed)), rod));
    let found = calibrate(&logs, &KNOWN).unwrap();
    for line in &found {
        println!("{line}");
    }
    // Within four of its own deviations, and as near as its use asks: a quarter of drag wrong is
    // half a degree of rod.
    for (key, truth, share) in [
        ("actuators.thrust_scale", THRUST, 0.01),
        ("estimator.uav_drag_area", UAV_AREA, 0.2),
        ("estimator.payload_drag_area", PAYLOAD_AREA, 0.2),
        // What the vehicle itself shakes in two samples comes on top.
        ("estimator.accelerometer_noise", NOISE, 0.2),
    ] {
        let found = number(&found, key);
        let off = (found.value - truth).abs();
        assert!(off < share * truth, "{key}: {} for {truth}", found.value);
        assert!(off < 4.0 * found.deviation.max(0.25 * share * truth), "{key}: {found}");
        assert!(found.doubt.is_none(), "{found}");
    }
    // A law that damps the swing leaves little of it: a guess no better than it says, and the
    // advice to measure.
    let length = number(&found, "vehicle.rod_length");
    assert!((length.value - CABLE).abs() < 4.0 * length.deviation, "{length}");
    assert!(length.doubt.is_some_and(|doubt| doubt.contains("measure")), "{length}");
    // There is none, and it can't be told from none.
    assert!(number(&found, "estimator.uav_rotor_drag").doubt.is_some());
    for (key, truth) in [("wind[0]", WIND[0]), ("wind[1]", WIND[1])] {
        // A tenth of the speeds that drag acts at.
        assert!((number(&found, key).value - truth).abs() < 0.3, "{}", number(&found, key));
    }
}

#[test]
fn what_a_log_cannot_tell_is_said() {
    let path = "path = { kind = \"circle\", radius = 5.0, p3 = -10.0, speed = 0.5 }";
    let at_rest = in_wind("hover", path, [0.0; 2]);
    let found = calibrate(&[log(&at_rest, 0.0)], &KNOWN).unwrap();
    for line in &found {
        println!("{line}");
    }
    for key in ["estimator.uav_drag_area", "estimator.uav_rotor_drag", "vehicle.rod_length"] {
        assert!(number(&found, key).doubt.is_some(), "{}", number(&found, key));
    }
    assert!(number(&found, "actuators.thrust_scale").doubt.is_none());
}

#[test]
fn a_log_without_its_columns_is_refused_by_name() {
    let missing = |name| LogError::Read(ReadError::Missing(name));
    assert_eq!(read(b"t_s,att_w\n0,1\n"), Err(missing("att_x")));
    let error = missing("f1").to_string();
    assert!(error.contains("`f1`"), "{error}");
}
