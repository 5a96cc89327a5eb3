//! Formulas over the controller's numbers: series and dual numbers in `f32` and `f64`.

use super::{Formula, Number};
use controller::Analytic;
use controller::Real;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A controller's number `A` over the scalar `T`, as formulas take it.
struct Over<T, A>(A, PhantomData<T>);

impl Formula {
    /// [`evaluate`](Self::evaluate) over the controller's numbers; constants are rounded to `T`.
    pub fn evaluate_analytic<T: Real, A: Analytic<T>>(&self, position: [A; 3]) -> A {
        self.evaluate(position.map(over)).0
    }
}

fn over<T: Real, A: Analytic<T>>(number: A) -> Over<T, A> {
    Over(number, PhantomData)
}

impl<T, A: Copy> Copy for Over<T, A> {}
impl<T, A: Copy> Clone for Over<T, A> {
    fn clone(&self) -> Self {
        *self
    }
}

macro_rules! forward {
    ($($operator:ident $method:ident),*) => {$(
        impl<T: Real, A: Analytic<T>> $operator for Over<T, A> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                over(self.0.$method(other.0))
            }
        }
    )*};
}
forward!(Add add, Sub sub, Mul mul, Div div);

impl<T: Real, A: Analytic<T>> Neg for Over<T, A> {
    type Output = Self;
    fn neg(self) -> Self {
        over(-self.0)
    }
}

impl<T: Real, A: Analytic<T>> Number for Over<T, A> {
    fn constant(value: f64) -> Self {
        over(A::constant(T::lit(value)))
    }
    fn scale(self, factor: f64) -> Self {
        over(self.0 * T::lit(factor))
    }
    fn offset(self, constant: f64) -> Self {
        over(self.0 + T::lit(constant))
    }
    fn powi(self, exponent: i32) -> Self {
        over(self.0.powi(exponent))
    }
    fn powf(self, exponent: f64) -> Self {
        over(self.0.powf(T::lit(exponent)))
    }
    fn sqrt(self) -> Self {
        over(self.0.sqrt())
    }
    fn exp(self) -> Self {
        over(self.0.exp())
    }
    fn ln(self) -> Self {
        over(self.0.ln())
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (over(sin), over(cos))
    }
    fn tanh(self) -> Self {
        over(self.0.tanh())
    }
    fn atan2(self, x: Self) -> Self {
        over(self.0.atan2(x.0))
    }
}
