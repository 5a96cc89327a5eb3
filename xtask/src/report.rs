//! The measurement as a table, as JSON, and against its expected values.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::{Result, ensure};
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use serde::{Deserialize, Serialize};

use crate::cycles::Cycles;
use crate::image::Image;

/// Instructions of the fastest and the slowest step, and in the mean, rounded up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Extremes {
    /// Fastest.
    pub best: u64,
    /// Slowest.
    pub worst: u64,
    /// Of all steps: a filter spreads its work over a cycle.
    pub mean: u64,
}

/// One case, as the table shows it.
pub struct Case {
    /// Its name.
    pub name: String,
    /// On the first core; the others run the same code.
    pub instructions: Extremes,
    /// By the model, of the slowest step that was traced.
    pub cycles: Cycles,
    /// Everything that its step can reach, bytes.
    pub code_bytes: u32,
    /// Stack touched, bytes.
    pub stack_painted: u64,
    /// Stack that the call graph allows, bytes.
    pub stack_bound: u32,
    /// The law's whole state, bytes.
    pub ram_bytes: u64,
    /// For each core, whether its commands equal the host's.
    pub identical: Vec<(String, bool)>,
}

/// What a program reads, and what the expected values hold.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// By case.
    pub instructions: BTreeMap<String, Extremes>,
    /// By the model, of the slowest step that was traced, by case.
    pub cycles: BTreeMap<String, Cycles>,
    /// Code of a step on the paper's circle with everything it can call, bytes.
    pub code_bytes: u32,
    /// The same by case.
    pub code_bytes_by_case: BTreeMap<String, u32>,
    /// State of the largest case, bytes: it has no statics.
    pub ram_bytes: u64,
    /// The same by case.
    pub ram_bytes_by_case: BTreeMap<String, u64>,
    /// Bound on the stack of a step, the deepest case, bytes.
    pub stack_bytes: u32,
    /// Likewise on laying a route, bytes.
    #[serde(default)]
    pub laying_stack_bytes: u32,
    /// All cores' commands equal the host's, bit for bit.
    pub bit_identical: bool,
    /// No panic is reachable.
    pub panic_free: bool,
    /// No double-precision emulation is linked.
    pub no_soft_double: bool,
}

impl Report {
    /// What has to hold whatever is expected.
    pub fn check_proofs(&self) -> Result<()> {
        ensure!(self.panic_free, "a panic is reachable: the bench does not link with its panic handler");
        ensure!(self.no_soft_double, "the image emulates double precision");
        ensure!(self.bit_identical, "host and target disagree");
        Ok(())
    }

    /// An error lists everything that exceeds `expected`.
    pub fn check_against(&self, expected: &Self) -> Result<()> {
        let mut rises = String::new();
        let mut compare = |what: &str, now: u64, before: Option<u64>| {
            let before_text = before.map_or("nothing".to_owned(), |before| before.to_string());
            if before.is_none_or(|before| now > before) {
                let _ = write!(rises, "\n  {what}: {now}, expected {before_text}");
            }
        };
        for (name, extremes) in &self.instructions {
            let before = expected.instructions.get(name);
            compare(&format!("{name}, fewest instructions"), extremes.best, before.map(|before| before.best));
            compare(&format!("{name}, most instructions"), extremes.worst, before.map(|before| before.worst));
            compare(&format!("{name}, instructions in the mean"), extremes.mean, before.map(|before| before.mean));
        }
        for (name, cycles) in &self.cycles {
            let before = expected.cycles.get(name);
            // From flash they move with the places that the linker gives to functions.
            compare(&format!("{name}, cycles"), cycles.zero_wait, before.map(|before| before.zero_wait));
            compare(&format!("{name}, divisions and roots"), cycles.divisions, before.map(|before| before.divisions));
        }
        for (name, &bytes) in &self.code_bytes_by_case {
            let before = expected.code_bytes_by_case.get(name);
            compare(&format!("{name}, bytes of code"), bytes.into(), before.map(|&before| before.into()));
        }
        for (name, &bytes) in &self.ram_bytes_by_case {
            compare(&format!("{name}, bytes of state"), bytes, expected.ram_bytes_by_case.get(name).copied());
        }
        compare("stack, bytes", self.stack_bytes.into(), Some(expected.stack_bytes.into()));
        let laying = [self, expected].map(|report| u64::from(report.laying_stack_bytes));
        compare("stack of laying a route, bytes", laying[0], Some(laying[1]));
        let missing: Vec<&str> = expected
            .instructions
            .keys()
            .filter(|name| !self.instructions.contains_key(*name))
            .map(String::as_str)
            .collect();
        ensure!(missing.is_empty(), "expected cases were not measured: {}", missing.join(", "));
        ensure!(
            rises.is_empty(),
            "these rose:{rises}\nIf that is meant, `cargo xtask target --refresh` and commit the file."
        );
        Ok(())
    }
}

