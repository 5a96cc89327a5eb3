//! A rounded rectangle seen from above, on a wave.

use model::{Analytic, OutOfRange, Real, Series};

use crate::path::PositionSeries;
use crate::path::draped;
use crate::path::{Curve, Curved, Located};
use crate::ranges::{BENT_HALF_AXIS_A, BENT_HALF_AXIS_B, HEIGHT};

/// h1 = (p1/a)⁴ + (p2/b)⁴ − 1, h2 = p3 − c0 − A sin(k p1) with A = 0.5 m and k = 0.5 rad/m,
/// along (3.2).
///
/// ```
/// use controller::{Bent, Curve};
///
/// let path = Bent::new(5.0_f32, 4.0, -10.0)?.at_speed(1.5)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent<T> {
    per_a: T,
    per_b: T,
    c0: T,
}

/// A, m.
const AMPLITUDE: f64 = 0.5;
/// k, rad/m.
const WAVENUMBER: f64 = 0.5;

impl<T: Real> Bent<T> {
    /// Half-axes `a` and `b` 0.01 to 1000 m; height `c0` m, |c0| ≤ 10⁵.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges).
    pub fn new(a: T, b: T, c0: T) -> Result<Self, OutOfRange<T>> {
        BENT_HALF_AXIS_A.check(a)?;
        BENT_HALF_AXIS_B.check(b)?;
        HEIGHT.check(c0)?;
        Ok(Self { per_a: T::one() / a, per_b: T::one() / b, c0 })
    }
}

impl<T: Real> Curve<T> for Bent<T> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [p1, p2, p3] = *position;
        let four = T::lit(4.0);
        let (x, y) = (p1 * self.per_a, p2 * self.per_b);
        let (x_2, y_2) = (x.square(), y.square());
        let (sin, cos) = (p1 * T::lit(WAVENUMBER)).sin_cos();
        let h1 = x_2.square() + y_2.square() - T::one();
        let h2 = p3 - sin * T::lit(AMPLITUDE) - self.c0;
        let f1 = x_2.truncate() * (x.truncate::<6>() * (four * self.per_a));
        let f2 = y_2.truncate() * (y.truncate::<6>() * (four * self.per_b));
        let slope = cos.truncate::<6>() * T::lit(AMPLITUDE * WAVENUMBER);
        draped::locate([h1, h2], [f1, f2], |c| c * slope, slope.value(), position)
    }
}

impl<T: Real> Curved<T> for Bent<T> {
    #[inline]
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let [p1, p2, _] = position.map(|coordinate| coordinate.truncate::<6>());
        let [u1, u2, _] = located.along;
        let [f2, ..] = located.along;
        let second = |p: Series<T, 6>, per: T| (p * per).square() * (T::lit(12.0) * per * per);
        let f1_along = second(p1, self.per_a) * u1;
        let f2_along = second(p2, self.per_b) * u2;
        let (sin, cos) = (p1 * T::lit(WAVENUMBER)).sin_cos();
        let slope = cos * T::lit(AMPLITUDE * WAVENUMBER);
        let slope_along = sin * u1 * T::lit(-AMPLITUDE * WAVENUMBER * WAVENUMBER);
        [f2_along, -f1_along, f2_along * slope + f2 * slope_along]
    }
}
