//! Truncated Taylor series in one variable, over any scalar.

use super::{Scalar, arithmetic_with_f64};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// x(t) = Σ c\[k\] tᵏ + O(t^N), so that c\[k\] = x⁽ᵏ⁾(0)/k!.
///
/// Each function is obtained from the differential equation it satisfies, one coefficient at a time
/// (A. Griewank and A. Walther, *Evaluating Derivatives*, SIAM 2008, chapter 13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor<S, const N: usize> {
    /// Coefficients, lowest order first.
    pub c: [S; N],
}

/// An order or an index as a factor; orders here are below ten.
fn factor(k: usize) -> f64 {
    k as f64
}

impl<S: Scalar, const N: usize> Taylor<S, N> {
    /// A series with the given value and no higher terms.
    pub fn at(value: S) -> Self {
        let mut c = [S::constant(0.0); N];
        c[0] = value;
        Self { c }
    }

    fn map(self, f: impl Fn(S) -> S) -> Self {
        Self { c: self.c.map(f) }
    }

    /// The series q with q · other = self.
    fn quotient(self, other: Self) -> Self {
        let mut c = [S::constant(0.0); N];
        for k in 0..N {
            let known = (0..k).fold(self.c[k], |sum, j| sum - c[j] * other.c[k - j]);
            c[k] = known / other.c[0];
        }
        Self { c }
    }

    /// Σ j·a\[j\]·b\[k−j\] for j from 1 to k: k times the k-th coefficient of ∫ ȧ b.
    fn convolve_derivative(a: &[S; N], b: &[S; N], k: usize) -> S {
        (1..=k).fold(S::constant(0.0), |sum, j| sum + a[j] * b[k - j] * factor(j))
    }
}

impl<S: Scalar, const N: usize> Add for Taylor<S, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { c: std::array::from_fn(|k| self.c[k] + other.c[k]) }
    }
}

impl<S: Scalar, const N: usize> Sub for Taylor<S, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { c: std::array::from_fn(|k| self.c[k] - other.c[k]) }
    }
}

impl<S: Scalar, const N: usize> Mul for Taylor<S, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { c: std::array::from_fn(|k| (0..=k).fold(S::constant(0.0), |sum, j| sum + self.c[j] * other.c[k - j])) }
    }
}

impl<S: Scalar, const N: usize> Div for Taylor<S, N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}

arithmetic_with_f64!([S: Scalar, const N: usize] Taylor<S, N>);

impl<S: Scalar, const N: usize> Scalar for Taylor<S, N> {
    fn constant(value: f64) -> Self {
        Self::at(S::constant(value))
    }

    fn value(&self) -> f64 {
        self.c[0].value()
    }

    /// y² = x.
    fn sqrt(self) -> Self {
        let mut c = [S::constant(0.0); N];
        c[0] = self.c[0].sqrt();
        for k in 1..N {
            let known = (1..k).fold(self.c[k], |sum, j| sum - c[j] * c[k - j]);
            c[k] = known / (c[0] * 2.0);
        }
        Self { c }
    }

    /// ẏ = ẋ y.
    fn exp(self) -> Self {
        let mut c = [S::constant(0.0); N];
        c[0] = self.c[0].exp();
        for k in 1..N {
            c[k] = Self::convolve_derivative(&self.c, &c, k) / factor(k);
        }
        Self { c }
    }

    /// x ẏ = ẋ.
    fn ln(self) -> Self {
        let mut c = [S::constant(0.0); N];
        c[0] = self.c[0].ln();
        for k in 1..N {
            let known = (1..k).fold(self.c[k] * factor(k), |sum, j| sum - c[j] * self.c[k - j] * factor(j));
            c[k] = known / (self.c[0] * factor(k));
        }
        Self { c }
    }

    /// ṡ = ẋ c, ċ = −ẋ s.
    fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = ([S::constant(0.0); N], [S::constant(0.0); N]);
        (sin[0], cos[0]) = self.c[0].sin_cos();
        for k in 1..N {
            sin[k] = Self::convolve_derivative(&self.c, &cos, k) / factor(k);
            cos[k] = -Self::convolve_derivative(&self.c, &sin, k) / factor(k);
        }
        (Self { c: sin }, Self { c: cos })
    }

    /// ẏ = ẋ (1 − y²).
    fn tanh(self) -> Self {
        let mut c = [S::constant(0.0); N];
        let mut slope = c;
        c[0] = self.c[0].tanh();
        slope[0] = -(c[0] * c[0]) + 1.0;
        for k in 1..N {
            c[k] = Self::convolve_derivative(&self.c, &slope, k) / factor(k);
            slope[k] = -(0..=k).fold(S::constant(0.0), |sum, j| sum + c[j] * c[k - j]);
        }
        Self { c }
    }

    /// (x² + y²) θ̇ = x ẏ − y ẋ.
    fn atan2(self, x: Self) -> Self {
        let y = self;
        let square = x * x + y * y;
        let mut c = [S::constant(0.0); N];
        c[0] = y.c[0].atan2(x.c[0]);
        for k in 1..N {
            let torque = Self::convolve_derivative(&y.c, &x.c, k) - Self::convolve_derivative(&x.c, &y.c, k);
            let known = (1..k).fold(torque, |sum, j| sum - c[j] * square.c[k - j] * factor(j));
            c[k] = known / (square.c[0] * factor(k));
        }
        Self { c }
    }

    /// x ẏ = a ẋ y.
    fn powf(self, exponent: f64) -> Self {
        let mut c = [S::constant(0.0); N];
        c[0] = self.c[0].powf(exponent);
        for k in 1..N {
            let sum = (1..=k)
                .fold(S::constant(0.0), |sum, j| sum + self.c[j] * c[k - j] * (exponent * factor(j) - factor(k - j)));
            c[k] = sum / (self.c[0] * factor(k));
        }
        Self { c }
    }
}
