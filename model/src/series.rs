//! Truncated Taylor polynomials of one variable (univariate jets) and their arithmetic.
//!
//! [`Series<T, N>`] holds a function of time about "now": f(t) = Σ cₖ tᵏ, cₖ =
//! f⁽ᵏ⁾(0)/k!, k < N. A path evaluated on the payload's series gives its outputs with all their
//! time derivatives in one pass (Taylor-mode automatic differentiation; Griewank and
//! Walther, *Evaluating Derivatives*, ch. 13). Lengths are compile-time constants and every loop
//! has constant bounds, so the cost is constant.
//!
//! Powers and transcendental functions are those of [`Analytic`](crate::analytic::Analytic).
//!
//! **Coefficients, not derivatives:** the k-th derivative is k! times the k-th coefficient, see
//! [`Series::derivative`].

// Indices here run over compile-time bounds below N; iterator chains in their place hide the
// convolutions.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use crate::scalar::Real;

/// Taylor coefficients of order 0 to N − 1, N ≤ 7.
///
/// ```
/// use model::{Analytic, Series};
///
/// // x = 3 + 2 t about t = 0, and its square: 9 + 12 t + 4 t².
/// let x = Series::<f64, 4>::from_derivatives([3.0, 2.0, 0.0, 0.0]);
/// let square = x.square();
/// assert_eq!([square.value(), square.derivative(1), square.derivative(2)], [9.0, 12.0, 8.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series<T, const N: usize>(pub [T; N]);

impl<T: Real, const N: usize> Series<T, N> {
    /// A constant.
    #[inline]
    pub fn constant(value: T) -> Self {
        let mut c = [T::zero(); N];
        c[0] = value;
        Self(c)
    }

    /// The series with the given derivatives f, ḟ, f̈, …
    #[inline]
    pub fn from_derivatives(derivatives: [T; N]) -> Self {
        let mut c = derivatives;
        for k in 2..N {
            c[k] = derivatives[k] * T::PER_FACTORIAL[k];
        }
        Self(c)
    }

    /// The k-th derivative, k! cₖ.
    #[inline]
    pub fn derivative(&self, k: usize) -> T {
        self.0[k] * T::FACTORIAL[k]
    }

    /// The value, c₀.
    #[inline]
    pub fn value(&self) -> T {
        self.0[0]
    }

    /// The first M coefficients.
    #[inline]
    pub fn truncate<const M: usize>(&self) -> Series<T, M> {
        const { assert!(M <= N) };
        let mut c = [T::zero(); M];
        c.copy_from_slice(&self.0[..M]);
        Series(c)
    }

    /// The first M coefficients of the time derivative.
    #[inline]
    pub fn differentiate<const M: usize>(&self) -> Series<T, M> {
        const { assert!(M < N) };
        let mut c = [T::zero(); M];
        for k in 0..M {
            c[k] = self.0[k + 1] * T::WHOLE[k + 1];
        }
        Series(c)
    }

    /// The time integral that starts from `value`, one order longer.
    #[inline]
    pub fn integrate<const M: usize>(&self, value: T) -> Series<T, M> {
        const { assert!(M == N + 1) };
        let mut c = [T::zero(); M];
        c[0] = value;
        for k in 0..N {
            c[k + 1] = self.0[k] * T::RECIPROCAL[k + 1];
        }
        Series(c)
    }

    /// Subtracts `factor` · `other` from the coefficients that both have; the others stay.
    #[inline]
    pub fn subtract<const M: usize>(&mut self, other: &Series<T, M>, factor: T) {
        subtract(&mut self.0, &other.0, factor);
    }

    /// The same polynomial about t = `dt` instead of t = 0 (Horner's synthetic division).
    #[inline]
    pub fn shift(&self, dt: T) -> Self {
        let mut c = self.0;
        for first in 0..N {
            for k in (first..N - 1).rev() {
                c[k] += c[k + 1] * dt;
            }
        }
        Self(c)
    }
}

