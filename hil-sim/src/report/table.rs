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
    Column { heading: "steady\nd_C max, m", value: |r| r.steady_dc_max_m, format: length },
    Column { heading: "steady\nd_C rms, m", value: |r| r.steady_dc_rms_m, format: length },
    Column { heading: "steady\nradius, m", value: |r| r.steady_radius_error_m, format: signed4 },
    Column { heading: "steady\np3, m", value: |r| r.steady_p3_error_m, format: signed4 },
    Column { heading: "steady\nspeed, m/s", value: |r| r.steady_speed_error_m_s, format: signed4 },
];

/// The table of these flights for a terminal.
#[must_use]
pub fn table(outcomes: &[Outcome], reference: &Reference) -> String {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
    let fixed = ["run", "law"];
    let last = ["f32 - f64,\nrelative", "times\nreal time"];
    let headings = COLUMNS.iter().map(|column| column.heading);
    table.set_header(fixed.into_iter().chain(headings).chain(last));
    for outcome in outcomes {
        let flight = &outcome.flight;
        let expected = reference.runs.get(&outcome.scenario.name).copied().unwrap_or_default();
        let mut row = vec![name(outcome), format!("{}\nreference", outcome.scenario.controller.law.name())];
        row.extend(COLUMNS.iter().map(|column| {
            let text = |results| column.text(results).unwrap_or_default();
            format!("{}\n{}", text(&flight.results), text(&expected))
        }));
        row.push(flight.deviation.map(|deviation| format!("{:.1e}", deviation.max())).unwrap_or_default());
        row.push(format!("{:.0}", flight.times_real_time));
        table.add_row(row);
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

/// The scenario's name, with how the flight ended if not at its end.
fn name(outcome: &Outcome) -> String {
    let name = &outcome.scenario.name;
    match outcome.flight.end.failure() {
        None => name.clone(),
        Some(failure) => format!("{name}\n{failure}"),
    }
}
