//! The conventions of others: which way their inertial and body axes point.

use nalgebra::{Matrix3, Vector3};

use crate::scalar::Real;

/// Inertial and body axes. The library's own are [`NedFrd`](Self::NedFrd).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frames {
    /// North, east, down; forward, right, down.
    NedFrd,
    /// East, north, up; forward, left, up.
    EnuFlu,
    /// North, west, up; forward, left, up.
    NwuFlu,
}

impl Frames {
    /// A vector of their inertial frame in N.
    #[must_use]
    pub fn inertial<T: Real>(self, v: &Vector3<T>) -> Vector3<T> {
        match self {
            Self::NedFrd => *v,
            Self::EnuFlu => Vector3::new(v.y, v.x, -v.z),
            Self::NwuFlu => Vector3::new(v.x, -v.y, -v.z),
        }
    }

    /// A vector of their body frame in B: an angular velocity or a specific force, say.
    #[must_use]
    pub fn body<T: Real>(self, v: &Vector3<T>) -> Vector3<T> {
        match self {
            Self::NedFrd => *v,
            Self::EnuFlu | Self::NwuFlu => Vector3::new(v.x, -v.y, -v.z),
        }
    }

    /// Their attitude, from their body to their inertial frame, as R from B to N.
    #[must_use]
    pub fn attitude<T: Real>(self, r: &Matrix3<T>) -> Matrix3<T> {
        let column = |i| self.inertial(&r.column(i).into());
        // Their second and third body axes are the opposites of b2 and b3, where they are not the
        // same.
        let sign = if self == Self::NedFrd { T::one() } else { -T::one() };
        Matrix3::from_columns(&[column(0), column(1) * sign, column(2) * sign])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_vector_is_the_same_vector_whichever_frames_it_is_told_in() {
        // Yawed, pitched and rolled by the quaternion (0.8, 0.2, -0.4, 0.4).
        let (w, x, y, z) = (0.8, 0.2, -0.4, 0.4);
        let r = Matrix3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        );
        let v = Vector3::new(0.3, -1.2, 2.5);
        for frames in [Frames::NedFrd, Frames::EnuFlu, Frames::NwuFlu] {
            let ours = frames.attitude(&r);
            let difference = ours * frames.body(&v) - frames.inertial(&(r * v));
            assert!(difference.amax() < 1e-15, "{frames:?}");
            let [b1, b2, b3]: [Vector3<f64>; 3] = [0, 1, 2].map(|i| ours.column(i).into());
            assert!((b1.cross(&b2).dot(&b3) - 1.0).abs() < 1e-14, "{frames:?}");
        }
    }

    #[test]
    fn level_and_facing_north_is_the_identity() {
        // East-north-up: forward is north, their second axis.
        let north = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        assert_eq!(Frames::EnuFlu.attitude(&north), Matrix3::identity());
        assert_eq!(Frames::NwuFlu.attitude(&Matrix3::<f64>::identity()), Matrix3::identity());
        assert_eq!(Frames::EnuFlu.inertial(&Vector3::new(1.0, 2.0, 3.0)), Vector3::new(2.0, 1.0, -3.0));
    }
}
