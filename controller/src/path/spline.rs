//! One span of a uniform B-spline of degree 7 (C⁶): its Taylor polynomial about any place of it.
//!
//! With knots at the whole numbers, the span [j, j + 1] belongs to eight control points P₀ … P₇,
//! of which Pᵢ has its weight about i − 3 from the span's beginning. The k-th derivative is a
//! spline of degree 7 − k over the k-th differences of the control points, so that
//!
//! ```text
//! c⁽ᵏ⁾(u)/k! = Σᵢ w_{k,i}(u) Δᵏ Pᵢ,   i = 0 … 7 − k
//! w_{k,i} = N_{i,7−k}(u)/k!                                         (15.8), (15.9)
//! ```
//!
//! with the cardinal bases N of Cox's and de Boor's recursion (de Boor, *A Practical Guide to
//! Splines*, ch. IX and X), here without a division.

// As in series.rs: indices run over compile-time orders.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop, clippy::reversed_empty_ranges)]

use model::Real;
use nalgebra::Vector3;

/// Control points of a span.
pub(super) const POINTS: usize = 8;

/// d! N_{i,d}(u) from (d − 1)! N_{i,d−1}(u), the row before.
#[inline(always)]
fn raise<T: Real, const D: usize>(u: T, below: &[T; POINTS]) -> [T; POINTS] {
    let mut row = [T::zero(); POINTS];
    row[0] = (T::one() - u) * below[0];
    for i in 1..D {
        row[i] = (u + T::WHOLE[D - i]) * below[i - 1] + (T::WHOLE[i + 1] - u) * below[i];
    }
    row[D] = u * below[D - 1];
    row
}

/// `row` times `factor`.
#[inline(always)]
fn scaled<T: Real>(row: &[T; POINTS], factor: T) -> [T; POINTS] {
    row.map(|weight| weight * factor)
}

/// The weights w_{k,i} at a place of a span, by k.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights<T>([[T; POINTS]; POINTS]);

impl<T: Real> Weights<T> {
    /// At `u` from the span's beginning, 0 to 1.
    #[inline(always)]
    pub(super) fn at(u: T) -> Self {
        let mut unit = [T::zero(); POINTS];
        unit[0] = T::one();
        let linear = raise::<T, 1>(u, &unit);
        let quadratic = raise::<T, 2>(u, &linear);
        let cubic = raise::<T, 3>(u, &quadratic);
        let quartic = raise::<T, 4>(u, &cubic);
        let quintic = raise::<T, 5>(u, &quartic);
        let sextic = raise::<T, 6>(u, &quintic);
        let septic = raise::<T, 7>(u, &sextic);
        let per = |k: usize| T::PER_FACTORIAL[k] * T::PER_FACTORIAL[7 - k];
        Self([
            scaled(&septic, per(0)),
            scaled(&sextic, per(1)),
            scaled(&quintic, per(2)),
            scaled(&quartic, per(3)),
            scaled(&cubic, per(4)),
            scaled(&quadratic, per(5)),
            scaled(&linear, per(6)),
            scaled(&unit, per(7)),
        ])
    }

    /// The curve's value from its control points.
    pub(super) fn value(&self, points: &[Vector3<T>; POINTS]) -> Vector3<T> {
        let [weights, ..] = &self.0;
        points.iter().zip(weights).fold(Vector3::zeros(), |sum, (point, &weight)| sum + point * weight)
    }

    /// Taylor coefficients of order 0 to M − 1 of C splines, from their control points.
    #[inline(always)]
    pub(super) fn taylor<const M: usize, const C: usize>(&self, points: [[T; POINTS]; C]) -> [[T; M]; C] {
        let mut differences = points;
        let mut taylor = [[T::zero(); M]; C];
        for_each_order!(K in [0 1 2 3 4 5 6 7] {
            if K < M {
                for c in 0..C {
                    taylor[c][K] = self.0[K][0] * differences[c][0];
                }
                for i in 1..POINTS - K {
                    for c in 0..C {
                        taylor[c][K] += self.0[K][i] * differences[c][i];
                    }
                }
                for c in 0..C {
                    difference::<_, { POINTS - 1 - K }>(&mut differences[c]);
                }
            }
        });
        taylor
    }

    /// Leaves the values alone: what the splines are where they do not change.
    #[cold]
    pub(super) fn hold(&mut self) {
        let [_, changes @ ..] = &mut self.0;
        *changes = [[T::zero(); POINTS]; POINTS - 1];
    }

    /// Taylor coefficients of a curve less P₃, from the steps Pᵢ₊₁ − Pᵢ of its control points:
    /// far from the origin the steps hold what their difference would lose.
    #[inline(always)]
    pub(super) fn taylor_of_steps(&self, steps: [Vector3<T>; POINTS - 1]) -> [Vector3<T>; POINTS] {
        // Step i belongs to all points behind it, or, before P₃, is what the points up to it lack.
        let w = &self.0[0];
        let (before_1, behind_6) = (w[0] + w[1], w[6] + w[7]);
        let behind_5 = behind_6 + w[5];
        let sums = [-w[0], -before_1, -(before_1 + w[2]), behind_5 + w[4], behind_5, behind_6, w[7]];
        let mut differences = steps;
        let mut taylor = [Vector3::zeros(); POINTS];
        taylor[0] = differences[0] * sums[0];
        for i in 1..POINTS - 1 {
            taylor[0] += differences[i] * sums[i];
        }
        for_each_order!(K in [1 2 3 4 5 6 7] {
            taylor[K] = differences[0] * self.0[K][0];
            for i in 1..POINTS - K {
                taylor[K] += differences[i] * self.0[K][i];
            }
            for i in 0..POINTS - 1 - K {
                differences[i] = differences[i + 1] - differences[i];
            }
        });
        taylor
    }

    /// Taylor coefficients of order 0 to 2 of the cubic spline (C²) over the four control points in
    /// the middle.
    #[inline(always)]
    pub(super) fn taylor_of_cubic(&self, points: [T; 4]) -> [T; 3] {
        let [p0, p1, p2, p3] = points;
        let [d0, d1, d2] = [p1 - p0, p2 - p1, p3 - p2];
        // w_{4,i} is N_{i,3}/4!, and so on.
        let row = |k: usize, n: usize| scaled(&self.0[k], T::FACTORIAL[k] * T::PER_FACTORIAL[n]);
        [
            dot::<_, 4>(&row(4, 0), &padded([p0, p1, p2, p3])),
            dot::<_, 3>(&row(5, 1), &padded([d0, d1, d2])),
            dot::<_, 2>(&row(6, 2), &padded([d1 - d0, d2 - d1])),
        ]
    }
}

/// `numbers`, and zeros.
#[inline(always)]
fn padded<T: Real, const N: usize>(numbers: [T; N]) -> [T; POINTS] {
    let mut row = [T::zero(); POINTS];
    row[..N].copy_from_slice(&numbers);
    row
}

/// Σ aᵢ bᵢ of the first N.
#[inline(always)]
fn dot<T: Real, const N: usize>(a: &[T; POINTS], b: &[T; POINTS]) -> T {
    let mut sum = a[0] * b[0];
    for i in 1..N {
        sum += a[i] * b[i];
    }
    sum
}

/// The first N differences of numbers, in their place.
#[inline(always)]
fn difference<T: Real, const N: usize>(numbers: &mut [T; POINTS]) {
    for i in 0..N {
        numbers[i] = numbers[i + 1] - numbers[i];
    }
}
