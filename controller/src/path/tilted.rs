//! A circle or ellipse in any plane.

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::{Curve, Curved, Located};
use crate::ranges::{COORDINATE, HALF_AXIS_A, HALF_AXIS_B};

/// Ellipse about the centre c in the plane of the orthonormal axes e1 and e2, n = e1 × e2 (15.2):
///
/// ```text
/// ξ = e1·(p − c),   η = e2·(p − c)
/// h1 = (ξ/a)² + (η/b)² − 1,   h2 = −n·(p − c) in m
/// ∇h1 × ∇h2 = 2 (ξ/a² e2 − η/b² e1)
/// ```
///
/// It runs along (3.2): right-handed about n, from e1 to e2.
///
/// ```
/// use controller::{Curve, Tilted, Vector3};
///
/// // A circle of 4 m radius that leans north, and a loop that stands upright.
/// let center = Vector3::new(0.0, 0.0, -10.0_f32);
/// let leaning = Tilted::circle(center, Vector3::new(-0.3, 0.0, 1.0), 4.0)?.at_speed(1.0)?;
/// let upright = Tilted::new(center, Vector3::y(), Vector3::x(), 5.0, 3.0)?.at_speed(0.8)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilted<T> {
    center: Vector3<T>,
    /// e1, e2, n.
    axes: [Vector3<T>; 3],
    /// 1/a² and 1/b².
    per_square: [T; 2],
}

impl<T: Real> Tilted<T> {
    /// Half-axes `a` along `major` and `b` across it, 0.01 to 10⁵ m, in the plane through `center`
    /// (N, m) across `normal`.
    ///
    /// `normal` and `major` are directions of any length above 10⁻³; only the part of `major` in
    /// the plane counts, and it must stand at least 0.06 rad from `normal`.
    ///
    /// # Errors
    /// A number is out of its [range](crate::ranges).
    pub fn new(center: Vector3<T>, normal: Vector3<T>, major: Vector3<T>, a: T, b: T) -> Result<Self, OutOfRange<T>> {
        for coordinate in center.iter() {
            OutOfRange::check("center", *coordinate, COORDINATE.min, COORDINATE.max)?;
        }
        HALF_AXIS_A.check(a)?;
        HALF_AXIS_B.check(b)?;
        let n = unit("length of normal", &normal)?;
        let major = unit("length of major", &major)?;
        let across = n.cross(&major);
        let sine = across.dot(&across).sqrt();
        OutOfRange::check("sine of the angle between normal and major", sine, 0.06, 1.001)?;
        let e2 = across * (T::one() / sine);
        let axes = [e2.cross(&n), e2, n];
        Ok(Self { center, axes, per_square: [T::one() / (a * a), T::one() / (b * b)] })
    }

    /// A circle of `radius` m, seen against `normal` turning anticlockwise.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn circle(center: Vector3<T>, normal: Vector3<T>, radius: T) -> Result<Self, OutOfRange<T>> {
        // The coordinate axis farthest from the normal.
        let [x, y, z] = [normal.x.abs(), normal.y.abs(), normal.z.abs()];
        let major = if x <= y && x <= z {
            Vector3::x()
        } else if y <= z {
            Vector3::y()
        } else {
            Vector3::z()
        };
        Self::new(center, normal, major, radius, radius)
    }
}

/// `vector` at unit length.
fn unit<T: Real>(field: &'static str, vector: &Vector3<T>) -> Result<Vector3<T>, OutOfRange<T>> {
    let length = vector.dot(vector).sqrt();
    OutOfRange::check(field, length, 1e-3, 1e5)?;
    Ok(vector * (T::one() / length))
}

/// axis·p.
#[inline]
fn project<T: Real, const N: usize>(axis: &Vector3<T>, [x, y, z]: &[Series<T, N>; 3]) -> Series<T, N> {
    *x * axis.x + *y * axis.y + *z * axis.z
}

impl<T: Real> Tilted<T> {
    /// ∇h1 × ∇h2 from (ξ, η), and its derivative in direction u from (u·e1, u·e2): it is linear.
    #[inline]
    fn along<const N: usize>(&self, x: Series<T, N>, y: Series<T, N>) -> [Series<T, N>; 2] {
        let [per_aa, per_bb] = self.per_square;
        let two = T::lit(2.0);
        [y * (-two * per_bb), x * (two * per_aa)]
    }

    /// The vector with components (u1, u2) along e1, e2, in N.
    #[inline]
    fn in_space<const N: usize>(&self, [u1, u2]: [Series<T, N>; 2]) -> [Series<T, N>; 3] {
        let [e1, e2, _] = &self.axes;
        [u1 * e1.x + u2 * e2.x, u1 * e1.y + u2 * e2.y, u1 * e1.z + u2 * e2.z]
    }
}

impl<T: Real> Curve<T> for Tilted<T> {
    #[inline(always)]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let [e1, e2, n] = &self.axes;
        let [p1, p2, p3] = *position;
        let offset = [p1 - self.center.x, p2 - self.center.y, p3 - self.center.z];
        let (x, y) = (project(e1, &offset), project(e2, &offset));
        let [per_aa, per_bb] = self.per_square;

        let two = T::lit(2.0);
        let along = self.along(x.truncate(), y.truncate());
        let [u1, u2] = along;
        let length = (u1.square() + u2.square()).sqrt();
        Located {
            surfaces: [x.square() * per_aa + y.square() * per_bb - T::one(), -project(n, &offset)],
            gradients: [e1 * (two * per_aa * x.value()) + e2 * (two * per_bb * y.value()), -n],
            along: self.in_space(along),
            length,
            // ξ˙ and η˙ are the velocity's components in the plane.
            speed: (u1 * x.differentiate() + u2 * y.differentiate()) / length,
            reach_margin: T::one(),
        }
    }
}

impl<T: Real> Curved<T> for Tilted<T> {
    #[inline]
    fn turning(&self, _: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        let [e1, e2, _] = &self.axes;
        self.in_space(self.along(project(e1, &located.along), project(e2, &located.along)))
    }
}
