//! A closed Fourier curve through waypoints, in the least-squares sense.
//!
//! c(σ) = a0 + Σ (A_k cos kσ + B_k sin kσ) with as few harmonics as keep every waypoint within the
//! tolerance. For given parameters σᵢ of the waypoints, at first by the square roots of the chords
//! (E. T. Y. Lee, *Choosing nodes in parametric curve interpolation*, 1989), the coefficients are a
//! linear least-squares problem, each waypoint weighted by the stretch of the loop it stands for.
//! From there orthogonal distance regression minimizes the distances from the waypoints to their
//! nearest points.

mod orthogonal;
mod output;
mod points;
mod reference;

pub use crate::describe::mission::columns::Columns;
pub use crate::describe::mission::csv::PointsError;
pub use output::{rust, toml};
pub use points::{Waypoints, read};
pub use reference::LEAST_ANGLE;

use crate::study::check::probe::{Frame, length};
use crate::study::check::walk::walk;
use crate::study::check::{Approach, Lap, Refusal};
use controller::{Curve, FourierPath, Harmonics};
use controller::{OutOfRange, Vector3};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Most harmonics of a path that can be flown.
pub const MAX_HARMONICS: usize = 16;
/// A fitted curve and how good it is.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The curve; harmonics above [`count`](Self::count) are zero.
    pub harmonics: Harmonics<f64, MAX_HARMONICS>,
    /// Harmonics in use.
    pub count: usize,
    /// Largest distance of a waypoint from the curve, m, and the waypoint's index.
    pub worst: (f64, usize),
    /// Root mean square of the distances, m.
    pub rms: f64,
    /// Largest distance of the curve from the closed polygon of the waypoints, m.
    pub strays: f64,
    /// Least angle between the reference direction and a tangent, rad.
    pub reference_angle: f64,
    /// The harmonic with the largest amplitude √(|A|² + |B|²): its number and the amplitude, m.
    pub largest: (usize, f64),
    /// The amplitude of the highest harmonic, m.
    pub highest: f64,
    /// The curve walked once round.
    pub lap: Lap,
    /// Its branches at their closest, if it has branches.
    pub branches: Option<Approach>,
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The tolerance is out of reach.
    #[error(
        "{points} waypoints and at most {MAX_HARMONICS} harmonics leave {error:.4} m at waypoint {worst}, above the tolerance \
         of {tolerance} m"
    )]
    Tolerance {
        /// Number of waypoints.
        points: usize,
        /// The best fit's largest error, m.
        error: f64,
        /// Waypoint with that error, from 1.
        worst: usize,
        /// As asked for, m.
        tolerance: f64,
    },
    /// No direction stays far enough from every tangent.
    #[error(
        "no reference direction stays 15 degrees away from every tangent: the best comes within {:.1} degrees at ({:.3}, {:.3}, \
         {:.3}) m, {arc:.3} m along the curve",
        .angle.to_degrees(), .position[0], .position[1], .position[2]
    )]
    NoReference {
        /// rad.
        angle: f64,
        /// In N, m.
        position: [f64; 3],
        /// m.
        arc: f64,
    },
    /// The fitted curve cannot be flown.
    #[error("the fitted curve cannot be flown: {0}")]
    Curve(#[from] Refusal),
    /// The controller refuses the coefficients.
    #[error("the fitted curve cannot be flown: {0}")]
    Range(#[from] OutOfRange<f64>),
    /// The least-squares problem has no solution.
    #[error("the waypoints leave the curve undetermined")]
    Undetermined,
}

/// The curve with the fewest harmonics whose distance from every one of `points` is at most
/// `tolerance` (m).
///
/// # Errors
/// [`FitError`].
pub fn fit(points: &[Vector3<f64>], tolerance: f64) -> Result<Fit, FitError> {
    let mut best = (f64::INFINITY, 0);
    // Up to as many unknowns as waypoints.
    for count in 1..=MAX_HARMONICS.min((points.len() - 1) / 2) {
        let (harmonics, sigma) = with_harmonics(points, count)?;
        let errors: Vec<f64> =
            points.iter().zip(&sigma).map(|(point, &sigma)| length(&(point - harmonics.point(sigma)))).collect();
        let worst = errors
            .iter()
            .enumerate()
            .fold((0.0, 0), |worst, (index, &error)| if error > worst.0 { (error, index) } else { worst });
        if worst.0 <= tolerance {
            return finish(points, harmonics, count, worst, &errors);
        }
        if worst.0 < best.0 {
            best = worst;
        }
    }
    Err(FitError::Tolerance { points: points.len(), error: best.0, worst: best.1 + 1, tolerance })
}

/// The fit with `count` harmonics, and the waypoints' parameters.
fn with_harmonics(
    points: &[Vector3<f64>],
    count: usize,
) -> Result<(Harmonics<f64, MAX_HARMONICS>, Vec<f64>), FitError> {
    let chords: Vec<f64> = (0..points.len()).map(|i| length(&(points[(i + 1) % points.len()] - points[i]))).collect();
    // Half of the chords on both sides.
    let weights: Vec<f64> =
        (0..points.len()).map(|i| 0.5 * (chords[i] + chords[(i + points.len() - 1) % points.len()])).collect();
    let total: f64 = chords.iter().map(|chord| chord.sqrt()).sum();
    let sigma: Vec<f64> = chords
        .iter()
        .scan(0.0, |passed, chord| {
            let here = TAU * *passed / total;
            *passed += chord.sqrt();
            Some(here)
        })
        .collect();
    let harmonics = coefficients(points, &weights, &sigma, count)?;
    Ok(orthogonal::minimize(points, &weights, harmonics, sigma, count))
}

/// The weighted least-squares coefficients for given parameters.
fn coefficients(
    points: &[Vector3<f64>],
    weights: &[f64],
    sigma: &[f64],
    count: usize,
) -> Result<Harmonics<f64, MAX_HARMONICS>, FitError> {
    let design = DMatrix::from_fn(points.len(), 2 * count + 1, |row, column| {
        weights[row].sqrt() * orthogonal::basis(column, sigma[row])
    });
    let decomposition = design.svd(true, true);
    let mut harmonics = Harmonics {
        center: [0.0; 3],
        cos: [[0.0; 3]; MAX_HARMONICS],
        sin: [[0.0; 3]; MAX_HARMONICS],
        reference: [0.0, 0.0, 1.0],
    };
    for axis in 0..3 {
        let wanted = DVector::from_fn(points.len(), |row, _| weights[row].sqrt() * points[row][axis]);
        // Singular values at rounding level only: the columns are independent as long as the
        // parameters differ.
        let solution = decomposition.solve(&wanted, 1e-12).map_err(|_| FitError::Undetermined)?;
        harmonics.center[axis] = solution[0];
        for k in 1..=count {
            harmonics.sin[k - 1][axis] = solution[2 * k - 1];
            harmonics.cos[k - 1][axis] = solution[2 * k];
        }
    }
    Ok(harmonics)
}

/// Chooses the reference direction and measures the curve.
fn finish(
    points: &[Vector3<f64>],
    mut harmonics: Harmonics<f64, MAX_HARMONICS>,
    count: usize,
    worst: (f64, usize),
    errors: &[f64],
) -> Result<Fit, FitError> {
    // Enough that the tangent turns little between them, even where the shortest harmonic
    // dominates.
    let samples = 64 * count.max(4);
    let sigma = |index: usize| TAU * index as f64 / samples as f64;
    let tangents: Vec<Vector3<f64>> = (0..samples)
        .map(|index| {
            let [_, first] = harmonics.derivatives(sigma(index));
            first / length(&first)
        })
        .collect();
    let (reference, reference_angle, nearest) = reference::farthest(&tangents);
    let position = harmonics.point(sigma(nearest));
    if reference_angle < LEAST_ANGLE {
        let arc = (0..nearest).map(|i| length(&(harmonics.point(sigma(i + 1)) - harmonics.point(sigma(i))))).sum();
        return Err(FitError::NoReference { angle: reference_angle, position: position.into(), arc });
    }
    harmonics.reference = reference.into();

    let mut path = FourierPath::new(harmonics)?.at_speed(1.0)?;
    let lap = lap_of(&mut path, &harmonics)?;
    let branches = lap.branches()?;

    let amplitude = |k: usize| {
        let (a, b) = (Vector3::from(harmonics.cos[k - 1]), Vector3::from(harmonics.sin[k - 1]));
        (a.dot(&a) + b.dot(&b)).sqrt()
    };
    let largest =
        (1..=count).map(|k| (k, amplitude(k))).fold((0, 0.0), |best, next| if next.1 > best.1 { next } else { best });
    let strays = lap.nodes().iter().map(|node| distance_to_polygon(points, node.position())).fold(0.0, f64::max);
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
    Ok(Fit {
        harmonics,
        count,
        worst,
        rms,
        strays,
        reference_angle,
        largest,
        highest: amplitude(count),
        lap,
        branches,
    })
}

/// Walks a Fourier curve from σ = 0.
fn lap_of<P: controller::Path<f64>>(
    path: &mut P,
    harmonics: &Harmonics<f64, MAX_HARMONICS>,
) -> Result<Lap, FitError> {
    use crate::study::check::{Place, Reason};
    let start = harmonics.point(0.0);
    path.search(&start);
    let refused = || Reason::NotSmooth.at(Place::of_curve(start, 0.0));
    let frame = Frame::on_curve(path, start, 1.0).ok_or_else(refused)?;
    Ok(walk(path, frame)?)
}

/// Distance of a point from the closed polygon of `points`, m.
fn distance_to_polygon(points: &[Vector3<f64>], position: Vector3<f64>) -> f64 {
    (0..points.len())
        .map(|i| {
            let (from, to) = (points[i], points[(i + 1) % points.len()]);
            let side = to - from;
            let part = ((position - from).dot(&side) / side.dot(&side)).clamp(0.0, 1.0);
            length(&(position - from - side * part))
        })
        .fold(f64::INFINITY, f64::min)
}
