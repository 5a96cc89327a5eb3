//! Joining from afar: 20 m off the path in any direction, moving at 3 m/s with the rod swinging at
//! 25°, whatever the yaw.
//!
//! What the approach promises is checked on the plant: it keeps its limits once the swing it was
//! given has died, it joins without overshoot, and neither thrust nor torque steps when the law
//! takes over.

use controller::{
    ActuatorLimits, ApproachLimits, Circle, Command, Curve, Follower, Gains, Law, ObserverParams, Path, Sampling,
    State, Vector3, Vehicle, VehicleParams,
};
use hil_sim::world::multibody::{Loads, Multibody, rotation};
use hil_sim::world::random::{Purpose, Stream};
use std::f64::consts::{PI, TAU};
use witness::plant::{VehicleParameters, distance_to_circle};

const RADIUS: f64 = 5.0;
const P3: f64 = -10.0;
const PATH_SPEED: f64 = 1.0;
const PERIOD: f64 = 0.002;

/// Largest step of a torque from one command to the next, N·m: 5 % of what the actuators have.
const TORQUE_STEP: f64 = 0.15;

fn follower(bandwidth: f32) -> Follower<f32, impl Path<f32>> {
    let gains = Gains::spread(1.0).expect("stable poles");
    let vehicle = Vehicle::new(VehicleParams::paper()).expect("Table I");
    let path =
        Circle::new(RADIUS as f32, P3 as f32).and_then(|circle| circle.at_speed(PATH_SPEED as f32)).expect("a path");
    Follower::new(vehicle, path, gains, Sampling::every(PERIOD as f32))
        .and_then(|follower| follower.with_observer(ObserverParams::with_bandwidth(bandwidth)))
        .and_then(|follower| {
            follower.with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] })
        })
        .expect("a follower")
}

/// A unit vector `angle` from `e3`, in any direction about it.
fn leaning(angle: f64, random: &mut Stream) -> Vector3<f64> {
    let turn = random.uniform(0.0, TAU);
    let across = angle.sin();
    Vector3::new(across * turn.cos(), across * turn.sin(), angle.cos())
}

/// 20 m from the circle (it is the nearest point that is 20 m away), at 3 m/s anywhere, the rod at
/// 25° and swinging through, tilted by up to 0.2 rad, any yaw.
fn start(random: &mut Stream) -> State<f64> {
    let along = random.uniform(0.0, TAU);
    let elevation = random.uniform(-1.0, 1.0);
    let outward = Vector3::new(along.cos(), along.sin(), 0.0);
    let position = outward * RADIUS + (outward * elevation.cos() + Vector3::z() * elevation.sin()) * 20.0;
    let heading = leaning(random.uniform(0.0, PI), random);
    let rod = leaning(25_f64.to_radians(), random);
    // Half of the yaw, then half of a tilt about a horizontal axis.
    let (yaw, tilt, axis) = (random.uniform(-0.5, 0.5) * PI, random.uniform(0.0, 0.1), random.uniform(0.0, TAU));
    let attitude = rotation([yaw.cos(), 0.0, 0.0, yaw.sin()])
        * rotation([tilt.cos(), tilt.sin() * axis.cos(), tilt.sin() * axis.sin(), 0.0]);
    State { velocity: heading * 3.0, rod, attitude, ..State::at_rest(position + Vector3::z() * P3) }
}

/// The extremes of a flight.
#[derive(Debug, Default)]
struct Extremes {
    /// Angle of the rod from the vertical, rad, all the way.
    rod: f64,
    /// After the first swing: angles of thrust and rod from the vertical, rad, speed (m/s) and
    /// thrust (N).
    calm_tilt: f64,
    calm_rod: f64,
    calm_speed: f64,
    calm_thrust: [f64; 2],
    /// The first command against what was applied before, as a share of hover and in N·m.
    first_thrust: f64,
    first_torque: f64,
    torque: f64,
    torque_step: f64,
    /// d_C after the slide, m, and at the end.
    overshoot: f64,
    end: f64,
}

