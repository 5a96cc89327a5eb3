//! The path-following law alone: one evaluation at a state and ζ, without look-ahead, observers,
//! limits and supervisor. What others publish costs for is this.

use controller::{Disturbance, Gains, Path, Solution, State, Vector3, Vehicle, VehicleParams, Xi, follow};

use crate::laws::{digest_solution, state_near, zeta};
use crate::{Case, Digest, Random};

/// The law on a path, with parameters that are read at run time.
pub struct Alone<P> {
    vehicle: Vehicle<f32>,
    path: P,
    gains: Gains<f32>,
    disturbance: Disturbance<f32>,
    on_path: fn(&mut Random) -> Vector3<f32>,
}

impl<P: Path<f32>> Alone<P> {
    /// The paper's vehicle on `path`. `None` if a parameter is refused.
    pub fn new(path: P, on_path: fn(&mut Random) -> Vector3<f32>) -> Option<Self> {
        let vehicle = Vehicle::new(VehicleParams::paper()).ok()?;
        Some(Self { vehicle, path, gains: Gains::spread(1.0).ok()?, disturbance: Disturbance::none(), on_path })
    }
}

impl<P: Path<f32>> Case for Alone<P> {
    /// The vehicle's state, and ζ.
    type State = (State<f32>, [f32; 4]);
    type Output = Solution<f32, Xi<f32>>;

    fn prepare(&mut self, random: &mut Random) -> Self::State {
        let point = (self.on_path)(random);
        (state_near(point, random), zeta(random))
    }

    fn step(&mut self, (state, zeta): &Self::State) -> Self::Output {
        let Self { vehicle, path, gains, disturbance, .. } = self;
        follow(vehicle, path, gains, state, zeta, &[0.0; 3], disturbance)
    }

    fn digest(&self, output: &Self::Output, digest: &mut Digest) {
        digest_solution(output, digest);
    }
}
