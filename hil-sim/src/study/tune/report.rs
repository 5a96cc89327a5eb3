//! A tuning in words and as a table.

use comfy_table::{CellAlignment, Table, presets};
use std::fmt::Write;

use super::{Row, Tuning, Value, best};
use crate::study::compare::length;

/// One sentence on what the proposal gives up and for what, against the most accurate and the
/// calmest setting with as many good flights; and one more where it lies at an edge of the grid.
#[must_use]
pub fn trade(tuning: &Tuning) -> String {
    let rows = &tuning.rows;
    let Some(chosen) = rows.get(tuning.proposed) else { return String::new() };
    let named = |row: &Row| format!("s = {}, {} rad/s", row.scale, row.bandwidth);
    let mut text = format!(
        "Proposed: {}, good in {} of {} flights, RMS d_C {} for an RMS torque of {:.3} N·m",
        named(chosen),
        chosen.good,
        chosen.runs,
        length(chosen.rms_dc_m),
        chosen.rms_torque_nm
    );
    let others: [(&str, Value); 2] = [("most accurate", |row| row.rms_dc_m), ("calmest", |row| row.rms_torque_nm)];
    for (name, cost) in others {
        match best(rows, cost) {
            Some(index) if index == tuning.proposed => {
                let _ = write!(text, "; it is the {name} too");
            }
            Some(index) => {
                let other = &rows[index];
                let percent = |of: f64, base: f64| 100.0 * (of / base - 1.0);
                let _ = write!(
                    text,
                    "; the {name} ({}) has {:+.0} % of d_C and {:+.0} % of torque",
                    named(other),
                    percent(other.rms_dc_m, chosen.rms_dc_m),
                    percent(other.rms_torque_nm, chosen.rms_torque_nm)
                );
            }
            None => {}
        }
    }
    text.push_str(".\n");
    let edge = |value: Value| {
        let (low, high) = rows.iter().map(value).fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        low < high && (value(chosen) == low || value(chosen) == high)
    };
    for (option, at_edge) in [("--scales", edge(|row| row.scale)), ("--bandwidths", edge(|row| row.bandwidth))] {
        if at_edge {
            let _ = writeln!(text, "It lies at an edge of what was tried: {option} can try more.");
        }
    }
    text
}

/// A line a setting, the one proposed marked.
#[must_use]
pub fn table(tuning: &Tuning) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    let header = ["", "s", "observer", "good", "RMS d_C", "median", "RMS torque", "largest", "rod", "thrust"];
    table.set_header(header.map(str::to_owned));
    for (index, row) in tuning.rows.iter().enumerate() {
        table.add_row([
            if index == tuning.proposed { "→" } else { "" }.to_owned(),
            row.scale.to_string(),
            format!("{} rad/s", row.bandwidth),
            format!("{} of {}", row.good, row.runs),
            length(row.rms_dc_m),
            length(row.median_dc_m),
            format!("{:.3} N·m", row.rms_torque_nm),
            format!("{:.2} N·m", row.max_torque_nm),
            format!("{:.0}°", row.max_rod_deg),
            format!("{:.0}°", row.max_thrust_deg),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}
