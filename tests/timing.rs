//! States slower than commands, latency and lag that are told, a cable that stretches, a payload
//! told wrong: the supervised law in f32 against the largest d_C of the end of a flight.
//!
//! Each row of a table has what a flight has beside [`BASE`], the limit of its largest d_C, mm, and
//! what was measured when it was written, mm: flights are the same on every machine, so that a
//! change shows.

use controller::{State, Vector3};
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::flight::{Control, Moment};
use hil_sim::fly::judge::judge;
use hil_sim::study::campaign::{ApproachFields, pilot};
use hil_sim::world::Seed;

/// A metre per second around the paper's circle, with the observers of the README; what is missing
/// is put in by name.
const BASE: &str = r#"
title = "t"
duration_s = 40.0
substeps = 2
[vehicle]
payload_mass = {mass}
[path]
kind = "circle"
radius = 5.0
p3 = -10.0
speed = {speed}
[controller]
law = "follow"
rate_hz = {rate}
vehicle = { payload_mass = 0.5 }
limits = { thrust = [3.0, 60.0], torque = [3.0, 3.0, 3.0] }
observer = { payload = {observer}, rod = {observer}, torque = {observer}, cable_stiffness = {ea} }
poles = {poles}
latency_s = {latency}
rotor_lag_s = {lag}
"#;

const GUSTS: &str = "
[environment.air]
wind = [3.0, 4.0, 0.0]
gusts = { speed_at_6m = 5.0, height = 10.0 }
payload_drag_area = 0.01
uav_drag_area = 0.05
";

/// Those of `tune`.
const NOISE: &str = "
[sensors]
position = { noise = 0.02 }
velocity = { noise = 0.03 }
rod = { noise = 0.005 }
rod_rate = { noise = 0.02 }
attitude = { noise = 0.005 }
body_rate = { noise = 0.01 }
";

/// What a flight has that others do not.
#[derive(Clone)]
struct Flight {
    rate: f64,
    speed: f64,
    mass: f64,
    observer: f64,
    /// Of the poles.
    scale: f64,
    /// As the law is told, s, and of the cable, N.
    latency: f64,
    lag: f64,
    ea: f64,
    /// Further tables.
    world: String,
}

impl Default for Flight {
    fn default() -> Self {
        Self {
            rate: 500.0,
            speed: 1.0,
            mass: 0.5,
            observer: 8.0,
            scale: 1.0,
            latency: 0.0,
            lag: 0.0,
            ea: 0.0,
            world: String::new(),
        }
    }
}

impl Flight {
    fn scenario(&self) -> Scenario {
        let poles =
            |count: i32, first: i32| -> Vec<f64> { (0..count).map(|i| -self.scale * f64::from(first + i)).collect() };
        let poles = [poles(6, 1), poles(6, 1), poles(5, 1), poles(2, 2)];
        let numbers = [
            ("mass", self.mass),
            ("speed", self.speed),
            ("rate", self.rate),
            ("observer", self.observer),
            ("ea", self.ea),
            ("latency", self.latency),
            ("lag", self.lag),
        ];
        let mut text = BASE.replace("{poles}", &format!("{poles:?}"));
        for (name, value) in numbers {
            text = text.replace(&format!("{{{name}}}"), &format!("{value:?}"));
        }
        Scenario::parse("timing", &(text + &self.world)).expect("a scenario")
    }

    /// Largest d_C, mm, in the last quarter of any of `runs` flights.
    fn worst_mm(&self, runs: u64) -> f64 {
        let scenario = self.scenario();
        let start = State::at_rest(Vector3::new(5.5, 0.0, -10.0));
        let largest = (0..runs).map(|run| {
            let mut pilot = pilot(&scenario.controller, &ApproachFields::default()).expect("numbers in range");
            let seed = Seed { batch: 11, run };
            let outcome = judge(&scenario, start, seed, None, Control::alone(), &mut pilot, &mut |_| {});
            1e3 * outcome.expect("nobody interrupts").dc_max_m
        });
        largest.fold(0.0, f64::max)
    }
}

