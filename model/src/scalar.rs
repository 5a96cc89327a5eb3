//! The scalar of the law: `f32` on the target, `f64` as the reference.
//!
//! Every square root and transcendental goes through [`Real`], and from there to code whose result
//! does not depend on the platform (libm, the FPU's correctly rounded square root, and the sine
//! kernel below). Together with IEEE 754 arithmetic and no contraction into fused operations this
//! makes host and target agree bit for bit.

use core::fmt::{Debug, Display};
use core::ops::Neg;

use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};
use num_traits::{One, Zero};

pub(crate) mod sealed {
    /// Closes [`Real`](super::Real), and holds the whole numbers that series arithmetic needs: from
    /// a table, since an index turned into a number at run time would take double precision.
    pub trait Sealed: Sized {
        /// What a sum begins with: −0, which added to any number is that number, so that the
        /// addition is left out. 0 is not, since 0 + −0 = 0.
        const EMPTY_SUM: Self;
        /// 0 to 7.
        const WHOLE: [Self; 8];
        /// 1/k for k up to 7; 0 for 0.
        const RECIPROCAL: [Self; 8];
        /// k! for k up to 7.
        const FACTORIAL: [Self; 8];
        /// 1/k! for k up to 7.
        const PER_FACTORIAL: [Self; 8];
        /// 1.5 times two to the number of bits behind the point: added and taken away, it rounds to
        /// the nearest whole number.
        const ROUND_TO_WHOLE: Self;
        /// Half of the distance between the numbers just above one.
        const HALF_ULP: Self;
    }

    macro_rules! tables {
        ($real:ty) => {
            impl Sealed for $real {
                const EMPTY_SUM: Self = -0.0;
                const WHOLE: [Self; 8] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
                const RECIPROCAL: [Self; 8] = [0.0, 1.0, 0.5, 1.0 / 3.0, 0.25, 0.2, 1.0 / 6.0, 1.0 / 7.0];
                const FACTORIAL: [Self; 8] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0];
                const PER_FACTORIAL: [Self; 8] =
                    [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0];
                const ROUND_TO_WHOLE: Self = 1.5 / <$real>::EPSILON;
                const HALF_ULP: Self = <$real>::EPSILON / 2.0;
            }
        };
    }
    tables!(f32);
    tables!(f64);
}

