//! An ellipse seen from above, on a plane that is inclined along n1.

use model::{Analytic, OutOfRange, Real, Series};

use crate::path::PositionSeries;
use crate::path::draped;
use crate::path::{Curve, Curved, Located};
use crate::ranges::{HALF_AXIS_A, HALF_AXIS_B, HEIGHT, SLOPE};

/// h1 = (p1/a)² + (p2/b)² − 1, h2 = p3 − c0 − c1 p1, both along (3.2): seen from above (n3
/// down), ρ turns from n2 to n1.
///
/// ```
/// use controller::{AlongTangent, Curve, Ellipse};
///
/// // Half-axes of 6 m and 4 m, 10 m up, sloping by 0.3 m a metre north; nose along it.
/// let path = Ellipse::new(6.0_f32, 4.0, -10.0, 0.3)?.at_speed(1.5)?.with_yaw(AlongTangent);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse<T> {
    per_a: T,
    per_b: T,
    c0: T,
    c1: T,
}

impl<T: Real> Ellipse<T> {
    /// Half-axes `a` and `b` 0.01 to 10⁵ m; height `c0` m, |c0| ≤ 10⁵; slope |c1| ≤ 100.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges).
    pub fn new(a: T, b: T, c0: T, c1: T) -> Result<Self, OutOfRange<T>> {
        HALF_AXIS_A.check(a)?;
        HALF_AXIS_B.check(b)?;
        HEIGHT.check(c0)?;
        SLOPE.check(c1)?;
        Ok(Self { per_a: T::one() / a, per_b: T::one() / b, c0, c1 })
    }
}

impl<T: Real> Curve<T> for Ellipse<T> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [p1, p2, p3] = *position;
        let (x, y) = (p1 * self.per_a, p2 * self.per_b);
        let h1 = x.square() + y.square() - T::one();
        let h2 = p3 - p1 * self.c1 - self.c0;
        let f1 = x.truncate() * (self.per_a + self.per_a);
        let f2 = y.truncate() * (self.per_b + self.per_b);
        draped::locate([h1, h2], [f1, f2], |c| c * self.c1, self.c1, position)
    }
}

impl<T: Real> Curved<T> for Ellipse<T> {
    #[inline]
    fn turning(&self, _: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let [u1, u2, _] = located.along;
        let two = T::lit(2.0);
        let f1 = u1 * (two * self.per_a * self.per_a);
        let f2 = u2 * (two * self.per_b * self.per_b);
        [f2, -f1, f2 * self.c1]
    }
}
