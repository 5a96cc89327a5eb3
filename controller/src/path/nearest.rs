//! The point of a curve nearest to the payload, followed along the payload's motion.
//!
//! The parameter σ(t) of the nearest point solves (p(t) − c(σ(t)))·c′(σ(t)) = 0. Order 0 is
//! Newton's method on the Taylor polynomial of r·c′ that the last sample left; the others follow
//! one by one, for each is linear in the newest coefficient of σ(t).

// As in series.rs: indices run over compile-time orders.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use model::{Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;

/// Orders of p(t), hence of σ(t).
const N: usize = 7;

/// c by its Taylor coefficients about some σ₀, orders 0 to 7.
pub(super) type Local<T> = [Vector3<T>; N + 1];

/// σ − σ₀ of the point of the polynomial `local` nearest to a payload at `error` from its
/// beginning c(σ₀), by `STEPS` of Newton from 0.
///
/// r·c′ is a polynomial in σ − σ₀ itself, here up to its fourth power: what is left out vanishes
/// with the way from sample to sample, so that a payload at rest has its nearest point exactly.
///
/// Each step is `longest` at most, and its divisor is bounded, so that it goes downhill wherever it
/// starts.
#[inline(always)]
pub(super) fn track<T: Real, const STEPS: usize>(local: &Local<T>, error: &Vector3<T>, longest: T) -> T {
    let [_, c_1, c_2, c_3, c_4, c_5, ..] = local;
    let square = c_1.dot(c_1);
    let least = square * T::lit(0.1);
    // Of r·c′ = (error − Δc)·c′ with Δc·c′ = (|Δc|²)′/2; the first less its sign.
    let f_0 = error.dot(c_1);
    let f_1 = square - error.dot(c_2) * T::lit(2.0);
    let f_2 = (error.dot(c_3) - c_1.dot(c_2)) * T::lit(3.0);
    let f_3 = (error.dot(c_4) - c_1.dot(c_3)) * T::lit(4.0) - c_2.dot(c_2) * T::lit(2.0);
    let f_4 = (error.dot(c_5) - c_1.dot(c_4) - c_2.dot(c_3)) * T::lit(5.0);
    let (f_2_twice, f_3_thrice, f_4_fourfold) = (f_2 + f_2, f_3 * T::lit(3.0), f_4 * T::lit(4.0));
    let step = |value: T, divisor: T| (value / divisor.max(least)).clamp(-longest, longest);
    let mut s = step(f_0, f_1);
    for _ in 1..STEPS {
        let value = (((f_4 * s + f_3) * s + f_2) * s - f_1) * s + f_0;
        let divisor = f_1 - ((f_4_fourfold * s + f_3_thrice) * s + f_2_twice) * s;
        s += step(value, divisor);
    }
    s
}

/// The Newton step for r·c′ = 0 from r, c′ and c″. Finite for any r.
#[inline(always)]
pub(super) fn newton<T: Real>(r: &Vector3<T>, first: &Vector3<T>, second: &Vector3<T>, longest: T) -> T {
    let speed_squared = first.dot(first);
    let divisor = (speed_squared - r.dot(second)).max(speed_squared * T::lit(0.1));
    (r.dot(first) / divisor).clamp(-longest, longest)
}

/// σ(t) − σ(0) and its powers: (σ(t) − σ(0))ʲ/tʲ, orders 0 to 6 − j, for j from 1 on, one
/// after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Advance<T>([T; N * (N - 1) / 2]);

/// Where order `order` of power `power` stands.
const fn at(power: usize, order: usize) -> usize {
    (power - 1) * (2 * N - power) / 2 + order
}

impl<T: Real> Advance<T> {
    /// None.
    pub(super) fn none() -> Self {
        Self([T::zero(); N * (N - 1) / 2])
    }

    /// Order M of the powers above the first, which the lower orders of σ(t) fix.
    #[inline(always)]
    fn raise<const M: usize>(&mut self) {
        for_each_order!(J in [2 3 4 5 6] {
            if J <= M {
                let mut sum = self.0[0] * self.0[at(J - 1, M - J)];
                for i in 1..=M - J {
                    sum += self.0[i] * self.0[at(J - 1, M - J - i)];
                }
                self.0[at(J, M - J)] = sum;
            }
        });
    }

