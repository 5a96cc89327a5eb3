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
    // The last first: each takes the place of one that no other needs any more.
    let mut row = *below;
    row[D] = u * below[D - 1];
    for i in (1..D).rev() {
        row[i] = (u + T::WHOLE[D - i]) * below[i - 1] + (T::WHOLE[i + 1] - u) * below[i];
    }
    row[0] = (T::one() - u) * below[0];
    row
}

/// The weights w_{k,i} at a place of a span, by k: 8 of order 0, 7 of order 1, and so on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights<T>([T; POINTS * (POINTS + 1) / 2]);

/// Where the weights of order k begin.
const fn row(k: usize) -> usize {
    k * (2 * POINTS + 1 - k) / 2
}

impl<T: Real> Weights<T> {
    /// At `u` from the span's beginning, 0 to 1.
    #[inline(never)]
    pub(super) fn at(u: T) -> Self {
        let mut weights = Self([T::zero(); POINTS * (POINTS + 1) / 2]);
        let mut bases = [T::zero(); POINTS];
        bases[0] = T::one();
        weights.set::<7>(&bases);
        for_each_order!(D in [1 2 3 4 5 6 7] {
            bases = raise::<T, D>(u, &bases);
            weights.set::<{ 7 - D }>(&bases);
        });
        weights
    }

    /// Those of order K from d! N_{i,d}, d = 7 − K.
    #[inline(always)]
    fn set<const K: usize>(&mut self, bases: &[T; POINTS]) {
        let factor = T::PER_FACTORIAL[K] * T::PER_FACTORIAL[7 - K];
        for i in 0..POINTS - K {
            self.0[row(K) + i] = bases[i] * factor;
        }
    }

    /// The curve's value from its control points.
    pub(super) fn value(&self, points: &[Vector3<T>; POINTS]) -> Vector3<T> {
        points.iter().zip(&self.0).fold(Vector3::zeros(), |sum, (point, &weight)| sum + point * weight)
    }

    /// Taylor coefficients of order 0 to M − 1 of C splines, from their control points.
    #[inline(always)]
    pub(super) fn taylor<const M: usize, const C: usize>(&self, points: [[T; POINTS]; C]) -> [[T; M]; C] {
        let mut differences = points;
        let mut taylor = [[T::zero(); M]; C];
        for_each_order!(K in [0 1 2 3 4 5 6 7] {
            if K < M {
                for c in 0..C {
                    taylor[c][K] = self.0[row(K)] * differences[c][0];
                }
                for i in 1..POINTS - K {
                    for c in 0..C {
                        taylor[c][K] += self.0[row(K) + i] * differences[c][i];
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
        self.0.iter_mut().skip(POINTS).for_each(|weight| *weight = T::zero());
    }

    /// Taylor coefficients of a curve less P₃, from the steps Pᵢ₊₁ − Pᵢ of its control points:
    /// far from the origin the steps hold what their difference would lose.
    #[inline(always)]
    pub(super) fn taylor_of_steps(&self, steps: [Vector3<T>; POINTS - 1], taylor: &mut [Vector3<T>; POINTS]) {
        // Step i belongs to all points behind it, or, before P₃, is what the points up to it lack.
        let w = &self.0;
        let (before_1, behind_6) = (w[0] + w[1], w[6] + w[7]);
        let behind_5 = behind_6 + w[5];
        let sums = [-w[0], -before_1, -(before_1 + w[2]), behind_5 + w[4], behind_5, behind_6, w[7]];
        let mut differences = steps;
        taylor[0] = differences[0] * sums[0];
        for i in 1..POINTS - 1 {
            taylor[0] += differences[i] * sums[i];
        }
        for_each_order!(K in [1 2 3 4 5 6 7] {
            taylor[K] = differences[0] * self.0[row(K)];
            for i in 1..POINTS - K {
                taylor[K] += differences[i] * self.0[row(K) + i];
            }
            for i in 0..POINTS - 1 - K {
                differences[i] = differences[i + 1] - differences[i];
            }
        });
    }

    /// Taylor coefficients of order 0 to 2 of the cubic spline (C²) over the four control points in
    /// the middle.
    #[inline(always)]
    pub(super) fn taylor_of_cubic(&self, points: [T; 4]) -> [T; 3] {
        let [p0, p1, p2, p3] = points;
        let [d0, d1, d2] = [p1 - p0, p2 - p1, p3 - p2];
        // w_{4,i} is N_{i,3}/4!, and so on.
        let factor = |k: usize, n: usize| T::FACTORIAL[k] * T::PER_FACTORIAL[n];
        let w = |k: usize, i: usize| self.0[row(k) + i];
        [
            (w(4, 0) * p0 + w(4, 1) * p1 + w(4, 2) * p2 + w(4, 3) * p3) * factor(4, 0),
            (w(5, 0) * d0 + w(5, 1) * d1 + w(5, 2) * d2) * factor(5, 1),
            (w(6, 0) * (d1 - d0) + w(6, 1) * (d2 - d1)) * factor(6, 2),
        ]
    }
}

/// The first N differences of numbers, in their place.
#[inline(always)]
fn difference<T: Real, const N: usize>(numbers: &mut [T; POINTS]) {
    for i in 0..N {
        numbers[i] = numbers[i + 1] - numbers[i];
    }
}
