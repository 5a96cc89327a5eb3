//! The UAV's frame: its axes, and points away from its centre of mass, sensors, antenna, hook.

use model::{Matrix3, OutOfRange, Real, Vector3};

/// S of S r = ω̇ × r + ω × (ω × r): what a point at r feels beyond the centre of mass, body axes,
/// 1/s².
#[inline(always)]
pub(crate) fn swing<T: Real>(omega: &Vector3<T>, turning: &Vector3<T>) -> Matrix3<T> {
    let (w, t) = (omega, turning);
    let [xx, yy, zz] = [w.x * w.x, w.y * w.y, w.z * w.z];
    let [xy, yz, zx] = [w.x * w.y, w.y * w.z, w.z * w.x];
    Matrix3::new(-(yy + zz), xy - t.z, zx + t.y, xy + t.z, -(zz + xx), yz - t.x, zx - t.y, yz + t.x, -(xx + yy))
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
