//! What a campaign says: shares, percentiles, and every flight that failed.

use comfy_table::{CellAlignment, Table};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;

use super::fly::{Row, Verdict};
use super::statistics::{interval, sensitivity};
use crate::study::compare::{length, percentile};

/// The shares of flights whose d_C is told.
const SHARES: [(&str, f64); 6] =
    [("p50", 0.5), ("p90", 0.9), ("p95", 0.95), ("p99", 0.99), ("p99_9", 0.999), ("max", 1.0)];

/// The numbers of a campaign, as `summary.json` has them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Flights.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// Share of flights with d_C below 25 cm throughout the last quarter; of those that are to land,
    /// on the ground with rotors off and the payload in its place.
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

/// Sums up a campaign's rows.
#[must_use]
pub fn summarize(seed: u64, rows: &[Row]) -> Summary {
    let count = |verdicts: &[Verdict]| rows.iter().filter(|row| verdicts.contains(&row.verdict)).count();
    let percentiles = |values: Vec<f64>| {
        let mut values = values;
        SHARES.into_iter().map(|(name, share)| (name, percentile(&mut values, share))).collect()
    };
    let mut faults = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.first_fault.is_empty()) {
        *faults.entry(row.first_fault.clone()).or_default() += 1;
    }
    let good = count(&[Verdict::Good]);
    let worst = |value: fn(&Row) -> Option<f64>| rows.iter().filter_map(value).reduce(f64::max);
    Summary {
        runs: rows.len(),
        seed,
        success_rate: good as f64 / rows.len().max(1) as f64,
        success_interval: interval(good, rows.len()),
        sensitivity: sensitivity(rows),
        good,
        held: count(&[Verdict::Held]),
        off: count(&[Verdict::Off]),
        crashed: count(&[Verdict::Crashed]),
        lost: count(&[Verdict::Lost]),
        non_finite: rows.iter().filter(|row| row.non_finite > 0 || row.verdict == Verdict::NonFinite).count(),
        out_of_limits: rows.iter().filter(|row| row.out_of_limits > 0).count(),
        fell_back: rows.iter().filter(|row| row.falls > 0).count(),
        dc_max_m: percentiles(rows.iter().map(|row| row.dc_max_m).collect()),
        dc_rms_m: percentiles(rows.iter().map(|row| row.dc_rms_m).collect()),
        reached_s: percentiles(rows.iter().filter_map(|row| row.reached_s).collect()),
        worst_uav_touchdown_m_s: worst(|row| row.uav_touchdown_m_s),
        worst_load_touchdown_m_s: worst(|row| row.load_touchdown_m_s),
        worst_load_place_m: worst(|row| row.load_place_m),
        faults,
        failures: rows
            .iter()
            .filter(|row| row.verdict != Verdict::Good)
            .map(|row| Failure {
                run: row.run,
                verdict: row.verdict,
                mode: row.mode.clone(),
                faults: [row.first_fault.clone(), row.last_fault.clone()],
                dc_max_m: row.dc_max_m,
            })
            .collect(),
    }
}

/// Failures and worst flights told in the terminal.
const TOLD: usize = 10;

impl Summary {
    /// For a terminal: shares, percentiles, worst flights, failures.
    #[must_use]
    pub fn text(&self, rows: &[Row]) -> String {
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
        let mut worst: Vec<&Row> = rows.iter().collect();
        worst.sort_by(|a, b| b.dc_max_m.total_cmp(&a.dc_max_m));
        let _ = writeln!(text, "worst flights (fly one again with --replay):");
        for row in worst.into_iter().take(TOLD) {
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
