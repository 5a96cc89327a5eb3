//! Episodes for a learner: flights of a campaign whose commands come from outside, many at once.

use controller::{Command, Path as _, Series, State, Vector3};
use hil_sim::describe::course::FlownPath;
use hil_sim::describe::scenario::{Law, Scenario};
use hil_sim::world::{Seed, World};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::error::{invalid, out_of_range, refused, whole, within};
use crate::study::Campaign;

/// Numbers of an observation.
const OBSERVED: usize = 27;
/// Offsets are told up to here, m: farther off, a curve's functions say nothing.
const TOLD_M: f64 = 10.0;
/// Torque of a full action where the scenario sets no limit, N·m.
const TORQUE: f64 = 1.0;
/// Errors of speed count in the reward as those of position do that they make in so long, s.
const AHEAD_S: f64 = 1.0;

/// Flights side by side.
#[pyclass(module = "slung")]
pub struct Fleet {
    campaign: Py<Campaign>,
    periods: u32,
    lost_m: f64,
    episodes: Vec<Option<Episode>>,
}

/// A flight under way.
struct Episode {
    scenario: Scenario,
    path: FlownPath<f64>,
    world: World,
    /// N, N·m: of a full action, thrust about hover's.
    hover: f64,
    torque: [f64; 3],
    step: u64,
}

/// What a step makes.
#[derive(Clone, Copy, Default)]
struct Step {
    reward: f64,
    terminated: bool,
    truncated: bool,
    distance_m: f64,
}

impl Episode {
    fn new(campaign: &Campaign, seed: Seed) -> PyResult<Self> {
        let drawn = campaign.0.draw(seed).map_err(invalid)?;
        let (scenario, start) = (drawn.scenario, drawn.start.state);
        let Law::Follow { path, .. } = &scenario.controller.law else {
            return Err(whole("an environment needs a path"));
        };
        let mut path = path.build::<f64>().map_err(out_of_range)?;
        // A longer path is searched in parts.
        while !path.search(&start.position) {}
        let told = &scenario.controller.vehicle;
        let hover = (told.payload_mass + told.uav_mass) * told.gravity;
        let limit = scenario.controller.limits.max_torque;
        let torque = limit.map(|torque| if torque < 1e3 { torque } else { TORQUE });
        let command = Command { thrust: hover, torque: Vector3::zeros() };
        let world = scenario.begin(&start, command, seed);
        Ok(Self { path, world, hover, torque, step: 0, scenario })
    }

    /// What the path says at the payload: the way to its nearest point to first order, and the
    /// wanted velocity.
    fn wanted(&mut self, state: &State<f64>) -> [Vector3<f64>; 2] {
        let outputs = self.path.outputs(&[0, 1, 2].map(|axis| Series::constant(state.position[axis])));
        let [h1, h2] = &outputs.surfaces;
        let (offset, _) = outputs.solve([-h1.value(), -h2.value(), 0.0]);
        let told = |v: Vector3<f64>| v.map(|x| if x.is_finite() { x.clamp(-TOLD_M, TOLD_M) } else { 0.0 });
        [told(offset), told(outputs.tangent * outputs.prescribed.value())]
    }

    fn observe(&mut self) -> [f32; OBSERVED] {
        let state = self.world.read(&self.world.body().state()).state;
        let [offset, wanted] = self.wanted(&state);
        let State { velocity, rod, rod_rate, attitude, body_rate, .. } = &state;
        let rows = attitude.transpose();
        let numbers =
            offset.iter().chain(&wanted).chain(velocity).chain(rod).chain(rod_rate).chain(&rows).chain(body_rate);
        let mut observed = [0.0; OBSERVED];
        for (slot, number) in observed.iter_mut().zip(numbers) {
            *slot = *number as f32;
        }
        observed
    }

    fn advance(&mut self, action: [f64; 4], periods: u32, lost_m: f64, ground_p3: Option<f64>) -> Step {
        let [thrust, roll, pitch, yaw] = action.map(|share| share.clamp(-1.0, 1.0));
        let [t1, t2, t3] = self.torque;
        let torque = Vector3::new(roll * t1, pitch * t2, yaw * t3);
        let command = Command { thrust: self.hover * (1.0 + thrust), torque };
        for _ in 0..periods {
            self.world.advance(&command);
        }
        self.step += u64::from(periods);
        let state = self.world.body().state();
        let distance_m = self.scenario.controller.law.distance(state.position.into());
        let [_, wanted] = self.wanted(&state);
        let error = state.velocity - wanted;
        let error = distance_m + AHEAD_S * error.dot(&error).sqrt();
        let on_ground =
            ground_p3.is_some_and(|ground| state.position.z.max(self.world.body().uav_position().z) >= ground);
        // A NaN is lost.
        let is_near = (0.0..=lost_m).contains(&distance_m);
        let terminated = !is_near || on_ground || !self.world.body().is_finite();
        let lasted = f64::from(periods) / self.scenario.controller.rate_hz;
        Step {
            reward: if terminated { 0.0 } else { lasted * (1.0 - error / lost_m).max(0.0) },
            terminated,
            truncated: !terminated && self.step >= self.scenario.steps(),
            distance_m,
        }
    }
}

