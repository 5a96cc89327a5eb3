//! The comparison for a terminal.

use comfy_table::{CellAlignment, Table};
use std::fmt::Write;

use super::{CASES, Comparison, Contender, Row};

/// A line a case, a column a law: good flights, and median and largest d_C in the last quarter.
#[must_use]
pub fn table(comparison: &Comparison) -> String {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
    let laws = Contender::ALL.map(Contender::name);
    table.set_header(["case"].into_iter().chain(laws).map(str::to_owned));
    for case in CASES {
        let cells: Vec<String> = comparison.of_case(case.name).map(cell).collect();
        if !cells.is_empty() {
            table.add_row([case.name.to_owned()].into_iter().chain(cells));
        }
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("good of {}, median (largest) d_C of the last quarter\n{}", comparison.runs, table.trim_fmt())
}

fn cell(row: &Row) -> String {
    format!("{}, {} ({})", row.good, length(row.median_dc_m), length(row.max_dc_m))
}

/// A length in m, mm or µm, to two or three digits.
pub(crate) fn length(metres: f64) -> String {
    match metres {
        m if m >= 1.0 => format!("{m:.1} m"),
        m if m >= 1e-3 => format!("{:.*} mm", usize::from(m < 0.01), 1e3 * m),
        m => format!("{:.0} µm", 1e6 * m),
    }
}

impl Comparison {
    /// The rows of a case, in the order of the laws.
    pub fn of_case(&self, name: &str) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.case == name)
    }
}

/// Medians closer than this are alike, m.
const ALIKE_M: f64 = 1e-3;

/// Where the observer does worse than another law, a line each: fewer good flights, or a median d_C
/// larger by more than a millimetre.
#[must_use]
pub fn worse(comparison: &Comparison) -> String {
    let mut text = String::new();
    for observer in comparison.rows.iter().filter(|row| row.law == Contender::Observer) {
        for other in comparison.of_case(observer.case).filter(|row| row.law != Contender::Observer) {
            let mut found = Vec::new();
            if observer.good < other.good {
                found.push(format!("{} good flights against {}", observer.good, other.good));
            }
            if observer.median_dc_m > other.median_dc_m + ALIKE_M {
                found.push(format!(
                    "median d_C {} against {}",
                    length(observer.median_dc_m),
                    length(other.median_dc_m)
                ));
            }
            if !found.is_empty() {
                let _ = writeln!(text, "  {}, than {}: {}", observer.case, other.law.name(), found.join(", "));
            }
        }
    }
    if text.is_empty() {
        "The observer does worse nowhere: in no case fewer good flights than another law, nor a median d_C larger by a \
         millimetre.\n"
            .to_owned()
    } else {
        format!("Where the observer does worse:\n{text}")
    }
}
