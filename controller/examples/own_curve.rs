//! A curve of your own: two functions that vanish on it, in ordinary arithmetic. Gradients and all
//! derivatives in time follow from them.
//!
//!     cargo run -p controller --example own_curve

use controller::*;

mod plant;

/// A rounded rectangle of 10 m by 8 m, seen from above, that rides a wave of ±0.5 m.
#[derive(Clone, Copy)]
struct Wave;

impl Implicit<f32> for Wave {
    fn surfaces<A: Analytic<f32>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        [(x / 5.0).powi(4) + (y / 4.0).powi(4) - 1.0, z + 10.0 - (x / 2.0).sin() * 0.5]
    }
}

/// 1.5 m/s, and up to 0.5 m/s more in the north.
#[derive(Clone, Copy)]
struct Faster;

impl ScalarField<f32> for Faster {
    fn at<A: Analytic<f32>>(&self, [x, _, _]: [A; 3]) -> A {
        x * 0.1 + 1.5
    }
}

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    let path = Formula(Wave).with_speed(Formula(Faster)).with_yaw(AlongTangent);
    let mut follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(0.002))?
        .with_observer(ObserverParams::with_bandwidth(8.0))?;

    let mut flight = plant::Plant::at_rest(&params, Vector3::new(5.0, 0.0, -9.7));
    let hover = Command::of_thrust(vehicle.hover_thrust());
    follower.take_over(&flight.state(), hover)?;
    let mut xi = Xi::default();
    for step in 0..10_000 {
        let solution = follower.step(&flight.state());
        flight.hold(&solution.command, 0.002);
        xi = solution.xi;
        if step % 1000 == 999 {
            let [h1, h2] = [xi.h1[0], xi.h2[0]];
            println!("{:4.0} s  h1 = {h1:9.2e}, h2 = {h2:9.2e} m", (step + 1) as f32 * 0.002);
        }
    }
    assert!(xi.h1[0].abs() < 1e-3 && xi.h2[0].abs() < 1e-3, "{xi:?}");
    Ok(())
}
