//! The tracking law under the supervisor: the same modes, the same approach, a reference in time
//! for a path.

use controller::{
    EnvelopeParams, Fault, Law, Mode, ObserverParams, Policy, Reference, Request, Sampling, State, Supervisor, Track,
    TrackGains, Tracker, Vector3,
};

use crate::flight::{CIRCLE, Flight, LIMITS, PERIOD, supervise, vehicle};

/// Angular rate of the reference, rad/s: 1 m/s.
const RATE: f64 = 0.2;

fn supervisor() -> Supervisor<f32, Track<f32>> {
    let gains = TrackGains::spread(1.0).unwrap();
    let tracker = Tracker::new(vehicle(), gains, Sampling::every(PERIOD as f32)).unwrap();
    let tracker = tracker.with_limits(LIMITS).unwrap().with_observer(ObserverParams::with_bandwidth(4.0)).unwrap();
    supervise(tracker, Policy::default())
}

fn reference(step: usize) -> Reference<f32> {
    Reference::circle(CIRCLE[0] as f32, CIRCLE[1] as f32, RATE as f32, (RATE * PERIOD * step as f64) as f32)
}

/// Distance from the reference at `step`, m.
fn off(flight: &Flight<Track<f32>>, step: usize) -> f64 {
    let [x, y, z] = reference(step).position.map(|p| f64::from(p.value()));
    let away = flight.body.state().position - Vector3::new(x, y, z);
    away.dot(&away).sqrt()
}

#[test]
fn a_reference_is_joined_from_afar_and_tracked() {
    let start = State::at_rest(Vector3::new(8.0, -3.0, -6.0));
    let mut flight = Flight::new(supervisor(), &start, 0.5, f64::from(vehicle().hover_thrust()), 0.0);
    let wide = EnvelopeParams::<f64>::wide();
    let (mut joined, mut worst) = (None, 0.0_f64);
    for step in 0..15_000 {
        flight.supervisor.law_mut().set_reference(&reference(step));
        let output = flight.step(Request::Follow);
        assert!(matches!(output.mode, Mode::Join | Mode::Follow), "{output:?} at step {step}");
        assert_eq!((output.fault, output.warning), (None, None));
        assert!(flight.body.state().rod.z > wide.rod_angle.warning.cos());
        if output.mode == Mode::Follow {
            joined.get_or_insert(step);
            worst = worst.max(off(&flight, step + 1));
        }
    }
    let joined = joined.expect("joined within 30 s");
    assert!(flight.supervisor.solution().is_some() && !flight.supervisor.law().approach().is_active());
    println!("joined after {:.1} s, at most {:.2} mm off from then on", joined as f64 * PERIOD, worst * 1e3);
    // What the end of the slide leaves, and f32's rounding of the phase.
    assert!(worst < 2e-3, "{worst} m");
}

#[test]
fn a_reference_of_no_numbers_leads_to_hold() {
    let start = State::at_rest(Vector3::new(0.0, CIRCLE[0], CIRCLE[1]));
    let mut flight = Flight::new(supervisor(), &start, 0.5, f64::from(vehicle().hover_thrust()), 0.0);
    flight.supervisor.law_mut().set_reference(&reference(0));
    assert_eq!(flight.step(Request::Follow).mode, Mode::Join);
    let nowhere = Reference::circle(f32::NAN, 0.0, 0.0, 0.0);
    flight.supervisor.law_mut().set_reference(&nowhere);
    let output = flight.step(Request::Follow);
    assert_eq!((output.mode, output.fault), (Mode::Hold, Some(Fault::NotFinite)));
    // And back, once there is one again: what was no number has left no trace.
    for step in 0..10_000 {
        flight.supervisor.law_mut().set_reference(&reference(step));
        flight.step(Request::Follow);
    }
    assert_eq!(flight.supervisor.mode(), Mode::Follow);
    assert!(off(&flight, 10_000) < 2e-3);
}
