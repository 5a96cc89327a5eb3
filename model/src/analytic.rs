//! Analytic functions, written once for every kind of number that a path is evaluated on.
//!
//! A curve or profile given as a formula over [`Analytic`] is evaluated on Taylor series along the
//! payload's motion for its time derivatives, and on [dual numbers](crate::dual) of such series for
//! its gradient besides.
//!
//! The series' rules follow from each function's differential equation, order by order (Griewank
//! and Walther, *Evaluating Derivatives*, table 13.2): with y = f(x), each new coefficient of y is
//! linear in known ones.

// As in series.rs: indices run over compile-time bounds below N.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::scalar::Real;
use crate::series::Series;

/// A number with arithmetic and the elementary functions, over the scalar `T`.
///
/// Outside a function's domain the result is NaN or infinite, never a panic.
///
/// A constant stands on the right, `x * 20.0`: with the number's kind left open, Rust knows no
/// `20.0 * x`. Of a known [`Series`] both are the same.
pub trait Analytic<T: Real>:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<T, Output = Self>
    + Sub<T, Output = Self>
    + Mul<T, Output = Self>
    + Div<T, Output = Self>
{
    /// A number that does not vary.
    fn constant(value: T) -> Self;
    /// x², half the work of x·x.
    fn square(self) -> Self;
    /// 1/x, x ≠ 0.
    fn recip(self) -> Self;
    /// √x, x > 0.
    fn sqrt(self) -> Self;
    /// x to a real power, x > 0.
    fn powf(self, exponent: T) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// Natural logarithm, x > 0.
    fn ln(self) -> Self;
    /// (sin x, cos x), x in rad.
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`) ≠ 0, rad. Its value is in [−π, π]; its derivatives know no
    /// jump there.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;

    /// 1/√x, x > 0.
    #[inline]
    fn rsqrt(self) -> Self {
        self.sqrt().recip()
    }
    /// sin x, x in rad.
    #[inline]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// cos x, x in rad.
    #[inline]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// x to a whole power by repeated squaring; x ≠ 0 where `exponent` < 0.
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        let mut rest = exponent.unsigned_abs();
        let mut square = self;
        let mut power = None;
        while rest > 0 {
            if rest & 1 == 1 {
                power = Some(power.map_or(square, |power| power * square));
            }
            rest >>= 1;
            if rest > 0 {
                square = square.square();
            }
        }
        let power = power.unwrap_or(Self::constant(T::one()));
        if exponent < 0 { power.recip() } else { power }
    }
}

impl<T: Real, const N: usize> Series<T, N> {
    /// (j xⱼ), the coefficients of t·ẋ, which every differential equation below is written in.
    #[inline]
    fn weighted(&self) -> [T; N] {
        let mut weighted = self.0;
        for j in 0..N {
            weighted[j] *= T::WHOLE[j];
        }
        weighted
    }
}

impl<T: Real, const N: usize> Analytic<T> for Series<T, N> {
    #[inline]
    fn constant(value: T) -> Self {
        Self::constant(value)
    }

    #[inline]
    fn square(self) -> Self {
        let a = &self.0;
        let mut c = [T::zero(); N];
        for k in 0..N {
            let mut half = T::EMPTY_SUM;
            for j in 0..k.div_ceil(2) {
                half += a[j] * a[k - j];
            }
            c[k] = half + half;
            if k % 2 == 0 {
                c[k] += a[k / 2] * a[k / 2];
            }
        }
        Self(c)
    }

    #[inline]
    fn recip(self) -> Self {
        let inverse = T::one() / self.0[0];
        let mut y = [T::zero(); N];
        y[0] = inverse;
        for k in 1..N {
            let mut sum = T::EMPTY_SUM;
            for j in 1..k + 1 {
                sum += self.0[j] * y[k - j];
            }
            y[k] = -sum * inverse;
        }
        Self(y)
    }

    /// From y² = x, in which the newest coefficient of y stands twice.
    #[inline]
    fn sqrt(self) -> Self {
        let mut y = [T::zero(); N];
        y[0] = self.0[0].sqrt();
        let per_twice = T::one() / (y[0] + y[0]);
        for k in 1..N {
            let mut half = T::EMPTY_SUM;
            for j in 1..k.div_ceil(2) {
                half += y[j] * y[k - j];
            }
            let mut rest = self.0[k] - (half + half);
            if k % 2 == 0 {
                rest -= y[k / 2] * y[k / 2];
            }
            y[k] = rest * per_twice;
        }
        Self(y)
    }

    /// From x·ẏ = α·ẋ·y.
    #[inline]
    fn powf(self, exponent: T) -> Self {
        let inverse = T::one() / self.0[0];
        let weighted = self.weighted();
        let mut y = [T::zero(); N];
        y[0] = self.0[0].powf(exponent);
        for k in 1..N {
            let mut sum = T::EMPTY_SUM;
            for j in 1..k + 1 {
                sum += (exponent * weighted[j] - self.0[j] * T::WHOLE[k - j]) * y[k - j];
            }
            y[k] = sum * inverse * T::RECIPROCAL[k];
        }
        Self(y)
    }

    /// From ẏ = ẋ·y.
    #[inline]
    fn exp(self) -> Self {
        let weighted = self.weighted();
        let mut y = [T::zero(); N];
        y[0] = self.0[0].exp();
        for k in 1..N {
            let mut sum = T::EMPTY_SUM;
            for j in 1..k + 1 {
                sum += weighted[j] * y[k - j];
            }
            y[k] = sum * T::RECIPROCAL[k];
        }
        Self(y)
    }

    /// From x·ẏ = ẋ.
    #[inline]
    fn ln(self) -> Self {
        let inverse = T::one() / self.0[0];
        let mut y = [T::zero(); N];
        let mut weighted = [T::zero(); N];
        y[0] = self.0[0].ln();
        for k in 1..N {
            let mut sum = self.0[k] * T::WHOLE[k];
            for j in 1..k {
                sum -= weighted[j] * self.0[k - j];
            }
            weighted[k] = sum * inverse;
            y[k] = weighted[k] * T::RECIPROCAL[k];
        }
        Self(y)
    }

    /// From ṡ = ẋ·c and ċ = −ẋ·s.
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let weighted = self.weighted();
        let mut sin = [T::zero(); N];
        let mut cos = [T::zero(); N];
        (sin[0], cos[0]) = self.0[0].sin_cos();
        for k in 1..N {
            let (mut sin_sum, mut cos_sum) = (T::EMPTY_SUM, T::EMPTY_SUM);
            for j in 1..k + 1 {
                sin_sum += weighted[j] * cos[k - j];
                cos_sum += weighted[j] * sin[k - j];
            }
            let per_k = T::RECIPROCAL[k];
            sin[k] = sin_sum * per_k;
            cos[k] = -cos_sum * per_k;
        }
        (Self(sin), Self(cos))
    }

    /// From (x² + y²)·θ̇ = x·ẏ − y·ẋ.
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let (dy, dx) = (self.weighted(), x.weighted());
        let norm = x.square() + self.square();
        let inverse = T::one() / norm.0[0];
        let mut theta = [T::zero(); N];
        let mut weighted = [T::zero(); N];
        theta[0] = self.0[0].atan2(x.0[0]);
        for k in 1..N {
            let mut sum = T::EMPTY_SUM;
            for j in 1..k + 1 {
                sum += x.0[k - j] * dy[j] - self.0[k - j] * dx[j];
            }
            for j in 1..k {
                sum -= weighted[j] * norm.0[k - j];
            }
            weighted[k] = sum * inverse;
            theta[k] = weighted[k] * T::RECIPROCAL[k];
        }
        Self(theta)
    }

    /// From ẏ = (1 − y²)·ẋ.
    #[inline]
    fn tanh(self) -> Self {
        let weighted = self.weighted();
        let mut y = [T::zero(); N];
        let mut slope = [T::zero(); N];
        y[0] = self.0[0].tanh();
        slope[0] = T::one() - y[0] * y[0];
        for k in 1..N {
            let mut sum = T::EMPTY_SUM;
            for j in 1..k + 1 {
                sum += weighted[j] * slope[k - j];
            }
            y[k] = sum * T::RECIPROCAL[k];
            let mut square = T::EMPTY_SUM;
            for j in 0..k + 1 {
                square += y[j] * y[k - j];
            }
            slope[k] = -square;
        }
        Self(y)
    }
}
