//! Orthogonal distance regression: the curve whose distances to the waypoints, squared, have the
//! least weighted sum.
//!
//! Levenberg's and Marquardt's method on the coefficients, with each waypoint's parameter kept at
//! its nearest point: to first order a change of the curve moves the distance by its part across
//! the tangent only. Changes along the curve do nothing; the damping keeps them out.

use controller::Harmonics;
use controller::Vector3;
use nalgebra::{DMatrix, DVector};

use super::MAX_HARMONICS;

/// Steps, most of them; ten are common.
const STEPS: usize = 60;
/// Steps end when the sum of squares falls by less than this part of itself, or of the loop's size
/// squared times 1e-24.
const SETTLED: f64 = 1e-9;
/// Damping at first, relative to the mean diagonal.
const DAMPING: f64 = 1e-6;
/// Newton steps for each nearest point from the last one.
const FOOT_STEPS: usize = 4;

type Curve = Harmonics<f64, MAX_HARMONICS>;

/// The curve and the waypoints' parameters from a first guess of both.
pub fn minimize(
    points: &[Vector3<f64>],
    weights: &[f64],
    mut curve: Curve,
    mut sigma: Vec<f64>,
    count: usize,
) -> (Curve, Vec<f64>) {
    feet(points, &curve, &mut sigma, count);
    let mut sum = squares(points, weights, &curve, &sigma);
    let size: f64 = points.iter().zip(weights).map(|(point, weight)| weight * point.dot(point)).sum();
    let mut damping = DAMPING;
    for _ in 0..STEPS {
        let Some(step) = step(points, weights, &curve, &sigma, count, damping) else { break };
        let moved = changed(&curve, &step, count);
        let mut moved_sigma = sigma.clone();
        feet(points, &moved, &mut moved_sigma, count);
        let moved_sum = squares(points, weights, &moved, &moved_sigma);
        if moved_sum < sum {
            let settled = sum - moved_sum <= SETTLED * sum || moved_sum <= 1e-24 * size;
            (curve, sigma, sum) = (moved, moved_sigma, moved_sum);
            damping = (0.1 * damping).max(1e-12);
            if settled {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    (curve, sigma)
}

/// One damped step: for each harmonic's column and axis its change, m.
fn step(
    points: &[Vector3<f64>],
    weights: &[f64],
    curve: &Curve,
    sigma: &[f64],
    count: usize,
    damping: f64,
) -> Option<DVector<f64>> {
    let columns = 2 * count + 1;
    let mut normal = DMatrix::<f64>::zeros(3 * columns, 3 * columns);
    let mut right = DVector::<f64>::zeros(3 * columns);
    for ((point, &weight), &sigma) in points.iter().zip(weights).zip(sigma) {
        let [_, tangent] = curve.derivatives(sigma);
        let square = tangent.dot(&tangent);
        let error = point - curve.point(sigma);
        let basis: Vec<f64> = (0..columns).map(|column| basis(column, sigma)).collect();
        for i in 0..3 {
            for j in 0..3 {
                // The part across the tangent: its projector is its own square.
                let across = f64::from(u8::from(i == j)) - tangent[i] * tangent[j] / square;
                for (row, &left) in basis.iter().enumerate() {
                    right[3 * row + i] += weight * left * across * error[j];
                    for (column, &other) in basis.iter().enumerate() {
                        normal[(3 * row + i, 3 * column + j)] += weight * left * across * other;
                    }
                }
            }
        }
    }
    let mean = normal.trace() / (3 * columns) as f64;
    for diagonal in 0..3 * columns {
        normal[(diagonal, diagonal)] += damping * mean;
    }
    Some(normal.cholesky()?.solve(&right))
}

/// 1, sin σ, cos σ, sin 2σ, …
pub fn basis(column: usize, sigma: f64) -> f64 {
    let (sin, cos) = (column.div_ceil(2) as f64 * sigma).sin_cos();
    if column % 2 == 1 { sin } else { cos }
}

fn changed(curve: &Curve, step: &DVector<f64>, count: usize) -> Curve {
    let mut changed = *curve;
    for axis in 0..3 {
        changed.center[axis] += step[axis];
        for k in 1..=count {
            changed.sin[k - 1][axis] += step[3 * (2 * k - 1) + axis];
            changed.cos[k - 1][axis] += step[3 * (2 * k) + axis];
        }
    }
    changed
}

fn squares(points: &[Vector3<f64>], weights: &[f64], curve: &Curve, sigma: &[f64]) -> f64 {
    let square = |(point, sigma): (&Vector3<f64>, &f64)| {
        let error = point - curve.point(*sigma);
        error.dot(&error)
    };
    points.iter().zip(sigma).map(square).zip(weights).map(|(square, weight)| weight * square).sum()
}

fn feet(points: &[Vector3<f64>], curve: &Curve, sigma: &mut [f64], count: usize) {
    for (point, sigma) in points.iter().zip(sigma) {
        for _ in 0..FOOT_STEPS {
            *sigma += towards_foot(curve, point, *sigma, count);
        }
    }
}

/// One Newton step towards the parameter of the nearest point, rad.
fn towards_foot(curve: &Curve, point: &Vector3<f64>, sigma: f64, count: usize) -> f64 {
    let [offset, first, second] = curve.derivatives(sigma);
    let error = point - Vector3::from(curve.center) - offset;
    let speed_squared = first.dot(&first);
    // Downhill also beyond the centre of curvature, and within the shortest harmonic's scale.
    let divisor = (speed_squared - error.dot(&second)).max(0.1 * speed_squared);
    let limit = 0.5 / count as f64;
    (error.dot(&first) / divisor).clamp(-limit, limit)
}
