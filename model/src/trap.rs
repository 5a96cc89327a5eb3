//! A scalar that stops at the first invalid operation: f32 in every bit, except that an operation
//! that makes a NaN of numbers panics and names itself, its operands and its place (the backtrace
//! says how it came to it).
//!
//! For simulators and tests, behind the feature `trap`; a flight program is built without.
//! Infinities pass, as in IEEE 754's *invalid* exception: 1/0 is one, and 0 × ∞, ∞ − ∞, 0/0
//! and roots and logarithms below zero stop. So does a sine of what is beyond its range.

use core::cmp::Ordering;
use core::fmt::{self, Debug, Display};
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use crate::scalar::{Real, sealed::Sealed};

/// An f32 whose invalid operations panic.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Trapped(f32);

/// `result`, unless it is a NaN that none of the `operands` was.
#[track_caller]
fn valid(result: f32, operation: &str, operands: [f32; 2]) -> Trapped {
    let [a, b] = operands;
    assert!(!result.is_nan() || a.is_nan() || b.is_nan(), "invalid operation: {operation} of {a} and {b}");
    Trapped(result)
}

macro_rules! operation {
    ($trait:ident, $method:ident, $assign:ident, $assign_method:ident, $operator:tt) => {
        impl $trait for Trapped {
            type Output = Self;
            // A call: with its message in place a flight on this scalar took as long to build as the rest.
            #[inline(never)]
            #[track_caller]
            fn $method(self, other: Self) -> Self {
                valid(self.0 $operator other.0, stringify!($operator), [self.0, other.0])
            }
        }
        impl $assign for Trapped {
            #[inline]
            #[track_caller]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    };
}
operation!(Add, add, AddAssign, add_assign, +);
operation!(Sub, sub, SubAssign, sub_assign, -);
operation!(Mul, mul, MulAssign, mul_assign, *);
operation!(Div, div, DivAssign, div_assign, /);

impl Neg for Trapped {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl PartialOrd for Trapped {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Debug for Trapped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Debug::fmt(&self.0, f)
    }
}

impl Display for Trapped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.0, f)
    }
}

impl Zero for Trapped {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Trapped {
    fn one() -> Self {
        Self(1.0)
    }
}

const fn table(numbers: [f32; 8]) -> [Trapped; 8] {
    let [a, b, c, d, e, f, g, h] = numbers;
    [Trapped(a), Trapped(b), Trapped(c), Trapped(d), Trapped(e), Trapped(f), Trapped(g), Trapped(h)]
}

impl Sealed for Trapped {
    const EMPTY_SUM: Self = Self(<f32 as Sealed>::EMPTY_SUM);
    const WHOLE: [Self; 8] = table(<f32 as Sealed>::WHOLE);
    const RECIPROCAL: [Self; 8] = table(<f32 as Sealed>::RECIPROCAL);
    const FACTORIAL: [Self; 8] = table(<f32 as Sealed>::FACTORIAL);
    const PER_FACTORIAL: [Self; 8] = table(<f32 as Sealed>::PER_FACTORIAL);
    const ROUND_TO_WHOLE: Self = Self(<f32 as Sealed>::ROUND_TO_WHOLE);
    const HALF_ULP: Self = Self(<f32 as Sealed>::HALF_ULP);
}

impl Real for Trapped {
    fn lit(value: f64) -> Self {
        Self(f32::lit(value))
    }
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }
    fn abs(self) -> Self {
        Self(Real::abs(self.0))
    }
    #[track_caller]
    fn sqrt(self) -> Self {
        valid(Real::sqrt(self.0), "square root", [self.0; 2])
    }
    #[track_caller]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.0);
        (valid(sin, "sine", [self.0; 2]), valid(cos, "cosine", [self.0; 2]))
    }
    #[track_caller]
    fn atan2(self, x: Self) -> Self {
        valid(Real::atan2(self.0, x.0), "arc tangent", [self.0, x.0])
    }
    #[track_caller]
    fn exp(self) -> Self {
        valid(Real::exp(self.0), "exponential", [self.0; 2])
    }
    #[track_caller]
    fn ln(self) -> Self {
        valid(Real::ln(self.0), "logarithm", [self.0; 2])
    }
    #[track_caller]
    fn tanh(self) -> Self {
        valid(Real::tanh(self.0), "hyperbolic tangent", [self.0; 2])
    }
    #[track_caller]
    fn powf(self, exponent: Self) -> Self {
        valid(Real::powf(self.0, exponent.0), "power", [self.0, exponent.0])
    }
    fn is_finite(self) -> bool {
        Real::is_finite(self.0)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    fn trapped(operation: impl FnOnce() -> Trapped + std::panic::UnwindSafe) -> bool {
        std::panic::catch_unwind(operation).is_err()
    }

    #[test]
    fn what_ieee_754_calls_invalid_stops_and_nothing_else() {
        let [zero, one, inf, nan] = [0.0, 1.0, f32::INFINITY, f32::NAN].map(Trapped);
        assert!(trapped(|| zero / zero) && trapped(|| inf - inf) && trapped(|| zero * inf) && trapped(|| inf / inf));
        assert!(trapped(|| Real::sqrt(-one)) && trapped(|| Real::ln(-one)) && trapped(|| inf.sin_cos().0));
        assert!(
            !trapped(|| one / zero) && !trapped(|| inf + one) && !trapped(|| nan + one) && !trapped(|| zero * nan)
        );
        assert!(!trapped(|| Trapped(f32::MAX) * Trapped(f32::MAX)));
    }
}
