//! A control task without an operating system: own vehicle, own curve, and the controller's type by
//! its name, so that it can stand in a `static`; made once, and stepped by a timer.
//!
//!     cargo run -p controller --example task
//!     cargo build -p controller --example task --release --target thumbv7em-none-eabihf
#![cfg_attr(target_os = "none", no_std, no_main, allow(dead_code))]

use controller::*;

/// Control period, s.
const PERIOD: f32 = 0.002;

/// An ellipse of 6 m by 8 m on a slope.
#[derive(Clone, Copy)]
struct Slope;

impl Implicit<f32> for Slope {
    fn surfaces<A: Analytic<f32>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        [(x / 3.0).powi(2) + (y / 4.0).powi(2) - 1.0, z + 8.0 - x * 0.3]
    }
}

/// A curve, its speed and its yaw.
type OnSlope = Profiled<Formula<Slope>, ConstantSpeed<f32>, AlongTangent>;

/// What flies: a law on a path, under its supervisor.
struct Task {
    supervisor: Supervisor<f32, Follow<f32, OnSlope>>,
    hover: Command<f32>,
}

fn vehicle() -> VehicleParams<f32> {
    VehicleParams { uav_mass: 2.0, payload_mass: 0.4, rod_length: 1.5, ..VehicleParams::paper() }
}

impl Task {
    fn new() -> Result<Self, SetupError<f32>> {
        let vehicle = Vehicle::new(vehicle())?;
        let path = Formula(Slope).at_speed(1.0)?.with_yaw(AlongTangent);
        let follower = Follower::new(vehicle, path, Gains::spread(1.0)?, Sampling::every(PERIOD))?
            .with_limits(ActuatorLimits { min_thrust: 3.0, max_thrust: 50.0, max_torque: [2.0; 3] })?
            .with_observer(ObserverParams::with_bandwidth(8.0))?;
        let (envelope, approach) = (EnvelopeParams::wide(), ApproachLimits::gentle());
        let supervisor = Supervisor::new(follower, envelope, approach, Policy::default())?;
        Ok(Self { supervisor, hover: Command::of_thrust(vehicle.hover_thrust()) })
    }

    /// Takes over a vehicle that hovers.
    fn begin(&mut self, state: &State<f32>) -> Result<(), Refused> {
        self.supervisor.take_over(state, self.hover)
    }

    /// What the timer calls, with the state that has come since its last tick, if one has.
    fn tick(&mut self, state: Option<&State<f32>>) -> Command<f32> {
        self.supervisor.step(state, Request::Follow).command
    }
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

#[cfg(not(target_os = "none"))]
mod plant;

#[cfg(not(target_os = "none"))]
pub(crate) fn main() -> Result<(), Box<dyn core::error::Error>> {
    let mut task = Task::new()?;
    let mut flight = plant::Plant::at_rest(&vehicle(), Vector3::new(4.0, 0.0, -7.0));
    task.begin(&flight.state())?;
    for _ in 0..15_000 {
        let command = task.tick(Some(&flight.state()));
        flight.hold(&command, PERIOD);
    }
    let [x, y, z] = flight.state().position.into();
    let away = [(x / 3.0).powi(2) + (y / 4.0).powi(2) - 1.0, z + 8.0 - x * 0.3];
    println!("{} bytes of state; after 30 s {away:?} from the curve", size_of::<Task>());
    assert!(away.iter().all(|h: &f32| h.abs() < 1e-3), "{away:?}");
    Ok(())
}
