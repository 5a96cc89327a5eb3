//! Tuning: the same for any number of threads, what it proposes is what it flew, and what it says
//! follows from its numbers.

use hil_sim::describe::scenario::{Law, Scenario};
use hil_sim::fly::flight::Control;
use hil_sim::study::tune::{self, Tuning, trade, tune};

const SCALES: [f64; 2] = [0.8, 1.2];
const BANDWIDTHS: [f64; 2] = [2.0, 8.0];

/// The scenario that comes with the program, cut to 24 s.
fn task() -> toml::Table {
    let mut table: toml::Table = toml::from_str(tune::SCENARIO).expect("TOML");
    table.insert("duration_s".to_owned(), 24.0.into());
    table
}

fn tuned(threads: usize) -> Tuning {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let grid = (&SCALES[..], &BANDWIDTHS[..]);
    let tuning = pool.install(|| tune(&task(), grid, (3, 7), Control::alone()));
    tuning.expect("a scenario that can be tuned").expect("not interrupted")
}

#[test]
fn a_tuning_is_the_same_on_any_number_of_threads_and_says_what_it_flew() {
    let tuning = tuned(1);
    let json = |tuning: &Tuning| serde_json::to_string(tuning).expect("JSON");
    let other = tuned(3);
    assert_eq!(json(&tuning), json(&other));
    assert_eq!(tuning.snippet, other.snippet);

    // The most good flights, and the least cost among those.
    let rows = &tuning.rows;
    let chosen = &rows[tuning.proposed];
    assert_eq!(rows.len(), SCALES.len() * BANDWIDTHS.len());
    assert!(rows.iter().all(|row| row.good < chosen.good || row.good == chosen.good && row.cost() >= chosen.cost()));

    // What physics has it trade: faster poles pay in torque, faster observers hold closer in a
    // gust.
    let at = |scale: f64, bandwidth: f64| {
        rows.iter().find(|row| row.scale == scale && row.bandwidth == bandwidth).expect("a setting of the grid")
    };
    assert!(at(1.2, 8.0).rms_torque_nm > 2.0 * at(0.8, 8.0).rms_torque_nm);
    assert!(at(1.2, 8.0).rms_dc_m < at(1.2, 2.0).rms_dc_m);

    // Accepted as it is, in place of the scenario's own.
    let mut table = task();
    table.extend(toml::from_str::<toml::Table>(&tuning.snippet).expect("TOML"));
    let scenario = Scenario::from_table("tuned", table).expect("a scenario");
    let was = Scenario::from_table("was", task()).expect("a scenario").controller;
    let controller = scenario.controller;
    assert_eq!(controller.observer.payload_bandwidth, chosen.bandwidth);
    assert_eq!((controller.limits, controller.sampling()), (was.limits, was.sampling()));
    let Law::Follow { gains, .. } = controller.law else { panic!("another law") };
    // The sum of the poles is the gain of the highest derivative.
    assert!((gains.k1[5] - 21.0 * chosen.scale).abs() < 1e-9 && (gains.k3[4] - 15.0 * chosen.scale).abs() < 1e-9);
    assert!((gains.k4[1] - 5.0 * chosen.scale).abs() < 1e-9);

    let said = trade(&tuning);
    assert!(
        said.contains(&format!("s = {}, {} rad/s, good in {} of 3", chosen.scale, chosen.bandwidth, chosen.good))
    );
    // Whatever was chosen of two and two lies at an edge.
    assert!(said.contains("--scales") && said.contains("--bandwidths"), "{said}");
}

#[test]
fn what_cannot_be_tuned_is_refused_with_its_field() {
    let refused = |change: &str| {
        let mut table = task();
        table.extend(toml::from_str::<toml::Table>(change).expect("TOML"));
        tune(&table, (&SCALES[..], &BANDWIDTHS[..]), (1, 1), Control::alone())
            .expect_err("it was accepted")
            .to_string()
    };
    assert!(refused("duration_s = -1.0").starts_with("duration_s: "));
    assert!(refused("[controller]\nlaw = \"fly\"").starts_with("controller.law: "));
    let unstable = tune(&task(), (&[-1.0], &[4.0]), (1, 1), Control::alone());
    assert!(unstable.expect_err("it was accepted").to_string().starts_with("controller.poles"));
}
