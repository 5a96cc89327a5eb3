//! Forward-mode automatic differentiation: one trait for real numbers, dual numbers and truncated
//! Taylor series.
//!
//! The plant and the outputs of a path are written once over [`Scalar`]. With `f64` they are
//! numbers; with [`Dual`] they carry exact first derivatives along chosen directions; with
//! [`Taylor`] they carry the derivatives along a flow. The types nest, so `Taylor<Dual<4>, 7>`
//! holds the Lie derivatives L_f^k h for k ≤ 6 together with their derivatives L_g L_f^k h along
//! four input fields.
//!
//! This serves the simulator's plant and [`crate::law`] only. It shares nothing with the series of
//! the `controller` crate, whose results it is there to check.

mod dual;
mod taylor;

pub use dual::Dual;
pub use taylor::Taylor;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a formula may do with a number, whatever derivatives the number carries.
///
/// The functions are those of `f64` and mean the same; each is analytic wherever a formula is
/// differentiated.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// A constant: all derivatives are zero.
    fn constant(value: f64) -> Self;
    /// The number itself, without derivatives.
    fn value(&self) -> f64;
    /// Square root; the derivatives need a positive value.
    fn sqrt(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine, in this order.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Angle of the point (`x`, `self`) from the first axis, in (−π, π] at order zero.
    fn atan2(self, x: Self) -> Self;
    /// Real power, for a positive value.
    fn powf(self, exponent: f64) -> Self;

    /// Sine.
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine.
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Tangent.
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    /// Integer power, by squaring, so that a zero value keeps exact derivatives.
    fn powi(self, exponent: i32) -> Self {
        let mut result = Self::constant(1.0);
        let mut square = self;
        let mut bits = exponent.unsigned_abs();
        while bits > 0 {
            if bits & 1 == 1 {
                result = result * square;
            }
            bits >>= 1;
            if bits > 0 {
                square = square * square;
            }
        }
        if exponent < 0 { Self::constant(1.0) / result } else { result }
    }
}

impl Scalar for f64 {
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn value(&self) -> f64 {
        *self
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        f64::tanh(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline]
    fn powf(self, exponent: f64) -> Self {
        f64::powf(self, exponent)
    }
}

/// a · b.
#[inline]
pub fn dot<S: Scalar>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
#[inline]
pub fn cross<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a scaled by s.
#[inline]
pub fn scale<S: Scalar>(a: [S; 3], s: S) -> [S; 3] {
    a.map(|component| component * s)
}

/// a + b.
#[inline]
pub fn add<S: Scalar>(a: [S; 3], b: [S; 3]) -> [S; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The arithmetic with plain numbers that every differentiable type forwards in the same way.
macro_rules! arithmetic_with_f64 {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> Add<f64> for $type {
            type Output = Self;
            fn add(self, constant: f64) -> Self {
                self + Self::constant(constant)
            }
        }
        impl<$($generics)*> Sub<f64> for $type {
            type Output = Self;
            fn sub(self, constant: f64) -> Self {
                self + Self::constant(-constant)
            }
        }
        impl<$($generics)*> Mul<f64> for $type {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                self.map(|part| part * factor)
            }
        }
        impl<$($generics)*> Div<f64> for $type {
            type Output = Self;
            fn div(self, divisor: f64) -> Self {
                self.map(|part| part / divisor)
            }
        }
        impl<$($generics)*> Neg for $type {
            type Output = Self;
            fn neg(self) -> Self {
                self.map(|part| -part)
            }
        }
    };
}
use arithmetic_with_f64;

#[cfg(test)]
mod tests;
