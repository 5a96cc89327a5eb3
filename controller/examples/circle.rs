//! The paper's circle in ten lines: a payload 1 m outside it joins it, and stays on it.
//!
//!     cargo run -p controller --example circle

use controller::*;

mod plant;

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    let path = Circle::new(5.0, -10.0)?.at_speed(1.0)?;
    let follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(0.002))?
        .with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] })?
        .with_observer(ObserverParams::with_bandwidth(8.0))?;
    let mut supervisor =
        Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), Policy::default())?;

    let mut flight = plant::Plant::at_rest(&params, Vector3::new(6.0, 0.0, -10.0));
    let hover = Command::of_thrust(vehicle.hover_thrust());
    supervisor.take_over(&flight.state(), hover)?;
    for step in 0..10_000 {
        let output = supervisor.step(Some(&flight.state()), Request::Follow);
        flight.hold(&output.command, 0.002);
        if step % 1000 == 999 {
            let p = flight.state().position;
            let off = (p.x.hypot(p.y) - 5.0).hypot(p.z + 10.0);
            println!("{:4.0} s  {:8.1} mm from the circle, {:?}", (step + 1) as f32 * 0.002, off * 1e3, output.mode);
        }
    }
    let p = flight.state().position;
    assert!((p.x.hypot(p.y) - 5.0).hypot(p.z + 10.0) < 1e-3, "{p}");
    Ok(())
}
