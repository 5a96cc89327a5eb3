//! The thrust model: where the rod's angle is seen.
//!
//! Thrust is along −b3, the accelerometer tells what acts on the UAV in all, and the difference is
//! the cable's pull and the air's:
//!
//! ```text
//! m_Q f_B = −k_T T e3 + Rᵀ (m_L s q + F_Q),   F_Q = F_Q(w − v_Q)                              (3)
//! ```
//!
//! Averaged over a cycle's window T_w it is three scalars z_i = f_i − l_i − model_i, with b_i the
//! body axes in N:
//!
//! ```text
//! h·δx = [m_L ((b_i·q) δs + s b_i·δq) + b_i·J_Q δw + m₀ s (b_i·q) δμ − [i=3] T δk_T]/m_Q + [i<3] δl_i
//! R_i = max(r_i², N_a²/(4 T_w)) + N_a²/T_w
//! E(ζ · noise of z_i) = N_a²/L (b_i − q (b_i·q))_h                                            (7)
//! ```
//!
//! By (7) the accelerometer that has moved the rod over the window is not taken for a second
//! witness: where it shakes, the model weighs more. The scalars of a batch come one by one, and a
//! gain K of the first leaves the second with c_2 − K (h_1·c_2).
//!
//! The covariance stays positive if before the batch it is at least Σ c_i c_iᵀ/R_i, with c_i the
//! correlation (7): then state and noises have a joint covariance, of which a scalar leaves the
//! Schur complement. Since b_i are a frame, and M = 1 − q qᵀ a projection,
//!
//! ```text
//! Σ c_i c_iᵀ/R_i ≤ (N_a²/L)² M (Σ b_i b_iᵀ) M/min R_i = (N_a²/L)² M/min R_i ≤ 4/5 (N_a/L)² T_w M
//! ```
//!
//! and (6) has just given the rate (N_a/L)² T_w M with the same q: a fifth of it stays for rounding
//! and for what the body turns in two periods, which is what R_i has its maximum for.

use model::{Matrix3, Real, Vector3};

use super::params::PayloadParams;
use super::pendulum::{Pendulum, Pivot, Pull, Sensitivity, into_body};
use super::predict::Covariance;
use super::state::{ERRORS, PayloadState, index};
use crate::covariance::{Scalar, dot};
use crate::lever::axes;

/// What acts over a window: sums over its periods.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window<T> {
    /// f − l − model, body axes, m/s².
    residual: Vector3<T>,
    /// T, N.
    thrust: T,
    count: T,
}

/// The mean over a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean<T> {
    pub(crate) residual: Vector3<T>,
    pub(crate) thrust: T,
    /// A full window's, or too few periods with a thrust told.
    pub(crate) is_full: bool,
}

impl<T: Real> Window<T> {
    pub(crate) fn empty() -> Self {
        Self { residual: Vector3::zeros(), thrust: T::zero(), count: T::zero() }
    }

    /// Adds a period: specific force of the centre of mass in body axes, and (2) at its middle.
    #[expect(clippy::too_many_arguments, reason = "each is a symbol of (3)")]
    #[inline(always)]
    pub(crate) fn add(
        &mut self,
        params: &PayloadParams<T>,
        state: &PayloadState<T>,
        (pendulum, pull): (&Pendulum<T>, &Pull<T>),
        attitude: &Matrix3<T>,
        velocity: &Vector3<T>,
        force: &Vector3<T>,
        thrust: T,
    ) {
        let drag = params.uav_drag.force(&(pendulum.wind - velocity));
        let pulled = into_body(attitude, &(state.rod * (pendulum.mass * pull.tension) + drag));
        let per_mass = T::one() / params.uav_mass;
        let given = thrust * state.thrust_scale;
        self.residual += Vector3::new(
            force.x - state.offset[0] - pulled.x * per_mass,
            force.y - state.offset[1] - pulled.y * per_mass,
            force.z - (pulled.z - given) * per_mass,
        );
        self.thrust += thrust;
        self.count += T::one();
    }