/// A real number of the law: `f32` or `f64`. Sealed, since bit equality between platforms is
/// promised for these two.
pub trait Real:
    sealed::Sealed
    + Scalar
    + Copy
    + Default
    + Debug
    + Display
    + PartialOrd
    + Zero
    + One
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
    + Neg<Output = Self>
{
    /// The nearest value to a literal or a host-side `f64`. On the target use it with constants
    /// only: there it folds away.
    fn lit(value: f64) -> Self;
    /// The value as `f64`, exact. Host-side use: the target has no double precision unit.
    fn to_f64(self) -> f64;
    /// The value in another scalar, rounded to nearest. Host-side use.
    fn cast<U: Real>(self) -> U {
        U::lit(self.to_f64())
    }
    /// `|x|`.
    fn abs(self) -> Self;
    /// Square root, correctly rounded; NaN below zero.
    fn sqrt(self) -> Self;
    /// `(sin x, cos x)`, x in rad. In `f32`: absolute error ≤ 1.2e-7 for |x| ≤ 8192, NaN beyond.
    fn sin_cos(self) -> (Self, Self);
    /// Four-quadrant angle of the point (`x`, `self`), rad, in [−π, π]; 0 at the origin. In `f32`:
    /// absolute error ≤ 3e-7 for finite numbers with a finite sum.
    fn atan2(self, x: Self) -> Self;
    /// `eˣ`.
    fn exp(self) -> Self;
    /// Natural logarithm; NaN below zero.
    fn ln(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// `self` to a real power; NaN below zero, but for whole exponents.
    fn powf(self, exponent: Self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The larger of the two; `other` when `self` is NaN.
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// The smaller of the two; `other` when `self` is NaN.
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// `self` limited to [`low`, `high`]; `low` when `self` is NaN.
    #[inline]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
    /// The angle `self` − 2πk in (−π, π], to within the rounding of its turns. In `f32`: for up to
    /// 4 million of them.
    #[inline]
    fn wrap_angle(self) -> Self {
        // +π must stay and −π become +π, so the tie is rounded from just below.
        let turns = self * Self::lit(1.0 / core::f64::consts::TAU) - Self::HALF_ULP;
        let whole = (turns + Self::ROUND_TO_WHOLE) - Self::ROUND_TO_WHOLE;
        self - whole * Self::lit(core::f64::consts::TAU)
    }
}

impl Real for f32 {
    #[inline]
    fn lit(value: f64) -> Self {
        value as Self
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline]
    fn abs(self) -> Self {
        libm::fabsf(self)
    }
    #[inline]
    fn sqrt(self) -> Self {
        fpu::sqrt(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos_f32(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        atan2_f32(self, x)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::expf(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::logf(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanhf(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::powf(self, exponent)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
}

impl Real for f64 {
    #[inline]
    fn lit(value: f64) -> Self {
        value
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline]
    fn abs(self) -> Self {
        libm::fabs(self)
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
}

/// Sine and cosine in `f32` arithmetic alone.
///
/// libm's reduce and evaluate in f64, which a Cortex-M4F has to emulate (2,079 instructions a
/// pair). Here π/2 is subtracted in three parts whose products with a quadrant count below 2¹³ are
/// exact (Cody and Waite), and the polynomials on [−π/4, π/4] are those of the Cephes library's
/// `sinf` and `cosf`.
fn sin_cos_f32(x: f32) -> (f32, f32) {
    const RANGE: f32 = 8192.0;
    // The nearest integer then stands in the low bits of the sum.
    const ROUND: f32 = <f32 as sealed::Sealed>::ROUND_TO_WHOLE;
    const HALF_PI: [f32; 3] = [1.570_312_5, 4.837_513e-4, 7.549_79e-8];

    if !(-RANGE..=RANGE).contains(&x) {
        return (f32::NAN, f32::NAN);
    }
    let shifted = x * core::f32::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let n = shifted - ROUND;
    let r = ((x - n * HALF_PI[0]) - n * HALF_PI[1]) - n * HALF_PI[2];

    let z = r * r;
    let sin = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * r + r;
    let cos = ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * z * z - 0.5 * z + 1.0;
    // Odd quadrants exchange the two, and signs go − for sine in 2 and 3, for cosine in 1 and 2: no
    // branch.
    let (sin, cos) = if quadrant & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let negate = |value: f32, when: u32| f32::from_bits(value.to_bits() ^ (when & 2) << 30);
    (negate(sin, quadrant), negate(cos, quadrant.wrapping_add(1)))
}

/// Where libm's follows every special case of the standard, this is short: the angle from the
/// nearer axis or diagonal, at most π/8, by the polynomial of the Cephes library's `atanf`, then
/// back to its octant.
#[inline(never)]
fn atan2_f32(y: f32, x: f32) -> f32 {
    use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    const TAN_PI_8: f32 = 0.414_213_56;

    let (across, along) = (y.abs(), x.abs());
    let is_steep = across > along;
    let (short, long) = if is_steep { (along, across) } else { (across, along) };
    let (from, opposite, adjacent) =
        if short > TAN_PI_8 * long { (FRAC_PI_4, short - long, short + long) } else { (0.0, short, long) };
    let t = if adjacent == 0.0 { 0.0 } else { opposite / adjacent };
    let z = t * t;
    let angle = from + ((((8.053_744_5e-2 * z - 1.387_768_6e-1) * z + 1.997_771e-1) * z - 3.333_295e-1) * z * t + t);
    let angle = if is_steep { FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bound the documentation states: half an ulp of rounding the result, one of the
    /// polynomial, and the reduction.
    const SIN_COS_BOUND: f64 = 1.2e-7;
    /// An ulp of π for the rounding of π and of the result, and half of one for the rest.
    const ATAN2_BOUND: f64 = 3e-7;

    #[test]
    fn sine_and_cosine_keep_their_stated_error() {
        let mut worst = 0.0_f64;
        for i in -400_000_i32..=400_000 {
            // Uneven steps, so that the samples fall anywhere between the multiples of π/2.
            let x = i as f32 * 0.020_477_3;
            let (sin, cos) = x.sin_cos();
            let exact = f64::from(x);
            worst =
                worst.max((f64::from(sin) - libm::sin(exact)).abs()).max((f64::from(cos) - libm::cos(exact)).abs());
        }
        assert!(worst <= SIN_COS_BOUND, "{worst:e}");
    }

    #[test]
    fn angles_keep_their_stated_error() {
        let mut worst = 0.0_f64;
        for i in -200_000_i32..=200_000 {
            let angle = f64::from(i) * 1.6e-5;
            for radius in [1e-18, 0.3, 1.0, 7e5] {
                let (y, x) = ((radius * libm::sin(angle)) as f32, (radius * libm::cos(angle)) as f32);
                let exact = libm::atan2(f64::from(y), f64::from(x));
                worst = worst.max((f64::from(y.atan2(x)) - exact).abs());
            }
        }
        assert!(worst <= ATAN2_BOUND, "{worst:e}");
    }

    #[test]
    fn angles_on_the_axes_and_diagonals_are_exact() {
        use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
        for (y, x, angle) in [
            (0.0, 0.0, 0.0),
            (0.0, 2.0, 0.0),
            (2.0, 2.0, FRAC_PI_4),
            (2.0, 0.0, FRAC_PI_2),
            (0.0, -2.0, PI),
            (-2.0, 0.0, -FRAC_PI_2),
            (f32::MIN_POSITIVE, 0.0, FRAC_PI_2),
        ] {
            assert_eq!(Real::atan2(y, x), angle, "{y} {x}");
        }
        assert!(Real::atan2(f32::NAN, 1.0_f32).is_nan() && Real::atan2(1.0_f32, f32::NAN).is_nan());
    }

    #[test]
    fn sine_and_cosine_outside_their_range_are_nan() {
        for x in [8193.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            let (sin, cos) = Real::sin_cos(x);
            assert!(sin.is_nan() && cos.is_nan(), "{x}");
        }
    }

    #[test]
    fn angles_wrap_into_the_half_open_turn() {
        fn check<T: Real>(least: f64) {
            let pi = T::lit(core::f64::consts::PI);
            assert_eq!(pi.wrap_angle(), pi);
            assert_eq!((-pi).wrap_angle(), pi);
            for i in -3000..=3000 {
                let angle = T::lit(f64::from(i) * 0.01);
                let wrapped = angle.wrap_angle();
                assert!(wrapped > -pi - T::lit(least) && wrapped <= pi + T::lit(least), "{angle}: {wrapped}");
                let turns = (angle - wrapped).to_f64() / core::f64::consts::TAU;
                assert!((turns - libm::round(turns)).abs() < least, "{angle}: {wrapped}");
                assert!(turns != 0.0 || angle == wrapped, "{angle}: {wrapped}");
            }
            assert!(T::lit(f64::NAN).wrap_angle().to_f64().is_nan());
        }
        // Of the rounding of five turns.
        check::<f32>(2e-6);
        check::<f64>(4e-15);
    }
}
