//! Thrust limited in mid-lap: nothing winds up.

use controller::{ActuatorLimits, Mode, Policy, Request, Sampling, State, Vector3};

use crate::flight::{CIRCLE, Flight, LIMITS, PERIOD, deviation, follower, supervise, vehicle};

/// Limits the thrust to 1.05 hover for two seconds at 4.5 m/s, which needs 1.08 of it, and gives
/// what the payload then sinks and overshoots, m, and the time from the release until it stays
/// within 5 cm of the path, s.
fn limited_for_two_seconds(bandwidth: f32, integral: [f32; 3], lag: f64) -> [f64; 3] {
    let sampling = Sampling { rotor_lag: lag as f32, ..Sampling::every(PERIOD as f32) };
    let law = supervise(follower(4.5, bandwidth, sampling, integral), Policy::default());
    let start = State::at_rest(Vector3::new(CIRCLE[0], 0.0, CIRCLE[1]));
    let mut flight = Flight::new(law, &start, 0.5, f64::from(vehicle().hover_thrust()), lag);
    flight.until(Mode::Follow, Request::Follow, 30.0);
    let seconds = |seconds: f64| (seconds / PERIOD).round() as usize;
    for _ in 0..seconds(15.0) {
        flight.step(Request::Follow);
    }
    assert!(deviation(&flight.body.state().position) < 0.02);

    let limits = ActuatorLimits { max_thrust: 1.05 * vehicle().hover_thrust(), ..LIMITS };
    flight.supervisor.set_actuation(limits).unwrap();
    let (mut sunk, mut over, mut back) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut limited = 0;
    for step in 0..seconds(22.0) {
        if step == seconds(2.0) {
            flight.supervisor.set_actuation(LIMITS).unwrap();
        }
        let output = flight.step(Request::Follow);
        assert_eq!(output.mode, Mode::Follow);
        limited += usize::from(output.command.thrust == limits.max_thrust);
        let position = flight.body.state().position;
        sunk = sunk.max(position.z - CIRCLE[1]);
        over = over.max(CIRCLE[1] - position.z);
        if deviation(&position) > 0.05 {
            back = (step as f64 + 1.0) * PERIOD - 2.0;
        }
    }
    assert!(limited > seconds(1.8), "limited for {limited} steps only");
    assert!(sunk > 0.2, "an excursion of {sunk} m shows nothing");
    [sunk, over, back]
}

#[test]
fn nothing_winds_up_while_thrust_is_limited() {
    for (bandwidth, integral, lag) in [(4.0, [0.0; 3], 0.0), (4.0, [0.0; 3], 0.05), (0.0, [108.0, 108.0, 12.0], 0.0)]
    {
        let [sunk, over, back] = limited_for_two_seconds(bandwidth, integral, lag);
        println!(
            "observers {bandwidth}, integral {integral:?}, lag {lag}: sunk {sunk:.3}, over {over:.3}, back after {back:.2} s"
        );
        assert!(over < 0.25 * sunk, "overshoot {over} after {sunk}");
        assert!(back < 5.0, "back after {back} s");
    }
}
