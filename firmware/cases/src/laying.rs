//! Laying a route: what a board does when a mission comes, on the ground.

use controller::{Built, Knot, RoutePace, Run, Waypoint, build_route};

use crate::{Case, Digest, Random};

/// Waypoints: two stops, and blended corners between them.
const WAYPOINTS: usize = 8;
/// Room that is always enough for them.
const KNOTS: usize = 400;
const RUNS: usize = 3;

/// A route with corners and a stop, and the room for its table.
pub struct Laying {
    knots: [Knot<f32>; KNOTS],
    runs: [Run<f32>; RUNS],
}

impl Laying {
    /// With an empty table.
    #[must_use]
    pub fn new() -> Self {
        Self { knots: [Knot::default(); KNOTS], runs: [Run::default(); RUNS] }
    }
}

impl Default for Laying {
    fn default() -> Self {
        Self::new()
    }
}

/// How much was laid, and the last knots' numbers.
pub struct Laid {
    built: Built,
    last: [Knot<f32>; 8],
}

impl Case for Laying {
    const IS_STEP: bool = false;

    type State = [Waypoint<f32>; WAYPOINTS];
    type Output = Laid;

    /// Rows of some 20 m, 8 m apart, as a survey has them.
    fn prepare(&mut self, random: &mut Random) -> Self::State {
        core::array::from_fn(|index| {
            let (row, far) = (index / 2, (index / 2 + index) % 2);
            let [x, y] = [20.0 * far as f32, 8.0 * row as f32].map(|at| at + random.around_zero(2.0));
            let stop = (index == WAYPOINTS / 2).then_some(5.0);
            let point = [x, y, random.around_zero(2.0) - 10.0];
            Waypoint { point, corner: Some(2.0), speed: 1.5, yaw: None, stop }
        })
    }

    fn step(&mut self, waypoints: &Self::State) -> Self::Output {
        let Self { knots, runs } = self;
        let built = build_route(waypoints, false, &RoutePace::default(), knots, runs).unwrap_or_default();
        let end = built.knots.min(KNOTS);
        let last = knots.get(end.saturating_sub(8)..end).and_then(|last| last.first_chunk().copied());
        Laid { built, last: last.unwrap_or_default() }
    }

    fn digest(&self, output: &Self::Output, digest: &mut Digest) {
        let Laid { built, last } = output;
        digest.take(built.knots as f32);
        for Knot { point, step, normals, speed, yaw } in self.knots.iter().take(built.knots).chain(last) {
            point
                .iter()
                .chain(step)
                .chain(normals.as_flattened())
                .chain(speed)
                .for_each(|&number| digest.take(number));
            digest.take(*yaw);
        }
    }
}