    /// f(σ(t)), orders 0 to M − 1, from f's Taylor coefficients about σ(0).
    #[inline(always)]
    pub(super) fn compose<const M: usize>(&self, taylor: &[T; M]) -> Series<T, M> {
        let mut f = *taylor;
        for_each_order!(K in [1 2 3 4 5 6] {
            if K < M {
                let mut sum = taylor[1] * self.0[K - 1];
                for j in (2..).take(K - 1) {
                    sum += taylor[j] * self.0[at(j, K - j)];
                }
                f[K] = sum;
            }
        });
        Series(f)
    }
}

/// r = p − c(σ), c′(σ) and σ − σ(0) along the payload's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearest<T> {
    pub(super) error: [Series<T, N>; 3],
    pub(super) first: [Series<T, N>; 3],
    pub(super) advance: Advance<T>,
    /// |c′|² and |c′|² − r·c″ now.
    pub(super) speed_squared: T,
    pub(super) divisor: T,
}

impl<T: Real> Nearest<T> {
    /// Order M of σ(t), r and c′.
    #[inline(always)]
    fn raise<const M: usize>(&mut self, position: &PositionSeries<T>, local: &Local<T>, per_divisor: T) {
        self.advance.raise::<M>();
        let mut product = T::EMPTY_SUM;
        let (mut r, mut d) = ([T::zero(); 3], [T::EMPTY_SUM; 3]);
        let mut powers = [T::zero(); N];
        let mut scaled = [T::zero(); N];
        for_each_order!(J in [2 3 4 5 6] {
            if J <= M {
                powers[J] = self.advance.0[at(J, M - J)];
                scaled[J] = powers[J] * T::WHOLE[J + 1];
            }
        });
        for_each_order!(AXIS in [0 1 2] {
            r[AXIS] = position[AXIS].0[M];
            for_each_order!(J in [2 3 4 5 6] {
                if J <= M {
                    r[AXIS] -= local[J][AXIS] * powers[J];
                    d[AXIS] += local[J + 1][AXIS] * scaled[J];
                }
            });
            product += r[AXIS] * self.first[AXIS].0[0];
            if M > 1 {
                product += self.error[AXIS].0[0] * d[AXIS];
            }
            for i in 1..M {
                product += self.error[AXIS].0[i] * self.first[AXIS].0[M - i];
            }
        });
        let newest = product * per_divisor;
        self.advance.0[M - 1] = newest;
        let twice = newest + newest;
        for_each_order!(AXIS in [0 1 2] {
            self.error[AXIS].0[M] = r[AXIS] - self.first[AXIS].0[0] * newest;
            self.first[AXIS].0[M] = d[AXIS] + local[2][AXIS] * twice;
        });
    }

    /// Of no motion at all.
    pub(super) fn none() -> Self {
        let (zero, zeros) = (T::zero(), [Series::constant(T::zero()); 3]);
        Self { error: zeros, first: zeros, advance: Advance::none(), speed_squared: zero, divisor: zero }
    }

    /// Solves r·c′ = 0 order by order, given c's Taylor polynomial about the nearest point and r
    /// there.
    #[inline(never)]
    pub(super) fn solve(&mut self, position: &PositionSeries<T>, error: &Vector3<T>, local: &Local<T>) {
        let half = error.dot(&local[2]);
        self.speed_squared = local[1].dot(&local[1]);
        self.divisor = self.speed_squared - (half + half);
        let per_divisor = T::one() / self.divisor;
        for axis in 0..3 {
            self.error[axis].0[0] = error[axis];
            self.first[axis].0[0] = local[1][axis];
        }
        self.raise::<1>(position, local, per_divisor);
        self.raise::<2>(position, local, per_divisor);
        self.raise::<3>(position, local, per_divisor);
        self.raise::<4>(position, local, per_divisor);
        self.raise::<5>(position, local, per_divisor);
        self.raise::<6>(position, local, per_divisor);
    }
}
