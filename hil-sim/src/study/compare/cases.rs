//! The scenario family of the comparison: what is wrong with the world, one case at a time and all
//! at once.

use controller::State;

use crate::describe::scenario::Scenario;
use crate::world::random::Stream;
use crate::world::{Air, Gusts, PayloadStep, RateLoop, Sensors};

/// One case.
pub struct Case {
    /// Its name in tables and files.
    pub name: &'static str,
    /// What is wrong.
    pub title: &'static str,
    /// Makes it so. Drawn from the flight's own stream, so that all laws meet the same.
    pub apply: fn(&mut Scenario, &mut Stream),
}

/// The cases, in the order of the table.
pub const CASES: &[Case] = &[
    Case { name: "nominal", title: "nothing", apply: |_, _| {} },
    Case { name: "force-0.1N", title: "constant force on the payload, ±0.1 N", apply: |s, r| force(s, r, 0.1) },
    Case { name: "force-0.3N", title: "constant force on the payload, ±0.3 N", apply: |s, r| force(s, r, 0.3) },
    Case { name: "force-1N", title: "constant force on the payload, ±1 N", apply: |s, r| force(s, r, 1.0) },
    Case {
        name: "mass-0.25",
        title: "payload of 0.25 kg, law told 0.5",
        apply: |s, _| s.vehicle.payload_mass = 0.25,
    },
    Case {
        name: "mass-0.75",
        title: "payload of 0.75 kg, law told 0.5",
        apply: |s, _| s.vehicle.payload_mass = 0.75,
    },
    Case { name: "mass-1.5", title: "payload of 1.5 kg, law told 0.5", apply: |s, _| s.vehicle.payload_mass = 1.5 },
    Case { name: "pick-up-1.5", title: "payload 0.5 kg, from 20 s on 1.5 kg", apply: |s, _| mass_step(s, 1.5) },
    Case {
        name: "drop-0.02",
        title: "payload 0.5 kg, from 20 s on a hook of 0.02 kg",
        apply: |s, _| mass_step(s, 0.02),
    },
    Case { name: "wind-5", title: "constant wind, 5 m/s", apply: |s, r| wind(s, r, 5.0, false) },
    Case { name: "gust-5", title: "wind of 5 m/s with Dryden gusts", apply: |s, r| wind(s, r, 5.0, true) },
    Case {
        name: "thrust-0.85",
        title: "85 % of the thrust commanded",
        apply: |s, _| s.actuators.thrust_scale = 0.85,
    },
    Case {
        name: "thrust-1.15",
        title: "115 % of the thrust commanded",
        apply: |s, _| s.actuators.thrust_scale = 1.15,
    },
    Case { name: "rod-0.9", title: "rod 10 % shorter than told", apply: |s, _| s.vehicle.rod_length *= 0.9 },
    Case { name: "rod-1.1", title: "rod 10 % longer than told", apply: |s, _| s.vehicle.rod_length *= 1.1 },
    Case { name: "inertia-0.7", title: "inertia 30 % less than told", apply: |s, _| inertia(s, [0.7; 3]) },
    Case { name: "inertia-1.3", title: "inertia 30 % more than told", apply: |s, _| inertia(s, [1.3; 3]) },
    Case { name: "lag", title: "rotor lag 50 ms, known", apply: |s, _| late(s, 0.05, 0.0) },
    Case { name: "latency", title: "latency 10 ms, known", apply: |s, _| late(s, 0.0, 0.01) },
    Case {
        name: "rate-loop",
        title: "above a rate loop of 30 ms with rotors of 30 ms: 100 setpoints a second, 20 ms late, known",
        apply: |s, _| rate_loop(s),
    },
    Case { name: "noise", title: "sensor noise", apply: |s, _| s.sensors = Sensors::noisy() },
    Case { name: "lag-latency-noise", title: "lag, latency and noise together", apply: |s, _| hardware(s) },
    Case {
        name: "wind-mass-hardware",
        title: "0.7 kg, ±0.3 N, lag, latency and noise together",
        apply: |s, r| {
            s.vehicle.payload_mass = 0.7;
            force(s, r, 0.3);
            hardware(s);
        },
    },
    Case { name: "all", title: "everything at once, each drawn from its range", apply: all },
];

