//! Functions of position, for speeds and yaws.

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::{Formula, Located, SpeedProfile, YawProfile};
use crate::ranges::{LINEAR_GRADIENT, LINEAR_VALUE, POINTING};

/// A function of position given as a formula. In a [`Formula`] it is a [`SpeedProfile`] (in m/s)
/// and a [`YawProfile`] (in rad).
///
/// ```
/// use controller::{Analytic, Circle, Curve, Formula, ScalarField};
///
/// /// 1 m/s, and up to twice as fast in the north.
/// struct Faster;
///
/// impl ScalarField<f32> for Faster {
///     fn at<A: Analytic<f32>>(&self, [x, _, _]: [A; 3]) -> A {
///         (x / 5.0).tanh() * 0.5 + 1.5
///     }
/// }
///
/// let path = Circle::new(5.0_f32, -10.0)?.with_speed(Formula(Faster));
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
pub trait ScalarField<T: Real> {
    /// The value at the point p (N, m).
    fn at<A: Analytic<T>>(&self, p: [A; 3]) -> A;
}

impl<T: Real, C, F: ScalarField<T>> SpeedProfile<T, C> for Formula<F> {
    #[inline]
    fn speed(&self, _: &C, position: &PositionSeries<T>, _: &Located<T>) -> Series<T, 6> {
        self.0.at(position.map(|coordinate| coordinate.truncate::<6>()))
    }
}

impl<T: Real, F: ScalarField<T>> YawProfile<T> for Formula<F> {
    #[inline]
    fn yaw(&self, position: &PositionSeries<T>, _: &Located<T>) -> Series<T, 3> {
        self.0.at(position.map(|coordinate| coordinate.truncate::<3>()))
    }
}

/// `value` at the origin, and from there a constant `gradient` (per m, in N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<T> {
    value: T,
    gradient: Vector3<T>,
}

impl<T: Real> Linear<T> {
    /// `value` at p = 0, and its change per metre along n1, n2, n3.
    ///
    /// # Errors
    /// A number is out of its range, [`LINEAR_VALUE`](crate::ranges::LINEAR_VALUE) or
    /// [`LINEAR_GRADIENT`](crate::ranges::LINEAR_GRADIENT).
    pub fn new(value: T, gradient: Vector3<T>) -> Result<Self, OutOfRange<T>> {
        LINEAR_VALUE.check(value)?;
        for &component in &gradient {
            LINEAR_GRADIENT.check(component)?;
        }
        Ok(Self { value, gradient })
    }
}

impl<T: Real> ScalarField<T> for Linear<T> {
    #[inline]
    fn at<A: Analytic<T>>(&self, [x, y, z]: [A; 3]) -> A {
        let g = &self.gradient;
        x * g.x + y * g.y + z * g.z + self.value
    }
}

/// atan2(y − p2, x − p1), rad: as a yaw, b1 points towards a vertical line. Not defined on that
/// line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointingAt<T> {
    x: T,
    y: T,
}

impl<T: Real> PointingAt<T> {
    /// The line through p1 = `x`, p2 = `y`, m.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges::POINTING).
    pub fn new(x: T, y: T) -> Result<Self, OutOfRange<T>> {
        for (range, place) in POINTING.iter().zip([x, y]) {
            range.check(place)?;
        }
        Ok(Self { x, y })
    }
}

impl<T: Real> ScalarField<T> for PointingAt<T> {
    #[inline]
    fn at<A: Analytic<T>>(&self, [x, y, _]: [A; 3]) -> A {
        (-y + self.y).atan2(-x + self.x)
    }
}
