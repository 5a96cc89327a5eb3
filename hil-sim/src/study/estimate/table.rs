//! The table for a terminal, and its file.

use comfy_table::{CellAlignment, Table as Lines};
use std::path::{Path, PathBuf};

use super::Table;
use crate::report::{ReportError, write_file};
use crate::study::compare::length;

/// A line a case.
#[must_use]
pub fn table(table: &Table) -> String {
    let mut lines = Lines::new();
    lines.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
    lines.set_header([
        "case", "lost", "d_C max", "worst", "d_C rms", "rod rms", "rate", "worst", "found", "NEES", "rate", "x_Q",
        "v_Q", "m_L", "k_T", "ΔT",
    ]);
    let or_none =
        |value: Option<f64>, digits: usize| value.map_or(String::new(), |value| format!("{value:.digits$}"));
    for row in &table.rows {
        lines.add_row([
            row.case.to_owned(),
            format!("{}/{}", row.lost, row.runs),
            length(row.dc_max_median_m),
            length(row.dc_max_worst_m),
            length(row.dc_rms_m),
            or_none(row.rod_rms_deg, 2) + "°",
            or_none(row.rod_rate_rms, 4),
            or_none(row.rod_worst_deg, 1) + "°",
            or_none(row.rod_found_s, 1) + " s",
            or_none(row.nees_rod, 2),
            or_none(row.nees_rate, 2),
            row.position_rms_m.map_or(String::new(), length),
            or_none(row.velocity_rms_m_s, 3),
            or_none(row.mass_found_kg, 2),
            or_none(row.thrust_found, 2),
            format!("{:.1} %", 100.0 * row.thrust_step),
        ]);
    }
    for column in lines.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("{} flights a case; d_C and errors of the last quarter\n{}", table.runs, lines.trim_fmt())
}

/// Writes `estimate.json` into `folder` and returns its path.
///
/// # Errors
/// [`ReportError`] names the file.
pub fn write(folder: &Path, table: &Table) -> Result<PathBuf, ReportError> {
    std::fs::create_dir_all(folder).map_err(|error| ReportError::File { path: folder.to_owned(), error })?;
    let mut json = serde_json::to_string_pretty(table).expect("plain numbers and strings");
    json.push('\n');
    let file = folder.join("estimate.json");
    write_file(&file, json.as_bytes())?;
    Ok(file)
}