fn force(scenario: &mut Scenario, random: &mut Stream, half: f64) {
    let [x, y, _] = random.cube(half).into();
    scenario.environment.payload_force = [x, y, 0.0];
}

/// From the middle of the flight on. A hook has no drag area to speak of.
fn mass_step(scenario: &mut Scenario, mass: f64) {
    let at_s = 0.5 * scenario.duration_s;
    scenario.environment.payload_step = Some(PayloadStep { at_s, mass, drag_area: None });
}

/// From any horizontal direction.
fn wind(scenario: &mut Scenario, random: &mut Stream, speed: f64, gusty: bool) {
    let angle = random.uniform(0.0, std::f64::consts::TAU);
    let wind = [speed * libm::cos(angle), speed * libm::sin(angle), 0.0];
    let gusts = gusty.then_some(Gusts { speed_at_6m: speed, height: 10.0 });
    scenario.environment.air = Some(Air { wind, gusts, ..Air::default() });
}

fn inertia(scenario: &mut Scenario, factors: [f64; 3]) {
    for (inertia, factor) in scenario.vehicle.inertia.iter_mut().zip(factors) {
        *inertia *= factor;
    }
}

/// Lag and latency that every law knows of.
fn late(scenario: &mut Scenario, lag_s: f64, latency_s: f64) {
    scenario.actuators.lag_s = lag_s;
    scenario.actuators.latency_s = latency_s;
    scenario.controller.rotor_lag_s = lag_s;
    scenario.controller.latency_s = latency_s;
}

/// The rotors' lag is the loop's to make good, and no law is told of it.
fn rate_loop(scenario: &mut Scenario) {
    let rate_loop = RateLoop::default();
    scenario.controller.rate_hz = 100.0;
    scenario.controller.rate_loop_s = Some(rate_loop.time_constant_s);
    scenario.actuators.rate_loop = Some(rate_loop);
    late(scenario, 0.03, 0.02);
    scenario.controller.rotor_lag_s = 0.0;
}

fn hardware(scenario: &mut Scenario) {
    late(scenario, 0.05, 0.01);
    scenario.sensors = Sensors::noisy();
}

pub(super) fn all(scenario: &mut Scenario, random: &mut Stream) {
    let wind_speed = random.uniform(0.0, 5.0);
    wind(scenario, random, wind_speed, true);
    force(scenario, random, 0.3);
    scenario.vehicle.payload_mass *= random.uniform(0.5, 1.5);
    scenario.vehicle.rod_length *= random.uniform(0.9, 1.1);
    scenario.actuators.thrust_scale = random.uniform(0.85, 1.15);
    inertia(scenario, [(); 3].map(|()| random.uniform(0.7, 1.3)));
    hardware(scenario);
}

/// A random start about the point (0, r, p3) of the circle: payload within ±1.15 m and ±0.5 m/s an
/// axis, rod within ±0.2 rad (α, β), roll and pitch within ±0.1 rad, yaw ±0.2 rad, body and rod
/// at rest.
#[must_use]
pub fn start(radius: f64, p3: f64, random: &mut Stream) -> State<f64> {
    let position = random.cube(1.15);
    let velocity = random.cube(0.5);
    let [alpha, beta, _] = random.cube(0.2).into();
    let [phi, theta, _] = random.cube(0.1).into();
    let psi = random.uniform(-0.2, 0.2);
    let mut x = [0.0; 16];
    x[0] = position.x;
    x[1] = radius + position.y;
    x[2] = p3 + position.z;
    x[3..8].copy_from_slice(&[alpha, beta, phi, theta, psi]);
    x[8..11].copy_from_slice(velocity.as_slice());
    State::from_paper(&x)
}
