//! The comparison a reviewer would ask for: the law as published, with integral action, with
//! disturbance observers, and trajectory tracking with the same observers, at equal poles, over the
//! same starts and the same faults of the world.
//!
//! Table I's vehicle flies the circle of 5 m at 1 m/s for 40 s, at 500 Hz. A flight is good when
//! d_C stays below 25 cm in its last quarter. Known lag and latency are compensated by every law
//! alike.

mod cases;
mod page;
mod policies;
mod table;

pub use cases::{CASES, Case, start};
pub use page::write;
pub use policies::{Line, Policies, policies, policies_work_s};
pub(crate) use table::length;
pub use table::{table, worse};

use controller::{ObserverParams, TrackGains};
use rayon::prelude::*;
use serde::Serialize;

use crate::describe::course::ReferenceSpec;
use crate::describe::scenario::{Law, Scenario, ScenarioError};
use crate::fly::flight::{Control, LOST_M};
use crate::fly::judge::{Outcome, judge};
use crate::fly::pilot::Pilot;
use crate::world::Seed;
use crate::world::random::Purpose;

/// The laws compared, in the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Contender {
    /// As the paper has it.
    Published,
    /// With its integral action (5.4).
    Integral,
    /// With disturbance observers.
    Observer,
    /// Trajectory tracking with the same observers.
    TrackingObserver,
}

impl Contender {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Published, Self::Integral, Self::Observer, Self::TrackingObserver];

    /// Its name in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Integral => "integral",
            Self::Observer => "observer",
            Self::TrackingObserver => "tracking-observer",
        }
    }
}

/// K̃ of the law with integral action.
const INTEGRAL: [f64; 3] = [108.0, 108.0, 12.0];

/// Bandwidth of all observers unless told otherwise, rad/s.
pub const BANDWIDTH: f64 = 8.0;

/// Period of the traces kept for plots, s.
const TRACE_PERIOD_S: f64 = 0.25;

/// What a law did in a case.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    pub case: &'static str,
    /// The law.
    pub law: Contender,
    /// Flights.
    pub runs: usize,
    /// Those with d_C < 25 cm in the last quarter.
    pub good: usize,
    /// Median over flights of the largest d_C in the last quarter, m.
    pub median_dc_m: f64,
    /// Root mean square of d_C over the last quarters of all flights, m; one that was lost counts
    /// as 100 m throughout.
    pub rms_dc_m: f64,
    /// Largest d_C in a last quarter, m.
    pub max_dc_m: f64,
    /// Median over flights of the root mean square of d_C in the last quarter, m.
    pub median_rms_dc_m: f64,
    /// Time (s), median and 95th percentile of d_C (m) over the flights.
    #[serde(skip)]
    pub trace: Vec<[f64; 3]>,
}

/// The whole comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Flights a row.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// Of the observers, rad/s.
    pub bandwidth: f64,
    /// A case and a law each.
    pub rows: Vec<Row>,
}

/// The scenario that every case and law starts from.
///
/// # Errors
/// [`ScenarioError`] never: a test reads the file.
pub fn base() -> Result<Scenario, ScenarioError> {
    Scenario::parse("hil-sim/scenarios/compare.toml", include_str!("../../../scenarios/compare.toml"))
}

/// `base` flown by `contender`, with observers of this `bandwidth`, rad/s.
#[must_use]
pub fn contend(base: &Scenario, contender: Contender, bandwidth: f64) -> Scenario {
    let mut scenario = base.clone();
    let controller = &mut scenario.controller;
    match contender {
        Contender::Published => {}
        Contender::Integral => {
            if let Law::Follow { gains, .. } = &mut controller.law {
                gains.integral = INTEGRAL;
            }
        }
        Contender::Observer => controller.observer = ObserverParams::with_bandwidth(bandwidth),
        Contender::TrackingObserver => {
            controller.observer = ObserverParams::with_bandwidth(bandwidth);
            if let (Some([radius, p3, speed]), Law::Follow { gains, .. }) = (controller.law.circle(), &controller.law)
            {
                // The path's poles, with the sixth of the surfaces' for the coordinate that speed
                // was. The reference turns from n2 to n1.
                let gains = TrackGains { position: [gains.k1; 3], yaw: gains.k4 };
                controller.law = Law::Track { reference: ReferenceSpec { radius, p3, rate: -speed / radius }, gains };
            }
        }
    }
    scenario
}

/// One flight: its outcome, and d_C every [`TRACE_PERIOD_S`]; `None` if it was interrupted.
fn fly_one(scenario: &Scenario, case: &Case, seed: Seed, control: Control<'_>) -> Option<(Outcome, Vec<f32>)> {
    let mut scenario = scenario.clone();
    let mut random = seed.stream(Purpose::Draw);
    let [radius, p3, _] = scenario.controller.law.circle().unwrap_or([5.0, -10.0, 1.0]);
    let start = start(radius, p3, &mut random);
    (case.apply)(&mut scenario, &mut random);
    let mut trace = Vec::new();
    let points = (scenario.duration_s / TRACE_PERIOD_S) as usize;
    // The numbers of the comparison are constants that f32 holds, as the tests show.
    let pilot = Pilot::<f32>::new(&scenario.controller).expect("the comparison's scenarios can be set up");
    let mut pilot = pilot.without_telemetry();
    let outcome = judge(&scenario, start, seed, None, control, &mut pilot, &mut |moment| {
        if let Some(distance) = moment.distance_m
            && moment.t_s >= TRACE_PERIOD_S * trace.len() as f64 - 1e-9
        {
            trace.push(distance as f32);
        }
    })?;
    trace.resize(points, LOST_M as f32);
    Some((outcome, trace))
}

