//! The way to the path: flown in calm, from where the flight begins until it is on the path, and
//! held against the fence.

use std::sync::atomic::{AtomicBool, Ordering};

use controller::{Mode, State};

use super::fence::{Breach, Ends};
use super::probe::length;
use super::{Fence, Node, Place, Report};
use crate::describe::input::Invalid;
use crate::describe::scenario::{Law, Scenario};
use crate::fly::flight::{Control, Entry, Moment, Plan, fly};
use crate::fly::pilot::Pilot;
use crate::world::{Environment, Seed, Sensors, Timing};

/// d_C below which the load is on the path, m.
const ON_PATH_M: f64 = 0.05;
/// Between two looks at where it is, s.
const LOOK_S: f64 = 0.02;
/// A way that takes longer is looked at for so long, s.
const LONGEST_S: f64 = 600.0;

/// Where load, UAV or cable do not keep the fence on the way to the path of `scenario`, which
/// `report` is of. Take-off, from ground that may lie outside of a fence, is not looked at.
///
/// # Errors
/// [`Invalid`] if the scenario's numbers make no controller.
pub fn way_breaches(scenario: &Scenario, fence: &Fence, report: &Report) -> Result<Vec<Breach>, Invalid> {
    let Law::Follow { .. } = scenario.controller.law else { return Ok(Vec::new()) };
    let calm = Scenario {
        environment: Environment::default(),
        sensors: Sensors::default(),
        timing: Timing::default(),
        estimator: None,
        obstacle: None,
        duration_s: scenario.duration_s.min(LONGEST_S),
        ..scenario.clone()
    };
    let every = calm.periods(LOOK_S).max(1);
    let is_there = AtomicBool::new(false);
    let plan = Plan {
        start: State::from_paper(&calm.initial),
        seed: Seed { batch: calm.seed, run: calm.run },
        entry: if calm.take_over { Entry::Hover } else { Entry::Stated },
        ground_p3: None,
        distance_every: every,
        control: Control { stop: &is_there, progress: &|_| {} },
    };
    let mut pilot = Pilot::<f64>::new(&calm.controller)?;
    let (mut last, mut worst): (Option<Ends>, _) = (None, Vec::new());
    fly(&calm, &plan, &mut pilot, &mut |moment| {
        let Moment { decision: Some(decision), distance_m: Some(distance), body, .. } = moment else { return };
        if is_there.load(Ordering::Relaxed) {
            return;
        }
        is_there.store(decision.mode == Mode::Follow && *distance < ON_PATH_M, Ordering::Relaxed);
        if matches!(decision.mode, Mode::Hold | Mode::Join | Mode::Follow) {
            let now = [body.position(), body.uav_position()];
            fence.look(&[last.unwrap_or(now), now], Place::of_curve(now[0], 0.0), true, &mut worst);
            last = Some(now);
        }
    });
    // It leads to where it ends.
    let Some([end, _]) = last else { return Ok(worst) };
    let away = |place: &Place| length(&(place.position - end));
    let joined = report.lap.nodes().iter().map(Node::place).min_by(|a, b| away(a).total_cmp(&away(b)));
    for breach in &mut worst {
        breach.place.leg = joined.and_then(|joined| joined.leg);
    }
    Ok(worst)
}
