//! A superellipse (Lamé's curve) seen from above, on a plane that is inclined along n1.

use model::{Analytic, OutOfRange, Real, Series};

use crate::path::PositionSeries;
use crate::path::draped;
use crate::path::{Curve, Curved, Located};
use crate::ranges::{HALF_AXIS_A, HALF_AXIS_B, HALF_EXPONENT, HEIGHT, SLOPE};

/// h1 = (p1/a)ⁿ + (p2/b)ⁿ − 1, h2 = p3 − c0 − c1 p1, n even, along (3.2) as the ellipse: n =
/// 2 is one, and the larger n, the closer to a rectangle with rounded corners.
///
/// ```
/// use controller::{Curve, Superellipse};
///
/// // A rounded rectangle of 12 m by 8 m, (p1/6)⁴ + (p2/4)⁴ = 1, level, 10 m up.
/// let path = Superellipse::new(6.0_f32, 4.0, 2, -10.0, 0.0)?.at_speed(1.0)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superellipse<T> {
    per_a: T,
    per_b: T,
    /// n.
    exponent: i32,
    /// n and n − 1 as numbers.
    factors: [T; 2],
    c0: T,
    c1: T,
}

impl<T: Real> Superellipse<T> {
    /// Half-axes `a` and `b` 0.01 to 10⁵ m; `half_exponent` n/2 1 to 10; height `c0` m, |c0| ≤ 10⁵;
    /// slope |c1| ≤ 100.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges).
    pub fn new(a: T, b: T, half_exponent: u8, c0: T, c1: T) -> Result<Self, OutOfRange<T>> {
        // By counting: a whole number is turned into one of any scalar without double precision.
        let half = (0..half_exponent).fold(T::zero(), |count, _| count + T::one());
        let n = half + half;
        HALF_AXIS_A.check(a)?;
        HALF_AXIS_B.check(b)?;
        HALF_EXPONENT.check(half)?;
        HEIGHT.check(c0)?;
        SLOPE.check(c1)?;
        Ok(Self {
            per_a: T::one() / a,
            per_b: T::one() / b,
            exponent: 2 * i32::from(half_exponent),
            factors: [n, n - T::one()],
            c0,
            c1,
        })
    }
}

impl<T: Real> Curve<T> for Superellipse<T> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [p1, p2, p3] = *position;
        let (x, y) = (p1 * self.per_a, p2 * self.per_b);
        let (x_below, y_below) = (x.powi(self.exponent - 1), y.powi(self.exponent - 1));
        let h1 = x_below * x + y_below * y - T::one();
        let h2 = p3 - p1 * self.c1 - self.c0;
        let [n, _] = self.factors;
        let f1 = x_below.truncate() * (n * self.per_a);
        let f2 = y_below.truncate() * (n * self.per_b);
        draped::locate([h1, h2], [f1, f2], |c| c * self.c1, self.c1, position)
    }
}

impl<T: Real> Curved<T> for Superellipse<T> {
    #[inline]
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let [p1, p2, _] = position;
        let [u1, u2, _] = located.along;
        let [n, m] = self.factors;
        let second =
            |p: &Series<T, 7>, per: T| (p.truncate::<6>() * per).powi(self.exponent - 2) * (n * m * per * per);
        let f1 = second(p1, self.per_a) * u1;
        let f2 = second(p2, self.per_b) * u2;
        [f2, -f1, f2 * self.c1]
    }
}
