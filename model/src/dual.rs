//! Dual numbers: a value with its derivatives in M directions (forward-mode automatic
//! differentiation).
//!
//! Over [`Series`](crate::series::Series), `Dual<Series<T, N>, 3>` carries a function of position
//! and its gradient, both along the payload's motion. Nested once more they carry second
//! derivatives.

// The product and quotient rules mix operators, as they should.
#![allow(clippy::suspicious_arithmetic_impl)]

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::analytic::Analytic;
use crate::scalar::Real;

/// A value and its derivatives in M directions.
///
/// ```
/// use model::{Series, variables};
///
/// // The gradient of x² y at (3, 2), of numbers: series of order 0.
/// let [x, y] = variables([3.0, 2.0].map(Series::<f64, 1>::constant));
/// let product = x * x * y;
/// assert_eq!(product.partials.map(|partial| partial.value()), [12.0, 9.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<A, const M: usize> {
    /// The value.
    pub value: A,
    /// Its derivatives, one per direction.
    pub partials: [A; M],
}

impl<A: Copy, const M: usize> Dual<A, M> {
    /// g(self), from g and g′ at the value.
    #[inline]
    fn chain(self, value: A, slope: A) -> Self
    where
        A: Mul<Output = A>,
    {
        Self { value, partials: self.partials.map(|partial| partial * slope) }
    }

    /// The partials of both, combined one by one.
    #[inline]
    fn zip(self, other: Self, value: A, combine: impl Fn(A, A) -> A) -> Self {
        let mut partials = self.partials;
        for (partial, other) in partials.iter_mut().zip(other.partials) {
            *partial = combine(*partial, other);
        }
        Self { value, partials }
    }
}

/// The coordinates of `point`, each the variable of its own direction: a function of them has its
/// gradient as partials.
#[inline]
pub fn variables<T: Real, A: Analytic<T>, const M: usize>(point: [A; M]) -> [Dual<A, M>; M] {
    let mut coordinate = 0;
    point.map(|value| {
        let own = coordinate;
        coordinate += 1;
        Dual { value, partials: from_fn(|i| A::constant(if i == own { T::one() } else { T::zero() })) }
    })
}

impl<A: Copy + Add<Output = A>, const M: usize> Add for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl<A: Copy + Sub<Output = A>, const M: usize> Sub for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl<A: Copy + Neg<Output = A>, const M: usize> Neg for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { value: -self.value, partials: self.partials.map(|partial| -partial) }
    }
}

impl<A: Copy + Add<Output = A> + Mul<Output = A>, const M: usize> Mul for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| a * other.value + self.value * b)
    }
}

impl<A: Copy + Sub<Output = A> + Mul<Output = A> + Div<Output = A>, const M: usize> Div for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.value / other.value;
        self.zip(other, quotient, |a, b| (a - quotient * b) / other.value)
    }
}

impl<T: Real, A: Analytic<T>, const M: usize> Add<T> for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn add(self, constant: T) -> Self {
        Self { value: self.value + constant, ..self }
    }
}

impl<T: Real, A: Analytic<T>, const M: usize> Sub<T> for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn sub(self, constant: T) -> Self {
        Self { value: self.value - constant, ..self }
    }
}

impl<T: Real, A: Analytic<T>, const M: usize> Mul<T> for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn mul(self, constant: T) -> Self {
        Self { value: self.value * constant, partials: self.partials.map(|partial| partial * constant) }
    }
}

impl<T: Real, A: Analytic<T>, const M: usize> Div<T> for Dual<A, M> {
    type Output = Self;
    #[inline]
    fn div(self, constant: T) -> Self {
        self * (T::one() / constant)
    }
}

impl<T: Real, A: Analytic<T>, const M: usize> Analytic<T> for Dual<A, M> {
    #[inline]
    fn constant(value: T) -> Self {
        Self { value: A::constant(value), partials: [A::constant(T::zero()); M] }
    }
    #[inline]
    fn square(self) -> Self {
        self.chain(self.value.square(), self.value + self.value)
    }
    #[inline]
    fn recip(self) -> Self {
        let value = self.value.recip();
        self.chain(value, -value.square())
    }
    #[inline]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, value.recip() * T::lit(0.5))
    }
    #[inline]
    fn powf(self, exponent: T) -> Self {
        let below = self.value.powf(exponent - T::one());
        self.chain(below * self.value, below * exponent)
    }
    #[inline]
    fn powi(self, exponent: i32) -> Self {
        if exponent == 0 {
            return Self::constant(T::one());
        }
        let below = self.value.powi(exponent.saturating_sub(1));
        self.chain(below * self.value, below * T::lit(f64::from(exponent)))
    }
    #[inline]
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), self.value.recip())
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let per_norm = (self.value.square() + x.value.square()).recip();
        let (along_y, along_x) = (x.value * per_norm, self.value * per_norm);
        self.zip(x, self.value.atan2(x.value), |dy, dx| dy * along_y - dx * along_x)
    }
    #[inline]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, -value.square() + T::one())
    }
}

/// The scalar on the left, as on the right; see the same of [`Series`](crate::Series).
macro_rules! scalar_on_the_left {
    ($($real:ty),*) => {$(
        impl<A: Analytic<$real>, const M: usize> Add<Dual<A, M>> for $real {
            type Output = Dual<A, M>;
            #[inline]
            fn add(self, dual: Dual<A, M>) -> Dual<A, M> {
                dual + self
            }
        }
        impl<A: Analytic<$real>, const M: usize> Sub<Dual<A, M>> for $real {
            type Output = Dual<A, M>;
            #[inline]
            fn sub(self, dual: Dual<A, M>) -> Dual<A, M> {
                -dual + self
            }
        }
        impl<A: Analytic<$real>, const M: usize> Mul<Dual<A, M>> for $real {
            type Output = Dual<A, M>;
            #[inline]
            fn mul(self, dual: Dual<A, M>) -> Dual<A, M> {
                dual * self
            }
        }
    )*};
}
scalar_on_the_left!(f32, f64);
