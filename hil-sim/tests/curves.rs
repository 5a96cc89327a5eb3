//! Proof by flight: every curve of the scenarios, from off the path, on it, and with a wrong
//! payload mass.

use hil_sim::describe::scenario::{CURVES, Law, Scenario, builtin};
use hil_sim::fly::flight::End;
use hil_sim::fly::run::{Arithmetic, Flight, fly_simply};
use rayon::prelude::*;

fn scenario(name: &str) -> Scenario {
    builtin(name).expect("a built-in scenario").unwrap_or_else(|error| panic!("{error}"))
}

fn fly(scenario: &Scenario) -> Flight {
    let flight = fly_simply(scenario, Arithmetic::F32).unwrap();
    assert_eq!(flight.end, End::Complete, "{}", scenario.name);
    flight
}

/// The curves, each with the text of its scenario.
fn curves() -> Vec<(&'static str, &'static str)> {
    CURVES.iter().copied().filter(|(name, _)| !is_wrong(name)).collect()
}

/// And those of a law that is told half or three halves of the payload's mass.
fn wrong() -> impl Iterator<Item = (&'static str, &'static str)> {
    CURVES.iter().copied().filter(|(name, _)| is_wrong(name))
}

fn is_wrong(name: &str) -> bool {
    name.ends_with("-light") || name.ends_with("-heavy")
}

/// Names, largest d_C and its RMS over the steady time, in parallel.
fn steady(scenarios: &[Scenario]) -> Vec<(&str, f64, f64)> {
    scenarios
        .par_iter()
        .map(|scenario| {
            let results = fly(scenario).results;
            (&*scenario.name, results.dc_max_m.unwrap(), results.dc_rms_m.unwrap())
        })
        .collect()
}

/// The same file with something else in it.
fn changed(name: &str, text: &str, change: impl FnOnce(&mut toml::Table)) -> Scenario {
    let mut table = toml::from_str(text).unwrap();
    change(&mut table);
    Scenario::parse(name, &table.to_string()).unwrap()
}

/// Curves that lie in a horizontal plane.
const HORIZONTAL: [&str; 2] = ["superellipse", "building"];

#[test]
fn every_curve_is_reached_and_kept() {
    let scenarios: Vec<Scenario> = curves().iter().map(|(name, _)| scenario(name)).collect();
    for (name, max, rms) in steady(&scenarios) {
        println!("{name}: d_C at most {max:.2e} m, {rms:.2e} m rms");
        assert!(max < 0.01 && rms < 0.002, "{name}: {max:e}, {rms:e}");
    }
}

/// Started on the path with all outputs zero, three laps.
#[test]
fn every_curve_is_invariant() {
    let worst: Vec<(&str, f64)> = curves()
        .par_iter()
        .map(|(name, text)| {
            let mut scenario = changed(name, text, |table| {
                table.insert("initial".into(), "steady".into());
                table.insert("steady_from_s".into(), 0.0.into());
            });
            let Law::Follow { path, .. } = &scenario.controller.law else { panic!("{name} follows no path") };
            let vehicle = controller::Vehicle::new(scenario.controller.vehicle).unwrap();
            let report = path.check(&vehicle, &scenario.limits).unwrap();
            assert!(report.excesses.is_empty(), "{name}: {report}");
            scenario.duration_s =
                (3.0 * report.lap_time * scenario.controller.rate_hz).ceil() / scenario.controller.rate_hz;
            (*name, fly(&scenario).results.dc_max_m.unwrap())
        })
        .collect();
    for (name, max) in worst {
        println!("{name}: d_C at most {max:.2e} m in three laps from on the path");
        assert!(max <= 1e-3, "{name}: {max:e}");
    }
}

/// A wrong mass is a force that is constant in N. On a horizontal curve the integrals find it;
/// where h1, h2 and ρ turn against the vertical along the lap it is not constant for them, and a
/// residual stays, which is printed.
#[test]
fn a_wrong_mass_with_integral_action_is_stable_on_every_curve() {
    let scenarios: Vec<Scenario> = wrong().map(|(name, _)| scenario(name)).collect();
    for (name, max, rms) in steady(&scenarios) {
        println!("{name}: d_C at most {max:.2e} m, {rms:.2e} m rms");
        if HORIZONTAL.iter().any(|horizontal| name.starts_with(horizontal)) {
            assert!(max < 0.02, "{name}: {max:e}");
        }
        // Stable: no more than without integrals, 2.01 m lower for half the mass.
        assert!(max < 2.1, "{name}: {max:e}");
    }
}

/// The observers find the same force wherever the curve turns, and need no slower flight and no
/// second lap for it.
#[test]
fn a_wrong_mass_is_observed_on_every_curve() {
    let scenarios: Vec<Scenario> = wrong()
        .map(|(name, text)| {
            changed(name, text, |table| {
                table.insert("steady_from_s".into(), 15.0.into());
                let controller = table["controller"].as_table_mut().unwrap();
                controller.remove("k_integral");
                // −1, −2, …, faster by as much as an observer of 8 rad/s allows.
                let poles: Vec<Vec<f64>> =
                    [6, 6, 5, 2].map(|n| (1..=n).map(|i| -1.6 * f64::from(i)).collect()).into();
                controller.insert("poles".into(), poles.into());
                let observer = ["payload", "rod", "torque"].map(|name| (name.to_owned(), 8.0.into()));
                controller.insert("observer".into(), toml::Table::from_iter(observer).into());
            })
        })
        .collect();
    assert!(!scenarios.is_empty());
    for (name, max, rms) in steady(&scenarios) {
        println!("{name}: d_C at most {max:.2e} m, {rms:.2e} m rms");
        assert!(max < 0.02, "{name}: {max:e}");
    }
}
