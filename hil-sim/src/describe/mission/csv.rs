//! Waypoints from a table: one a line, in the order flown.

use controller::Vector3;
use std::fmt;

use super::columns::Columns;

/// Coordinates beyond this are a mistake, m; degrees are fewer.
const FURTHEST: f64 = 1e5;

/// A table that holds no waypoints: where, and why.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct PointsError {
    /// The file.
    pub file: String,
    /// The line, from 1; 0 for the file as a whole.
    pub line: u64,
    /// The column of the table, from 1, if one is at fault.
    pub column: Option<usize>,
    /// What is wrong.
    pub message: String,
}

impl fmt::Display for PointsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        if let Some(column) = self.column {
            write!(f, ": column {column}")?;
        }
        write!(f, ": {}", self.message)
    }
}

/// A table's waypoints, each with its line.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// How they stand in the file.
    pub columns: Columns,
    /// In N, m; where columns are angles, those in degrees.
    pub rows: Vec<(u64, Vector3<f64>)>,
}

/// Reads one point a line, `most` at most: x, y, z in N (m, z down), or what a first line of names
/// says. Lines that begin with # are passed over.
///
/// # Errors
/// [`PointsError`] for anything that is not a finite number, a name that is not known, and a
/// missing or surplus column.
pub fn rows(file: &str, text: &str, most: usize) -> Result<Rows, PointsError> {
    let error = |line, column, message: String| PointsError { file: file.to_owned(), line, column, message };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut points: Vec<(u64, Vector3<f64>)> = Vec::new();
    let mut columns = Columns::plain();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|fault| {
            error(fault.position().map_or(0, csv::Position::line), None, format!("no line of a table: {fault}"))
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        // Names have letters that no number starts with.
        let named = record
            .iter()
            .all(|field| field.starts_with(|c: char| c.is_alphabetic()) && field.parse::<f64>().is_err());
        if index == 0 && named {
            columns = Columns::read(record.iter()).map_err(|(column, message)| error(line, column, message))?;
            continue;
        }
        if points.len() > most {
            let message = format!("more than {most} waypoints: give every few of them");
            return Err(error(line, None, message));
        }
        if record.len() != 3 {
            return Err(error(line, None, format!("{} values where x, y, z are 3", record.len())));
        }
        let mut point = Vector3::zeros();
        for (axis, field) in record.iter().enumerate() {
            let column = Some(axis + 1);
            let value: f64 = field.parse().map_err(|_| error(line, column, format!("\"{field}\" is no number")))?;
            let metres = value * columns.unit(axis);
            if !metres.is_finite() || metres.abs() > FURTHEST {
                return Err(error(line, column, format!("{metres} is outside -{FURTHEST} to {FURTHEST} m")));
            }
            columns.place(&mut point, axis, value);
        }
        points.push((line, point));
    }

    Ok(Rows { columns, rows: points })
}
