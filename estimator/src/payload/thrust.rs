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
//! R_i = max(r_i², N_a²/T_w) + N_a²/T_w
//! E(ζ · noise of z_i) = N_a²/L (b_i − q (b_i·q))_h                                            (7)
//! ```
//!
//! By (7) the accelerometer that has moved the rod over the window is not taken for a second
//! witness: where it shakes, the model weighs more. (That the second and third scalar of a batch
//! meet a state corrected by the first changes (7) in second order, and is left out.)

use model::{Matrix3, Real, Vector3};

use super::params::PayloadParams;
use super::pendulum::{Pendulum, Pivot, Pull, Sensitivity, into_body};
use super::predict::Covariance;
use super::state::{ERRORS, PayloadState, index};
use crate::covariance::Scalar;
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
        // The model counts as no better than the accelerometer: what (7) then takes is no more than
        // what (6) has given to the rate in half a window, whatever else the rate hangs together
        // with, and the covariance stays positive.
        let white = density / window;
        let mut scalar = Scalar::of(residual, (least * least).max(white) + white);
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
            let across = (body - self.rod * along) * (density / params.cable_length);
            scalar.correlation[index::RATE] = across.x;
            scalar.correlation[index::RATE + 1] = across.y;
        }
        (scalar, along)
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

/// Whether the mass is only considered in a scalar, with b·q = `along` for its axis, rather than
/// estimated.
///
/// Until the rod is known to 0.04 rad an axis a very light load blown far out explains what is
/// measured as well, and a filter that may choose finds it. And at hover thrust scale and mass are
/// one: what the lateral axes say of the mass is then the product of two errors, which would lead
/// there in minutes. So once it `is_found` they have a say only while the rod is plainly off the
/// thrust's axis: by 0.05 rad and three of its deviations, together, which no noise about a hover
/// is.
pub(crate) fn is_considered<T: Real>(covariance: &Covariance<T>, axis: Axis, along: T, is_found: bool) -> bool {
    let variance = covariance.get(index::ROD, index::ROD) + covariance.get(index::ROD + 1, index::ROD + 1);
    let is_plain = along * along > variance * T::lit(4.5) + T::lit(0.05 * 0.05);
    variance > T::lit(2.0 * 0.04 * 0.04) || (is_found && axis != Axis::Thrust && !is_plain)
}
