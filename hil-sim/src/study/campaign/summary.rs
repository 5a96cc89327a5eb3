//! What a campaign says: shares, percentiles, and every flight that failed.

use comfy_table::{CellAlignment, Table};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

use super::fly::{Row, Verdict};
use super::statistics::{interval, sensitivity};
use super::tally::Tally;
use crate::study::compare::{length, percentile};

/// The shares of flights whose d_C is told.
const SHARES: [(&str, f64); 6] =
    [("p50", 0.5), ("p90", 0.9), ("p95", 0.95), ("p99", 0.99), ("p99_9", 0.999), ("max", 1.0)];

/// The numbers of a campaign, as `summary.json` has them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Flights.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// Share of flights with d_C below 25 cm throughout the last quarter; of those that are to
    /// land, on the ground with rotors off and the payload in its place.
    pub success_rate: f64,
    /// Clopper and Pearson's interval for it, of 95 % confidence.
    pub success_interval: [f64; 2],
    /// Flights that had it.
    pub good: usize,
    /// Flights that had not and ended in hold.
    pub held: usize,
    /// Flights that had not and ended in another mode.
    pub off: usize,
    /// Flights that ended on the ground, but for those that landed.
    pub crashed: usize,
    /// Flights that ended 100 m from the path.
    pub lost: usize,
    /// Flights with a command or state that was not finite.
    pub non_finite: usize,
    /// Flights with a command outside its limits.
    pub out_of_limits: usize,
    /// Flights that fell back to another mode on the way.
    pub fell_back: usize,
    /// Percentiles over all flights of the largest d_C in the last quarter, m; a flight that ended
    /// early counts 100 m.
    pub dc_max_m: BTreeMap<&'static str, f64>,
    /// Percentiles over all flights of the root mean square of d_C in the last quarter, m.
    pub dc_rms_m: BTreeMap<&'static str, f64>,
    /// Percentiles over the flights that reached it of the time from which d_C stayed below 25 cm,
    /// s.
    pub reached_s: BTreeMap<&'static str, f64>,
    /// Share of the variance of d_C's rank that each drawn number explains alone (ε² over 20 bins),
    /// largest first; empty below 100 flights.
    pub sensitivity: Vec<(&'static str, f64)>,
    /// Fastest touch of a UAV on the ground, m/s; null if none touched it.
    pub worst_uav_touchdown_m_s: Option<f64>,
    /// Fastest touch of a payload on the ground, m/s; likewise.
    pub worst_load_touchdown_m_s: Option<f64>,
    /// Largest distance of a payload from its place, m; null if none was to land.
    pub worst_load_place_m: Option<f64>,
    /// First faults by how many flights had them.
    pub faults: BTreeMap<String, usize>,
    /// Every flight that failed, with its reason.
    pub failures: Vec<Failure>,
    /// The flights of the largest d_C, it first.
    #[serde(skip)]
    pub worst: Vec<Row>,
}

/// A flight that failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Failure {
    /// Its number, for a replay.
    pub run: u64,
    /// What became of it.
    pub verdict: Verdict,
    /// The mode at the end.
    pub mode: String,
    /// Its first and its last fault.
    pub faults: [String; 2],
    /// Largest d_C in the last quarter, m.
    pub dc_max_m: f64,
}

/// Sums up a campaign's flights, and keeps what its page shows of them.
///
/// # Errors
/// The first that `rows` has.
pub fn summarize<E>(seed: u64, rows: impl IntoIterator<Item = Result<Row, E>>) -> Result<(Summary, Tally), E> {
    let (mut summary, mut tally) = (Summary { seed, ..Summary::default() }, Tally::default());
    for row in rows {
        let row = row?;
        tally.add(&row);
        summary.count(row);
    }
    let Summary { good, runs, .. } = summary;
    summary.success_rate = good as f64 / runs.max(1) as f64;
    summary.success_interval = interval(good, runs);
    summary.sensitivity = sensitivity(&tally);
    summary.dc_max_m = percentiles(&tally.dc_max_m);
    summary.dc_rms_m = percentiles(&tally.dc_rms_m);
    summary.reached_s = percentiles(&tally.reached_s);
    Ok((summary, tally))
}

fn percentiles(values: &[f64]) -> BTreeMap<&'static str, f64> {
    let mut values = values.to_vec();
    SHARES.into_iter().map(|(name, share)| (name, percentile(&mut values, share))).collect()
}

/// Worst flights told in the terminal.
const TOLD: usize = 10;

