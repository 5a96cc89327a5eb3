//! What the README shows is what there is.

use hil_sim::run::{Arithmetic, End, fly_simply};
use hil_sim::scenario::{Law, Scenario};

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
