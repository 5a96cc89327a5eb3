//! The estimator's filters as they fly, on readings about a hover: steps of whole cycles, so that
//! the mean is that of a flight.

use controller::{Matrix3, Real, State, Vector3, VehicleParams};
use estimator::{Drag, Estimate, Fix, Imu, Motion, Navigation, NavigationParams, Payload, PayloadParams};

use crate::{Case, Digest, Random};

/// Control period, s.
const PERIOD: f32 = 0.002;
const GRAVITY: f32 = 9.81;
/// Thrust of the paper's vehicle at hover, N.
pub(crate) const HOVER: f32 = 3.0 * GRAVITY;
/// Where the UAV hovers, m: with its load on the paper's circle.
pub(crate) const PLACE: Vector3<f32> = Vector3::new(5.0, 0.0, -12.0);
/// Periods from one reading to the next: of the receiver at 10 Hz, the magnetometer at 20 Hz, the
/// barometer at 25 Hz.
const FIX: u32 = 50;
const FIELD: u32 = 25;
const HEIGHT: u32 = 20;

/// The payload filter behind somebody else's navigation.
pub struct LoadBehindNavigation(Payload<f32>);

/// Both filters, one behind the other.
pub struct LoadAndNavigation {
    pub(crate) navigation: Navigation<f32>,
    pub(crate) payload: Payload<f32>,
    step: u32,
}

/// What the instruments read.
pub(crate) type Readings = (Imu<f32>, Fix<f32>, Vector3<f32>, f32);

fn payload() -> Option<Payload<f32>> {
    let params = PayloadParams {
        uav_drag: Drag::of_area(0.05),
        payload_drag: Drag::of_area(0.01),
        hook: Vector3::new(0.02, 0.0, 0.1),
        imu: Vector3::new(0.03, 0.01, -0.02),
        ..PayloadParams::of(&VehicleParams::paper(), PERIOD)
    };
    Payload::new(params).ok()
}

impl LoadBehindNavigation {
    /// Table I's vehicle, with levers and drag. `None` if a parameter is refused.
    pub fn new() -> Option<Self> {
        Some(Self(payload()?))
    }
}

impl LoadAndNavigation {
    /// The same, with antenna and IMU off the centre of mass.
    pub fn new() -> Option<Self> {
        let params = NavigationParams {
            imu: Vector3::new(0.03, 0.01, -0.02),
            antenna: Vector3::new(-0.1, 0.0, -0.15),
            ..NavigationParams::every(PERIOD)
        };
        let start = Motion::at_rest(PLACE, GRAVITY);
        let navigation = Navigation::new(params, &start, [0.02, 0.1]).ok()?;
        Some(Self { navigation, payload: payload()?, step: 0 })
    }

    /// What else has come with a period's IMU.
    pub(crate) fn take(&mut self, (_, fix, field, height): &Readings) {
        self.step += 1;
        // What is refused is not taken, and the state that comes of it is digested.
        if self.step.is_multiple_of(FIX) {
            let _ = self.navigation.fix(fix);
        }
        if self.step.is_multiple_of(FIELD) {
            let _ = self.navigation.magnetic_field(field);
        }
        if self.step.is_multiple_of(HEIGHT) {
            let _ = self.navigation.height(*height);
        }
    }
}

fn imu(random: &mut Random) -> Imu<f32> {
    Imu { body_rate: random.vector(0.005), specific_force: random.vector(0.5) + Vector3::new(0.0, 0.0, -GRAVITY) }
}

impl Case for LoadBehindNavigation {
    type State = Motion<f32>;
    type Output = Estimate<f32>;

    fn prepare(&mut self, random: &mut Random) -> Motion<f32> {
        let Imu { body_rate, specific_force } = imu(random);
        // Columns of a small rotation, orthonormal to its square.
        let turn = random.vector(0.05);
        let column = |axis: Vector3<f32>| {
            let turned = axis + turn.cross(&axis);
            turned * (1.0 / Real::sqrt(turned.dot(&turned)))
        };
        let attitude = Matrix3::from_columns(&[column(Vector3::x()), column(Vector3::y()), column(Vector3::z())]);
        // Within what navigation corrects from one period to the next: a jump has a cost of its
        // own.
        let (position, velocity) = (random.vector(0.02), random.vector(0.02));
        Motion { position, velocity, attitude, body_rate, specific_force }
    }

    fn step(&mut self, state: &Motion<f32>) -> Estimate<f32> {
        self.0.step(Some(state), Some(HOVER))
    }

    fn digest(&self, output: &Estimate<f32>, digest: &mut Digest) {
        digest_estimate(output, digest);
    }
}

impl Case for LoadAndNavigation {
    type State = Readings;
    type Output = Estimate<f32>;

    fn prepare(&mut self, random: &mut Random) -> Self::State {
        let fix = Fix {
            position: Some(PLACE + Vector3::new(-0.1, 0.0, -0.15) + random.vector(0.02)),
            velocity: Some(random.vector(0.05)),
            position_accuracy: [0.01, 0.02],
            velocity_accuracy: [0.04, 0.06],
            age: 0.1,
        };
        let field = Vector3::new(0.45, 0.0, 0.89) + random.vector(0.02);
        (imu(random), fix, field, random.around_zero(0.3) - PLACE.z)
    }

    fn step(&mut self, readings: &Readings) -> Estimate<f32> {
        self.take(readings);
        let motion = self.navigation.step(Some(&readings.0));
        self.payload.step(Some(&motion), Some(HOVER))
    }

    fn digest(&self, output: &Estimate<f32>, digest: &mut Digest) {
        digest_estimate(output, digest);
    }
}

fn digest_estimate(estimate: &Estimate<f32>, digest: &mut Digest) {
    let State { position, velocity, rod, rod_rate, attitude, body_rate } = &estimate.state;
    [position, velocity, rod, rod_rate, body_rate].into_iter().flatten().for_each(|&number| digest.take(number));
    attitude.iter().for_each(|&number| digest.take(number));
    [estimate.tension, estimate.health.rod_deviation, estimate.health.rate_deviation]
        .into_iter()
        .for_each(|number| digest.take(number));
}
