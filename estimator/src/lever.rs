//! The UAV's frame: its axes, and points away from its centre of mass, sensors, antenna, hook.

use model::{Matrix3, OutOfRange, Real, Vector3};

/// ω̇ × r + ω × (ω × r): what a point at `lever` feels beyond the centre of mass, body axes, m/s².
#[inline(always)]
pub(crate) fn swung<T: Real>(omega: &Vector3<T>, turning: &Vector3<T>, lever: &Vector3<T>) -> Vector3<T> {
    turning.cross(lever) + omega * omega.dot(lever) - lever * omega.dot(omega)
}

/// A lever arm within ±2 m.
pub(crate) fn within<T: Real>(field: &'static str, lever: &Vector3<T>) -> Result<(), OutOfRange<T>> {
    lever.iter().try_for_each(|&along| OutOfRange::check(field, along, -2.0, 2.0))
}

/// b1, b2, b3 in N.
#[inline(always)]
pub(crate) fn axes<T: Real>(attitude: &Matrix3<T>) -> [Vector3<T>; 3] {
    let r = attitude;
    [Vector3::new(r.m11, r.m21, r.m31), Vector3::new(r.m12, r.m22, r.m32), Vector3::new(r.m13, r.m23, r.m33)]
}
