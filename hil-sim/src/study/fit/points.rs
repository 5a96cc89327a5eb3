//! Waypoints from a CSV file.

use controller::Vector3;

use crate::describe::mission::columns::Columns;
use crate::describe::mission::csv::{self, PointsError, Rows};

/// Fewest points that make a loop in space, and most: more than a few for each harmonic say nothing
/// new.
const FEWEST: usize = 4;
const MOST: usize = 20_000;
/// Points closer than this part of the loop's extent are the same.
const SAME: f64 = 1e-6;

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
    let Rows { columns, rows: mut points } = csv::rows(file, text, MOST)?;
    if let Some((column, angle)) = columns.angle() {
        let message = format!(
            "\"{angle}\" is an angle; waypoints are lengths from the origin of the vehicle's own position, or \
             `hil-sim route` makes them of it"
        );
        return Err(error(1, Some(column), message));
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
