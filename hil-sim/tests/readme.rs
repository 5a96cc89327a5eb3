//! The README's scenario flies, and its costs are the measured ones.

use hil_sim::describe::scenario::{Law, Scenario};
use hil_sim::fly::flight::End;
use hil_sim::fly::run::{Arithmetic, fly_simply};

const README: &str = include_str!("../../README.md");

#[test]
fn its_scenario_is_valid_and_flies() {
    let (_, rest) = README.split_once("```toml\n").expect("a scenario");
    let (text, _) = rest.split_once("```").expect("its end");
    let scenario = Scenario::parse("README.md", text).unwrap_or_else(|error| panic!("{error}"));
    let Law::Follow { path, .. } = &scenario.controller.law else { panic!("it follows a path") };
    let vehicle = controller::Vehicle::new(scenario.controller.vehicle).unwrap();
    assert!(path.check(&vehicle, &scenario.limits).unwrap().excesses.is_empty());
    let flight = fly_simply(&scenario, Arithmetic::F32).unwrap();
    assert_eq!(flight.end, End::Complete);
    assert!(flight.results.settle_s.unwrap() < 10.0);
}

#[test]
fn its_mission_takes_off_and_lands() {
    let (_, rest) = README.split_once("## From the ground to the ground").expect("the section");
    let (_, rest) = rest.split_once("```toml\n").expect("a scenario");
    let (text, _) = rest.split_once("```").expect("its end");
    let scenario = Scenario::parse("README.md", text).unwrap_or_else(|error| panic!("{error}"));
    let flight = fly_simply(&scenario, Arithmetic::F32).unwrap();
    assert!(matches!(flight.end, End::Landed(_)), "{:?}", flight.end);
    assert!(flight.results.uav_touchdown_m_s.unwrap() < 0.6 && flight.results.load_touchdown_m_s.unwrap() < 0.6);
}

#[test]
fn its_costs_are_the_expected_ones() {
    let expected: serde_json::Value =
        serde_json::from_str(include_str!("../../firmware/bench/expected.json")).expect("JSON");
    let grouped = |number: &serde_json::Value| {
        let number = number.as_u64().expect("a count");
        let (thousands, rest) = (number / 1000, number % 1000);
        if thousands == 0 { rest.to_string() } else { format!("{thousands},{rest:03}") }
    };
    let count = |case: &str, end: &str| grouped(&expected["instructions"][case][end]);
    // What stands behind the instructions: cycles, from flash, code.
    let rest = |case: &str| {
        let cycles = |memory: &str| grouped(&expected["cycles"][case][memory]);
        let code = grouped(&expected["code_bytes_by_case"][case]);
        format!("{} | {} | {code} B |", cycles("zero_wait"), cycles("flash"))
    };
    for (case, row) in [
        ("circle", "| whole step, circle |"),
        ("ellipse", "| whole step, ellipse, yaw along it |"),
        ("bent", "| whole step, bent curve, speed and yaw of position |"),
        ("fourier8", "| whole step, Fourier loop of 8 harmonics |"),
        ("route", "| whole step, route of any length |"),
        ("flown", "| as a board flies it: circle chosen at run time, limits and four rotors |"),
        ("flown-on-estimate", "| the same on an estimate: navigation, payload filter, and that |"),
    ] {
        let shown = format!("{row} {} to {} | {}", count(case, "best"), count(case, "worst"), rest(case));
        assert!(README.contains(&shown), "{shown}");
    }
    for (case, row) in [("law-circle", "| the law alone, circle |"), ("law-bent", "| the law alone, bent curve |")] {
        let shown = format!("{row} {} | {}", count(case, "worst"), rest(case));
        assert!(README.contains(&shown), "{shown}");
    }
    for (case, row) in [
        ("load-filter", "the payload filter takes {} instructions a period"),
        ("load-filter-and-navigation", "{} with navigation"),
        ("flown-on-estimate", "whole period on an estimate {}."),
    ] {
        let shown = row.replace("{}", &count(case, "mean"));
        assert!(README.contains(&shown), "{shown}");
    }
    let joining =
        format!("| whole step, circle, while joining it from afar | {} at most |", count("joining", "worst"));
    let tracking = format!("| tracking, without the supervisor | {} | {}", count("track", "worst"), rest("track"));
    assert!(README.contains(&joining) && README.contains(&tracking), "{joining}, {tracking}");
    let laying = format!(
        "| on the ground: laying a route of eight waypoints, with corners and a stop | {} to {} | | | {} B |",
        count("laying", "best"),
        count("laying", "worst"),
        grouped(&expected["code_bytes_by_case"]["laying"])
    );
    assert!(README.contains(&laying), "{laying}");
}
