//! How the errors of the payload filter spread: P ← Φ P Φᵀ + Q over half a cycle.
//!
//! Φ = 1 + F Δt has four rows that are not the identity's, of which two have one entry beside it;
//! wind and residual are first-order Markov processes, the rest walks at random:
//!
//! ```text
//! η̇ = ζ,   ζ̇ = δq̈_h of (2),   ẇ = −w/τ_w,   ṙ = −r/τ_r
//! noise of ζ: q_rod² + (N_a/L)² (1 − q qᵀ)_h      since the accelerometer's noise drives the pivot       (6)
//! ```

use model::{Real, Vector3};

use super::params::{PayloadNoise, PayloadParams};
use super::state::{ERRORS, PayloadState, index};
use crate::covariance::Covariance;

/// Noise and decay over one step of the covariance, made once.
#[derive(Clone, Debug)]
pub(crate) struct Spread<T> {
    step: T,
    /// What a step leaves of each error that doesn't move with the rod.
    kept: [T; ERRORS],
    /// What it adds to its variance.
    added: [T; ERRORS],
    /// q_rod² and (N_a/L)², times the step.
    rod: T,
    pivot: T,
}

/// The variance that no component falls below, whatever rounding makes of it.
const FLOOR: f64 = 1e-9;

impl<T: Real> Spread<T> {
    pub(crate) fn new(params: &PayloadParams<T>, step: T) -> Self {
        let PayloadNoise { accelerometer, rod, wind, wind_time, residual, residual_time, .. } = params.noise;
        let one = T::one();
        let left = |time: T| one - step / time;
        let new = |deviation: T, kept: T| deviation * deviation * (one - kept * kept);
        let (air, rest) = (left(wind_time), left(residual_time));
        let walk = |per_root: T| per_root * per_root * step;
        let pivot = accelerometer / params.cable_length;
        let (gust, force) = (new(wind, air), new(residual, rest));
        let (offset, scale, none) = (walk(params.noise.offset_walk), walk(params.noise.scale_walk), T::zero());
        Self {
            step,
            kept: [one, one, one, one, air, air, rest, rest, one, one, one, one],
            added: [none, none, none, none, gust, gust, force, force, offset, offset, scale, scale],
            rod: walk(rod),
            pivot: walk(pivot),
        }
    }

    /// What a step leaves of wind and residual themselves: the same that it leaves of their errors.
    pub(crate) fn relax(&self, state: &mut PayloadState<T>) {
        let (air, rest) = (self.kept[index::WIND], self.kept[index::RESIDUAL]);
        state.wind = state.wind.map(|component| component * air);
        state.residual = state.residual.map(|component| component * rest);
    }

    /// One step with q̈'s answers `rows` to (η, ζ, w, r, μ) at the rod `q`. `most` are the
    /// variances up to which walks walk.
    #[inline(never)]
    pub(crate) fn advance(
        &self,
        covariance: &mut Covariance<T, ERRORS>,
        rows: &[[T; 9]; 2],
        q: &Vector3<T>,
        most: &[T; ERRORS],
    ) {
        let p = &mut covariance.0;
        let rows = rows.map(|row| row.map(|entry| entry * self.step));
        // Y = A P: rows of η are those of ζ times the step, rows of ζ sums of nine.
        let mut turned = [[T::zero(); ERRORS]; 2];
        for (sum, row) in turned.iter_mut().zip(&rows) {
            for (j, sum) in sum.iter_mut().enumerate() {
                *sum = row[0] * p[0][j]
                    + row[1] * p[1][j]
                    + row[2] * p[2][j]
                    + row[3] * p[3][j]
                    + row[4] * p[4][j]
                    + row[5] * p[5][j]
                    + row[6] * p[6][j]
                    + row[7] * p[7][j]
                    + row[8] * p[index::MASS][j];
            }
        }
        // Rows of the new matrix, then its columns: of ζ first, since those of η need the old ones.
        let moved = |y: &[T; ERRORS], row: &[T; 9]| -> T {
            row[0] * y[0]
                + row[1] * y[1]
                + row[2] * y[2]
                + row[3] * y[3]
                + row[4] * y[4]
                + row[5] * y[5]
                + row[6] * y[6]
                + row[7] * y[7]
                + row[8] * y[index::MASS]
        };
        let step = self.step;
        // E(ζ′ ηᵀ′) and E(η′ η′ᵀ) from the old blocks and Y.
        let rod = [
            p[0][0] + step * (p[0][2] + p[0][2] + step * p[2][2]),
            p[1][0] + step * (p[1][2] + p[0][3] + step * p[2][3]),
            p[1][1] + step * (p[1][3] + p[1][3] + step * p[3][3]),
        ];
        let mixed = [0, 1].map(|a| {
            [0, 1].map(|b| {
                // ζ_a′ with η_b′.
                p[2 + a][b] + turned[a][b] + step * (p[2 + a][2 + b] + turned[a][2 + b])
            })
        });
        let rate = [
            p[2][2] + turned[0][2] + turned[0][2] + moved(&turned[0], &rows[0]),
            p[3][2] + turned[1][2] + turned[0][3] + moved(&turned[1], &rows[0]),
            p[3][3] + turned[1][3] + turned[1][3] + moved(&turned[1], &rows[1]),
        ];
        for j in index::WIND..ERRORS {
            let kept = self.kept[j];
            for a in 0..2 {
                let rod = (p[a][j] + step * p[2 + a][j]) * kept;
                let rate = (p[2 + a][j] + turned[a][j]) * kept;
                p[a][j] = rod;
                p[j][a] = rod;
                p[2 + a][j] = rate;
                p[j][2 + a] = rate;
            }
        }
        for k in index::WIND..index::OFFSET {
            for j in k..ERRORS {
                let entry = p[k][j] * (self.kept[k] * self.kept[j]);
                p[k][j] = entry;
                p[j][k] = entry;
            }
        }
        p[0][0] = rod[0];
        p[1][1] = rod[2];
        p[0][1] = rod[1];
        p[1][0] = rod[1];
        for a in 0..2 {
            for b in 0..2 {
                p[2 + a][b] = mixed[a][b];
                p[b][2 + a] = mixed[a][b];
            }
        }
        let across = self.pivot * (q.x * q.y);
        p[2][2] = rate[0] + self.rod + self.pivot * (T::one() - q.x * q.x);
        p[3][3] = rate[2] + self.rod + self.pivot * (T::one() - q.y * q.y);
        p[3][2] = rate[1] - across;
        p[2][3] = p[3][2];
        for k in index::WIND..ERRORS {
            // What walks stops where it was at the start: nothing that is not heard of grows for
            // ever.
            if k < index::OFFSET || p[k][k] < most[k] {
                p[k][k] += self.added[k];
            }
        }
        covariance.floor(&[T::lit(FLOOR); ERRORS]);
    }
}
