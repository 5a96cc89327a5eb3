//! The laws as they fly, set up once and put into random states.

use controller::path::Path;
use controller::{
    Command, Follower, Gains, Matrix3, Pole, Real, Reference, Sampling, Solution, State, TrackGains, TrackXi,
    Tracker, Vector3, Vehicle, VehicleParams, Xi, place,
};

use crate::{Case, Digest, Random};

/// Control period, s.
const PERIOD: f32 = 0.002;
/// Spread poles, 1/s: the ones to fly with. Chains of 6, 5 and 2.
const POLES: [f32; 6] = [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0];
const YAW_POLES: [f32; 2] = [-2.0, -3.0];
/// Of h1, h2, h3: far below what those poles allow.
const INTEGRAL: [f32; 3] = [100.0, 100.0, 10.0];

/// A path-following law, and where its states are drawn.
pub struct Following<P> {
    follower: Follower<f32, P>,
    /// Draws a point of the path.
    on_path: fn(&mut Random) -> Vector3<f32>,
}

impl<P: Path<f32>> Following<P> {
    /// The paper's vehicle on `path`. `None` if a parameter is refused.
    pub fn new(path: P, on_path: fn(&mut Random) -> Vector3<f32>) -> Option<Self> {
        let k = place(&POLES.map(Pole::Real)).ok()?;
        let [slowest @ .., _] = POLES;
        let gains = Gains {
            k1: k,
            k2: k,
            k3: place(&slowest.map(Pole::Real)).ok()?,
            k4: place(&YAW_POLES.map(Pole::Real)).ok()?,
            integral: INTEGRAL,
        };
        let vehicle = Vehicle::new(VehicleParams::default()).ok()?;
        let follower = Follower::new(vehicle, path, gains, Sampling::every(PERIOD)).ok()?;
        Some(Self { follower, on_path })
    }
}

impl<P: Path<f32>> Case for Following<P> {
    type State = State<f32>;
    type Output = Solution<f32, Xi<f32>>;

    fn prepare(&mut self, random: &mut Random) -> State<f32> {
        let state = state_near((self.on_path)(random), random);
        self.follower.start(&state, zeta(random));
        state
    }

    fn step(&mut self, state: &State<f32>) -> Self::Output {
        self.follower.step(state)
    }

    fn digest(output: &Self::Output, digest: &mut Digest) {
        digest_solution(output, digest);
    }
}

/// The tracking law on the paper's reference, evaluated at a phase.
pub struct Tracking(Tracker<f32>);

impl Tracking {
    /// The paper's vehicle. `None` if a parameter is refused.
    pub fn new() -> Option<Self> {
        let k = place(&POLES.map(Pole::Real)).ok()?;
        let gains = TrackGains { position: [k; 3], yaw: place(&YAW_POLES.map(Pole::Real)).ok()? };
        let vehicle = Vehicle::new(VehicleParams::default()).ok()?;
        Some(Self(Tracker::new(vehicle, gains, Sampling::every(PERIOD)).ok()?))
    }
}

impl Case for Tracking {
    /// The vehicle's state and the reference's phase, rad.
    type State = (State<f32>, f32);
    type Output = Solution<f32, TrackXi<f32>>;

    fn prepare(&mut self, random: &mut Random) -> Self::State {
        let state = state_near(on_circle(random), random);
        self.0.start(&state, zeta(random));
        // A minute and a half of flight at 1 rad/s.
        (state, 45.0 + random.around_zero(45.0))
    }

    fn step(&mut self, (state, phase): &Self::State) -> Self::Output {
        self.0.step(state, &Reference::circle(5.0, -10.0, 1.0, *phase))
    }

    fn digest(output: &Self::Output, digest: &mut Digest) {
        digest_solution(output, digest);
    }
}

/// A point of the circle of radius 5 m at p3 = −10 m.
pub fn on_circle(random: &mut Random) -> Vector3<f32> {
    let (sin, cos) = random.around_zero(core::f32::consts::PI).sin_cos();
    Vector3::new(5.0 * cos, 5.0 * sin, -10.0)
}

/// A flyable state around `point`: 1 m and 1.5 m/s off, rod and attitude some 0.4 rad from upright, any yaw.
fn state_near(point: Vector3<f32>, random: &mut Random) -> State<f32> {
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
    vector * (1.0 / vector.dot(&vector).sqrt())
}

/// ζ1 well away from free fall, and as much of its derivatives.
fn zeta(random: &mut Random) -> [f32; 4] {
    [1.0, 1.0, 2.0, 4.0].map(|amplitude| random.around_zero(amplitude))
}

fn digest_solution<X>(solution: &Solution<f32, X>, digest: &mut Digest) {
    let Command { thrust, torque } = &solution.command;
    let all = [*thrust, solution.u_zeta].into_iter().chain(torque.iter().copied()).chain(solution.nu);
    all.for_each(|number| digest.take(number));
}
