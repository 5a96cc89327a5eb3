//! Yaws prescribed along a curve.

use model::{Analytic, OutOfRange, Real, Series};

use crate::path::Located;
use crate::path::PositionSeries;
use crate::ranges::YAW;

/// The yaw ψ_d prescribed along a curve, as a function of position.
///
/// A yaw is defined modulo 2π: any representative will do. A jump of 2π between two samples has no
/// effect in flight, and does not appear in the derivatives.
pub trait YawProfile<T: Real> {
    /// ψ_d, rad, orders 0 to 2.
    fn yaw(&self, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 3>;
}

/// ψ_d constant, rad.
///
/// ```
/// use controller::{Circle, Curve, FixedYaw};
///
/// // Nose to the east.
/// let east = FixedYaw::new(core::f32::consts::FRAC_PI_2)?;
/// let path = Circle::new(5.0_f32, -10.0)?.at_speed(1.0)?.with_yaw(east);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedYaw<T>(T);

impl<T: Real> FixedYaw<T> {
    /// `yaw`, rad.
    ///
    /// # Errors
    /// It is out of its [range](crate::ranges::YAW).
    pub fn new(yaw: T) -> Result<Self, OutOfRange<T>> {
        YAW.check(yaw)?;
        Ok(Self(yaw))
    }

    /// 0: b1 along n1.
    #[must_use]
    pub fn north() -> Self {
        Self(T::zero())
    }
}

impl<T: Real> YawProfile<T> for FixedYaw<T> {
    #[inline]
    fn yaw(&self, _: &PositionSeries<T>, _: &Located<T>) -> Series<T, 3> {
        Series::constant(self.0)
    }
}

/// ψ_d = atan2(ρ2, ρ1): b1 along the tangent's horizontal part. Not defined where the tangent is
/// vertical.
///
/// ```
/// use controller::{AlongTangent, Circle, Curve};
///
/// let path = Circle::new(5.0_f32, -10.0)?.at_speed(1.0)?.with_yaw(AlongTangent);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongTangent;

impl<T: Real> YawProfile<T> for AlongTangent {
    #[inline]
    fn yaw(&self, _: &PositionSeries<T>, located: &Located<T>) -> Series<T, 3> {
        let [x, y, _] = &located.along;
        y.truncate().atan2(x.truncate())
    }
}
