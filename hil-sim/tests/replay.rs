//! Logs through estimator and law again: our own say what was flown, and PX4's are enough.

use hil_sim::describe::scenario::{Scenario, builtin};
use hil_sim::fly::batch::Outcome;
use hil_sim::fly::run::{Arithmetic, fly_simply};
use hil_sim::report::log::{Format, Record, Table, write};
use hil_sim::study::replay::{Part, ReplayError, Replayed, replay};
use std::path::PathBuf;

/// A flight of `scenario` as a log of this `ending`, and its table.
fn flown(scenario: &Scenario, format: Format, ending: &str) -> (Vec<u8>, Table) {
    let flight = fly_simply(scenario, Arithmetic::F32).unwrap();
    let outcome = Outcome { scenario: scenario.clone(), flight };
    let table = Table::new(&scenario.name, &scenario.title, &Record::of_flight(&outcome));
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("replay");
    std::fs::create_dir_all(&folder).unwrap();
    write(&folder, &table, &[format]).unwrap();
    (std::fs::read(folder.join(format!("{}.{ending}", scenario.name))).unwrap(), table)
}

/// The built-in scenario, for 8 s, logged every `log_period_s` or period.
fn scenario(name: &str, log_period_s: f64) -> Scenario {
    let scenario = builtin(name).unwrap().unwrap();
    Scenario { name: format!("{name}-{}", 1e3 * log_period_s), duration_s: 8.0, log_period_s, ..scenario }
}

/// On the estimate: RTK, rotors of 30 ms.
fn estimated(log_period_s: f64) -> Scenario {
    let text = include_str!("../scenarios/estimate.toml");
    let scenario = Scenario::parse("estimate.toml", text).unwrap();
    Scenario { name: format!("estimate-{}", 1e3 * log_period_s), duration_s: 40.0, log_period_s, ..scenario }
}

fn replayed(scenario: &Scenario, bytes: &[u8]) -> Replayed {
    let outcome = replay(scenario.clone(), bytes, &Part::default()).unwrap();
    outcome.flight.replayed.unwrap()
}

/// An obstacle, integral action with a wrong mass, and a law that tracks are among them.
#[test]
fn a_log_of_every_period_gives_the_commands_that_were_flown() {
    for (name, format, ending) in [
        ("fig3a", Format::Csv, "csv"),
        ("fig2a", Format::Ulog, "ulg"),
        ("fig2b", Format::Csv, "csv"),
        ("fig5", Format::Ulog, "ulg"),
        ("tilted-circle", Format::Csv, "csv"),
    ] {
        let scenario = scenario(name, 0.0);
        let (bytes, _) = flown(&scenario, format, ending);
        let Replayed { thrust_n, torque_nm, load_m, .. } = replayed(&scenario, &bytes);
        let (thrust, torque) = (thrust_n.unwrap().max, torque_nm.unwrap().max);
        // The log has positions in single precision, from which the rod is taken: of 12 m that is
        // half a micrometre, and 2⁻²⁴ of 30 N a few millionths of a newton. A hundred of these.
        assert!(thrust < 2e-4 && torque < 2e-4, "{name}: {thrust} N, {torque} N m");
        // Without an accelerometer there is no estimate.
        assert_eq!(load_m, None);
    }
}

#[test]
fn between_the_rows_of_a_coarse_log_hardly_anything_is_lost() {
    for name in ["fig3a", "tilted-circle"] {
        let scenario = scenario(name, 0.02);
        let (bytes, _) = flown(&scenario, Format::Csv, "csv");
        let Replayed { thrust_n, torque_nm, .. } = replayed(&scenario, &bytes);
        let (thrust, torque) = (thrust_n.unwrap().max, torque_nm.unwrap().max);
        // Between rows 20 ms apart a line is off by h²/8 of the second derivative: of rates that
        // turn at 10 rad/s³, 0.5 mrad/s.
        assert!(thrust < 1e-3 && torque < 0.01, "{name}: {thrust} N, {torque} N m");
    }
}

