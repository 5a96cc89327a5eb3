//! Waypoints from a CSV file.

use controller::Vector3;
use std::fmt;

/// Coordinates beyond this are a mistake, m.
const FURTHEST: f64 = 1e5;
/// Fewest points that make a loop in space.
const FEWEST: usize = 4;
/// Points closer than this part of the loop's extent are the same.
const SAME: f64 = 1e-6;

/// A file that holds no loop of waypoints: where, and why.
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

/// Reads x, y, z in N (m, z down), one point a line in the order flown; the loop closes from the
/// last to the first. A first line of names and lines that begin with # are passed over. A last
/// point equal to the first is left out.
///
/// # Errors
/// [`PointsError`] for anything that is no finite number, a missing or surplus column, a point that
/// repeats the one before it, and fewer than four points.
pub fn read(file: &str, text: &str) -> Result<Vec<Vector3<f64>>, PointsError> {
    let error = |line, column, message: String| PointsError { file: file.to_owned(), line, column, message };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut points: Vec<(u64, Vector3<f64>)> = Vec::new();
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
            continue;
        }
        if record.len() != 3 {
            return Err(error(line, None, format!("{} values where x, y, z are 3", record.len())));
        }
        let mut point = Vector3::zeros();
        for (axis, field) in record.iter().enumerate() {
            let column = Some(axis + 1);
            let value: f64 = field.parse().map_err(|_| error(line, column, format!("\"{field}\" is no number")))?;
            if !value.is_finite() || value.abs() > FURTHEST {
                return Err(error(line, column, format!("{value} is outside -{FURTHEST} to {FURTHEST} m")));
            }
            point[axis] = value;
        }
        points.push((line, point));
    }

    let distance = |a: &Vector3<f64>, b: &Vector3<f64>| (a - b).dot(&(a - b)).sqrt();
    let extent = points.iter().map(|(_, point)| distance(point, &points[0].1)).fold(0.0, f64::max);
    if points.len() > 1 && distance(&points[0].1, &points[points.len() - 1].1) <= SAME * extent {
        points.pop();
    }
    for [(_, before), (line, point)] in points.array_windows() {
        if distance(before, point) <= SAME * extent {
            return Err(error(*line, None, "repeats the point before it".to_owned()));
        }
    }
    if points.len() < FEWEST {
        return Err(error(0, None, format!("{} points where a loop needs at least {FEWEST}", points.len())));
    }
    Ok(points.into_iter().map(|(_, point)| point).collect())
}
