//! Four rotors in place of thrust and torque: what they can't give, the law knows of.
//!
//!     cargo run -p controller --example rotors

use controller::*;

mod plant;

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    // Where they are: b1 forward, b2 right, m; seen from above, diagonal pairs turn the same way.
    let place = |x, y| Place { x, y, counter_clockwise: x * y > 0.0 };
    let places = [place(0.18, 0.18), place(-0.18, -0.18), place(0.18, -0.18), place(-0.18, 0.18)];
    let rotor =
        RotorParams { thrust_coefficient: 2e-5, torque_coefficient: 3.2e-7, min_speed: 80.0, max_speed: 900.0 };
    let rotors = Rotors::new(rotor, &places)?;

    let path = Circle::new(5.0, -10.0)?.at_speed(1.0)?;
    let follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(0.002))?
        .with_actuation(rotors)?
        .with_observer(ObserverParams::with_bandwidth(8.0))?;
    let mut supervisor =
        Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), Policy::default())?;

    let mut flight = plant::Plant::at_rest(&params, Vector3::new(6.0, 0.0, -10.0));
    let hover = Command::of_thrust(vehicle.hover_thrust());
    supervisor.take_over(&flight.state(), hover)?;
    for step in 0..10_000 {
        let output = supervisor.step(Some(&flight.state()), Request::Follow);
        // What a motor driver needs: speeds, rad/s, within their range.
        let allocation = rotors.allocate(&output.command);
        assert!(!allocation.saturated, "the supervisor has limited the command to what they give");
        flight.hold(&allocation.applied, 0.002);
        if step % 1000 == 999 {
            println!("{:4.0} s  rotors at {:.1?} rad/s", (step + 1) as f32 * 0.002, allocation.speeds);
        }
    }
    let p = flight.state().position;
    assert!((p.x.hypot(p.y) - 5.0).hypot(p.z + 10.0) < 1e-3, "{p}");
    Ok(())
}
