//! Curves and profiles given as formulas.

use model::{Analytic, Dual, Real, Series, variables};

use crate::path::PositionSeries;
use crate::path::curve::{cross, now};
use crate::path::{Curve, Curved, Located};

/// A curve as the common zero of two formulas; it runs along (3.2), so exchanging them turns it
/// round. In a [`Formula`] it is a [`Curve`] with [curvature](Curved): gradients and their
/// derivatives come from dual numbers over series.
///
/// ```
/// use controller::{Analytic, Curve, Formula, Implicit};
///
/// /// A rounded square of side 2 m, 3 m above the origin, with one side raised.
/// struct Ramp;
///
/// impl Implicit<f32> for Ramp {
///     fn surfaces<A: Analytic<f32>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
///         [x.powi(4) + y.powi(4) - 1.0, z + (x * 0.5).tanh() + 3.0]
///     }
/// }
///
/// let path = Formula(Ramp).at_speed(0.5)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
pub trait Implicit<T: Real> {
    /// h1 and h2 at the point p (N, m).
    fn surfaces<A: Analytic<T>>(&self, p: [A; 3]) -> [A; 2];
}

/// A formula as a curve ([`Implicit`]) or as a profile ([`ScalarField`](crate::path::ScalarField)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula<F>(pub F);

/// The part of a gradient that a tangent needs.
#[inline]
fn truncated<T: Real>(gradient: [Series<T, 7>; 3]) -> [Series<T, 6>; 3] {
    gradient.map(|partial| partial.truncate())
}

impl<T: Real, I: Implicit<T>> Curve<T> for Formula<I> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [h1, h2]: [Dual<_, 3>; 2] = self.0.surfaces(variables(*position));
        let gradients = [now(&h1.partials), now(&h2.partials)];
        let along = cross(&truncated(h1.partials), &truncated(h2.partials));
        Located::new([h1.value, h2.value], gradients, along, position)
    }
}

impl<T: Real, I: Implicit<T>> Curved<T> for Formula<I> {
    /// (D(∇h1 × ∇h2))·u with u = ∇h1 × ∇h2: each gradient carries its own derivative along u.
    #[inline]
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let ([x, y, z], [u1, u2, u3]) = (*position, located.along);
        let moving = |p: Series<T, 7>, u| Dual { value: p.truncate::<6>(), partials: [u] };
        let [h1, h2]: [Dual<Dual<_, 1>, 3>; 2] =
            self.0.surfaces(variables([moving(x, u1), moving(y, u2), moving(z, u3)]));
        let values = |h: &Dual<Dual<Series<T, 6>, 1>, 3>| h.partials.map(|partial| partial.value);
        let derivatives = |h: &Dual<Dual<Series<T, 6>, 1>, 3>| {
            h.partials.map(|partial| {
                let [derivative] = partial.partials;
                derivative
            })
        };
        let [a1, a2, a3] = cross(&derivatives(&h1), &values(&h2));
        let [b1, b2, b3] = cross(&values(&h1), &derivatives(&h2));
        [a1 + b1, a2 + b2, a3 + b3]
    }
}
