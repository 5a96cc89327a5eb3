//! The baseline: following a reference in time, where a path would wait for the payload.
//!
//!     cargo run -p controller --example tracking

use controller::*;

mod plant;

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    let mut tracker = Tracker::new(vehicle, TrackGains::spread(1.0)?, Sampling::every(0.002))?;

    let mut flight = plant::Plant::at_rest(&params, Vector3::new(0.0, 5.0, -10.0));
    let hover = Command::of_thrust(vehicle.hover_thrust());
    tracker.take_over(&flight.state(), hover)?;
    // y_ref = (5 sin a, 5 cos a, −10 m) with a turning at 0.2 rad/s: 1 m/s.
    let phase = |step: u16| 0.2 * 0.002 * f32::from(step);
    let mut off = 0.0;
    for step in 0..=10_000 {
        let state = flight.state();
        let reference = Reference::circle(5.0, -10.0, 0.2, phase(step));
        off = distance(&state, reference.position.map(|p| p.value()));
        if step % 1000 == 0 {
            println!("{:4.0} s  {:8.1} mm from the reference", f32::from(step) * 0.002, off * 1e3);
        }
        let solution = tracker.track(&state, &reference);
        flight.hold(&solution.command, 0.002);
    }
    assert!(off < 1e-3, "{off} m");
    Ok(())
}

/// From the payload to a point, m.
fn distance(state: &State<f32>, point: [f32; 3]) -> f32 {
    let off = state.position - Vector3::from(point);
    off.dot(&off).sqrt()
}
