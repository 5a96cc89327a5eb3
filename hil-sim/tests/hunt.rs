//! The hunt for the smallest fault, against a scan of all of them, and its finds flown by `run`.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::Control;
use hil_sim::fly::judge::{GOOD_M, JUDGED};
use hil_sim::fly::run::{Arithmetic, fly_simply};
use hil_sim::study::campaign::{Along, Campaign, Find, Hunt, hunt};
use hil_sim::world::Seed;
use rayon::prelude::*;

/// The law as published, which has no observer, in a steady wind, and a force on its payload.
const PUBLISHED: &str = r#"
[scenario]
duration_s = 16.0
substeps = 1
path = { kind = "circle", radius = 5.0, p3 = -10.0, speed = 1.0 }
[scenario.controller]
law = "follow"
rate_hz = 200.0
poles = [[-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5], [-2, -3]]
limits = { thrust = [3.0, 60.0], torque = [3.0, 3.0, 3.0] }
[scenario.environment.air]
wind = [2.0, 1.0, 0.0]
payload_drag_area = 0.01
uav_drag_area = 0.05
[draw]
"environment.payload_force" = { disc = 0.5 }
"#;

/// What a flight meets beside the force, none of which it fails by alone.
const MORE: &str = r#"
"vehicle.payload_mass" = { uniform = [0.49, 0.51] }
"environment.air.gusts.speed_at_6m" = { uniform = [0.0, 0.1] }
[start]
distance_m = 1.0
speed = 1.0
rod_deg = 20.0
tilt_deg = 10.0
yaw_deg = 90.0
"#;

const SEED: Seed = Seed { batch: 1, run: 0 };

fn hunted(text: &str, seed: Seed, from_flight: bool) -> Hunt {
    let campaign = Campaign::parse(text).expect("a campaign");
    hunt(&campaign, seed, from_flight, Control::alone()).expect("a hunt")
}

fn scenario(find: &Find) -> Scenario {
    Scenario::parse("fault.toml", &find.scenario).expect("a scenario")
}

/// Largest d_C in the last quarter, as `run` flies and logs it.
fn largest(scenario: &Scenario) -> f64 {
    let flight = fly_simply(scenario, Arithmetic::F32).expect("numbers in range");
    let judged = flight.log.iter().filter(|sample| sample.t_s >= (1.0 - JUDGED) * scenario.duration_s - 1e-9);
    judged.filter(|sample| sample.decision.is_some()).map(|sample| sample.distance_m).fold(0.0, f64::max)
}

#[test]
fn the_smallest_losing_force_is_that_of_a_scan_at_a_twentieth_of_its_flights() {
    let hunt = hunted(PUBLISHED, SEED, false);
    let [x, y, _] = scenario(&hunt.finds[0]).environment.payload_force;
    let found = x.hypot(y);

    // Every 7.5 degrees, from 0.02 N on in steps of 3 %, to the first force that fails.
    let base = scenario(&hunt.finds[0]);
    let scanned: Vec<(usize, f64)> = (0..48)
        .into_par_iter()
        .map(|direction| {
            let angle = std::f64::consts::TAU * f64::from(direction) / 48.0;
            let mut scenario = base.clone();
            let mut flights = 0;
            let forces =
                std::iter::successors(Some(0.02), |force| Some(1.03 * force)).take_while(|force| *force < 0.5);
            let fails = forces.into_iter().find(|force| {
                flights += 1;
                scenario.environment.payload_force = [force * angle.cos(), force * angle.sin(), 0.0];
                largest(&scenario) >= GOOD_M
            });
            (flights, fails.unwrap_or(f64::INFINITY))
        })
        .collect();
    let flights: usize = scanned.iter().map(|(flights, _)| flights).sum();
    let least = scanned.iter().map(|(_, force)| *force).fold(f64::INFINITY, f64::min);
    println!("found {found} N in {} flights, scanned {least} N in {flights}", hunt.flights);
    assert!((found / least - 1.0).abs() <= 0.05, "{found} N, and {least} N in the scan");
    assert!(20 * hunt.flights <= flights, "{} flights, and {flights} in the scan", hunt.flights);
    // What a ray's bisection takes for granted.
    assert_eq!(hunt.along, Some(Along { smaller: 8, smaller_failed: 0, larger: 8, larger_failed: 8 }));
}

#[test]
fn run_flies_a_find_to_the_same_end() {
    for find in hunted(PUBLISHED, SEED, false).finds {
        assert_eq!(largest(&scenario(&find)), find.dc_max_m, "{}", find.line());
    }
}

#[test]
fn a_flight_that_fails_is_shrunk_to_what_it_fails_by() {
    let text = format!("{PUBLISHED}{MORE}");
    let seed = Seed { batch: 1, run: 3 };
    let hunt = hunted(&text, seed, true);
    let [find] = hunt.finds.as_slice() else { panic!("{} finds", hunt.finds.len()) };
    let names: Vec<&str> = find.fault.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["environment.payload_force"]);
    let met = Campaign::parse(&text).unwrap().draw(seed).unwrap().scenario.environment.payload_force;
    let left = scenario(find).environment.payload_force;
    assert!(left[0].hypot(left[1]) < met[0].hypot(met[1]), "{left:?} of {met:?}");
    assert_eq!(largest(&scenario(find)), find.dc_max_m);
    assert!(find.dc_max_m >= GOOD_M);
}

/// `campaign` on this text with these options, in a folder of this test's own.
fn command(test: &str, text: &str, options: &[&str]) -> (PathBuf, Output) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("hunt-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder for the test");
    fs::write(folder.join("my.toml"), text).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hil-sim"));
    command.arg("campaign").arg(folder.join("my.toml")).args(options).arg("--out").arg(folder.join("out"));
    let output = command.output().expect("it starts");
    (folder.join("out"), output)
}

#[test]
fn the_command_writes_files_that_run_takes() {
    let (out, output) = command("files", PUBLISHED, &["--hunt"]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("environment.payload_force") && said.contains("fault-1.toml"), "{said}");
    let mut run = Command::new(env!("CARGO_BIN_EXE_hil-sim"));
    let run = run.arg("run").arg(out.join("fault-1.toml")).arg("--out").arg(&out).output().expect("it starts");
    assert!(run.status.success(), "{run:?}");
    assert!(out.join("report.html").exists() && out.join("hunt.json").exists());
}

#[test]
fn what_cannot_be_hunted_is_said() {
    let nothing = PUBLISHED.replace("disc = 0.5", "choice = [[0.0, 0.0, 0.0]]");
    let windy = PUBLISHED.replace("[2.0, 1.0, 0.0]", "[9.0, 1.0, 0.0]");
    let calm = PUBLISHED.replace("disc = 0.5", "disc = 0.01");
    for (text, option, said) in [
        (nothing.as_str(), "--hunt", "draws no numbers"),
        (&windy, "--hunt", "the nominal flight fails"),
        (&calm, "--hunt=2", "flight 2 does not fail"),
        (PUBLISHED, "--hunt=1000", "--hunt 1000: the campaign's flights are 0 to 999"),
    ] {
        let (_, output) = command("refused", text, &[option]);
        assert!(!output.status.success(), "{option} was taken");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(error.contains(said), "{said}: {error}");
    }
    let (_, output) = command("harmless", &calm, &["--hunt"]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("none fails"), "{output:?}");
}
