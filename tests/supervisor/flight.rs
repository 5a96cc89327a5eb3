//! A supervised vehicle in flight: the law, told what the world is or not, and the plant.

use controller::{
    ActuatorLimits, ApproachLimits, Circle, Command, Controller, Curve, EnvelopeParams, Follow, Follower, Gains, Law,
    Measured, Mode, ObserverParams, Output, Path, Policy, Request, Sampling, State, Supervisor, Uav, Vector3,
    Vehicle, VehicleParams,
};
use hil_sim::world::multibody::{Loads, Multibody};
use witness::plant::VehicleParameters;

/// Control period, s.
pub const PERIOD: f64 = 0.002;
/// Radius and p3 of the circle flown, m.
pub const CIRCLE: [f64; 2] = [5.0, -10.0];
/// What may be commanded: thrust a tenth to twice of hover.
pub const LIMITS: ActuatorLimits<f32> = ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] };

/// The law's vehicle, the paper's Table I.
pub fn vehicle() -> Vehicle<f32> {
    Vehicle::new(VehicleParams::paper()).unwrap()
}

/// Poles −1 to −6, and integral action where asked for.
pub fn gains(integral: [f32; 3]) -> Gains<f32> {
    Gains { integral, ..Gains::spread(1.0).unwrap() }
}

/// A follower of the circle at `speed`, m/s, with observers of `bandwidth`, rad/s.
pub fn follower(
    speed: f32,
    bandwidth: f32,
    sampling: Sampling<f32>,
    integral: [f32; 3],
) -> Follower<f32, impl Path<f32> + Clone> {
    let path = Circle::new(CIRCLE[0] as f32, CIRCLE[1] as f32).unwrap().at_speed(speed).unwrap();
    let follower = Follower::new(vehicle(), path, gains(integral), sampling).unwrap();
    follower.with_limits(LIMITS).unwrap().with_observer(ObserverParams::with_bandwidth(bandwidth)).unwrap()
}

/// The usual one: 1 m/s, observers on, and a policy.
pub fn supervisor(
    sampling: Sampling<f32>,
    policy: Policy<f32>,
) -> Supervisor<f32, Follow<f32, impl Path<f32> + Clone>> {
    supervise(follower(1.0, 4.0, sampling, [0.0; 3]), policy)
}

/// `controller`, supervised.
pub fn supervise<L: Law<f32>>(controller: Controller<f32, L>, policy: Policy<f32>) -> Supervisor<f32, L> {
    Supervisor::new(controller, EnvelopeParams::wide(), ApproachLimits::gentle(), policy).unwrap()
}

/// A command in f64.
fn exact(command: &Command<f32>) -> Command<f64> {
    Command { thrust: f64::from(command.thrust), torque: command.torque.map(f64::from) }
}

/// Distance from the circle, m.
pub fn deviation(position: &Vector3<f64>) -> f64 {
    witness::plant::distance_to_circle([position.x, position.y, position.z], CIRCLE[0], CIRCLE[1])
}

/// A flight: the plant under a supervised law, behind rotors of a first-order lag.
pub struct Flight<L> {
    pub supervisor: Supervisor<f32, L>,
    pub body: Multibody,
    /// τ_d that the law is not told of, N·m.
    pub torque: Vector3<f64>,
    lag: f64,
    acting: Command<f64>,
    time: f64,
}

impl<L: Law<f32>> Flight<L> {
    /// The plant in `state`, its payload `payload_mass` kg, under `applied`, N, without torque; the
    /// law takes over.
    pub fn new(
        mut supervisor: Supervisor<f32, L>,
        state: &State<f64>,
        payload_mass: f64,
        applied: f64,
        lag: f64,
    ) -> Self {
        let vehicle = VehicleParameters { payload_mass, ..VehicleParameters::default() };
        let acting = Command { thrust: applied, torque: Vector3::zeros() };
        supervisor.take_over(&state.cast(), Command::of_thrust(applied as f32)).unwrap();
        let torque = Vector3::zeros();
        Self { supervisor, body: Multibody::new(vehicle, state), torque, lag, acting, time: 0.0 }
    }

    /// One control period. Every command is checked.
    pub fn step(&mut self, request: Request) -> Output<f32> {
        let sampled = self.body.state().cast();
        self.step_seeing(Some(&sampled), request)
    }

    /// The UAV by its own navigation.
    pub fn uav(&self) -> Uav<f32> {
        Uav::of(&self.body.state().cast(), &vehicle())
    }

    /// One control period in which the law sees the state or does not, and the UAV's own
    /// navigation.
    pub fn step_knowing(&mut self, sees: bool, uav: Option<&Uav<f32>>, request: Request) -> Output<f32> {
        let sampled = self.body.state().cast();
        let measured = Measured { state: sees.then_some(&sampled), uav, specific_force: None };
        let output = self.supervisor.step(measured, request);
        self.fly(output)
    }

    /// One control period with what the law sees.
    pub fn step_seeing(&mut self, sampled: Option<&State<f32>>, request: Request) -> Output<f32> {
        let output = self.supervisor.step(sampled, request);
        self.fly(output)
    }

    /// A period under an `output`.
    pub fn fly(&mut self, output: Output<f32>) -> Output<f32> {
        assert_bounded(&output);
        let command = exact(&output.command);
        let share = if self.lag > 0.0 { 1.0 - (-PERIOD / 2.0 / self.lag).exp() } else { 1.0 };
        for _ in 0..2 {
            self.acting.thrust += (command.thrust - self.acting.thrust) * share;
            self.acting.torque += (command.torque - self.acting.torque) * share;
            let (acting, loads) = (self.acting, Loads { torque: self.torque, ..Loads::none() });
            self.body.advance(PERIOD / 2.0, |_| acting, |_, _| loads);
        }
        assert!(self.body.is_finite());
        self.time += PERIOD;
        output
    }

    /// Up to `seconds`, until `mode` is reached.
    pub fn until(&mut self, mode: Mode, request: Request, seconds: f64) {
        let end = self.time + seconds;
        while self.supervisor.mode() != mode {
            assert!(self.time < end, "{mode:?} not reached in {seconds} s: {:?}", self.supervisor.mode());
            self.step(request);
        }
    }
}

/// Finite, and within the limits or nothing at all.
pub fn assert_bounded(output: &Output<f32>) {
    let Command { thrust, torque } = output.command;
    let within = (LIMITS.min_thrust..=LIMITS.max_thrust).contains(&thrust)
        && torque.iter().zip(LIMITS.max_torque).all(|(torque, most)| torque.abs() <= most);
    assert!(within || output.command == Command::zero(), "{output:?}");
    assert!(output.mode != Mode::Off || output.command == Command::zero(), "{output:?}");
}
