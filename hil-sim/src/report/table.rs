//! The table: one row a flight, what was measured above what the reference says.

use comfy_table::{CellAlignment, Table};

use crate::describe::reference::Reference;
use crate::fly::batch::Outcome;
use crate::fly::metrics::Results;

/// How a column's number is written.
type Format = fn(f64) -> String;

/// A column of results: its heading and how to take and write its number.
pub struct Column {
    /// Heading.
    pub heading: &'static str,
    value: fn(&Results) -> Option<f64>,
    format: Format,
}

impl Column {
    /// The number of these results as text, if there is one.
    pub fn text(&self, results: &Results) -> Option<String> {
        (self.value)(results).map(self.format)
    }
}

fn digits3(value: f64) -> String {
    format!("{value:.3}")
}
fn signed4(value: f64) -> String {
    format!("{value:+.4}")
}
/// Distances from micrometres to metres.
fn length(value: f64) -> String {
    if value < 1e-2 { format!("{value:.1e}") } else { format!("{value:.3}") }
}

/// The columns, in order.
pub const COLUMNS: &[Column] = &[
    Column { heading: "d_C < 5 cm\nfirst, s", value: |r| r.first_below_s, format: digits3 },
    Column { heading: "for good,\ns", value: |r| r.settle_s, format: digits3 },
    Column { heading: "effort,\nN s", value: |r| r.effort_n_s, format: digits3 },
    Column { heading: "peak\n|u|", value: |r| r.peak_u, format: digits3 },
    Column { heading: "min T,\nN", value: |r| r.min_thrust_n, format: digits3 },
    Column { heading: "peak torque,\nN m", value: |r| r.peak_torque_nm, format: digits3 },
    Column { heading: "d_C after\nrelease, m", value: |r| r.dc_max_after_release_m, format: length },
    Column { heading: "d_C max,\nm", value: |r| r.dc_max_m, format: length },
    Column { heading: "d_C rms,\nm", value: |r| r.dc_rms_m, format: length },
    Column { heading: "off its\nstops, m", value: |r| r.stop_error_m, format: length },
    Column { heading: "steady\nradius, m", value: |r| r.steady_radius_error_m, format: signed4 },
    Column { heading: "steady\np3, m", value: |r| r.steady_p3_error_m, format: signed4 },
    Column { heading: "steady\nspeed, m/s", value: |r| r.steady_speed_error_m_s, format: signed4 },
];

/// The columns that one of these flights, or its reference, has a number for.
pub fn filled(outcomes: &[&Outcome], reference: &Reference) -> Vec<&'static Column> {
    let has = |column: &Column, outcome: &Outcome| {
        let expected = reference.runs.get(&outcome.scenario.name);
        (column.value)(&outcome.flight.results).is_some()
            || expected.is_some_and(|expected| (column.value)(expected).is_some())
    };
    COLUMNS.iter().filter(|column| outcomes.iter().any(|outcome| has(column, outcome))).collect()
}

/// The table of these flights for a terminal of so many columns: where it would be wider, its
/// columns go on in a table below.
#[must_use]
pub fn table(outcomes: &[Outcome], reference: &Reference, width: Option<usize>) -> String {
    let outcomes: Vec<&Outcome> = outcomes.iter().collect();
    let expected = |outcome: &Outcome| reference.runs.get(&outcome.scenario.name);
    let names: Vec<String> = outcomes
        .iter()
        .map(|outcome| {
            let (name, end) = name_and_end(outcome);
            match end.or_else(|| expected(outcome).map(|_| "reference".to_owned())) {
                Some(below) => format!("{name}\n{below}"),
                None => name.to_owned(),
            }
        })
        .collect();
    let law = outcomes.iter().map(|outcome| outcome.scenario.controller.law.name().to_owned()).collect();
    let mut columns = vec![("law", law)];
    columns.extend(filled(&outcomes, reference).into_iter().map(|column| {
        let text = |results: &Results| column.text(results).unwrap_or_default();
        let cells = outcomes.iter().map(|outcome| match expected(outcome) {
            Some(expected) => format!("{}\n{}", text(&outcome.flight.results), text(expected)),
            None => text(&outcome.flight.results),
        });
        (column.heading, cells.collect())
    }));
    let deviation = |outcome: &&Outcome| outcome.flight.deviation.map(|deviation| format!("{:.1e}", deviation.max()));
    columns.push((
        "f32 - f64,\nrelative",
        outcomes.iter().map(|outcome| deviation(outcome).unwrap_or_default()).collect(),
    ));
    let speed = outcomes.iter().map(|outcome| format!("{:.0}", outcome.flight.times_real_time));
    columns.push(("times\nreal time", speed.collect()));
    folded(("flight", &names), &columns, width.unwrap_or(usize::MAX))
}

/// Tables below each other, none wider than `width`, each with the first column and as many of the
/// others as fit.
fn folded((heading, names): (&str, &[String]), columns: &[(&str, Vec<String>)], width: usize) -> String {
    let mut text = String::new();
    let mut left = columns;
    while !left.is_empty() {
        let first = needed(heading, names);
        let fitting = left
            .iter()
            .scan(first, |sum, (heading, cells)| {
                *sum = sum.saturating_add(needed(heading, cells));
                Some(*sum)
            })
            .take_while(|&sum| sum <= width)
            .count();
        let (now, later) = left.split_at(fitting.max(1));
        let mut table = Table::new();
        table.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(std::iter::once(heading).chain(now.iter().map(|(heading, _)| *heading)));
        for (row, name) in names.iter().enumerate() {
            table.add_row(std::iter::once(name).chain(now.iter().map(|(_, cells)| &cells[row])));
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        text += &table.trim_fmt();
        text.push('\n');
        left = later;
    }
    text.pop();
    text
}

/// Characters across that a column takes: its longest line between two spaces, and one to the next.
fn needed(heading: &str, cells: &[String]) -> usize {
    let lines = heading.lines().chain(cells.iter().flat_map(|cell| cell.lines()));
    lines.map(|line| line.chars().count()).max().unwrap_or(0) + 3
}

/// The scenario's name, and how the flight ended if not at its duration.
pub fn name_and_end(outcome: &Outcome) -> (&str, Option<String>) {
    (&outcome.scenario.name, outcome.flight.end.failure())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_is_wider_than_the_terminal_and_no_number_is_broken() {
        let names = vec!["a-flight\nreference".to_owned(), "another\nlost at 27.632 s".to_owned()];
        let columns: Vec<(&str, Vec<String>)> =
            (0..9).map(|k| ("heading,\nm", vec![format!("{k}.123456"), format!("-{k}00.5")])).collect();
        for width in [40, 60, 80, 200] {
            let text = folded(("flight", &names), &columns, width);
            assert!(text.lines().all(|line| line.chars().count() <= width), "{width}:\n{text}");
            for k in 0..9 {
                assert!(text.contains(&format!("{k}.123456")) && text.contains(&format!("-{k}00.5")), "{text}");
            }
        }
    }
}
