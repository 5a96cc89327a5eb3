//! A route of four waypoints, with a stop and a corner, laid into a table and flown from end to
//! end.
//!
//!     cargo run -p controller --example route

use controller::*;

mod plant;

/// Room for the table: it could as well be a `static` in flash.
const KNOTS: usize = 300;
const RUNS: usize = 4;

/// Over 8 m with a blended corner, at rest for a second, and down to the end.
fn waypoints() -> [Waypoint<f32>; 4] {
    let passed = Waypoint { point: [0.0, 0.0, -10.0], corner: Some(1.5), speed: 1.0, yaw: None, stop: None };
    [
        passed,
        Waypoint { point: [8.0, 0.0, -10.0], speed: 1.5, ..passed },
        Waypoint { point: [8.0, 6.0, -11.0], stop: Some(1.0), ..passed },
        Waypoint { point: [14.0, 6.0, -10.0], ..passed },
    ]
}

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let (mut knots, mut runs) = ([Knot::default(); KNOTS], [Run::default(); RUNS]);
    let built = build_route(&waypoints(), false, &RoutePace::default(), &mut knots, &mut runs)?;
    println!("{} knots, {} runs", built.knots, built.runs);
    let route = Route::new(RouteTable { knots: &knots[..built.knots], runs: &runs[..built.runs] })?;

    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    let follower = Follower::new(vehicle, route, Gains::spread(1.0)?, Sampling::every(0.002))?
        .with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] })?
        .with_observer(ObserverParams::with_bandwidth(8.0))?;
    let mut supervisor =
        Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), Policy::default())?;

    let mut flight = plant::Plant::at_rest(&params, Vector3::new(-1.0, 1.0, -10.0));
    supervisor.take_over(&flight.state(), Command::of_thrust(vehicle.hover_thrust()))?;
    for step in 0..30_000 {
        let output = supervisor.step(Some(&flight.state()), Request::Follow);
        flight.hold(&output.command, 0.002);
        if step % 2500 == 2499 {
            let p = flight.state().position;
            println!(
                "{:4.0} s  at {:6.2} {:6.2} {:6.2} m, {:?}",
                (step + 1) as f32 * 0.002,
                p.x,
                p.y,
                p.z,
                output.mode
            );
        }
    }
    let off = flight.state().position - Vector3::new(14.0, 6.0, -10.0);
    assert!(off.amax() < 1e-3, "{off}");
    Ok(())
}
