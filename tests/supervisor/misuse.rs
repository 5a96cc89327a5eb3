//! An interface that can't be misused: what makes no sense is refused where it is said, with the
//! reason, and changes nothing.

use controller::{
    ActuatorLimits, Analytic, Channel, Circle, Command, Curve, FixedYaw, Follower, FourierPath, Gains, Harmonics,
    Linear, Path, PointingAt, Policy, Refused, Request, RotorParams, Rotors, Sampling, Series, State, Vector3,
};

use crate::flight::{CIRCLE, LIMITS, PERIOD, follower, gains, supervisor, vehicle};

#[test]
fn profiles_are_checked_when_they_are_made() {
    let circle = Circle::new(5.0_f32, -10.0).unwrap();
    for speed in [f32::NAN, f32::INFINITY, 101.0] {
        assert_eq!(circle.at_speed(speed).unwrap_err().field, "speed");
    }
    assert_eq!(FixedYaw::new(1e9_f32).unwrap_err().field, "yaw");
    assert_eq!(Linear::new(0.0, Vector3::new(f32::NAN, 0.0, 0.0)).unwrap_err().field, "gradient");
    assert_eq!(Linear::new(f32::NAN, Vector3::zeros()).unwrap_err().field, "value");
    assert_eq!(PointingAt::new(0.0, f32::INFINITY).unwrap_err().field, "y");
    assert_eq!(Gains::spread(-1.0_f32).unwrap_err().field, "bandwidth");
}

#[test]
fn actuators_that_can_not_hover_are_refused_by_name() {
    let hover = vehicle().hover_thrust();
    let refused = |limits| match follower(1.0, 0.0, Sampling::every(0.002), [0.0; 3]).with_limits(limits) {
        Err(controller::SetupError::Range(error)) => error.field,
        other => panic!("{:?}", other.err()),
    };
    assert_eq!(refused(ActuatorLimits { max_thrust: 0.99 * hover, ..LIMITS }), "max_thrust");
    assert_eq!(refused(ActuatorLimits { min_thrust: 1.01 * hover, ..LIMITS }), "min_thrust");
    let weak = Rotors::quad_x(RotorParams::typical(0.4 * hover, 4), 0.25).unwrap();
    assert!(follower(1.0, 0.0, Sampling::every(0.002), [0.0; 3]).with_actuation(weak).is_err());
}

#[test]
fn bad_states_and_commands_are_refused_with_the_reason() {
    let good = State::at_rest(Vector3::new(5.5, 0.0, -10.0));
    let bad = State { rod: Vector3::zeros(), ..good };
    let hover = Command::of_thrust(vehicle().hover_thrust());
    let nothing = Command::of_thrust(f32::NAN);
    let mut law = supervisor(Sampling::every(PERIOD as f32), Policy::default());
    let mut bare = follower(1.0, 4.0, Sampling::every(PERIOD as f32), [0.0; 3]);
    let pace = controller::ApproachLimits::gentle().pace(&vehicle()).unwrap();
    for (state, applied, reason) in [(&bad, hover, Refused::State(Channel::Rod)), (&good, nothing, Refused::Applied)]
    {
        assert_eq!(law.take_over(state, applied), Err(reason));
        assert_eq!(bare.take_over(state, applied), Err(reason));
        assert_eq!(bare.join(state, applied, &pace), Err(reason));
    }
    assert_eq!(law.start(&good, [0.0, f32::INFINITY, 0.0, 0.0]), Err(Refused::Zeta));
    // As if nothing had been said.
    let mut fresh = supervisor(Sampling::every(PERIOD as f32), Policy::default());
    assert_eq!(law.step(Some(&good), Request::Hold), fresh.step(Some(&good), Request::Hold));
}

/// A loop of one harmonic, 10 m from where its search begins.
fn circle_by_harmonics() -> FourierPath<f32, 1> {
    let [radius, p3] = CIRCLE.map(|x| x as f32);
    let harmonics = Harmonics {
        center: [0.0, 0.0, p3],
        cos: [[radius, 0.0, 0.0]],
        sin: [[0.0, radius, 0.0]],
        reference: [0.0, 0.0, 1.0],
    };
    FourierPath::new(harmonics).unwrap()
}

#[test]
fn a_follower_that_nothing_started_starts_itself() {
    let path = circle_by_harmonics().at_speed(0.0).unwrap();
    let mut forgotten = Follower::new(vehicle(), path, gains([0.0; 3]), Sampling::every(PERIOD as f32)).unwrap();
    let mut started = forgotten.clone();
    let across = State::at_rest(Vector3::new(-CIRCLE[0] as f32, 0.0, CIRCLE[1] as f32));
    started.start(&across, [0.0; 4]).unwrap();
    let solution = forgotten.step(&across);
    assert_eq!(solution, started.step(&across));
    assert!(solution.xi.h1[0].abs() < 1e-5 && solution.command.torque.amax() < 1e-4, "{solution:?}");
}

#[test]
fn a_path_chosen_at_run_time_is_a_path() {
    let mut circle = Circle::new(5.0_f32, -10.0).unwrap().at_speed(1.0).unwrap();
    let mut knot = circle_by_harmonics().at_speed(1.0).unwrap();
    let state = State::at_rest(Vector3::new(5.0, 0.0, -10.0));
    for by_name in ["circle", "harmonics"] {
        let path: &mut dyn Path<f32> = if by_name == "circle" { &mut circle } else { &mut knot };
        let mut follower = Follower::new(vehicle(), path, gains([0.0; 3]), Sampling::every(PERIOD as f32)).unwrap();
        // At rest on either: h3 = −v_d alone.
        let h3 = follower.step(&state).xi.h3[0];
        assert!((h3 + 1.0).abs() < 1e-5, "{by_name}: {h3}");
    }
}

#[test]
fn a_scalar_stands_on_either_side() {
    let x = Series([0.5, -1.0, 2.0, 0.25]);
    assert_eq!(20.0 * x, x * 20.0);
    assert_eq!(20.0 + x, x + 20.0);
    assert_eq!(20.0 - x, -x + 20.0);
    assert_eq!(20.0 / x, Series::constant(20.0) / x);
    assert_eq!(2.0_f32 * Series([1.0_f32, 3.0]).square(), Series([2.0, 12.0]));
}
