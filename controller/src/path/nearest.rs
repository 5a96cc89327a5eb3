//! The point of a curve nearest to the payload, followed along the payload's motion.
//!
//! The parameter σ(t) of the nearest point solves (p(t) − c(σ(t)))·c′(σ(t)) = 0. Order 0 is
//! Newton's method on the Taylor polynomial of c that the last sample left; the others follow one
//! by one, for each is linear in the newest coefficient of σ(t).

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
/// Each step is `longest` at most, and the curvature's part of its divisor is bounded, so that it
/// goes downhill wherever it starts.
#[inline(always)]
pub(super) fn track<T: Real, const STEPS: usize>(local: &Local<T>, error: &Vector3<T>, longest: T) -> T {
    // The first step is from 0, where the polynomial's derivatives are its coefficients.
    let mut s = newton(error, &local[1], &(local[2] + local[2]), longest);
    for _ in 1..STEPS {
        // c, c′ and c″/2 by Horner's rule.
        let (mut c, mut c_1, mut c_2) = (local[N] * s + local[N - 1], local[N], Vector3::zeros());
        for_each_order!(K in [5 4 3 2 1 0] {
            c_2 = c_2 * s + c_1;
            c_1 = c_1 * s + c;
            c = c * s + local[K];
        });
        let r = error - (c - local[0]);
        s += newton(&r, &c_1, &(c_2 + c_2), longest);
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
pub(super) struct Nearest<T> {
    pub(super) error: [Series<T, N>; 3],
    pub(super) first: [Series<T, N>; 3],
    pub(super) advance: Advance<T>,
    /// |c′|² and |c′|² − r·c″ now.
    pub(super) speed_squared: T,
    pub(super) divisor: T,
}

/// r and c′ up to an order.
struct Solving<T> {
    r: [Vector3<T>; N],
    first: [Vector3<T>; N],
    advance: Advance<T>,
}

impl<T: Real> Solving<T> {
    /// Order M of σ(t), r and c′.
    #[inline(always)]
    fn raise<const M: usize>(&mut self, local: &Local<T>, motion: Vector3<T>, per_divisor: T) {
        self.advance.raise::<M>();
        let (mut r, mut d) = (motion, Vector3::zeros());
        for_each_order!(J in [2 3 4 5 6] {
            if J <= M {
                let power = self.advance.0[at(J, M - J)];
                r -= local[J] * power;
                d += local[J + 1] * (power * T::WHOLE[J + 1]);
            }
        });
        let mut product = r.dot(&self.first[0]) + self.r[0].dot(&d);
        for i in 1..M {
            product += self.r[i].dot(&self.first[M - i]);
        }
        let newest = product * per_divisor;
        self.advance.0[M - 1] = newest;
        self.r[M] = r - local[1] * newest;
        let twice = newest + newest;
        self.first[M] = d + local[2] * twice;
    }
}

/// Solves r·c′ = 0 order by order, given c's Taylor polynomial about the nearest point and r there.
#[inline(always)]
pub(super) fn solve<T: Real>(position: &PositionSeries<T>, error: &Vector3<T>, local: &Local<T>) -> Nearest<T> {
    let speed_squared = local[1].dot(&local[1]);
    let half = error.dot(&local[2]);
    let divisor = speed_squared - (half + half);
    let per_divisor = T::one() / divisor;
    let [x, y, z] = position;
    let motion = |m: usize| Vector3::new(x.0[m], y.0[m], z.0[m]);
    let mut solving = Solving { r: [Vector3::zeros(); N], first: [Vector3::zeros(); N], advance: Advance::none() };
    solving.r[0] = *error;
    solving.first[0] = local[1];
    solving.raise::<1>(local, motion(1), per_divisor);
    solving.raise::<2>(local, motion(2), per_divisor);
    solving.raise::<3>(local, motion(3), per_divisor);
    solving.raise::<4>(local, motion(4), per_divisor);
    solving.raise::<5>(local, motion(5), per_divisor);
    solving.raise::<6>(local, motion(6), per_divisor);
    let transposed = |v: &[Vector3<T>; N]| [Series(v.map(|v| v.x)), Series(v.map(|v| v.y)), Series(v.map(|v| v.z))];
    Nearest {
        error: transposed(&solving.r),
        first: transposed(&solving.first),
        advance: solving.advance,
        speed_squared,
        divisor,
    }
}
