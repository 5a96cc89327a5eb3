//! The paper's horizontal circle (15.7).

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::curve::velocity;
use crate::path::{Curve, Curved, Located};
use crate::ranges::{P3, RADIUS};

/// Circle of radius d1 about the n3 axis at height p3 = d2, with the paper's outputs (15.7):
///
/// ```text
/// h1 = p1² + p2² − d1²,   h2 = p3 − d2,   ρ = (−p2, p1, 0)/√(p1² + p2²)
/// ```
///
/// **h1 is in m², and ρ is the opposite of (3.2)**, both as printed: seen from above (n3 down), ρ
/// turns from n1 to n2.
///
/// ```
/// use controller::{Circle, Curve};
///
/// // 5 m radius, 10 m above the origin, 1 m/s from n1 to n2; at −1 m/s the other way round.
/// let path = Circle::new(5.0_f32, -10.0)?.at_speed(1.0)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle<T> {
    radius: T,
    p3: T,
}

impl<T: Real> Circle<T> {
    /// A circle of `radius` 0.01 to 10⁵ m at `p3` m (negative is above the origin), |p3| ≤ 10⁵.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges).
    pub fn new(radius: T, p3: T) -> Result<Self, OutOfRange<T>> {
        RADIUS.check(radius)?;
        P3.check(p3)?;
        Ok(Self { radius, p3 })
    }
}

impl<T: Real> Curve<T> for Circle<T> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [x, y, z] = position;
        let distance_squared = x.square() + y.square();

        let length = distance_squared.truncate().sqrt();
        let along = [-y.truncate::<6>(), x.truncate(), Series::constant(T::zero())];
        let [v_x, v_y, _] = velocity(position);
        let [a_x, a_y, _] = along;
        let (x0, y0) = (x.value(), y.value());
        let (zero, one) = (T::zero(), T::one());
        Located {
            surfaces: [distance_squared - self.radius * self.radius, *z - self.p3],
            gradients: [Vector3::new(x0 + x0, y0 + y0, zero), Vector3::new(zero, zero, one)],
            along,
            length,
            speed: (a_x * v_x + a_y * v_y) / length,
            reach_margin: one,
        }
    }
}

impl<T: Real> Curved<T> for Circle<T> {
    #[inline]
    fn turning(&self, _: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let [x, y, z] = located.along;
        [-y, x, z]
    }
}
