//! How the errors of navigation spread: P ← Φ P Φᵀ + Q over half a cycle, Φ = 1 + F Δt of (10).
//!
//! Each block of (10) lets three errors move with three others. Taken one after the other, each
//! part before what it stands on has moved, the blocks make up Φ; and as each is a change of state
//! of its own, the covariance is whole after every one, so that they have two periods.

use model::{Matrix3, Real, Vector3};

use super::params::NavigationNoise;
use super::strapdown::{ERRORS, index};
use crate::covariance::{at, unrolled};

/// The covariance of the fifteen errors.
pub(crate) type Covariance<T> = crate::covariance::Covariance<T, ERRORS, { ERRORS * (ERRORS + 1) / 2 }>;

/// Q for one step.
#[derive(Clone, Debug)]
pub(crate) struct Spread<T> {
    step: T,
    /// Added to the variances of velocity, attitude, gyro's and accelerometer's bias.
    added: [T; 4],
    /// Added to that of the attitude for each (rad/s)² of body rate.
    unscaled: T,
    /// Largest variances of the biases of gyro and accelerometer: walks go no further than where
    /// they started.
    most: [T; 2],
}

/// Error of the gyro in proportion to the body rate, by its scale and its axes, and for how long one turn keeps it,
/// s: (10) has no state for it. Below so many rad/s, which flights on a path keep to, the bias takes it up.
const UNSCALED: f64 = 0.01;
const TURNING: f64 = 0.5;
const TURNED: f64 = 8.0;

/// The variance that no component falls below.
const FLOOR: f64 = 1e-12;

impl<T: Real> Spread<T> {
    pub(crate) fn new(noise: &NavigationNoise<T>, step: T) -> Self {
        let walk = |density: T| density * density * step;
        Self {
            step,
            unscaled: walk(T::lit(UNSCALED)) * T::lit(TURNING),
            added: [
                walk(noise.accelerometer),
                walk(noise.gyro),
                walk(noise.gyro_walk),
                walk(noise.accelerometer_walk),
            ],
            most: [noise.start_gyro, noise.start_accelerometer].map(|deviation| deviation * deviation),
        }
    }

    /// Position moves with velocity, velocity with attitude under the specific `force` in N.
    #[inline(never)]
    pub(crate) fn move_with_attitude(&self, covariance: &mut Covariance<T>, force: &Vector3<T>) {
        let (step, f) = (self.step, force * self.step);
        couple::<T, { index::POSITION }, { index::VELOCITY }>(covariance, |v| v.map(|v| v * step));
        // −[f]×.
        couple::<T, { index::VELOCITY }, { index::ATTITUDE }>(covariance, |[x, y, z]| {
            [f.z * y - f.y * z, f.x * z - f.z * x, f.y * x - f.x * y]
        });
    }

    /// Velocity and attitude move with the biases; Q of a vehicle that turns at `body_rate`, rad/s.
    #[inline(never)]
    pub(crate) fn move_with_biases(
        &self,
        covariance: &mut Covariance<T>,
        attitude: &Matrix3<T>,
        body_rate: &Vector3<T>,
    ) {
        let r = attitude * -self.step;
        let turned = |[x, y, z]: [T; 3]| {
            [r.m11 * x + r.m12 * y + r.m13 * z, r.m21 * x + r.m22 * y + r.m23 * z, r.m31 * x + r.m32 * y + r.m33 * z]
        };
        couple::<T, { index::VELOCITY }, { index::ACCELEROMETER }>(covariance, turned);
        couple::<T, { index::ATTITUDE }, { index::GYRO }>(covariance, turned);
        let [velocity, attitude, gyro, accelerometer] = self.added;
        let turning = (body_rate.dot(body_rate) - T::lit(TURNED * TURNED)).max(T::zero());
        let attitude = attitude + self.unscaled * turning;
        let [most_gyro, most_accelerometer] = self.most;
        for i in 0..3 {
            covariance.add(index::VELOCITY + i, velocity);
            covariance.add(index::ATTITUDE + i, attitude);
            for (bias, added, most) in
                [(index::GYRO, gyro, most_gyro), (index::ACCELEROMETER, accelerometer, most_accelerometer)]
            {
                if covariance.get(bias + i, bias + i) < most {
                    covariance.add(bias + i, added);
                }
            }
        }
        covariance.floor(T::lit(FLOOR));
    }
}

/// P ← (1 + E) P (1 + E)ᵀ, where E adds M times the three errors at `FROM` to those at `TO`.
#[inline(always)]
fn couple<T: Real, const TO: usize, const FROM: usize>(covariance: &mut Covariance<T>, m: impl Fn([T; 3]) -> [T; 3]) {
    let p = &mut covariance.0;
    // M P of the columns at TO, from the old ones: its transpose is the other half.
    let before: [[T; 3]; 3] =
        [0, 1, 2].map(|b| m([p[at(FROM, TO + b)], p[at(FROM + 1, TO + b)], p[at(FROM + 2, TO + b)]]));
    unrolled!(j < ERRORS, {
        if j < TO || j >= TO + 3 {
            let moved = m([p[at(FROM, j)], p[at(FROM + 1, j)], p[at(FROM + 2, j)]]);
            unrolled!(a < 3, { p[at(TO + a, j)] += moved[a] });
        }
    });
    unrolled!(a < 3, {
        let after = m([p[at(TO + a, FROM)], p[at(TO + a, FROM + 1)], p[at(TO + a, FROM + 2)]]);
        unrolled!(b < a + 1, { p[at(TO + a, TO + b)] += before[b][a] + after[b] });
    });
}
