//! The controller as a board flies it: made of parameters, on a path chosen at run time, with
//! limits and four rotors.

use controller::{Matrix3, Measured, Request, State, Uav, Vector3, VehicleParams};
use estimator::Motion;
use rig::{Output, Rig, parameter, run};

use crate::filters::{HOVER, LoadAndNavigation, PLACE, Readings};
use crate::laws::{INTEGRAL, digest_command, state_near, zeta};
use crate::paths::on_circle;
use crate::{Case, Digest, Random};

/// All of it, on the paper's circle.
pub struct Flown(Rig<f32>);

/// The same where nothing sees the load: a whole control period, from instruments to rotors.
pub struct FlownOnEstimate {
    filters: LoadAndNavigation,
    rig: Rig<f32>,
    /// The hover that it is about.
    hover: State<f32>,
}

/// The default parameters, with the integral action that the other cases have. `None` if one is
/// refused.
fn rig() -> Option<Rig<f32>> {
    let mut parameters = rig::Parameters::default();
    parameters.set_run(run!("KI_1" to "KI_3"), INTEGRAL).ok()?;
    parameters.set(parameter!("LIM_T_MIN"), 3.0).ok()?;
    Rig::new(&parameters).ok()
}

impl Flown {
    /// `None` if a parameter is refused.
    pub fn new() -> Option<Self> {
        Some(Self(rig()?))
    }
}

impl FlownOnEstimate {
    /// About a hover with the load on the circle. `None` if a parameter is refused.
    pub fn new() -> Option<Self> {
        let rod = Vector3::z();
        let hover = State {
            position: PLACE + rod * VehicleParams::<f32>::paper().rod_length,
            velocity: Vector3::zeros(),
            rod,
            rod_rate: Vector3::zeros(),
            attitude: Matrix3::identity(),
            body_rate: Vector3::zeros(),
        };
        Some(Self { filters: LoadAndNavigation::new()?, rig: rig()?, hover })
    }
}

impl Case for Flown {
    type State = State<f32>;
    type Output = (Output<f32>, [f32; 4]);

    fn prepare(&mut self, random: &mut Random) -> State<f32> {
        let state = state_near(on_circle(random), random);
        let started = self.0.start(&state, zeta(random));
        debug_assert!(started.is_ok(), "{started:?}");
        state
    }

    fn step(&mut self, state: &State<f32>) -> Self::Output {
        (*self.0.step(Some(state), Request::Follow, 0.0), self.0.duties())
    }

    fn digest(&self, (output, duties): &Self::Output, digest: &mut Digest) {
        digest_command(&output.command, digest);
        duties.iter().chain(self.0.zeta()).for_each(|&number| digest.take(number));
    }
}

impl Case for FlownOnEstimate {
    type State = Readings;
    type Output = (Output<f32>, [f32; 4]);

    fn prepare(&mut self, random: &mut Random) -> Readings {
        let started = self.rig.start(&self.hover, zeta(random));
        debug_assert!(started.is_ok(), "{started:?}");
        self.filters.prepare(random)
    }

    fn step(&mut self, readings: &Readings) -> Self::Output {
        self.filters.take(readings);
        let motion = self.filters.navigation.step(Some(&readings.0));
        let estimate = self.filters.payload.step(Some(&motion), Some(HOVER));
        let Motion { position, velocity, attitude, body_rate, specific_force } = motion;
        let uav = estimate.beside(&Uav { position, velocity, attitude, body_rate });
        let measured =
            Measured { state: Some(&estimate.state), uav: Some(&uav), specific_force: Some(specific_force) };
        (*self.rig.step(measured, Request::Follow, 0.0), self.rig.duties())
    }

    fn digest(&self, output: &Self::Output, digest: &mut Digest) {
        digest_command(&output.0.command, digest);
        output.1.iter().chain(self.rig.zeta()).for_each(|&number| digest.take(number));
    }
}