/// The table for people, with the image's own numbers below it.
pub fn table(image: &Image, cases: &[Case], report: &Report) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let cores = cases.first().map_or(&[][..], |case| &case.identical);
    let columns = ["case", "instructions, best", "worst", "mean", "cycles", "from flash", "÷ and √", "code, B"];
    let columns = columns.into_iter().chain(["stack, B", "bound, B", "state, B"]);
    let mut header: Vec<String> = columns.map(str::to_owned).collect();
    header.extend(cores.iter().map(|(core, _)| format!("{core} = host")));
    let columns = header.len();
    table.set_header(header);
    for case in cases {
        let Extremes { best, worst, mean } = case.instructions;
        let mut row = vec![
            case.name.clone(),
            best.to_string(),
            worst.to_string(),
            mean.to_string(),
            case.cycles.zero_wait.to_string(),
            case.cycles.flash.to_string(),
            case.cycles.divisions.to_string(),
            case.code_bytes.to_string(),
            case.stack_painted.to_string(),
            case.stack_bound.to_string(),
            case.ram_bytes.to_string(),
        ];
        row.extend(case.identical.iter().map(|(_, same)| if *same { "yes" } else { "NO" }.to_owned()));
        table.add_row(row);
    }
    for column in 1..columns {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let yes = |holds: bool| if holds { "yes" } else { "NO" };
    format!(
        "{table}\n\
         image: {} B of code, {} B of constants, {} B of statics\n\
         no panic reachable: {}; no double-precision emulation: {}; no allocator: {}; host and target agree in every bit: {}",
        image.text,
        image.constants,
        image.statics,
        yes(report.panic_free),
        yes(report.no_soft_double),
        yes(image.allocators.is_empty()),
        yes(report.bit_identical),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(worst: u64) -> Report {
        Report {
            instructions: BTreeMap::from([("circle".to_owned(), Extremes { best: 10, worst, mean: 10 })]),
            cycles: BTreeMap::from([("circle".to_owned(), Cycles { zero_wait: 20, flash: 50, divisions: 1 })]),
            code_bytes: 1000,
            code_bytes_by_case: BTreeMap::from([("circle".to_owned(), 1000)]),
            ram_bytes: 100,
            ram_bytes_by_case: BTreeMap::from([("circle".to_owned(), 100)]),
            stack_bytes: 500,
            laying_stack_bytes: 0,
            bit_identical: true,
            panic_free: true,
            no_soft_double: true,
        }
    }

    #[test]
    fn a_rise_fails_and_a_fall_passes() {
        assert!(report(12).check_against(&report(12)).is_ok());
        assert!(report(11).check_against(&report(12)).is_ok());
        let message = report(13).check_against(&report(12)).unwrap_err().to_string();
        assert!(message.contains("circle, most instructions: 13, expected 12"), "{message}");
        assert!(Report { stack_bytes: 501, ..report(12) }.check_against(&report(12)).is_err());
    }

    #[test]
    fn cases_may_neither_vanish_nor_come_unexpected() {
        let none = Report { instructions: BTreeMap::new(), ..report(12) };
        assert!(none.check_against(&report(12)).is_err());
        assert!(report(12).check_against(&none).is_err());
    }

    #[test]
    fn a_proof_that_fails_is_an_error() {
        assert!(report(12).check_proofs().is_ok());
        assert!(Report { panic_free: false, ..report(12) }.check_proofs().is_err());
        assert!(Report { bit_identical: false, ..report(12) }.check_proofs().is_err());
    }
}
