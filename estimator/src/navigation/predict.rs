//! How the errors of navigation spread: P ← Φ P Φᵀ + Q over half a cycle, Φ = 1 + F Δt of (10).
//!
//! Rows first, then columns. The columns of the biases stay, so that the rows of all others with
//! them are known by symmetry; what is left for the columns is the block of position, velocity and
//! attitude.

use model::{Matrix3, Real, Vector3};

use super::params::NavigationNoise;
use super::strapdown::{ERRORS, index};
use crate::covariance::Covariance;

/// Φ's blocks beside ones, and Q, for one step.
#[derive(Clone, Debug)]
pub(crate) struct Spread<T> {
    step: T,
    /// Added to the variances of velocity, attitude, gyro's and accelerometer's bias.
    added: [T; 4],
    /// Of the running step: f Δt in N, and R Δt.
    force: Vector3<T>,
    turn: Matrix3<T>,
}

/// The variance that no component falls below.
const FLOOR: f64 = 1e-12;

impl<T: Real> Spread<T> {
    pub(crate) fn new(noise: &NavigationNoise<T>, step: T) -> Self {
        let walk = |density: T| density * density * step;
        Self {
            step,
            added: [
                walk(noise.accelerometer),
                walk(noise.gyro),
                walk(noise.gyro_walk),
                walk(noise.accelerometer_walk),
            ],
            force: Vector3::zeros(),
            turn: Matrix3::zeros(),
        }
    }

    /// Φ for an attitude and a specific `force` in N.
    pub(crate) fn take(&mut self, attitude: &Matrix3<T>, force: &Vector3<T>) {
        self.force = force * self.step;
        self.turn = attitude * self.step;
    }

    /// Φ times a vector, in place: each part before what it stands on has moved.
    #[inline(always)]
    fn apply(&self, x: &mut [T; 9], biases: &[T; 6]) {
        let [g1, g2, g3, a1, a2, a3] = *biases;
        let (step, f, turn) = (self.step, &self.force, &self.turn);
        x[0] += step * x[3];
        x[1] += step * x[4];
        x[2] += step * x[5];
        x[3] += f.z * x[7] - f.y * x[8] - (turn.m11 * a1 + turn.m12 * a2 + turn.m13 * a3);
        x[4] += f.x * x[8] - f.z * x[6] - (turn.m21 * a1 + turn.m22 * a2 + turn.m23 * a3);
        x[5] += f.y * x[6] - f.x * x[7] - (turn.m31 * a1 + turn.m32 * a2 + turn.m33 * a3);
        x[6] -= turn.m11 * g1 + turn.m12 * g2 + turn.m13 * g3;
        x[7] -= turn.m21 * g1 + turn.m22 * g2 + turn.m23 * g3;
        x[8] -= turn.m31 * g1 + turn.m32 * g2 + turn.m33 * g3;
    }

    /// Φ P, a column at a time. The covariance is whole again after [`columns`](Self::columns).
    #[inline(never)]
    pub(crate) fn rows(&self, covariance: &mut Covariance<T, ERRORS>) {
        let p = &mut covariance.0;
        for j in 0..ERRORS {
            let mut x: [T; 9] = core::array::from_fn(|i| p[i][j]);
            let biases: [T; 6] = core::array::from_fn(|i| p[9 + i][j]);
            self.apply(&mut x, &biases);
            for (row, x) in p.iter_mut().zip(x) {
                row[j] = x;
            }
        }
    }

    /// (Φ P) Φᵀ + Q, a row at a time. `most` are the variances up to which the biases of gyro and
    /// accelerometer walk.
    #[inline(never)]
    pub(crate) fn columns(&self, covariance: &mut Covariance<T, ERRORS>, most: [T; 2]) {
        let p = &mut covariance.0;
        for i in 0..index::GYRO {
            let mut x: [T; 9] = core::array::from_fn(|j| p[i][j]);
            let biases: [T; 6] = core::array::from_fn(|j| p[i][9 + j]);
            self.apply(&mut x, &biases);
            for (entry, x) in p[i].iter_mut().zip(x) {
                *entry = x;
            }
            for (row, bias) in p.iter_mut().skip(index::GYRO).zip(biases) {
                row[i] = bias;
            }
        }
        // Rounding has made the two halves differ by as much.
        for i in 0..index::GYRO {
            for j in i..index::GYRO {
                p[j][i] = p[i][j];
            }
        }
        let [velocity, attitude, gyro, accelerometer] = self.added;
        for i in 0..3 {
            p[index::VELOCITY + i][index::VELOCITY + i] += velocity;
            p[index::ATTITUDE + i][index::ATTITUDE + i] += attitude;
            for (at, added, most) in [(index::GYRO, gyro, most[0]), (index::ACCELEROMETER, accelerometer, most[1])] {
                if p[at + i][at + i] < most {
                    p[at + i][at + i] += added;
                }
            }
        }
        covariance.floor(&[T::lit(FLOOR); ERRORS]);
    }
}
