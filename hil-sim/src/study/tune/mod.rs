//! Poles and observer bandwidths for a vehicle, its rate, latency, rotor lag and noise, found by
//! flying.
//!
//! Two numbers are sought: s of the spread poles s·{−1, …, −6} for the surfaces, s·{−1, …,
//! −5} for the speed and s·{−2, −3} for the yaw, and the bandwidth of the observers, in place
//! of the scenario's own poles and integral action. Each pair of a grid flies the scenario's world
//! with the same random starts beside its path, gusts and noise.
//!
//! A flight is good as in [`compare`](crate::study::compare) (d_C < 25 cm in the last quarter), if
//! rod and thrust also stayed within the angles of [`EnvelopeParams::wide`], where a supervised law
//! would have given up. Of the settings with the most good flights the one proposed has the least
//! d_C² τ, both root mean squares of the last quarter: a setting may cost two per cent more torque
//! for each per cent by which it comes closer to the path. What the law does not know of the world
//! counts only if the scenario has it: another payload than `controller.vehicle`, wind, a weak
//! rotor.

mod report;

pub use report::{table, trade};

use controller::{EnvelopeParams, Vector3};
use rayon::prelude::*;
use serde::Serialize;

use crate::describe::input::Invalid;
use crate::describe::scenario::{Law, Scenario};
use crate::fly::flight::Control;
use crate::fly::judge::{JUDGED, judge};
use crate::fly::pilot::Pilot;
use crate::study::compare::{percentile, start};
use crate::world::Seed;
use crate::world::random::Purpose;

/// The scenario that is tuned for if there is no other.
pub const SCENARIO: &str = include_str!("../../../scenarios/tune.toml");

/// s unless told otherwise.
pub const SCALES: [f64; 7] = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2];

/// Bandwidths of the observers unless told otherwise, rad/s.
pub const BANDWIDTHS: [f64; 6] = [2.0, 4.0, 6.0, 8.0, 10.0, 12.0];

/// Points of the path at which flights may start.
const STARTS: usize = 64;

/// What a setting did, over all flights.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// s of the poles.
    pub scale: f64,
    /// Of all observers, rad/s.
    pub bandwidth: f64,
    /// Flights.
    pub runs: usize,
    /// Good ones.
    pub good: usize,
    /// Root mean square of d_C over the last quarters, m.
    pub rms_dc_m: f64,
    /// Median over flights of the largest d_C in the last quarter, m.
    pub median_dc_m: f64,
    /// Root mean square of |τ| as commanded over the last quarters, N·m.
    pub rms_torque_nm: f64,
    /// Largest |τ| as commanded, over whole flights, N·m.
    pub max_torque_nm: f64,
    /// Largest angle of the rod from the vertical, over whole flights, degrees.
    pub max_rod_deg: f64,
    /// Largest angle of the thrust from the rod, over whole flights, degrees.
    pub max_thrust_deg: f64,
}

impl Row {
    /// d_C² τ, m² N·m: the least is proposed.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.rms_dc_m * self.rms_dc_m * self.rms_torque_nm
    }
}

/// What was flown and what is proposed.
#[derive(Clone, Debug, Serialize)]
pub struct Tuning {
    /// Of all random numbers.
    pub seed: u64,
    /// A setting each.
    pub rows: Vec<Row>,
    /// The index of the one proposed.
    pub proposed: usize,
    /// The scenario's `[controller]` with the proposed settings.
    #[serde(skip)]
    pub snippet: String,
}

/// The keys of a scenario with spread poles of this `scale` and observers of this `bandwidth`,
/// rad/s, in place of its own, and without integral action.
#[must_use]
pub fn with_settings(table: &toml::Table, scale: f64, bandwidth: f64) -> toml::Table {
    let mut table = table.clone();
    if let Some(toml::Value::Table(controller)) = table.get_mut("controller") {
        let row = |poles: &[f64]| -> toml::Value {
            // As a person would write them: −1.8, not −1.7999999999999998.
            poles.iter().map(|pole| (-1e6 * scale * pole).round() / 1e6).collect::<Vec<_>>().into()
        };
        let (six, five) = ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [1.0, 2.0, 3.0, 4.0, 5.0]);
        controller.remove("k");
        controller.remove("k_integral");
        controller.insert("poles".to_owned(), vec![row(&six), row(&six), row(&five), row(&[2.0, 3.0])].into());
        let observer = ["payload", "rod", "torque"].map(|name| (name.to_owned(), bandwidth.into()));
        controller.insert("observer".to_owned(), toml::Table::from_iter(observer).into());
    }
    table
}