    /// The mean, if at least `least` periods were added.
    pub(crate) fn mean(&self, least: T) -> Mean<T> {
        let per_count = T::one() / self.count.max(T::one());
        Mean {
            residual: self.residual * per_count,
            thrust: self.thrust * per_count,
            is_full: self.count >= least && self.residual.dot(&self.residual).is_finite(),
        }
    }
}

/// (3) about one state, for the three scalars of a batch.
#[derive(Clone, Debug)]
pub(crate) struct Linearized<T> {
    /// Of s by (η, ζ, w, r, μ).
    tension_by: [T; 9],
    /// B₃.
    lean: [T; 2],
    /// s and q.
    tension: T,
    rod: Vector3<T>,
    /// J_Q, columns of the horizontal wind.
    push: [Vector3<T>; 2],
    /// m_L.
    mass: T,
}

impl<T: Real> Linearized<T> {
    /// About `state`, with the UAV at `velocity`.
    pub(crate) fn about(
        params: &PayloadParams<T>,
        state: &PayloadState<T>,
        pendulum: &Pendulum<T>,
        pivot: &Pivot<T>,
        velocity: &Vector3<T>,
    ) -> Self {
        let Sensitivity { tension: tension_by, pull, chart, .. } = pendulum.sensitivity(params, pivot, state);
        let [push_1, push_2, _] = axes(&params.uav_drag.slope(&(pendulum.wind - velocity)));
        Self {
            tension_by,
            lean: chart.lean,
            tension: pull.tension,
            rod: state.rod,
            push: [push_1, push_2],
            mass: pendulum.mass,
        }
    }

    /// q.
    pub(crate) fn rod(&self) -> &Vector3<T> {
        &self.rod
    }

    /// Before there is a state.
    pub(crate) fn none() -> Self {
        let zero = T::zero();
        Self {
            tension_by: [zero; 9],
            lean: [zero; 2],
            tension: zero,
            rod: Vector3::zeros(),
            push: [Vector3::zeros(); 2],
            mass: zero,
        }
    }

    /// The scalar of body axis `axis`, `body` in N, over a window of `window` s; and b·q. Where the
    /// load itself was measured in the window (`is_witnessed`), what moved the rod is no longer
    /// that window's noise, and (7) does not hold.
    #[inline(always)]
    pub(crate) fn scalar(
        &self,
        params: &PayloadParams<T>,
        axis: Axis,
        body: &Vector3<T>,
        mean: &Mean<T>,
        window: T,
        is_witnessed: bool,
    ) -> (Scalar<T, ERRORS>, T) {
        let noise = &params.noise;
        let per_mass = T::one() / params.uav_mass;
        let density = noise.accelerometer * noise.accelerometer;
        let along = body.dot(&self.rod);
        let (least, residual) = match axis {
            Axis::First => (noise.lateral, mean.residual.x),
            Axis::Second => (noise.lateral, mean.residual.y),
            Axis::Thrust => (noise.axial, mean.residual.z),
        };
        let white = density / window;
        let mut scalar = Scalar::of(residual, (least * least).max(white * T::lit(0.25)) + white);
        let by_tension = self.mass * along * per_mass;
        let pull = self.mass * self.tension * per_mass;
        let [s_q1, s_q2, s_w1, s_w2, s_a1, s_a2, s_r1, s_r2, s_mass] = self.tension_by.map(|s| s * by_tension);
        let zero = T::zero();
        let mass = s_mass + params.payload_mass * self.tension * along * per_mass;
        let (l1, l2, thrust) = match axis {
            Axis::First => (T::one(), zero, zero),
            Axis::Second => (zero, T::one(), zero),
            Axis::Thrust => (zero, zero, -(mean.thrust * per_mass)),
        };
        scalar.h = [
            s_q1 + (body.x + body.z * self.lean[0]) * pull,
            s_q2 + (body.y + body.z * self.lean[1]) * pull,
            s_w1,
            s_w2,
            s_a1 + self.push[0].dot(body) * per_mass,
            s_a2 + self.push[1].dot(body) * per_mass,
            s_r1,
            s_r2,
            l1,
            l2,
            thrust,
            mass,
        ];
        if !is_witnessed {
            let [x, y] = self.correlation(params, body);
            scalar.correlation[index::RATE] = x;
            scalar.correlation[index::RATE + 1] = y;
        }
        (scalar, along)
    }

