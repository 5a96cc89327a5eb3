//! The controller as a board flies it: made of parameters, on a path chosen at run time, with
//! limits and four rotors.

use controller::{Request, State};
use rig::{Output, Rig, parameter, run};

use crate::laws::{INTEGRAL, digest_command, state_near, zeta};
use crate::paths::on_circle;
use crate::{Case, Digest, Random};

/// All of it, on the paper's circle.
pub struct Flown(Rig<f32>);

impl Flown {
    /// The default parameters, with the integral action that the other cases have. `None` if one is
    /// refused.
    pub fn new() -> Option<Self> {
        let mut parameters = rig::Parameters::default();
        parameters.set_run(run!("KI_1" to "KI_3"), INTEGRAL).ok()?;
        parameters.set(parameter!("LIM_T_MIN"), 3.0).ok()?;
        Some(Self(Rig::new(&parameters).ok()?))
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
