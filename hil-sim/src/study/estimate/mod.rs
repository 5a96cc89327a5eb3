//! How well the law flies on an estimate: a table of cases, each from random starts, with the full
//! state beside it.

mod cases;
mod measure;
mod table;

pub use cases::{CASES, Case, Course};
pub use table::{table, write};

use controller::State;
use rayon::prelude::*;
use serde::Serialize;

use crate::describe::scenario::{Scenario, ScenarioError};
use crate::fly::flight::{Control, End};
use crate::fly::judge::{Outcome, judge};
use crate::study::campaign::{self, ApproachFields};
use crate::study::compare;
use crate::world::Seed;
use crate::world::random::Purpose;
use measure::Errors;

/// What a case came to.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    pub case: &'static str,
    /// Flights.
    pub runs: usize,
    /// Those that did not end in the air at their time, or ended more than 2 m off the path.
    pub lost: usize,
    /// Over the flights, the median of the largest d_C in the last quarter, m.
    pub dc_max_median_m: f64,
    /// The worst, m.
    pub dc_max_worst_m: f64,
    /// Root mean square of d_C over the last quarters of all flights that were not lost, m.
    pub dc_rms_m: f64,
    /// Root mean square of the rod's error in the last quarters, degrees; none of the full state.
    pub rod_rms_deg: Option<f64>,
    /// Of the rod's rate, 1/s.
    pub rod_rate_rms: Option<f64>,
    /// Largest error of a rod after the first 20 s, degrees.
    pub rod_worst_deg: Option<f64>,
    /// Median time from which the rod's error stays below 2°, s.
    pub rod_found_s: Option<f64>,
    /// Mean over the last quarters of e·P⁻¹e/2 of the rod: 1 where the filter knows how good it is.
    pub nees_rod: Option<f64>,
    /// The same of its rate.
    pub nees_rate: Option<f64>,
    /// Root mean square of the errors of the UAV's position (m) and velocity (m/s).
    pub position_rms_m: Option<f64>,
    /// m/s.
    pub velocity_rms_m_s: Option<f64>,
    /// Median of the payload's mass that was found, kg.
    pub mass_found_kg: Option<f64>,
    /// Median of the thrust scale that was found.
    pub thrust_found: Option<f64>,
    /// Largest step of the thrust commanded from one period to the next in the last quarters, of
    /// its mean.
    pub thrust_step: f64,
}

/// The table.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Flights a row.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// A case each.
    pub rows: Vec<Row>,
}

/// A flight that ends so far off the path does not count as flown, m. A plain receiver's metres are
/// its own.
const ASTRAY_M: f64 = 10.0;

/// The scenario that every case starts from.
///
/// # Errors
/// [`ScenarioError`] never: a test reads the file.
pub fn base() -> Result<Scenario, ScenarioError> {
    Scenario::parse("hil-sim/scenarios/estimate.toml", include_str!("../../../scenarios/estimate.toml"))
}

struct Flown {
    outcome: Outcome,
    errors: Errors,
}

fn fly_one(base: &Scenario, case: &Case, seed: Seed, control: Control<'_>) -> Result<Option<Flown>, ScenarioError> {
    let mut random = seed.stream(Purpose::Draw);
    let mut start: State<f64> = compare::start(5.0, -10.0, &mut random);
    if let Some(degrees) = case.rod {
        let (angle, turn) = (degrees.to_radians(), random.uniform(0.0, std::f64::consts::TAU));
        let across = libm::sin(angle);
        start.rod = [across * libm::cos(turn), across * libm::sin(turn), libm::cos(angle)].into();
    }
    let scenario = case.scenario(base, &mut random)?;
    let mut pilot = campaign::pilot(&scenario.controller, &ApproachFields::default())
        .expect("the table's scenarios can be set up, as a test shows")
        .without_telemetry();
    let mut errors = Errors::new(&scenario);
    let outcome = judge(&scenario, start, seed, None, control, &mut pilot, &mut |moment| errors.push(moment));
    Ok(outcome.map(|outcome| Flown { outcome, errors }))
}

