//! How the errors of the payload filter spread: P ← Φ P Φᵀ + Q over a cycle Δt.
//!
//! Wind and residual are first-order Markov processes, the rest walks at random, and the rod
//! swings:
//!
//! ```text
//! η̇ = ζ,   ζ̇ = δq̈_h of (2),   ẇ = −w/τ_w,   ṙ = −r/τ_r
//! noise of ζ: q_rod² + (N_a/L)² (1 − q qᵀ)_h      since the accelerometer's noise drives the pivot       (6)
//! ```
//!
//! Φ moves ζ first and then η by the new ζ. On a swing its determinant is one, as the swing's own:
//! 1 + F Δt at once would make an error at √(s/L) larger by (1 + s/L Δt²) each step, which is noise
//! that nobody has told.

use model::{Real, Vector3};

use super::params::{PayloadNoise, PayloadParams};
use super::state::{ERRORS, PayloadState, index};
use crate::covariance::{at, unrolled};

/// The covariance of the twelve errors.
pub(super) type Covariance<T> = crate::covariance::Covariance<T, ERRORS, { ERRORS * (ERRORS + 1) / 2 }>;

/// Noise and decay over one step of the covariance, made once.
#[derive(Clone, Debug)]
pub(super) struct Spread<T> {
    step: T,
    /// What a step leaves of wind and residual.
    kept: [T; 2],
    /// What it adds to the variances of wind, residual, offset, and of thrust scale and mass.
    added: [T; 4],
    /// Variances beyond which offset, thrust scale and mass don't walk: nothing that is not heard
    /// of grows for ever.
    most: [T; 3],
    /// q_rod² and (N_a/L)², times the step.
    rod: T,
    pivot: T,
}

/// The variance that no component falls below, whatever rounding makes of it.
const FLOOR: f64 = 1e-9;

impl<T: Real> Spread<T> {
    pub(super) fn new(params: &PayloadParams<T>, step: T) -> Self {
        let PayloadNoise { accelerometer, rod, wind, wind_time, residual, residual_time, .. } = params.noise;
        let PayloadNoise { offset, offset_walk, scale_walk, thrust, mass, .. } = params.noise;
        let one = T::one();
        let left = |time: T| one - step / time;
        let new = |deviation: T, kept: T| deviation * deviation * (one - kept * kept);
        let (air, rest) = (left(wind_time), left(residual_time));
        let walk = |per_root: T| per_root * per_root * step;
        Self {
            step,
            kept: [air, rest],
            added: [new(wind, air), new(residual, rest), walk(offset_walk), walk(scale_walk)],
            most: [offset, thrust, mass].map(|deviation| deviation * deviation),
            rod: walk(rod),
            pivot: walk(accelerometer / params.cable_length),
        }
    }

    /// What a step leaves of wind and residual themselves: the same that it leaves of their errors.
    pub(super) fn relax(&self, state: &mut PayloadState<T>) {
        let [air, rest] = self.kept;
        state.wind = state.wind.map(|component| component * air);
        state.residual = state.residual.map(|component| component * rest);
    }

    /// One step with q̈'s answers `rows` to (η, ζ, w, r, μ) at the rod `q`.
    #[inline(never)]
    pub(super) fn advance(&self, covariance: &mut Covariance<T>, rows: &[[T; 9]; 2], q: &Vector3<T>) {
        let p = &mut covariance.0;
        let rows = rows.map(|row| row.map(|entry| entry * self.step));
        let step = self.step;
        // Y = A P, rows of ζ: sums of nine.
        let mut turned = [[T::zero(); ERRORS]; 2];
        unrolled!(a < 2, {
            unrolled!(j < ERRORS, {
                let mut sum = rows[a][8] * p[at(index::MASS, j)];
                unrolled!(k < 8, { sum += rows[a][k] * p[at(k, j)] });
                turned[a][j] = sum;
            });
        });
        let moved = |y: &[T; ERRORS], row: &[T; 9]| -> T {
            let mut sum = row[8] * y[index::MASS];
            unrolled!(k < 8, { sum += row[k] * y[k] });
            sum
        };
        let rate = [
            p[at(2, 2)] + turned[0][2] + turned[0][2] + moved(&turned[0], &rows[0]),
            p[at(3, 2)] + turned[1][2] + turned[0][3] + moved(&turned[1], &rows[0]),
            p[at(3, 3)] + turned[1][3] + turned[1][3] + moved(&turned[1], &rows[1]),
        ];
        let [air, rest] = self.kept;
        // What is left of the error `j`.
        macro_rules! kept {
            ($j:expr) => {
                if $j < index::RESIDUAL {
                    air
                } else if $j < index::OFFSET {
                    rest
                } else {
                    T::one()
                }
            };
        }
        unrolled!(a < 2, {
            unrolled!(b < 2, {
                // ζ_a with η_b, and η's block from the new ones.
                p[at(2 + a, b)] += turned[a][b];
            });
        });
        p[at(0, 0)] += step * (p[at(2, 0)] + p[at(2, 0)] + step * rate[0]);
        p[at(1, 0)] += step * (p[at(2, 1)] + p[at(3, 0)] + step * rate[1]);
        p[at(1, 1)] += step * (p[at(3, 1)] + p[at(3, 1)] + step * rate[2]);
        unrolled!(a < 2, { unrolled!(b < 2, { p[at(2 + a, b)] += step * rate[a + b] }) });
        unrolled!(j < ERRORS, {
            if j >= index::WIND {
                unrolled!(a < 2, {
                    let with_rate = (p[at(2 + a, j)] + turned[a][j]) * kept!(j);
                    p[at(2 + a, j)] = with_rate;
                    p[at(a, j)] = p[at(a, j)] * kept!(j) + step * with_rate;
                });
                unrolled!(k < index::OFFSET, {
                    if k >= index::WIND && k <= j {
                        p[at(k, j)] *= kept!(k) * kept!(j);
                    }
                });
            }
        });
        p[at(2, 2)] = rate[0] + self.rod + self.pivot * (T::one() - q.x * q.x);
        p[at(3, 2)] = rate[1] - self.pivot * (q.x * q.y);
        p[at(3, 3)] = rate[2] + self.rod + self.pivot * (T::one() - q.y * q.y);
        let [gust, force, offset, scale] = self.added;
        let [most_offset, most_thrust, most_mass] = self.most;
        for (k, added) in [(4, gust), (5, gust), (6, force), (7, force)] {
            covariance.add(k, added);
        }
        for (k, added, most) in
            [(8, offset, most_offset), (9, offset, most_offset), (10, scale, most_thrust), (11, scale, most_mass)]
        {
            if covariance.get(k, k) < most {
                covariance.add(k, added);
            }
        }
        covariance.floor(T::lit(FLOOR));
    }
}
