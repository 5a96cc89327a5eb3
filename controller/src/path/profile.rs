//! Speed and yaw profiles.

use crate::lift::PositionSeries;
use crate::path::{Located, SpeedProfile, YawProfile};
use crate::scalar::Real;
use crate::series::Series;

/// v_d constant, m/s along the curve's tangent; negative flies it the other way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantSpeed<T>(pub T);

impl<T: Real> SpeedProfile<T> for ConstantSpeed<T> {
    #[inline]
    fn speed(&self, _: &PositionSeries<T>, _: &Located<T>) -> Series<T, 6> {
        Series::constant(self.0)
    }
}

/// ψ_d constant, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedYaw<T>(pub T);

impl<T: Real> YawProfile<T> for FixedYaw<T> {
    #[inline]
    fn yaw(&self, _: &PositionSeries<T>, _: &Located<T>) -> Series<T, 3> {
        Series::constant(self.0)
    }
}
