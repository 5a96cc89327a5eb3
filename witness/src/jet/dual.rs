//! Dual numbers: a value and its first derivatives along N directions.

use super::{Scalar, arithmetic_with_f64};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// x + Σ εᵢ xᵢ with εᵢ εⱼ = 0: the value of an expression and its directional derivatives,
/// exact to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S, const N: usize> {
    /// The value.
    pub value: S,
    /// The derivative along each direction.
    pub parts: [S; N],
}

impl<S: Scalar, const N: usize> Dual<S, N> {
    /// The independent variable of one direction: derivative 1 along it, 0 along the others.
    pub fn variable(value: S, direction: usize) -> Self {
        let mut parts = [S::constant(0.0); N];
        parts[direction] = S::constant(1.0);
        Self { value, parts }
    }

    fn map(self, f: impl Fn(S) -> S) -> Self {
        Self { value: f(self.value), parts: self.parts.map(f) }
    }

    /// A function of this number, given its value and slope here (the chain rule).
    fn chain(self, value: S, slope: S) -> Self {
        Self { value, parts: self.parts.map(|part| part * slope) }
    }

    /// (a b)˙ = ȧ b + a ḃ.
    fn product(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| a * other.value + self.value * b)
    }

    /// (a/b)˙ = (ȧ − (a/b) ḃ)/b.
    fn quotient(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.zip(other, quotient, |a, b| (a - quotient * b) / other.value)
    }

    fn zip(self, other: Self, value: S, part: impl Fn(S, S) -> S) -> Self {
        Self { value, parts: std::array::from_fn(|i| part(self.parts[i], other.parts[i])) }
    }
}

impl<S: Scalar, const N: usize> Add for Dual<S, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl<S: Scalar, const N: usize> Sub for Dual<S, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl<S: Scalar, const N: usize> Mul for Dual<S, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl<S: Scalar, const N: usize> Div for Dual<S, N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.quotient(other)
    }
}

arithmetic_with_f64!([S: Scalar, const N: usize] Dual<S, N>);

impl<S: Scalar, const N: usize> Scalar for Dual<S, N> {
    fn constant(value: f64) -> Self {
        Self { value: S::constant(value), parts: [S::constant(0.0); N] }
    }

    fn value(&self) -> f64 {
        self.value.value()
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::constant(0.5) / root)
    }

    fn exp(self) -> Self {
        let exp = self.value.exp();
        self.chain(exp, exp)
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::constant(1.0) / self.value)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    fn tanh(self) -> Self {
        let tanh = self.value.tanh();
        self.chain(tanh, -(tanh * tanh) + 1.0)
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        self.zip(x, self.value.atan2(x.value), |dy, dx| (x.value * dy - self.value * dx) / square)
    }

    fn powf(self, exponent: f64) -> Self {
        let power = self.value.powf(exponent);
        self.chain(power, power * exponent / self.value)
    }
}
