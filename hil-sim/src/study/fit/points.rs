//! Waypoints from a CSV file.

use controller::Vector3;
use std::fmt;

use super::columns::Columns;

/// Coordinates beyond this are a mistake, m.
const FURTHEST: f64 = 1e5;
/// Fewest points that make a loop in space, and most: more than a few for each harmonic say nothing
/// new.
const FEWEST: usize = 4;
const MOST: usize = 20_000;
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

/// A loop of waypoints.
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoints {
    /// In N, m, in the order flown.
    pub points: Vec<Vector3<f64>>,
    /// How they stood in the file.
    pub columns: Columns,
}

/// Reads one point a line in the order flown: x, y, z in N (m, z down), or what a first line of
/// names says. The loop closes from the last to the first. Lines that begin with # are passed over.
/// A last point equal to the first is left out.
///
/// # Errors
/// [`PointsError`] for anything that is not a finite number, a name that is not known, a missing or
/// surplus column, a point that repeats the one before it, fewer than four points, and more than
/// 20,000.
pub fn read(file: &str, text: &str) -> Result<Waypoints, PointsError> {
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
        if points.len() > MOST {
            let message = format!("more than {MOST} waypoints: give every few of them");
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
    Ok(Waypoints { points: points.into_iter().map(|(_, point)| point).collect(), columns })
}

/// Loops smaller than this, or larger, or further from the origin, are likely in other units, m.
const LIKELY: [f64; 2] = [0.5, 5e3];
const LIKELY_FAR: f64 = 1e4;

impl Waypoints {
    /// What makes no sense for a payload's way, and may be another unit or another frame.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        let span = |axis: usize| {
            let values = self.points.iter().map(|point| point[axis]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        let spans = [0, 1, 2].map(span);
        let extent = spans.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        let furthest = spans.iter().map(|(low, high)| low.abs().max(high.abs())).fold(0.0, f64::max);
        let mut doubts = Vec::new();
        let [least, most] = LIKELY;
        if extent < least {
            doubts.push(format!("the loop is {extent:.2e} m across: are these metres?"));
        } else if extent > most {
            doubts.push(format!("the loop is {:.1} km across: are these metres?", 1e-3 * extent));
        }
        if furthest > LIKELY_FAR {
            doubts.push(format!("the loop is {:.1} km from the origin of N", 1e-3 * furthest));
        }
        if spans[2].0 > 0.0 {
            doubts
                .push("all waypoints are below the origin: z counts down; name the column up if it counts up".into());
        }
        doubts
    }
}