/// Flies `runs` flights for every case and law whose names `wanted` accepts; `None` if interrupted.
///
/// # Errors
/// [`ScenarioError`] as [`base`].
pub fn compare(
    runs: usize,
    seed: u64,
    bandwidth: f64,
    wanted: &(dyn Fn(&str) -> bool + Sync),
    control: Control<'_>,
) -> Result<Option<Comparison>, ScenarioError> {
    let base = base()?;
    let mut rows = Vec::new();
    for case in CASES.iter().filter(|case| wanted(case.name)) {
        for contender in Contender::ALL {
            let scenario = contend(&base, contender, bandwidth);
            let flights: Option<Vec<(Outcome, Vec<f32>)>> = (0..runs as u64)
                .into_par_iter()
                .map(|run| fly_one(&scenario, case, Seed { batch: seed, run }, control))
                .collect();
            let Some(flights) = flights else { return Ok(None) };
            rows.push(row(case, contender, &flights));
        }
    }
    Ok(Some(Comparison { runs, seed, bandwidth, rows }))
}

/// Seconds of flight in a comparison.
#[must_use]
pub fn work_s(runs: usize, wanted: &dyn Fn(&str) -> bool) -> f64 {
    let cases = CASES.iter().filter(|case| wanted(case.name)).count();
    let duration = base().map_or(0.0, |scenario| scenario.duration_s);
    (cases * Contender::ALL.len() * runs) as f64 * duration
}

fn row(case: &Case, law: Contender, flights: &[(Outcome, Vec<f32>)]) -> Row {
    let count = flights.len().max(1) as f64;
    let of = |value: fn(&Outcome) -> f64| -> Vec<f64> { flights.iter().map(|(outcome, _)| value(outcome)).collect() };
    let largest = of(|outcome| outcome.dc_max_m);
    let rms = of(|outcome| outcome.dc_rms_m);
    let points = flights.first().map_or(0, |(_, trace)| trace.len());
    let trace = (0..points)
        .map(|point| {
            let mut values: Vec<f64> = flights.iter().map(|(_, trace)| f64::from(trace[point])).collect();
            [TRACE_PERIOD_S * point as f64, percentile(&mut values, 0.5), percentile(&mut values, 0.95)]
        })
        .collect();
    Row {
        case: case.name,
        law,
        runs: flights.len(),
        good: flights.iter().filter(|(outcome, _)| outcome.is_good()).count(),
        median_dc_m: percentile(&mut largest.clone(), 0.5),
        rms_dc_m: (rms.iter().map(|value| value * value).sum::<f64>() / count).sqrt(),
        max_dc_m: largest.iter().copied().fold(0.0, f64::max),
        median_rms_dc_m: percentile(&mut rms.clone(), 0.5),
        trace,
    }
}

/// The `share` percentile, linear between values; sorts `values`; 0 without any.
pub fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let at = share * last as f64;
    let below = values[at as usize];
    let above = values[(at as usize + 1).min(last)];
    below + (above - below) * at.fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller::State;

    #[test]
    fn percentiles_lie_between_the_values() {
        assert_eq!(percentile(&mut [3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(percentile(&mut [0.0, 10.0], 0.95), 9.5);
        assert_eq!(percentile(&mut [], 0.5), 0.0);
    }

    #[test]
    fn every_contender_of_every_case_can_be_set_up_and_flies_alike_twice() {
        let base = base().expect("the file is valid");
        let seed = Seed { batch: 1, run: 3 };
        for contender in Contender::ALL {
            let mut scenario = contend(&base, contender, BANDWIDTH);
            scenario.duration_s = 0.5;
            for case in CASES {
                let fly = || fly_one(&scenario, case, seed, Control::alone());
                let (first, again) = (fly(), fly());
                assert_eq!(first, again, "{} {}", case.name, contender.name());
            }
        }
    }

    /// Against a steady force of 1 N the path is held within 5 mm, and the force is found.
    #[test]
    fn a_newton_of_wind_costs_the_observer_five_millimetres() {
        let mut scenario = contend(&base().expect("the file is valid"), Contender::Observer, BANDWIDTH);
        scenario.environment.payload_force = [0.6, 0.8, 0.0];
        let start = State::from_paper(&scenario.initial);
        let mut missed_n = 0.0_f64;
        let mut pilot = Pilot::<f32>::new(&scenario.controller).expect("it can be set up");
        let outcome = judge(&scenario, start, Seed::default(), None, Control::alone(), &mut pilot, &mut |moment| {
            let Some(telemetry) = moment.decision.and_then(|decision| decision.telemetry) else { return };
            let [x, y, _] = telemetry.observed.payload_force;
            if moment.t_s >= 3.0 {
                missed_n = missed_n.max((x - 0.6).hypot(y - 0.8));
            }
        })
        .expect("nobody interrupts it");
        assert!(outcome.dc_max_m <= 5e-3, "{outcome:?}");
        assert!(missed_n <= 0.02, "{missed_n} N");
    }
}