    /// (7) for the body axis `body` in N.
    #[inline(always)]
    pub(crate) fn correlation(&self, params: &PayloadParams<T>, body: &Vector3<T>) -> [T; 2] {
        let density = params.noise.accelerometer * params.noise.accelerometer;
        let across = (body - self.rod * body.dot(&self.rod)) * (density / params.cable_length);
        [across.x, across.y]
    }
}

/// What the scalars of a batch leave of the correlations of those that come after them.
#[derive(Clone, Debug)]
pub(crate) struct Batch<T> {
    /// To be taken off the second's and the third's, so often.
    taken: [T; ERRORS],
    share: [T; 2],
}

impl<T: Real> Batch<T> {
    /// Before a batch.
    pub(crate) fn none() -> Self {
        Self { taken: [T::zero(); ERRORS], share: [T::zero(); 2] }
    }

    /// Brings the `correlation` of a scalar from before the batch to its turn.
    #[inline(always)]
    pub(crate) fn correct(&self, axis: Axis, correlation: &mut [T; ERRORS]) {
        let share = match axis {
            Axis::First => return,
            Axis::Second => self.share[0],
            Axis::Thrust => self.share[1],
        };
        for (entry, &taken) in correlation.iter_mut().zip(&self.taken) {
            *entry -= taken * share;
        }
    }

    /// A scalar `h` was taken in with this `gain`; (7) of the axes to come is `of` their place.
    #[inline(always)]
    pub(crate) fn follow(&mut self, axis: Axis, h: &[T; ERRORS], gain: &[T; ERRORS], of: impl Fn(usize) -> [T; 2]) {
        let meets = |[x, y]: [T; 2]| h[index::RATE] * x + h[index::RATE + 1] * y;
        match axis {
            Axis::First => {
                self.taken = *gain;
                self.share = [meets(of(1)), meets(of(2))];
            }
            Axis::Second => {
                let before = self.share[1];
                let share = meets(of(2)) - dot(h, &self.taken) * before;
                for (taken, &gain) in self.taken.iter_mut().zip(gain) {
                    *taken = *taken * before + gain * share;
                }
                self.share[1] = T::one();
            }
            Axis::Thrust => *self = Self::none(),
        }
    }
}

/// A body axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// b1.
    First,
    /// b2.
    Second,
    /// b3, which the thrust is along.
    Thrust,
}

/// Whether the rod is known to 0.04 rad an axis.
pub(crate) fn is_rod_known<T: Real>(covariance: &Covariance<T>) -> bool {
    variance(covariance) <= T::lit(2.0 * 0.04 * 0.04)
}

/// Of the rod, both axes together.
fn variance<T: Real>(covariance: &Covariance<T>) -> T {
    covariance.get(index::ROD, index::ROD) + covariance.get(index::ROD + 1, index::ROD + 1)
}

/// Whether the mass is only considered in a scalar, with b·q = `along` for its axis, rather than
/// estimated, once the rod is known.
///
/// At hover thrust scale and mass are
/// one: what the lateral axes say of the mass is then the product of two errors, which would lead
/// there in minutes. So once it `is_found` they have a say only while the rod is plainly off the
/// thrust's axis: by 0.05 rad and three of its deviations, together, which no noise about a hover
/// is.
pub(crate) fn is_considered<T: Real>(covariance: &Covariance<T>, axis: Axis, along: T, is_found: bool) -> bool {
    let is_plain = along * along > variance(covariance) * T::lit(4.5) + T::lit(0.05 * 0.05);
    is_found && axis != Axis::Thrust && !is_plain
}
