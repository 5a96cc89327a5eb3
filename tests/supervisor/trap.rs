//! The scalar that stops at the first invalid operation, in flight.

use controller::{
    Circle, Command, Curve, Follower, Gains, Real, Sampling, State, Trapped, Vector3, Vehicle, VehicleParams,
};
use hil_sim::describe::scenario;
use hil_sim::fly::run::{Arithmetic, fly_simply};

#[test]
fn a_flight_meets_no_invalid_operation_and_is_the_same_with_the_trap_set() {
    let scenario = scenario::builtin("fig2b").unwrap().unwrap();
    let plain = fly_simply(&scenario, Arithmetic::F32).unwrap();
    let trapped = fly_simply(&scenario, Arithmetic::Trapped).unwrap();
    assert!(!plain.log.is_empty());
    assert_eq!(plain.log, trapped.log);
}

/// The law from `state`, three steps of it, without a supervisor.
fn law<T: Real>(state: &State<f64>) -> [Command<f64>; 3] {
    let circle = Circle::new(T::lit(5.0), T::lit(-10.0)).unwrap().at_speed(T::one()).unwrap();
    let gains = Gains::spread(T::one()).unwrap();
    let vehicle = Vehicle::new(VehicleParams::paper()).unwrap();
    let mut follower = Follower::new(vehicle, circle, gains, Sampling::every(T::lit(0.002))).unwrap();
    follower.start(&state.cast(), [T::zero(); 4]).unwrap();
    core::array::from_fn(|_| {
        let Command { thrust, torque } = follower.step(&state.cast()).command;
        Command { thrust: thrust.to_f64(), torque: torque.map(Real::to_f64) }
    })
}

#[test]
fn a_trapped_law_is_the_flying_one() {
    let state = State::at_rest(Vector3::new(5.5, 0.3, -9.8));
    assert_eq!(law::<Trapped>(&state), law::<f32>(&state));
}

#[test]
#[should_panic(expected = "invalid operation")]
fn a_law_at_its_singularity_stops() {
    law::<Trapped>(&State { rod: Vector3::x(), ..State::at_rest(Vector3::new(5.5, 0.3, -9.8)) });
}