#[pymethods]
impl Fleet {
    #[new]
    fn new(campaign: Py<Campaign>, size: usize, periods: u32, lost_m: f64) -> PyResult<Self> {
        within("size", size as f64, [1.0, 1e6])?;
        within("periods", f64::from(periods), [1.0, 1e4])?;
        within("lost_m", lost_m, [0.1, 100.0])?;
        Ok(Self { campaign, periods, lost_m, episodes: (0..size).map(|_| None).collect() })
    }

    /// Seconds between two actions.
    #[getter]
    fn period_s(&self, py: Python<'_>) -> PyResult<f64> {
        let drawn = self.campaign.get().0.draw(Seed { batch: 0, run: 0 });
        let rate_hz = py.detach(|| drawn).map_err(invalid)?.scenario.controller.rate_hz;
        Ok(f64::from(self.periods) / rate_hz)
    }

    /// Begins an episode anew.
    fn begin<'py>(
        &mut self,
        py: Python<'py>,
        index: usize,
        seed: u64,
        run: u64,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let campaign = self.campaign.get();
        let mut episode = py.detach(|| Episode::new(campaign, Seed { batch: seed, run }))?;
        let observed = episode.observe();
        let size = self.episodes.len();
        let slot = self.episodes.get_mut(index);
        *slot.ok_or_else(|| refused(format!("index = {index} of {size}"), "index", None))? = Some(episode);
        Ok(PyArray1::from_slice(py, &observed))
    }

    /// A step of all but those to `skip`: observations, rewards, terminated, truncated, distances
    /// from the path.
    #[expect(clippy::type_complexity, reason = "it is what Gymnasium answers")]
    #[pyo3(signature = (actions, skip = None))]
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        actions: Vec<[f64; 4]>,
        skip: Option<Vec<bool>>,
    ) -> PyResult<(
        Bound<'py, PyArray2<f32>>,
        Bound<'py, PyArray1<f64>>,
        Bound<'py, PyArray1<bool>>,
        Bound<'py, PyArray1<bool>>,
        Bound<'py, PyArray1<f64>>,
    )> {
        let size = self.episodes.len();
        if actions.len() != size {
            return Err(refused(format!("{} actions for {size} flights", actions.len()), "actions", None));
        }
        let skip = skip.unwrap_or_else(|| vec![false; size]);
        if skip.len() != size {
            return Err(refused(format!("{} to skip or not, of {size} flights", skip.len()), "skip", None));
        }
        if actions.as_flattened().iter().any(|share| !share.is_finite()) {
            return Err(refused("an action is not a number", "actions", None));
        }
        let (periods, lost_m, ground_p3) = (self.periods, self.lost_m, self.campaign.get().0.ground_p3);
        let episodes = &mut self.episodes;
        let steps: Option<Vec<(Step, [f32; OBSERVED])>> = py.detach(|| {
            let flown = episodes.par_iter_mut().zip(actions).zip(skip).map(|((episode, action), skip)| {
                let episode = episode.as_mut()?;
                if skip {
                    return Some((Step::default(), [0.0; OBSERVED]));
                }
                let step = episode.advance(action, periods, lost_m, ground_p3);
                Some((step, episode.observe()))
            });
            flown.collect()
        });
        let steps = steps.ok_or_else(|| refused("a flight has not begun", "index", None))?;
        let observed: Vec<f32> = steps.iter().flat_map(|(_, observed)| observed).copied().collect();
        let of = |value: fn(&Step) -> f64| PyArray1::from_iter(py, steps.iter().map(|(step, _)| value(step)));
        let is = |value: fn(&Step) -> bool| PyArray1::from_iter(py, steps.iter().map(|(step, _)| value(step)));
        Ok((
            PyArray1::from_vec(py, observed).reshape([size, OBSERVED])?,
            of(|step| step.reward),
            is(|step| step.terminated),
            is(|step| step.truncated),
            of(|step| step.distance_m),
        ))
    }

    /// The state of a flight as it is, for a law that is no learner.
    fn state(&self, index: usize) -> PyResult<crate::state::State> {
        let episode = self.episodes.get(index).and_then(Option::as_ref);
        let episode = episode.ok_or_else(|| refused("a flight has not begun", "index", None))?;
        Ok(crate::state::State(episode.world.body().state()))
    }

    /// A flight's full action: thrust beyond hover's, N, and torque, N·m.
    fn scale(&self, index: usize) -> PyResult<(f64, [f64; 3])> {
        let episode = self.episodes.get(index).and_then(Option::as_ref);
        let episode = episode.ok_or_else(|| refused("a flight has not begun", "index", None))?;
        Ok((episode.hover, episode.torque))
    }
}
