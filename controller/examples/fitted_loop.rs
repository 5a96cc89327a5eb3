//! A smooth loop through waypoints, as `hil-sim fit FILE --rust` prints it: here round a building.
//!
//!     cargo run -p controller --example fitted_loop

use controller::{
    ActuatorLimits, AlongTangent, ApproachLimits, Command, CurvatureLimited, Curve, EnvelopeParams, Follower,
    FourierPath, Gains, ObserverParams, Policy, Request, Sampling, Supervisor, Vector3, Vehicle, VehicleParams,
};

mod plant;

/// Fitted to building.csv: waypoints within 0.0013 m, length 89.685 m, least radius 4.596 m.
/// In N, m.
const PATH: controller::Harmonics<f32, 7> = controller::Harmonics {
    center: [0.0, 0.0, -15.0],
    cos: [
        [15.609456, 3.028668, 0.0],
        [0.0, 0.0, 0.0],
        [-0.94126904, 1.1954411, 0.0],
        [0.0, 0.0, 0.0],
        [0.17281385, 0.000581648, 0.0],
        [0.0, 0.0, 0.0],
        [0.14891064, -0.07429009, 0.0],
    ],
    sin: [
        [-4.2210684, 11.199975, 0.0],
        [0.0, 0.0, 0.0],
        [0.95435727, 1.1790466, 0.0],
        [0.0, 0.0, 0.0],
        [-0.6759699, 0.0001487, 0.0],
        [0.0, 0.0, 0.0],
        [0.5219581, 0.021194393, 0.0],
    ],
    reference: [0.0, 0.0, 1.0],
};

pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let params = VehicleParams::paper();
    let vehicle = Vehicle::new(params)?;
    // 2 m/s, less in the corners: at most 0.5 m/s² towards their centre.
    let speed = CurvatureLimited::new(2.0, 0.5)?;
    let path = FourierPath::new(PATH)?.with_speed(speed).with_yaw(AlongTangent);
    let follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(0.002))?
        .with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] })?
        .with_observer(ObserverParams::with_bandwidth(8.0))?;
    let mut supervisor =
        Supervisor::new(follower, EnvelopeParams::wide(), ApproachLimits::gentle(), Policy::default())?;

    // From the middle of the building, which the approach leaves on the shortest way.
    let mut flight = plant::Plant::at_rest(&params, Vector3::new(10.0, 0.0, -15.0));
    let hover = Command::of_thrust(vehicle.hover_thrust());
    supervisor.take_over(&flight.state(), hover)?;
    let mut off = f32::INFINITY;
    for step in 0..20_000 {
        let output = supervisor.step(Some(&flight.state()), Request::Follow);
        flight.hold(&output.command, 0.002);
        // Of a loop, h1 and h2 are metres.
        if let Some(solution) = supervisor.solution() {
            off = solution.xi.h1[0].hypot(solution.xi.h2[0]);
        }
        if step % 2000 == 1999 {
            println!("{:4.0} s  {:8.1} mm off, {:?}", (step + 1) as f32 * 0.002, off * 1e3, output.mode);
        }
    }
    assert!(off < 1e-3, "{off} m");
    Ok(())
}