#[test]
fn the_estimate_is_replayed_from_the_motion_of_the_uav() {
    let scenario = estimated(0.01);
    let (bytes, _) = flown(&scenario, Format::Ulog, "ulg");
    let outcome = replay(scenario, &bytes, &Part { from_s: Some(10.0), ..Part::default() }).unwrap();
    let found = outcome.flight.replayed.unwrap();
    assert_eq!((found.given, found.unsaid.len()), ("the estimate", 0));
    // Readings of 2 ms every 10 ms, and a rod that was told to hang: some degrees until it is
    // found, then what a filter knows of a load whose wind it has to find.
    assert!(found.rod_deg.unwrap().rms < 3.0, "{found:?}");
    for sample in outcome.flight.log.iter().filter(|sample| sample.t_s > 10.0 && sample.logged.is_some()) {
        let (seen, x) = (sample.seen.unwrap(), &sample.x);
        let apart = seen.position - controller::Vector3::new(x[0], x[1], x[2]);
        assert!(apart.dot(&apart).sqrt() < 0.1, "{} s: {apart:?}", sample.t_s);
    }
    assert!(outcome.flight.log.first().unwrap().logged.is_some());
}

fn message(kind: u8, parts: &[&[u8]]) -> Vec<u8> {
    let body = parts.concat();
    [&(body.len() as u16).to_le_bytes()[..], &[kind], &body].concat()
}

