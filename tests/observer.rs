//! What the disturbance observers find, and what they cost: the f32 law at 500 Hz on the circle of
//! 5 m at 1 m/s, on a plant that differs from what the law is told.

use controller::Disturbance;
use controller::{
    ActuatorLimits, Circle, Command, Curve, Follower, Gains, ObserverParams, Sampling, State, Vector3, Vehicle,
    VehicleParams,
};
use hil_sim::world::multibody::{Loads, Multibody};
use std::ops::Range;
use witness::plant::{VehicleParameters, distance_to_circle};

const RADIUS: f64 = 5.0;
const P3: f64 = -10.0;
const PERIOD: f64 = 0.002;

/// Bandwidths in use, rad/s: the prototype's, and the one that gusts ask for.
const BANDWIDTHS: [f32; 2] = [4.0, 8.0];

/// A flight to be had.
#[derive(Clone, Copy)]
struct Setting {
    /// Of the observers, rad/s; 0 is off.
    bandwidth: f32,
    /// Of the payload that flies, kg; the law is told 0.5.
    mass: f64,
    /// It becomes this, kg, at this time, s.
    step: Option<(f64, f64)>,
    /// On the payload in N, N, from this time on, s.
    force: (f64, Vector3<f64>),
    duration: f64,
}

impl Setting {
    fn new(bandwidth: f32) -> Self {
        Self { bandwidth, mass: 0.5, step: None, force: (0.0, Vector3::zeros()), duration: 30.0 }
    }
}

/// What a flight shows at one sample.
struct Sample {
    t: f64,
    distance: f64,
    position: Vector3<f64>,
    rod: Vector3<f64>,
    estimate: Disturbance<f64>,
    /// kg.
    implied_mass: f64,
}

/// Flies from a metre off the path, at rest.
fn fly(setting: &Setting) -> Vec<Sample> {
    let gains = Gains::spread(1.0).expect("stable poles");
    let vehicle = Vehicle::new(VehicleParams::paper()).expect("Table I");
    let path = Circle::new(RADIUS as f32, P3 as f32).and_then(|circle| circle.at_speed(1.0)).expect("a path");
    let mut follower = Follower::new(vehicle, path, gains, Sampling::every(PERIOD as f32))
        .and_then(|follower| follower.with_observer(ObserverParams::with_bandwidth(setting.bandwidth)))
        .and_then(|follower| {
            follower.with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] })
        })
        .expect("a follower");

    let state = State::at_rest(Vector3::new(RADIUS + 0.6, 0.0, P3 - 0.8));
    let mut body = Multibody::new(VehicleParameters { payload_mass: setting.mass, ..Default::default() }, &state);
    follower.take_over(&state.cast(), Command::of_thrust(vehicle.hover_thrust())).expect("a good state");
    let (onset, payload_force) = setting.force;
    (0..(setting.duration / PERIOD) as u32)
        .map(|step| {
            let t = PERIOD * f64::from(step);
            if let Some((at, mass)) = setting.step
                && t >= at
            {
                body.set_payload_mass(mass);
            }
            let state = body.state();
            let solution = follower.step(&state.cast());
            let disturbance = follower.disturbance();
            let sample = Sample {
                t,
                distance: distance_to_circle(state.position.into(), RADIUS, P3),
                position: state.position,
                rod: state.rod,
                estimate: disturbance.cast(),
                implied_mass: f64::from(follower.sampler().payload_mass()),
            };
            let Command { thrust, torque } = solution.command;
            let command = Command { thrust: f64::from(thrust), torque: torque.cast() };
            let loads = if t >= onset { Loads { payload_force, ..Loads::none() } } else { Loads::none() };
            body.advance(PERIOD, |_| command, |_, _| loads);
            sample
        })
        .collect()
}

fn length(v: Vector3<f64>) -> f64 {
    v.dot(&v).sqrt()
}

/// The largest, NaN if there is one.
fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| if value <= most || most.is_nan() { most } else { value })
}

/// The largest of a value over a span of time.
fn largest(samples: &[Sample], span: &Range<f64>, value: impl Fn(&Sample) -> f64) -> f64 {
    worst(samples.iter().filter(|sample| span.contains(&sample.t)).map(value))
}

#[test]
fn a_steady_newton_on_the_payload_is_found_and_flown() {
    let told = Vehicle::new(VehicleParams::<f64>::paper()).expect("Table I");
    let force = Vector3::new(0.6, -0.8, 0.0);
    // In mid-lap, and at rest a metre off the path.
    for onset in [10.0, 0.0] {
        let samples = fly(&Setting { force: (onset, force), ..Setting::new(8.0) });
        let missed = |sample: &Sample| length(sample.estimate.payload_force(&told, &sample.rod) - force);
        let missed = largest(&samples, &(onset + 3.0..30.0), missed);
        let distance = largest(&samples, &(onset + 15.0..30.0), |sample| sample.distance);
        println!("onset at {onset} s: missed by {missed:.4} N, d_C {distance:.1e} m");
        assert!(missed < 0.02, "onset at {onset} s: {missed} N of 1 N");
        assert!(distance < 1e-3, "onset at {onset} s: {distance} m");
    }
}

#[test]
fn observers_of_a_perfect_model_change_a_flight_by_less_than_a_millimetre() {
    let without = fly(&Setting::new(0.0));
    for bandwidth in BANDWIDTHS {
        let with = fly(&Setting::new(bandwidth));
        let apart = with.iter().zip(&without).map(|(with, without)| length(with.position - without.position));
        let distance = worst(apart);
        // In space, which bounds the change of d_C.
        assert!(distance < 1e-3, "{bandwidth} rad/s: {distance} m");
    }
}

#[test]
fn a_wrong_payload_mass_is_told() {
    for (mass, bandwidth) in [(0.74, 4.0), (0.74, 8.0), (0.25, 8.0)] {
        let samples = fly(&Setting { mass, ..Setting::new(bandwidth) });
        let error = largest(&samples, &(5.0..30.0), |sample| (sample.implied_mass / mass - 1.0).abs());
        assert!(error < 0.01, "{mass} kg, {bandwidth} rad/s: off by {error}");
    }
    // Nothing wrong, nothing told.
    let samples = fly(&Setting::new(8.0));
    let error = largest(&samples, &(0.0..30.0), |sample| (sample.implied_mass - 0.5).abs());
    assert!(error < 0.01, "{error} kg");
}

#[test]
fn payloads_picked_up_and_dropped_in_flight_are_flown_on() {
    // +200 %, and a drop that leaves the hook.
    for (mass, bandwidth) in [(1.5, 4.0), (1.5, 8.0), (0.02, 4.0), (0.02, 8.0)] {
        let setting = Setting { step: Some((15.0, mass)), duration: 45.0, ..Setting::new(bandwidth) };
        let samples = fly(&setting);
        let before = largest(&samples, &(14.0..15.0), |sample| sample.distance);
        // A step of twice the payload's weight lets it drop before anything can know.
        let peak = largest(&samples, &(15.0..45.0), |sample| sample.distance);
        let late = largest(&samples, &(30.0..45.0), |sample| sample.distance);
        let told = largest(&samples, &(30.0..45.0), |sample| (sample.implied_mass - mass).abs());
        assert!(before < 1e-3 && late < 0.02, "{mass} kg, {bandwidth} rad/s: {before} m, {late} m");
        assert!(peak < 2.0, "{mass} kg, {bandwidth} rad/s: {peak} m");
        assert!(told < 0.01, "{mass} kg, {bandwidth} rad/s: told {told} kg beside it");
    }
}
