//! Path following against trajectory tracking, start by start: where the paper's two claims hold,
//! and where they do not.
//!
//! A1: stopped on its path and released, path following goes on from where it is; tracking leaves
//! the path to catch up with its reference. A2: path following comes to the path sooner, without
//! leaving it again, at less effort. The paper compares unequal poles (2 against 1.5); here
//! tracking flies with equal poles, and with poles three quarters as fast. All have the same
//! observers.
//!
//! The reference starts at the point of the circle about which starts are drawn.

use rayon::prelude::*;
use serde::Serialize;
use std::fmt::Write as _;

use controller::TrackGains;

use super::cases::all;
use super::table::length;
use super::{BANDWIDTH, Contender, base, contend, percentile, start};
use crate::describe::scenario::{Law, Obstacle, Scenario, ScenarioError};
use crate::fly::flight::{Control, LOST_M};
use crate::fly::judge::judge;
use crate::fly::metrics::SETTLED_M;
use crate::fly::pilot::Pilot;
use crate::world::Seed;
use crate::world::random::{Purpose, Stream};

/// The policies, in the order of the table.
const POLICIES: [&str; 3] = ["path following", "tracking, equal poles", "tracking, slower poles"];

/// Ratio of the slower poles to the others: the paper's 1.5 to 2.
const SLOWER: f64 = 0.75;

/// A trial: what the flights meet, and what is measured.
struct Trial {
    name: &'static str,
    prepare: fn(&mut Scenario, &mut Stream),
    quantities: &'static [Quantity],
}

const TRIALS: [Trial; 3] = [
    Trial { name: "joining the path", prepare: |_, _| {}, quantities: &JOINING },
    Trial { name: "joining the path, everything wrong with the world", prepare: all, quantities: &JOINING },
    Trial { name: "stopped at 20 s for up to 3 s", prepare: stop, quantities: &[Quantity::AfterRelease] },
];

const JOINING: [Quantity; 4] = [Quantity::Settling, Quantity::LeavingAgain, Quantity::Effort, Quantity::PeakTorque];

fn stop(scenario: &mut Scenario, random: &mut Stream) {
    scenario.obstacle = Some(Obstacle { at_s: 0.5 * scenario.duration_s, hold_s: random.uniform(0.0, 3.0) });
}

/// What is measured; of all of it less is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Quantity {
    /// Time from which d_C stays below 5 cm, s; the flight's length if it does not.
    Settling,
    /// By how much d_C comes to be above 5 cm again after it was first below, m; 0 if it does not.
    LeavingAgain,
    /// ∫‖u − u_hover‖dt with u = (T, τ) as numbers in N and N·m, N·s.
    Effort,
    /// Largest ‖τ‖, N·m.
    PeakTorque,
    /// Largest d_C after the release, m.
    AfterRelease,
}

impl Quantity {
    fn text(self, value: f64) -> String {
        match self {
            Self::Settling => format!("{value:.2} s"),
            Self::LeavingAgain | Self::AfterRelease => length(value),
            Self::Effort => format!("{value:.1} N s"),
            Self::PeakTorque => format!("{value:.3} N m"),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Settling => "d_C < 5 cm for good",
            Self::LeavingAgain => "above 5 cm again by",
            Self::Effort => "effort",
            Self::PeakTorque => "peak torque",
            Self::AfterRelease => "d_C after release",
        }
    }
}

/// A quantity of a trial over all starts.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// The trial.
    pub trial: &'static str,
    quantity: Quantity,
    /// Medians of the policies in their order.
    pub medians: [f64; 3],
    /// Share of starts in which path following was as good as tracking with equal and with slower
    /// poles, or better.
    pub better: [f64; 2],
}

/// The whole comparison of policies.
#[derive(Clone, Debug, Serialize)]
pub struct Policies {
    /// Starts for each trial.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// Names in the order of the medians.
    pub policies: [&'static str; 3],
    /// A quantity of a trial each.
    pub lines: Vec<Line>,
}

/// Flies each policy from `runs` starts in every trial; `None` if interrupted.
///
/// # Errors
/// [`ScenarioError`] as [`base`].
pub fn policies(runs: usize, seed: u64, control: Control<'_>) -> Result<Option<Policies>, ScenarioError> {
    let base = base()?;
    let following = contend(&base, Contender::Observer, BANDWIDTH);
    let equal = contend(&base, Contender::TrackingObserver, BANDWIDTH);
    let mut slower = equal.clone();
    if let Law::Track { gains, .. } = &mut slower.controller.law {
        // Poles times s are gains times powers of s.
        let scale = |row: [f64; 6]| std::array::from_fn(|k| row[k] * SLOWER.powi(6 - k as i32));
        let [yaw, yaw_rate] = gains.yaw;
        *gains = TrackGains { position: gains.position.map(scale), yaw: [yaw * SLOWER * SLOWER, yaw_rate * SLOWER] };
    }
    let scenarios = [following, equal, slower];
    let mut lines = Vec::new();
    for trial in &TRIALS {
        let flown: Option<Vec<[Measured; 3]>> = (0..runs as u64)
            .into_par_iter()
            .map(|run| {
                let seed = Seed { batch: seed, run };
                let [following, equal, slower] = scenarios.each_ref().map(|s| measure(s, trial, seed, control));
                Some([following?, equal?, slower?])
            })
            .collect();
        let Some(flown) = flown else { return Ok(None) };
        lines.extend(trial.quantities.iter().map(|&quantity| line(trial.name, quantity, &flown)));
    }
    Ok(Some(Policies { runs, seed, policies: POLICIES, lines }))
}

/// Seconds of flight in a comparison of policies.
#[must_use]
pub fn policies_work_s(runs: usize) -> f64 {
    (TRIALS.len() * POLICIES.len() * runs) as f64 * base().map_or(0.0, |scenario| scenario.duration_s)
}

/// What one flight showed.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    settling: f64,
    leaving_again: f64,
    effort: f64,
    peak_torque: f64,
    after_release: f64,
}