/// What PX4 would have logged of the flight in `table` on an airframe whose rotors give
/// `full_thrust` (N) at most: its topics at rates of their own, from 12 s after boot.
fn px4(table: &Table, full_thrust: f32, leave_out: &[&str]) -> Vec<u8> {
    type Field<'a> = (&'a [&'a str], f32);
    let topics: [(&str, &str, usize, &[Field<'_>]); 5] = [
        (
            "vehicle_local_position",
            "uint64_t timestamp_sample;float x;float y;float z;float vx;float vy;float vz;bool xy_valid;uint8_t[7] _padding0;",
            10,
            &[(&["uav_p1", "uav_p2", "uav_p3", "uav_v1", "uav_v2", "uav_v3"], 1.0)],
        ),
        (
            "vehicle_attitude",
            "uint64_t timestamp_sample;float[4] q;",
            5,
            &[(&["att_w", "att_x", "att_y", "att_z"], 1.0)],
        ),
        (
            "vehicle_angular_velocity",
            "uint64_t timestamp_sample;float[3] xyz;",
            4,
            &[(&["omega1", "omega2", "omega3"], 1.0)],
        ),
        (
            "sensor_combined",
            "float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;",
            1,
            &[(&["omega1", "omega2", "omega3"], 1.0), (&["", ""], 1.0), (&["f1", "f2", "f3"], 1.0)],
        ),
        (
            "vehicle_thrust_setpoint",
            "uint64_t timestamp_sample;float[3] xyz;",
            1,
            &[(&["", ""], 1.0), (&["thrust"], -1.0 / full_thrust)],
        ),
    ];
    let topics = topics.iter().filter(|(name, ..)| !leave_out.contains(name));
    let mut file = b"ULog\x01\x12\x35\x01".to_vec();
    file.extend(12_000_000_u64.to_le_bytes());
    for (name, fields, ..) in topics.clone() {
        file.extend(message(b'F', &[format!("{name}:uint64_t timestamp;{fields}").as_bytes()]));
    }
    for (id, (name, ..)) in (0_u16..).zip(topics.clone()) {
        file.extend(message(b'A', &[&[0], &id.to_le_bytes(), name.as_bytes()]));
    }
    // The last row has no command.
    for row in 0..table.t_s.len() - 1 {
        for (id, (_, fields, every, columns)) in (0_u16..).zip(topics.clone()) {
            if row % every == 0 {
                let mut data = (12_000_000 + table.microseconds(row)).to_le_bytes().to_vec();
                if fields.starts_with("uint64_t timestamp_sample") {
                    data.extend_from_within(..);
                }
                for (names, scale) in *columns {
                    for name in *names {
                        data.extend((table.numbers(name).map_or(0.0, |numbers| numbers[row]) * scale).to_le_bytes());
                    }
                }
                data.resize(data.len() + 8 * usize::from(fields.ends_with("_padding0;")), 1);
                file.extend(message(b'D', &[&id.to_le_bytes(), &data]));
            }
        }
    }
    file
}

#[test]
fn px4s_log_without_the_load_is_enough_for_estimator_and_law() {
    let scenario = estimated(0.002);
    let (_, table) = flown(&scenario, Format::Ulog, "ulg");
    let full = 60.0;
    let part = Part { full_thrust: Some(full.into()), from_s: Some(32.0), to_s: None };
    let log = px4(&table, full, &[]);
    let outcome = replay(scenario.clone(), &log, &part).unwrap();
    let found = outcome.flight.replayed.as_ref().unwrap();
    assert_eq!(found.given, "the estimate");
    assert!(found.unsaid.iter().any(|sentence| sentence.contains("p1 … p3")), "{found:?}");
    // The load that the log has not, against the one that flew, from when it is on its path: 12 s
    // are of the boot, 20 s of the join, and 10 s are left out, in which the filter settles and then
    // the law's observers.
    let mut worst = [0.0_f64; 2];
    for sample in outcome.flight.log.iter().filter(|sample| sample.t_s > 10.0) {
        let t_s = sample.t_s + 20.0;
        let row = table.t_s.partition_point(|time| *time < t_s - 1e-6);
        let off: f64 = (0..3)
            .map(|axis| {
                let name = ["p1", "p2", "p3"][axis];
                (sample.x[axis] - f64::from(table.numbers(name).unwrap()[row])).powi(2)
            })
            .sum();
        let thrust = sample.decision.unwrap().command.thrust - f64::from(table.numbers("thrust").unwrap()[row]);
        if thrust.is_finite() {
            worst = [worst[0].max(off.sqrt()), worst[1].max(thrust.abs())];
        }
    }
    // With navigation's errors beside it the filter keeps such a load within 45 to 78 mm; here the
    // motion is the true one. At most 1 % of the thrust is what the law makes of that.
    assert!(worst[0] < 0.08 && worst[1] < 0.3, "{worst:?}");
    // In newtons of what is a share in the log, and of the hold in which the rod is waited for, too.
    let told = outcome.flight.log.iter().filter_map(|sample| sample.decision.zip(sample.logged));
    let squares: Vec<f64> = told.map(|(here, there)| (here.command.thrust - there.thrust).powi(2)).collect();
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    let said = found.thrust_n.unwrap().rms;
    // The log ends a row before its commands do.
    assert!((said / rms - 1.0).abs() < 1e-3 && said < 2.0, "{said} {rms}");

    // Without what is full, a share is no thrust.
    let unscaled = replay(scenario.clone(), &log, &Part::default()).unwrap().flight.replayed.unwrap();
    assert!(unscaled.unsaid.iter().any(|sentence| sentence.contains("--full-thrust")), "{unscaled:?}");
    assert_eq!(unscaled.thrust_n, None);
}

#[test]
fn what_a_log_lacks_is_named() {
    let scenario = estimated(0.1);
    let (_, table) = flown(&scenario, Format::Ulog, "ulg");
    let refused = |leave_out: &[&str]| replay(scenario.clone(), &px4(&table, 60.0, leave_out), &Part::default());
    for (topic, column) in [("vehicle_attitude", "att_w"), ("vehicle_local_position", "uav_p1")] {
        let error = refused(&[topic]).unwrap_err();
        assert!(matches!(error, ReplayError::Motion(_)));
        assert!(error.to_string().contains(topic) && error.to_string().contains(column), "{error}");
    }
    let error = refused(&["sensor_combined"]).unwrap_err();
    assert!(matches!(error, ReplayError::Load), "{error}");
    assert!(error.to_string().contains("sensor_combined"), "{error}");
    let part = Part { from_s: Some(900.0), ..Part::default() };
    let error = replay(scenario.clone(), &px4(&table, 60.0, &[]), &part).unwrap_err().to_string();
    assert!(error.contains("--from 900") && error.contains("the log has 12.000 to"), "{error}");
    assert!(replay(scenario, b"no log at all", &Part::default()).is_err());
}