fn join(seed: u64, bandwidth: f32) -> Extremes {
    let mut random = Stream::new(20, seed, Purpose::Draw);
    let state = start(&mut random);
    let mut body = Multibody::new(VehicleParameters::default(), &state);
    let mut follower = follower(bandwidth);
    let hover = f64::from(follower.vehicle().hover_thrust());
    let applied = Command { thrust: hover as f32, torque: Vector3::zeros() };
    let pace = ApproachLimits::gentle().pace(follower.vehicle()).expect("limits in range");
    follower.join(&state.cast(), applied, &pace).unwrap_or_else(|refused| panic!("seed {seed}: {refused}"));
    let slide = f64::from(follower.law().approach().remaining());
    // The rod's own period, as of a pendulum from a UAV held still.
    let swing = TAU * (2.0_f64 / 9.81).sqrt();
    let mut seen = Extremes { calm_thrust: [f64::INFINITY, 0.0], ..Extremes::default() };
    let mut last: Command<f64> = Command { thrust: hover, torque: Vector3::zeros() };
    for step in 0..((slide + 20.0) / PERIOD) as u32 {
        let t = PERIOD * f64::from(step);
        let state = body.state();
        let command = follower.step(&state.cast()).command;
        let command = Command { thrust: f64::from(command.thrust), torque: command.torque.map(f64::from) };
        if step == 0 {
            seen.first_thrust = (command.thrust - last.thrust).abs() / hover;
            seen.first_torque = command.torque.amax();
        }
        let (tilt, rod) = (state.attitude.m33.acos(), state.rod.z.acos());
        seen.rod = seen.rod.max(rod);
        if t > swing {
            seen.calm_tilt = seen.calm_tilt.max(tilt);
            seen.calm_rod = seen.calm_rod.max(rod);
            seen.calm_speed = seen.calm_speed.max(state.velocity.dot(&state.velocity).sqrt());
            let [low, high] = seen.calm_thrust;
            seen.calm_thrust = [low.min(command.thrust), high.max(command.thrust)];
        }
        seen.torque = seen.torque.max(command.torque.amax());
        seen.torque_step = seen.torque_step.max((command.torque - last.torque).amax());
        seen.end = distance_to_circle(state.position.into(), RADIUS, P3);
        if t > slide {
            seen.overshoot = seen.overshoot.max(seen.end);
        }
        body.advance(PERIOD, |_| command, |_, _| Loads::none());
        last = command;
    }
    seen
}

#[test]
fn joining_from_twenty_metres_away_keeps_the_limits_and_does_not_overshoot() {
    let limits = ApproachLimits::<f64>::gentle();
    let hover = f64::from(Vehicle::new(VehicleParams::<f32>::paper()).expect("Table I").hover_thrust());
    for bandwidth in [0.0, 8.0] {
        for seed in 0..20 {
            let seen = join(seed, bandwidth);
            let told = format!("seed {seed}, observers of {bandwidth} rad/s: {seen:?}");
            assert!(seen.calm_tilt <= limits.tilt, "{told}");
            assert!(seen.calm_rod <= limits.rod_angle, "{told}");
            // The limit is the slide's; the path's own speed comes on top.
            assert!(seen.calm_speed <= limits.speed + PATH_SPEED, "{told}");
            let [least, largest] = seen.calm_thrust.map(|thrust| thrust / hover);
            assert!(least >= limits.min_thrust && largest <= limits.max_thrust, "{told}");
            assert!(seen.first_thrust <= 0.01, "{told}");
            assert!(seen.first_torque <= TORQUE_STEP && seen.torque_step <= TORQUE_STEP, "{told}");
            assert!(seen.overshoot <= 0.1 && seen.end <= 0.01, "{told}");
            // What it was given is not made worse.
            assert!(seen.rod <= 25.5_f64.to_radians() && seen.torque < 3.0, "{told}");
        }
    }
}