impl Summary {
    /// Counts a flight in.
    fn count(&mut self, row: Row) {
        self.runs += 1;
        *match row.verdict {
            Verdict::Good => &mut self.good,
            Verdict::Held => &mut self.held,
            Verdict::Off => &mut self.off,
            Verdict::Crashed => &mut self.crashed,
            Verdict::Lost => &mut self.lost,
            Verdict::NonFinite => &mut self.non_finite,
        } += 1;
        self.non_finite += usize::from(row.non_finite > 0 && row.verdict != Verdict::NonFinite);
        self.out_of_limits += usize::from(row.out_of_limits > 0);
        self.fell_back += usize::from(row.falls > 0);
        for (worst, value) in [
            (&mut self.worst_uav_touchdown_m_s, row.uav_touchdown_m_s),
            (&mut self.worst_load_touchdown_m_s, row.load_touchdown_m_s),
            (&mut self.worst_load_place_m, row.load_place_m),
        ] {
            *worst = [*worst, value].into_iter().flatten().reduce(f64::max);
        }
        if !row.first_fault.is_empty() {
            *self.faults.entry(row.first_fault.clone()).or_default() += 1;
        }
        if row.verdict != Verdict::Good {
            self.failures.push(Failure {
                run: row.run,
                verdict: row.verdict,
                mode: row.mode.clone(),
                faults: [row.first_fault.clone(), row.last_fault.clone()],
                dc_max_m: row.dc_max_m,
            });
        }
        let place = self.worst.partition_point(|other| other.dc_max_m.total_cmp(&row.dc_max_m).is_ge());
        if place < TOLD {
            self.worst.truncate(TOLD - 1);
            self.worst.insert(place, row);
        }
    }

    /// For a terminal: shares, percentiles, worst flights, failures.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        let Self { runs, good, held, off, crashed, lost, non_finite, out_of_limits, fell_back, .. } = self;
        let _ = writeln!(
            text,
            "{runs} flights: {good} good ({:.2} %; 95 % sure of {:.2} to {:.2} %), {held} in hold, {off} in another mode, {crashed} crashed, {lost} lost; \
             {non_finite} with numbers that are not finite, {out_of_limits} outside limits; {fell_back} fell back on the way",
            100.0 * self.success_rate,
            100.0 * self.success_interval[0],
            100.0 * self.success_interval[1],
        );
        let mut table = Table::new();
        table.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(["over the flights"].into_iter().chain(SHARES.map(|(name, _)| name)));
        let lengths = |values: &BTreeMap<&str, f64>| SHARES.map(|(name, _)| length(values[name]));
        let line = |name: &str, cells: [String; 6]| [name.to_owned()].into_iter().chain(cells);
        table.add_row(line("largest d_C, last quarter", lengths(&self.dc_max_m)));
        table.add_row(line("RMS d_C, last quarter", lengths(&self.dc_rms_m)));
        table.add_row(line("d_C < 25 cm from", SHARES.map(|(name, _)| format!("{:.1} s", self.reached_s[name]))));
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let _ = writeln!(text, "{}", table.trim_fmt());
        if let Some(place) = self.worst_load_place_m {
            let speed = |speed: Option<f64>| speed.map_or("never".to_owned(), |speed| format!("{speed:.2} m/s"));
            let (load, uav) = (speed(self.worst_load_touchdown_m_s), speed(self.worst_uav_touchdown_m_s));
            let _ = writeln!(
                text,
                "on the ground, the worst: payload at {load}, {} from its place; UAV at {uav}",
                length(place)
            );
        }
        for (fault, flights) in &self.faults {
            let _ = writeln!(text, "first fault {fault}: {flights}");
        }
        if !self.sensitivity.is_empty() {
            let shares = self.sensitivity.iter().map(|(name, share)| format!("{name} {:.0} %", 100.0 * share));
            let _ = writeln!(
                text,
                "largest d_C, by rank, is explained by: {} (each alone, ε² over 20 bins)",
                shares.collect::<Vec<_>>().join(", ")
            );
        }
        let _ = writeln!(text, "worst flights (fly one again with --replay):");
        for row in &self.worst {
            let _ = writeln!(
                text,
                "  {:>6}  {:?} in {}, d_C {}, from {:.1} m and {:.1} m/s, rod {:.0}°, tilt {:.0}°, {:.2} kg, wind {:.1} m/s{}{}",
                row.run,
                row.verdict,
                row.mode,
                length(row.dc_max_m),
                row.start_distance_m,
                row.start_speed,
                row.start_rod_deg,
                row.start_tilt_deg,
                row.payload_mass,
                row.wind,
                if row.first_fault.is_empty() { "" } else { "; " },
                row.first_fault
            );
        }
        text
    }
}
