//! Joining under noise: the step from hold's command to the law's leaves no motion behind.

use controller::{Measured, Mode, Policy, Request, Sampling, State, Uav, Vector3};
use hil_sim::world::random::{Purpose, Stream};

use crate::flight::{CIRCLE, Flight, PERIOD, follower, supervise, vehicle};

/// Holds beside the path for three seconds on noisy measurements, then joins, and gives the largest
/// vertical speed of the load in the join's first second, m/s.
fn sinks_at(run: u64) -> f64 {
    let (lag, mut random) = (0.05, Stream::new(1, run, Purpose::Sensor));
    let sampling = Sampling { rotor_lag: lag as f32, ..Sampling::every(PERIOD as f32) };
    let start = State::at_rest(Vector3::new(CIRCLE[0] + 3.0, 0.0, CIRCLE[1]));
    let law = supervise(follower(1.0, 8.0, sampling, [0.0; 3]), Policy::default());
    let mut flight = Flight::new(law, &start, 0.5, f64::from(vehicle().hover_thrust()), lag);
    let mut noise = |deviation: f32| random.normals().map(|unit| unit as f32 * deviation);
    let mut sunk = 0.0_f64;
    for step in 0..2000 {
        let exact: State<f32> = flight.body.state().cast();
        let rod = (exact.rod + noise(0.005)).normalize();
        let rod_rate = exact.rod_rate + noise(0.02);
        let state = State {
            position: exact.position + noise(0.02),
            velocity: exact.velocity + noise(0.03),
            rod_rate: rod_rate - rod * rod.dot(&rod_rate),
            rod,
            body_rate: exact.body_rate + noise(0.01),
            ..exact
        };
        let uav = Uav { velocity: flight.uav().velocity + noise(0.03), ..flight.uav() };
        let measured = Measured { state: Some(&state), uav: Some(&uav), specific_force: None };
        let request = if step < 1500 { Request::Hold } else { Request::Follow };
        let output = flight.supervisor.step(measured, request);
        flight.fly(output);
        if step >= 1500 {
            assert_eq!(output.mode, Mode::Join, "{output:?}");
            sunk = sunk.max(flight.body.state().velocity.z.abs());
        }
    }
    sunk
}

/// One sample's noise is an acceleration of 0.05 m/s², half of it by hold's 2 1/s of velocity,
/// which the compensator goes on from; twice that for a second. Grown by what fades of the step, it
/// was 0.25 m/s.
#[test]
fn a_noisy_hold_leaves_no_fall_behind_in_the_join() {
    let worst = (0..20).map(sinks_at).fold(0.0, f64::max);
    assert!(worst < 0.1, "{worst} m/s");
}