/// Flies `runs` flights of every case whose name `wanted` accepts; `None` if they were interrupted.
///
/// # Errors
/// [`ScenarioError`] as [`base`].
pub fn estimate(
    runs: usize,
    seed: u64,
    wanted: &(dyn Fn(&str) -> bool + Sync),
    control: Control<'_>,
) -> Result<Option<Table>, ScenarioError> {
    let base = base()?;
    let mut rows = Vec::new();
    for case in CASES.iter().filter(|case| wanted(case.name)) {
        let flights: Result<Option<Vec<Flown>>, ScenarioError> = (0..runs as u64)
            .into_par_iter()
            .map(|run| fly_one(&base, case, Seed { batch: seed, run }, control))
            .collect::<Result<Vec<_>, _>>()
            .map(|flights| flights.into_iter().collect());
        let Some(flights) = flights? else { return Ok(None) };
        rows.push(row(case, &flights));
    }
    Ok(Some(Table { runs, seed, rows }))
}

/// Seconds of flight in a table.
#[must_use]
pub fn work_s(runs: usize, wanted: &dyn Fn(&str) -> bool) -> f64 {
    let cases = CASES.iter().filter(|case| wanted(case.name)).count();
    base().map_or(0.0, |base| base.duration_s) * (cases * runs) as f64
}

fn row(case: &Case, flights: &[Flown]) -> Row {
    let is_lost = |flown: &Flown| flown.outcome.end != End::Complete || flown.outcome.dc_max_m > ASTRAY_M;
    let kept: Vec<&Flown> = flights.iter().filter(|flown| !is_lost(flown)).collect();
    let largest: Vec<f64> = flights.iter().map(|flown| flown.outcome.dc_max_m).collect();
    let mean = |of: fn(&Flown) -> f64| kept.iter().map(|flown| of(flown)).sum::<f64>() / kept.len().max(1) as f64;
    let has_estimate = kept.iter().any(|flown| flown.errors.count > 0);
    let rms = |of: fn(&Errors) -> f64| {
        has_estimate.then(|| {
            let (sum, count) = kept
                .iter()
                .fold((0.0, 0), |(sum, count), flown| (sum + of(&flown.errors), count + flown.errors.count));
            (sum / f64::from(count.max(1))).sqrt()
        })
    };
    let found = |of: fn(&Errors) -> f64| {
        has_estimate.then(|| median(&kept.iter().map(|flown| of(&flown.errors)).collect::<Vec<_>>()))
    };
    Row {
        case: case.name,
        runs: flights.len(),
        lost: flights.len() - kept.len(),
        dc_max_median_m: median(&largest),
        dc_max_worst_m: largest.iter().copied().fold(0.0, f64::max),
        dc_rms_m: mean(|flown| flown.outcome.dc_rms_m * flown.outcome.dc_rms_m).sqrt(),
        rod_rms_deg: rms(|errors| errors.rod).map(f64::to_degrees),
        rod_rate_rms: rms(|errors| errors.rate),
        rod_worst_deg: has_estimate
            .then(|| kept.iter().map(|flown| flown.errors.rod_worst).fold(0.0, f64::max).to_degrees()),
        rod_found_s: found(|errors| errors.found_s),
        nees_rod: rms(|errors| errors.nees_rod).map(|root| root * root),
        nees_rate: rms(|errors| errors.nees_rate).map(|root| root * root),
        position_rms_m: rms(|errors| errors.position),
        velocity_rms_m_s: rms(|errors| errors.velocity),
        mass_found_kg: found(|errors| errors.mass),
        thrust_found: found(|errors| errors.thrust_scale),
        thrust_step: kept.iter().map(|flown| flown.errors.thrust_step).fold(0.0, f64::max),
    }
}

/// The middle one, or the mean of the two; 0 of none.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match (sorted.get(middle.saturating_sub(1)), sorted.get(middle)) {
        (Some(below), Some(above)) if sorted.len().is_multiple_of(2) => 0.5 * (below + above),
        (_, Some(above)) => *above,
        _ => 0.0,
    }
}