/// For series of any length: called where speed does not matter, and one copy is smaller than one
/// for each.
#[inline(never)]
fn subtract<T: Real>(from: &mut [T], other: &[T], factor: T) {
    for (c, &other) in from.iter_mut().zip(other) {
        *c -= factor * other;
    }
}

impl<T: Real, const N: usize> Add for Series<T, N> {
    type Output = Self;
    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<T: Real, const N: usize> AddAssign for Series<T, N> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        for k in 0..N {
            self.0[k] += other.0[k];
        }
    }
}

impl<T: Real, const N: usize> Sub for Series<T, N> {
    type Output = Self;
    #[inline]
    fn sub(mut self, other: Self) -> Self {
        for k in 0..N {
            self.0[k] -= other.0[k];
        }
        self
    }
}

impl<T: Real, const N: usize> Neg for Series<T, N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|c| -c))
    }
}

impl<T: Real, const N: usize> Mul for Series<T, N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let mut c = [T::zero(); N];
        for k in 0..N {
            let mut sum = self.0[0] * other.0[k];
            for j in 1..k + 1 {
                sum += self.0[j] * other.0[k - j];
            }
            c[k] = sum;
        }
        Self(c)
    }
}

impl<T: Real, const N: usize> Div for Series<T, N> {
    type Output = Self;
    /// Quotient, the divisor's value ≠ 0.
    #[inline]
    fn div(self, other: Self) -> Self {
        let inverse = T::one() / other.0[0];
        let mut c = [T::zero(); N];
        for k in 0..N {
            let mut sum = self.0[k];
            for j in 1..k + 1 {
                sum -= other.0[j] * c[k - j];
            }
            c[k] = sum * inverse;
        }
        Self(c)
    }
}

impl<T: Real, const N: usize> Add<T> for Series<T, N> {
    type Output = Self;
    #[inline]
    fn add(mut self, constant: T) -> Self {
        self.0[0] += constant;
        self
    }
}

impl<T: Real, const N: usize> Sub<T> for Series<T, N> {
    type Output = Self;
    #[inline]
    fn sub(mut self, constant: T) -> Self {
        self.0[0] -= constant;
        self
    }
}

impl<T: Real, const N: usize> Mul<T> for Series<T, N> {
    type Output = Self;
    #[inline]
    fn mul(self, constant: T) -> Self {
        Self(self.0.map(|c| c * constant))
    }
}

impl<T: Real, const N: usize> Div<T> for Series<T, N> {
    type Output = Self;
    #[inline]
    fn div(self, constant: T) -> Self {
        self * (T::one() / constant)
    }
}

/// The scalar on the left, as on the right: `20.0 * x`, `1.0 - x`, `1.0 / x`. A formula that is
/// generic over [`Analytic`](crate::Analytic) has it on the right only, since Rust does not carry
/// bounds on the scalar from trait to user.
macro_rules! scalar_on_the_left {
    ($($real:ty),*) => {$(
        impl<const N: usize> Add<Series<$real, N>> for $real {
            type Output = Series<$real, N>;
            #[inline]
            fn add(self, series: Series<$real, N>) -> Series<$real, N> {
                series + self
            }
        }
        impl<const N: usize> Sub<Series<$real, N>> for $real {
            type Output = Series<$real, N>;
            #[inline]
            fn sub(self, series: Series<$real, N>) -> Series<$real, N> {
                -series + self
            }
        }
        impl<const N: usize> Mul<Series<$real, N>> for $real {
            type Output = Series<$real, N>;
            #[inline]
            fn mul(self, series: Series<$real, N>) -> Series<$real, N> {
                series * self
            }
        }
        impl<const N: usize> Div<Series<$real, N>> for $real {
            type Output = Series<$real, N>;
            #[inline]
            fn div(self, series: Series<$real, N>) -> Series<$real, N> {
                Series::constant(self) / series
            }
        }
    )*};
}
scalar_on_the_left!(f32, f64);