/// Flies `runs` flights for each pair of a scale and a bandwidth (rad/s); `None` if interrupted.
/// `table` are a scenario's keys.
///
/// # Errors
/// [`Invalid`] for an invalid scenario, one that does not follow a closed path, or one that does
/// not take one of the settings.
pub fn tune(
    table: &toml::Table,
    (scales, bandwidths): (&[f64], &[f64]),
    (runs, seed): (usize, u64),
    control: Control<'_>,
) -> Result<Option<Tuning>, Invalid> {
    let mut rows = Vec::new();
    for (&scale, &bandwidth) in scales.iter().flat_map(|scale| bandwidths.iter().map(move |o| (scale, o))) {
        let scenario = Scenario::from_table("tune", with_settings(table, scale, bandwidth))?;
        let outline = outline(&scenario)?;
        let envelope = envelope();
        // Whatever f32 refuses is refused here.
        Pilot::<f32>::new(&scenario.controller)?;
        let flights: Option<Vec<Flown>> = (0..runs as u64)
            .into_par_iter()
            .map(|run| fly_one(&scenario, &outline, envelope, Seed { batch: seed, run }, control))
            .collect();
        let Some(flights) = flights else { return Ok(None) };
        rows.push(row(scale, bandwidth, &flights));
    }
    let Some(proposed) = best(&rows, Row::cost) else { return Ok(None) };
    let Row { scale, bandwidth, .. } = rows[proposed];
    let controller =
        with_settings(table, scale, bandwidth).remove("controller").unwrap_or_else(|| toml::Table::new().into());
    let snippet = toml::Table::from_iter([("controller".to_owned(), controller)]).to_string();
    Ok(Some(Tuning { seed, rows, proposed, snippet }))
}

/// Points of the path to be followed.
fn outline(scenario: &Scenario) -> Result<Vec<[f64; 3]>, Invalid> {
    let Law::Follow { path, .. } = &scenario.controller.law else {
        return Err(Invalid::new("controller.law", "what is tuned is \"follow\""));
    };
    let outline = path.outline(STARTS);
    if outline.is_empty() {
        Err(Invalid::new("path", "not a closed curve, see `hil-sim check`"))
    } else {
        Ok(outline)
    }
}

/// Largest angles of rod and thrust, rad.
fn envelope() -> [f64; 2] {
    let wide = EnvelopeParams::wide();
    [wide.rod_angle.limit, wide.thrust_angle.limit]
}

/// What is kept of a flight.
struct Flown {
    good: bool,
    dc_rms_m: f64,
    dc_max_m: f64,
    /// Mean of |τ|² in the last quarter and largest |τ|, (N·m)² and N·m.
    torque_squared: f64,
    torque_max: f64,
    /// rad.
    rod: f64,
    thrust: f64,
}

fn fly_one(
    scenario: &Scenario,
    outline: &[[f64; 3]],
    [rod_limit, thrust_limit]: [f64; 2],
    seed: Seed,
    control: Control<'_>,
) -> Option<Flown> {
    let mut random = seed.stream(Purpose::Draw);
    let beside = outline[(random.unit() * outline.len() as f64) as usize];
    let mut start = start(0.0, 0.0, &mut random);
    start.position += Vector3::from(beside);
    let judged_from_s = (1.0 - JUDGED) * scenario.duration_s;
    let (mut squares, mut count, mut torque_max) = (0.0, 0_u32, 0.0_f64);
    let (mut q3, mut q_b3) = (1.0_f64, 1.0_f64);
    let mut pilot = Pilot::<f32>::new(&scenario.controller).expect("it was set up before").without_telemetry();
    let outcome = judge(scenario, start, seed, None, control, &mut pilot, &mut |moment| {
        let Some(decision) = moment.decision else { return };
        let torque = &decision.command.torque;
        let square = torque.dot(torque);
        torque_max = torque_max.max(square.sqrt());
        if moment.t_s >= judged_from_s {
            squares += square;
            count += 1;
        }
        if let Some(margins) = &decision.margins {
            (q3, q_b3) = (q3.min(margins.q3), q_b3.min(margins.q_b3));
        }
    })?;
    let [rod, thrust] = [q3, q_b3].map(|cosine| libm::acos(cosine.clamp(-1.0, 1.0)));
    Some(Flown {
        good: outcome.is_good() && rod <= rod_limit && thrust <= thrust_limit,
        dc_rms_m: outcome.dc_rms_m,
        dc_max_m: outcome.dc_max_m,
        torque_squared: squares / f64::from(count.max(1)),
        torque_max,
        rod,
        thrust,
    })
}

fn row(scale: f64, bandwidth: f64, flights: &[Flown]) -> Row {
    let count = flights.len().max(1) as f64;
    let mean = |value: fn(&Flown) -> f64| flights.iter().map(value).sum::<f64>() / count;
    let largest = |value: fn(&Flown) -> f64| flights.iter().map(value).fold(0.0, f64::max);
    let mut distances: Vec<f64> = flights.iter().map(|flown| flown.dc_max_m).collect();
    Row {
        scale,
        bandwidth,
        runs: flights.len(),
        good: flights.iter().filter(|flown| flown.good).count(),
        rms_dc_m: mean(|flown| flown.dc_rms_m * flown.dc_rms_m).sqrt(),
        median_dc_m: percentile(&mut distances, 0.5),
        rms_torque_nm: mean(|flown| flown.torque_squared).sqrt(),
        max_torque_nm: largest(|flown| flown.torque_max),
        max_rod_deg: largest(|flown| flown.rod).to_degrees(),
        max_thrust_deg: largest(|flown| flown.thrust).to_degrees(),
    }
}

/// One number of a row.
type Value = fn(&Row) -> f64;

/// The index of the least `cost` among the rows with the most good flights.
fn best(rows: &[Row], cost: Value) -> Option<usize> {
    let most = rows.iter().map(|row| row.good).max()?;
    let good = (0..rows.len()).filter(|&index| rows[index].good == most);
    good.min_by(|&a, &b| cost(&rows[a]).total_cmp(&cost(&rows[b])))
}