/// Flies the rows (name, flight, limit, measured), and says all that are wrong.
fn hold_to(rows: &[(String, Flight, f64, f64)], runs: u64) {
    let wrong: Vec<String> = rows
        .iter()
        .filter_map(|(name, flight, limit, measured)| {
            let worst = flight.worst_mm(runs);
            println!("{name}: {worst:.3} mm of {limit} mm");
            // Half as much again, and the rounding of f32 at ten metres.
            let is_as_measured = worst <= 1.5 * measured + 0.01;
            (!(worst <= *limit && is_as_measured)).then(|| format!("{name}: {worst} mm, {limit}, {measured}"))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn states_at_a_fraction_of_the_control_rate_cost_nothing() {
    let rows: Vec<_> = [100.0, 200.0, 500.0]
        .into_iter()
        .flat_map(|rate| [1, 2, 5, 10].map(|every| (rate, every)))
        .map(|(rate, every)| {
            let world = format!("[timing]\nstate_every = {every}\n");
            (format!("1/{every} of {rate} Hz"), Flight { rate, world, ..Flight::default() }, 5.0, 0.005)
        })
        .collect();
    hold_to(&rows, 1);
    // At rates at which a gap longer than the model carries does not occur in four flights.
    let lost = [(0.3, 100.0), (0.5, 200.0)].map(|(missed, rate)| {
        let world = format!("[timing]\nmissed = {missed}\n");
        (format!("{missed} lost"), Flight { rate, world, ..Flight::default() }, 5.0, 0.005)
    });
    hold_to(&lost, 4);
}

fn late(latency: f64, is_told: bool, weather: &str) -> Flight {
    let world = format!("[actuators]\nlatency_s = {latency}\n{weather}");
    Flight { latency: if is_told { latency } else { 0.0 }, world, ..Flight::default() }
}

#[test]
fn a_latency_that_is_told_costs_nothing_in_calm() {
    let rows =
        [0.02, 0.03, 0.04, 0.05, 0.06].map(|latency| (format!("{latency} s"), late(latency, true, ""), 0.5, 0.003));
    hold_to(&rows, 1);
}

#[test]
fn a_latency_that_is_told_costs_little_in_gusts() {
    let rows = [(0.02, 16.0), (0.03, 16.0), (0.04, 16.0), (0.05, 16.0), (0.06, 16.5)].map(|(latency, measured)| {
        let flight = Flight { scale: 1.4, observer: 10.0, ..late(latency, true, GUSTS) };
        (format!("{latency} s"), flight, 25.0, measured)
    });
    hold_to(&rows, 20);
}

#[test]
fn a_lag_that_is_told_is_led() {
    let rows: Vec<_> = [(0.05, 30.0, [19.8, 22.5]), (0.1, 60.0, [20.4, 23.2])]
        .into_iter()
        .flat_map(|(lag, limit, [ideal, noisy])| {
            [("", ideal), (NOISE, noisy)].map(|(noise, measured)| {
                let world = format!("[actuators]\nlag_s = {lag}\n{noise}{GUSTS}");
                let flight = Flight { lag, scale: 1.4, world, ..Flight::default() };
                (format!("{lag} s, noisy {}", !noise.is_empty()), flight, limit, measured)
            })
        })
        .collect();
    hold_to(&rows, 6);
}

#[test]
fn a_cable_that_stretches_is_flown_be_it_told_or_not() {
    // A static stretch of 2 and 5 %, and damping ratios of 0.02 to 0.1 of the bounce.
    let rows: Vec<_> = [(245.25, [0.3, 1.0]), (98.1, [0.3, 1.0])]
        .into_iter()
        .flat_map(|(ea, damping)| damping.map(|damping| (ea, damping)))
        .flat_map(|(ea, damping)| [1.0, 2.5].map(|speed| (ea, damping, speed)))
        .flat_map(|(ea, damping, speed)| {
            let world = format!("[cable]\nea = {ea}\ndamping = {damping}\n");
            let cases = [(4.0, ea, 0.25), (8.0, ea, 0.25), (4.0, 0.0, 2.0), (8.0, 0.0, 0.25)];
            cases.map(|(observer, told, measured)| {
                let flight = Flight { speed, observer, ea: told, world: world.clone(), ..Flight::default() };
                (format!("{ea} N told {told}, {damping} N s/m, {speed} m/s, {observer} rad/s"), flight, 5.0, measured)
            })
        })
        .collect();
    hold_to(&rows, 1);
}

#[test]
fn a_payload_told_wrong_is_learnt() {
    let rows: Vec<_> = [(1.5, 1.0, 0.05), (0.25, 1.0, 0.03), (0.5, 1.2, 0.8), (0.5, 0.85, 0.8)]
        .into_iter()
        .flat_map(|(mass, thrust, measured)| {
            [4.0, 8.0].map(|observer| {
                let world = format!("[actuators]\nthrust_scale = {thrust}\n");
                let flight = Flight { mass, speed: 2.5, observer, world, ..Flight::default() };
                (format!("{mass} kg told 0.5, {thrust} of the thrust, {observer} rad/s"), flight, 5.0, measured)
            })
        })
        .collect();
    hold_to(&rows, 1);
}

/// From the first second on, in which the observers settle: what they have found becomes mass two
/// seconds after the law has begun, and the thrust does not notice.
#[test]
fn a_mass_that_has_been_learnt_is_flown_without_a_bump() {
    for mass in [1.5, 0.25] {
        let scenario = Flight { mass, ..Flight::default() }.scenario();
        let start = State::at_rest(Vector3::new(5.5, 0.0, -10.0));
        let mut pilot = pilot(&scenario.controller, &ApproachFields::default()).expect("numbers in range");
        let (mut last, mut largest) = (None, 0.0_f64);
        let watch = &mut |moment: &Moment<'_>| {
            let Some(decision) = moment.decision.filter(|_| moment.t_s > 1.0) else { return };
            let thrust = decision.command.thrust;
            largest = largest.max(last.replace(thrust).map_or(0.0, |last: f64| (thrust / last - 1.0).abs()));
        };
        judge(&scenario, start, Seed::default(), None, Control::alone(), &mut pilot, watch);
        assert!(largest < 0.01, "{mass} kg told 0.5: the thrust jumps by {largest} of itself");
    }
}

#[test]
fn a_latency_beyond_the_ring_is_refused_with_the_limit() {
    let told = Flight { rate: 1000.0, latency: 0.06, ..Flight::default() }.scenario();
    let refused = pilot(&told.controller, &ApproachFields::default()).err().expect("too long");
    assert!(refused.to_string().contains("is outside 0 to 0.031"), "{refused}");
}
