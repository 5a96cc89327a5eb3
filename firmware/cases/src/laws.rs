//! The laws as they fly, set up once and put into random states.

use controller::{
    ActuatorLimits, ApproachLimits, Command, EnvelopeParams, Follow, Follower, Gains, Matrix3, ObserverParams,
    Output, Path, Policy, Real, Reference, Request, Sampling, Solution, State, Supervisor, TrackGains, TrackXi,
    Tracker, Vector3, Vehicle, VehicleParams,
};

use crate::paths::on_circle;
use crate::{Case, Digest, Random};

/// Control period, s.
const PERIOD: f32 = 0.002;
/// Scale of the spread poles, 1/s: the ones to fly with.
const BANDWIDTH: f32 = 1.0;
/// Of h1, h2, h3: far below what those poles allow.
pub(crate) const INTEGRAL: [f32; 3] = [100.0, 100.0, 10.0];

/// A supervised path-following law as it flies, observers, guard and limits on, and where its
/// states are drawn.
pub struct Following<P> {
    supervisor: Supervisor<f32, Follow<f32, P>>,
    /// Draws a point of the path.
    on_path: fn(&mut Random) -> Vector3<f32>,
    /// On the way to the path rather than on it.
    joining: bool,
}

impl<P: Path<f32>> Following<P> {
    /// The paper's vehicle on `path`. `None` if a parameter is refused.
    pub fn new(path: P, on_path: fn(&mut Random) -> Vector3<f32>) -> Option<Self> {
        let gains = Gains { integral: INTEGRAL, ..Gains::spread(BANDWIDTH).ok()? };
        let vehicle = Vehicle::new(VehicleParams::paper()).ok()?;
        let limits = ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque: [3.0; 3] };
        let follower = Follower::new(vehicle, path, gains, Sampling::every(PERIOD))
            .and_then(|follower| follower.with_limits(limits))
            .and_then(|follower| follower.with_observer(ObserverParams::with_bandwidth(4.0)))
            .ok()?;
        let (envelope, approach) = (EnvelopeParams::wide(), ApproachLimits::gentle());
        let supervisor = Supervisor::new(follower, envelope, approach, Policy::default()).ok()?;
        Some(Self { supervisor, on_path, joining: false })
    }

    /// The same, on its way to the path.
    pub fn joining(self) -> Self {
        Self { joining: true, ..self }
    }
}

impl<P: Path<f32>> Case for Following<P> {
    type State = State<f32>;
    type Output = Output<f32>;

    fn prepare(&mut self, random: &mut Random) -> State<f32> {
        let state = state_near((self.on_path)(random), random);
        let zeta = zeta(random);
        if self.joining {
            let hover = Command::of_thrust(self.supervisor.sampler().vehicle().hover_thrust());
            let taken_over = self.supervisor.take_over(&state, hover);
            debug_assert!(taken_over.is_ok(), "{taken_over:?}");
            self.supervisor.step(Some(&state), Request::Follow);
        } else {
            let started = self.supervisor.start(&state, zeta);
            debug_assert!(started.is_ok(), "{started:?}");
        }
        state
    }

    fn step(&mut self, state: &State<f32>) -> Self::Output {
        self.supervisor.step(Some(state), Request::Follow)
    }

    fn digest(&self, output: &Self::Output, digest: &mut Digest) {
        digest_command(&output.command, digest);
        if let Some(solution) = self.supervisor.solution() {
            digest_solution(&solution, digest);
        }
    }
}

/// The tracking law on the paper's reference, evaluated at a phase.
pub struct Tracking(Tracker<f32>);

impl Tracking {
    /// The paper's vehicle. `None` if a parameter is refused.
    pub fn new() -> Option<Self> {
        let gains = TrackGains::spread(BANDWIDTH).ok()?;
        let vehicle = Vehicle::new(VehicleParams::paper()).ok()?;
        Some(Self(Tracker::new(vehicle, gains, Sampling::every(PERIOD)).ok()?))
    }
}

impl Case for Tracking {
    /// The vehicle's state and the reference's phase, rad.
    type State = (State<f32>, f32);
    type Output = Solution<f32, TrackXi<f32>>;

    fn prepare(&mut self, random: &mut Random) -> Self::State {
        let state = state_near(on_circle(random), random);
        let started = self.0.start(&state, zeta(random));
        debug_assert!(started.is_ok(), "{started:?}");
        // A minute and a half of flight at 1 rad/s.
        (state, 45.0 + random.around_zero(45.0))
    }

    fn step(&mut self, (state, phase): &Self::State) -> Self::Output {
        self.0.track(state, &Reference::circle(5.0, -10.0, 1.0, *phase))
    }

    fn digest(&self, output: &Self::Output, digest: &mut Digest) {
        digest_solution(output, digest);
    }
}

/// A flyable state around `point`: 1 m and 1.5 m/s off, rod and attitude some 0.4 rad from upright,
/// any yaw.
pub(crate) fn state_near(point: Vector3<f32>, random: &mut Random) -> State<f32> {
    let rod = unit(Vector3::new(0.0, 0.0, 1.0) + random.vector(0.4));
    let swing = random.vector(0.6);
    let thrust_axis = unit(Vector3::new(0.0, 0.0, 1.0) + random.vector(0.4));
    let right = unit(thrust_axis.cross(&random.vector(1.0)));
    State {
        position: point + random.vector(1.0),
        velocity: random.vector(1.5),
        rod,
        rod_rate: swing - rod * rod.dot(&swing),
        attitude: Matrix3::from_columns(&[right.cross(&thrust_axis), right, thrust_axis]),
        body_rate: random.vector(0.5),
    }
}

fn unit(vector: Vector3<f32>) -> Vector3<f32> {
    vector * (1.0 / Real::sqrt(vector.dot(&vector)))
}

/// ζ1 well away from free fall, and as much of its derivatives.
pub(crate) fn zeta(random: &mut Random) -> [f32; 4] {
    [1.0, 1.0, 2.0, 4.0].map(|amplitude| random.around_zero(amplitude))
}

pub(crate) fn digest_command(command: &Command<f32>, digest: &mut Digest) {
    [command.thrust].iter().chain(&command.torque).for_each(|&number| digest.take(number));
}

pub(crate) fn digest_solution<X>(solution: &Solution<f32, X>, digest: &mut Digest) {
    digest_command(&solution.command, digest);
    [solution.u_zeta].into_iter().chain(solution.nu).for_each(|number| digest.take(number));
}
