//! What a curve answers: where the payload is with respect to it.

// As in series.rs: indices run over compile-time orders.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::{ConstantSpeed, FixedYaw, Profiled, SpeedProfile};

/// Where a payload is with respect to a curve, along its Taylor series.
#[derive(Clone, Copy, Debug)]
pub struct Located<T> {
    /// h1 and h2, orders 0 to 6.
    pub surfaces: [Series<T, 7>; 2],
    /// ∇h1 and ∇h2 now, in N.
    pub gradients: [Vector3<T>; 2],
    /// A vector along ρ in N, of any length, orders 0 to 5.
    pub along: [Series<T, 6>; 3],
    /// |`along`|, orders 0 to 5.
    pub length: Series<T, 6>,
    /// ρ·v, m/s, orders 0 to 5.
    pub speed: Series<T, 6>,
    /// 1 − (curvature · distance towards the centre of curvature) for curves with a nearest point,
    /// whose coordinates end where this reaches 0; 1 for the others.
    pub reach_margin: T,
}

impl<T: Real> Located<T> {
    /// From the functions, their gradients now, and a vector `along` the tangent.
    #[inline]
    pub fn new(
        surfaces: [Series<T, 7>; 2],
        gradients: [Vector3<T>; 2],
        along: [Series<T, 6>; 3],
        position: &PositionSeries<T>,
    ) -> Self {
        let length = norm_squared(&along).sqrt();
        let speed = dot(&along, &velocity(position)) / length;
        Self { surfaces, gradients, along, length, speed, reach_margin: T::one() }
    }

    /// ρ now, in N.
    #[inline]
    pub fn tangent(&self) -> Vector3<T> {
        now(&self.along) * (T::one() / self.length.value())
    }
}

/// A closed curve in space, as two functions that vanish on it. With a speed and a yaw it is a
/// [`Path`](crate::Path):
///
/// ```
/// use controller::{AlongTangent, Curve, Ellipse};
///
/// let path = Ellipse::new(5.0_f32, 4.0, -10.0, 0.3)?.at_speed(1.5)?.with_yaw(AlongTangent);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
pub trait Curve<T: Real> {
    /// Evaluates the curve's functions along `position`.
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T>;

    /// Looks for the point of the whole curve that is nearest to the payload at `position` (N, m),
    /// as far as one control period has time for: called once a period when a controller starts,
    /// until it is `true`. A curve that knows no nearest point has nothing to do.
    fn search(&mut self, _position: &Vector3<T>) -> bool {
        true
    }

    /// The curve at a constant `speed` (m/s along ρ, negative against it) with yaw 0.
    ///
    /// # Errors
    /// `speed` is out of its [range](crate::ranges::SPEED).
    fn at_speed(self, speed: T) -> Result<Profiled<Self, ConstantSpeed<T>, FixedYaw<T>>, OutOfRange<T>>
    where
        Self: Sized,
    {
        Ok(self.with_speed(ConstantSpeed::new(speed)?))
    }

    /// The curve at a `speed` that varies along it, with yaw 0.
    fn with_speed<S: SpeedProfile<T, Self>>(self, speed: S) -> Profiled<Self, S, FixedYaw<T>>
    where
        Self: Sized,
    {
        Profiled { curve: self, speed, yaw: FixedYaw::north() }
    }
}

/// A curve that knows how its tangent turns.
pub trait Curved<T: Real>: Curve<T> {
    /// The derivative of [`Located::along`] in its own direction, (D`along`)·`along`, at the
    /// position that was located last.
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3];

    /// κ², 1/m²: the squared curvature of the curve of constant (h1, h2) through the payload;
    /// κ = |a × a′|/|a|³ with a = `along`.
    #[inline]
    fn curvature_squared(&self, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 6> {
        let bend = cross(&located.along, &self.turning(position, located));
        let square = located.length.square();
        norm_squared(&bend) / (square.square() * square)
    }
}

/// v, m/s, from p.
#[inline]
pub(super) fn velocity<T: Real>(position: &PositionSeries<T>) -> [Series<T, 6>; 3] {
    let [x, y, z] = position;
    [x.differentiate(), y.differentiate(), z.differentiate()]
}

/// a·b.
#[inline(always)]
pub(super) fn dot<T: Real, const N: usize>(a: &[Series<T, N>; 3], b: &[Series<T, N>; 3]) -> Series<T, N> {
    let mut sum = Sum::empty();
    a.iter().zip(b).for_each(|(a, b)| sum.add_product(a, b));
    sum.0
}

/// |a|².
#[inline(always)]
pub(super) fn norm_squared<T: Real, const N: usize>(a: &[Series<T, N>; 3]) -> Series<T, N> {
    let mut sum = Sum::empty();
    a.iter().for_each(|a| sum.add_square(a));
    sum.0
}

/// A sum over the axes, one after the other, so that the numbers at work fit the registers.
pub(super) struct Sum<T, const N: usize>(pub(super) Series<T, N>);

impl<T: Real, const N: usize> Sum<T, N> {
    #[inline(always)]
    pub(super) fn empty() -> Self {
        Self(Series([T::EMPTY_SUM; N]))
    }

    /// Adds a·b.
    #[inline(always)]
    pub(super) fn add_product(&mut self, Series(a): &Series<T, N>, Series(b): &Series<T, N>) {
        for j in 0..N {
            for k in j..N {
                self.0.0[k] += a[k - j] * b[j];
            }
        }
    }

    /// Adds a², each product of two coefficients once.
    #[inline(always)]
    pub(super) fn add_square(&mut self, Series(a): &Series<T, N>) {
        for k in 0..N {
            for j in 0..k.div_ceil(2) {
                self.0.0[k] += (a[j] + a[j]) * a[k - j];
            }
            if k % 2 == 0 {
                self.0.0[k] += a[k / 2] * a[k / 2];
            }
        }
    }
}

/// a × b.
#[inline]
pub(super) fn cross<T: Real, const N: usize>(a: &[Series<T, N>; 3], b: &[Series<T, N>; 3]) -> [Series<T, N>; 3] {
    let ([a1, a2, a3], [b1, b2, b3]) = (*a, *b);
    [a2 * b3 - a3 * b2, a3 * b1 - a1 * b3, a1 * b2 - a2 * b1]
}

/// The value of a vector of series.
#[inline]
pub(super) fn now<T: Real, const N: usize>(a: &[Series<T, N>; 3]) -> Vector3<T> {
    let [x, y, z] = a;
    Vector3::new(x.value(), y.value(), z.value())
}
