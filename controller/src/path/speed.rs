//! Speeds prescribed along a curve.

use model::{Analytic, OutOfRange, Real, Series};

use crate::path::PositionSeries;
use crate::path::{Curved, Located};
use crate::ranges::{CENTRIPETAL, SPEED};

/// The speed v_d prescribed along a curve `C`, as a function of position.
pub trait SpeedProfile<T: Real, C> {
    /// v_d, m/s along ρ (negative: against it), orders 0 to 5, where `curve` has just `located` the
    /// payload.
    fn speed(&self, curve: &C, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 6>;
}

/// v_d constant, m/s along ρ; negative flies it the other way.
///
/// ```
/// use controller::{Circle, ConstantSpeed, Curve};
///
/// let path = Circle::new(5.0_f32, -10.0)?.with_speed(ConstantSpeed::new(1.5)?);
/// assert!(ConstantSpeed::new(f32::NAN).is_err());
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed<T>(T);

impl<T: Real> ConstantSpeed<T> {
    /// `speed`, m/s.
    ///
    /// # Errors
    /// It is out of its [range](crate::ranges::SPEED).
    pub fn new(speed: T) -> Result<Self, OutOfRange<T>> {
        SPEED.check(speed)?;
        Ok(Self(speed))
    }
}

impl<T: Real, C> SpeedProfile<T, C> for ConstantSpeed<T> {
    #[inline]
    fn speed(&self, _: &C, _: &PositionSeries<T>, _: &Located<T>) -> Series<T, 6> {
        Series::constant(self.0)
    }
}

/// Slower where the curve bends, so that the centripetal acceleration κ v² stays below a bound a
/// (15.6):
///
/// ```text
/// v_d = v0 (1 + (κ v0²/a)²)^(−1/4)
/// ```
///
/// Smooth, equal to v0 on a straight piece, and √(a/κ) where v0 would be much too fast.
///
/// ```
/// use controller::{Curve, CurvatureLimited, Ellipse};
///
/// // 3 m/s on the straighter sides, at most 1 m/s² towards the centre in the bends.
/// let path = Ellipse::new(8.0_f32, 3.0, -10.0, 0.0)?.with_speed(CurvatureLimited::new(3.0, 1.0)?);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureLimited<T> {
    speed: T,
    /// (v0²/a)², m².
    radius_squared: T,
}

impl<T: Real> CurvatureLimited<T> {
    /// At most `speed` (m/s, negative flies the other way) and `acceleration` (m/s²).
    ///
    /// # Errors
    /// One of them is out of its range, [`SPEED`](crate::ranges::SPEED) or
    /// [`CENTRIPETAL`](crate::ranges::CENTRIPETAL).
    pub fn new(speed: T, acceleration: T) -> Result<Self, OutOfRange<T>> {
        SPEED.check(speed)?;
        CENTRIPETAL.check(acceleration)?;
        let radius = speed * speed / acceleration;
        Ok(Self { speed, radius_squared: radius * radius })
    }
}

impl<T: Real, C: Curved<T>> SpeedProfile<T, C> for CurvatureLimited<T> {
    #[inline]
    fn speed(&self, curve: &C, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 6> {
        let excess = curve.curvature_squared(position, located) * self.radius_squared;
        (excess + T::one()).sqrt().rsqrt() * self.speed
    }
}
