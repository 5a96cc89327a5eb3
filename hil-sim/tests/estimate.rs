//! The law on an estimate: the loop closes, and every case of the table can be made.

use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::Control;
use hil_sim::study::estimate::{CASES, base, estimate};
use hil_sim::world::Seed;
use hil_sim::world::random::Purpose;

#[test]
fn every_case_can_be_made() {
    let base = base().unwrap();
    for (run, case) in CASES.iter().enumerate() {
        let mut random = Seed { batch: 1, run: run as u64 }.stream(Purpose::Draw);
        let scenario = case.scenario(&base, &mut random).unwrap();
        assert_eq!(scenario.estimator.is_none(), case.name.starts_with("full-state"), "{}", case.name);
    }
}

/// The bars are a centimetre above what 16 flights measure in the median: a sign that is wrong
/// costs metres.
#[test]
fn the_law_flies_on_rtk_alone() {
    for (case, most_m, rod_deg) in [("rtk-calm", 0.06, 0.45), ("rtk-gusts", 0.07, 0.55)] {
        let table = estimate(4, 3, &|name| name == case, Control::alone()).unwrap().unwrap();
        let row = &table.rows[0];
        assert_eq!((row.case, row.lost), (case, 0));
        assert!(row.dc_max_median_m < most_m, "{case}: {}", row.dc_max_median_m);
        assert!(row.rod_rms_deg.unwrap() < rod_deg, "{case}: {:?}", row.rod_rms_deg);
    }
}

#[test]
fn a_flight_depends_on_its_seed_alone() {
    let fly = || estimate(1, 9, &|name| name == "rtk-gusts", Control::alone()).unwrap().unwrap();
    let (first, again) = (fly(), fly());
    assert_eq!(first.rows[0].dc_max_worst_m.to_bits(), again.rows[0].dc_max_worst_m.to_bits());
}

#[test]
fn what_a_scenario_says_of_instruments_is_checked() {
    let text = include_str!("../scenarios/estimate.toml");
    for (wrong, field) in [
        ("gnss = { part = \"rtk\", rate_hz = 0.0 }", "sensors.gnss.rate_hz"),
        ("imu = { range = 1.0 }", "sensors.imu.range"),
        ("mocap = { noise = 0.0 }", "sensors.mocap.noise"),
        ("gnss = { part = \"sextant\" }", "gnss"),
    ] {
        let key = wrong.split(' ').next().unwrap();
        let lines: String = text
            .lines()
            .filter(|line| !line.starts_with(&format!("{key} = ")))
            .map(|line| if line == "[sensors]" { format!("[sensors]\n{wrong}\n") } else { format!("{line}\n") })
            .collect();
        let error = Scenario::parse("wrong.toml", &lines).unwrap_err().to_string();
        assert!(error.contains(field), "{wrong}: {error}");
    }
    let told = text.replace("[estimator]", "[estimator]\nnoise = 1000.0");
    let error = Scenario::parse("wrong.toml", &told).unwrap_err().to_string();
    assert!(error.contains("estimator.noise"), "{error}");
}