impl Measured {
    fn of(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Settling => self.settling,
            Quantity::LeavingAgain => self.leaving_again,
            Quantity::Effort => self.effort,
            Quantity::PeakTorque => self.peak_torque,
            Quantity::AfterRelease => self.after_release,
        }
    }
}

fn measure(scenario: &Scenario, trial: &Trial, seed: Seed, control: Control<'_>) -> Option<Measured> {
    let mut scenario = scenario.clone();
    let mut random = seed.stream(Purpose::Draw);
    let [radius, p3, _] = scenario.controller.law.circle().unwrap_or([5.0, -10.0, 1.0]);
    let start = start(radius, p3, &mut random);
    (trial.prepare)(&mut scenario, &mut random);
    let pilot = Pilot::<f32>::new(&scenario.controller).expect("the comparison's scenarios can be set up");
    let mut pilot = pilot.without_telemetry();
    let hover = scenario.vehicle.total_mass() * scenario.vehicle.gravity;
    let period = 1.0 / scenario.controller.rate_hz;
    let release_s = scenario.obstacle.map_or(f64::INFINITY, |obstacle| obstacle.at_s + obstacle.hold_s);
    let mut measured = Measured::default();
    let mut settled = None;
    let mut has_been_below = false;
    let outcome = judge(&scenario, start, seed, None, control, &mut pilot, &mut |moment| {
        let Some(decision) = moment.decision else { return };
        let command = &decision.command;
        let torque = command.torque.dot(&command.torque).sqrt();
        measured.effort += (command.thrust - hover).hypot(torque) * period;
        measured.peak_torque = measured.peak_torque.max(torque);
        let Some(distance) = moment.distance_m else { return };
        if distance < SETTLED_M {
            settled.get_or_insert(moment.t_s);
            has_been_below = true;
        } else {
            settled = None;
        }
        if has_been_below {
            measured.leaving_again = measured.leaving_again.max(distance - SETTLED_M);
        }
        if moment.t_s >= release_s {
            measured.after_release = measured.after_release.max(distance);
        }
    })?;
    measured.settling = settled.unwrap_or(scenario.duration_s);
    if outcome.dc_max_m >= LOST_M {
        measured.leaving_again = LOST_M;
        measured.after_release = LOST_M;
    }
    Some(measured)
}

fn line(trial: &'static str, quantity: Quantity, flown: &[[Measured; 3]]) -> Line {
    let count = flown.len().max(1) as f64;
    let better = |other: usize| {
        flown.iter().filter(|policies| policies[0].of(quantity) <= policies[other].of(quantity)).count() as f64
            / count
    };
    let median = |policy: usize| {
        percentile(&mut flown.iter().map(|policies| policies[policy].of(quantity)).collect::<Vec<_>>(), 0.5)
    };
    Line { trial, quantity, medians: [median(0), median(1), median(2)], better: [better(1), better(2)] }
}

impl Policies {
    /// For a terminal: medians, and for each claim whether it holds.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text =
            format!("{} starts a trial; medians, and where path following is as good or better\n", self.runs);
        let mut trial = "";
        for line in &self.lines {
            if line.trial != trial {
                trial = line.trial;
                let _ = writeln!(text, "\n{trial}");
            }
            let [following, equal, slower] = line.medians.map(|median| line.quantity.text(median));
            let _ = writeln!(
                text,
                "  {:<20} {following:>11} following; {equal:>11} tracking with equal poles: {}; {slower:>11} with slower: {}",
                line.quantity.name(),
                holds(line.better[0]),
                holds(line.better[1])
            );
        }
        text
    }
}

/// A claim over all starts, in words.
fn holds(share: f64) -> String {
    let percent = 100.0 * share;
    match share {
        s if s >= 0.95 => format!("holds ({percent:.0} %)"),
        s if s > 0.5 => format!("holds in {percent:.0} %"),
        _ => format!("DOES NOT HOLD ({percent:.0} %)"),
    }
}
