//! The load as a pendulum whose pivot's specific force is measured.
//!
//! With f the pivot's specific force (N), f = a − g e3, and d_L the specific force of drag and the
//! residual on the payload,
//!
//! ```text
//! u = d_L − f                                                                               (1)
//! s = q·u + L |q̇|²,   q̈ = (u − s q)/L          s = tension / m_L                            (2)
//! d_L = F_L(w − v)/m_L + r,   v = v_hook + L q̇
//! ```
//!
//! No mass, no thrust and no drag of the UAV enters. Exact for a taut, massless cable.

use model::{Matrix3, Real, Vector3};

use super::params::PayloadParams;
use super::state::{Chart, PayloadState};
use crate::lever::axes;

/// Least q₃ that the motion may lead to: a little beyond what a correction may.
const LOWEST: f64 = 0.3;

/// The pivot over a period.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivot<T> {
    /// Its velocity in N, m/s.
    pub(crate) velocity: Vector3<T>,
    /// Its specific force in N, m/s².
    pub(crate) specific_force: Vector3<T>,
}

/// Forces on the payload at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull<T> {
    /// u of (1), m/s².
    pub(crate) u: Vector3<T>,
    /// s of (2), m/s².
    pub(crate) tension: T,
    /// q̈, 1/s².
    pub(crate) acceleration: Vector3<T>,
}

/// What of the pendulum stays the same.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pendulum<T> {
    /// m_L, kg.
    pub(crate) mass: T,
    /// Wind in N, m/s.
    pub(crate) wind: Vector3<T>,
    /// r in N, m/s².
    pub(crate) residual: Vector3<T>,
}

impl<T: Real> Pendulum<T> {
    #[inline(always)]
    pub(crate) fn new(params: &PayloadParams<T>, state: &PayloadState<T>) -> Self {
        Self {
            mass: params.payload_mass * (T::one() + state.mass_ratio),
            wind: Vector3::new(state.wind[0], state.wind[1], T::zero()),
            residual: Vector3::new(state.residual[0], state.residual[1], T::zero()),
        }
    }

    /// (1), (2) at the rod `q`, `w`.
    #[inline(always)]
    pub(crate) fn pull(
        &self,
        params: &PayloadParams<T>,
        pivot: &Pivot<T>,
        q: &Vector3<T>,
        w: &Vector3<T>,
    ) -> Pull<T> {
        let length = params.cable_length;
        let relative = self.relative(params, pivot, w);
        let u = params.payload_drag.force(&relative) * (T::one() / self.mass) + self.residual - pivot.specific_force;
        let tension = q.dot(&u) + length * w.dot(w);
        Pull { u, tension, acceleration: (u - q * tension) * (T::one() / length) }
    }

    /// w − v, m/s.
    #[inline(always)]
    fn relative(&self, params: &PayloadParams<T>, pivot: &Pivot<T>, w: &Vector3<T>) -> Vector3<T> {
        self.wind - pivot.velocity - w * params.cable_length
    }

    /// One period by the midpoint rule, then |q| = 1 by a Newton step, and q̇ ⊥ q. The acceleration
    /// of the period `before` leads to the middle of this one: its change over a period is of the
    /// rule's own order. Returns (2) there.
    #[inline(always)]
    pub(crate) fn advance(
        &self,
        params: &PayloadParams<T>,
        pivot: &Pivot<T>,
        before: &Vector3<T>,
        state: &mut PayloadState<T>,
    ) -> Pull<T> {
        let (h, half) = (params.period, params.period * T::lit(0.5));
        let (q, w) = (state.rod, state.rod_rate);
        let gained = before * half;
        let middle = self.pull(params, pivot, &(q + (w + gained * T::lit(0.5)) * half), &(w + gained));
        let q = q + (w + middle.acceleration * half) * h;
        let w = w + middle.acceleration * h;
        let q = q * (T::lit(1.5) - q.dot(&q) * T::lit(0.5));
        state.rod = q;
        state.rod_rate = w - q * q.dot(&w);
        // Readings that can't be true may not carry the rod out of its chart.
        if q.z < T::lit(LOWEST) {
            state.set_rod([q.x, q.y], [w.x, w.y]);
        }
        middle
    }

    /// How s and q̈ answer small errors at `state`.
    pub(crate) fn sensitivity(
        &self,
        params: &PayloadParams<T>,
        pivot: &Pivot<T>,
        state: &PayloadState<T>,
    ) -> Sensitivity<T> {
        let (q, w, length) = (state.rod, state.rod_rate, params.cable_length);
        let pull = self.pull(params, pivot, &q, &w);
        let relative = self.relative(params, pivot, &w);
        let per_mass = T::one() / self.mass;
        let slope = params.payload_drag.slope(&relative) * per_mass;
        let air = params.payload_drag.force(&relative) * per_mass;
        let chart = Chart::at(&q, &w);
        let [j1, j2, j3] = axes(&slope);
        // δu per δq̇₃, which η and ζ both turn.
        let vertical = j3 * -length;
        let u_rod = [vertical * chart.turn[0], vertical * chart.turn[1]];
        let u_rate = [j1 * -length + vertical * chart.lean[0], j2 * -length + vertical * chart.lean[1]];
        let u_mass = air * (-(T::one() / (T::one() + state.mass_ratio)));
        let double = length * T::lit(2.0);
        let [s_q1, s_q2] = chart.per_rod(&pull.u);
        let [s_w1, s_w2] = chart.per_rod(&w).map(|rate| rate * double);
        let s_turn = w.z * double;
        Sensitivity {
            tension: [
                s_q1 + q.dot(&u_rod[0]) + s_turn * chart.turn[0],
                s_q2 + q.dot(&u_rod[1]) + s_turn * chart.turn[1],
                s_w1 + q.dot(&u_rate[0]),
                s_w2 + q.dot(&u_rate[1]),
                q.dot(&j1),
                q.dot(&j2),
                q.x,
                q.y,
                q.dot(&u_mass),
            ],
            u: [
                [u_rod[0].x, u_rod[1].x, u_rate[0].x, u_rate[1].x, j1.x, j2.x, T::one(), T::zero(), u_mass.x],
                [u_rod[0].y, u_rod[1].y, u_rate[0].y, u_rate[1].y, j1.y, j2.y, T::zero(), T::one(), u_mass.y],
            ],
            pull,
            chart,
        }
    }
}

/// Derivatives by (η, ζ, w, r, μ), in this order.
pub(crate) struct Sensitivity<T> {
    /// Of s.
    pub(crate) tension: [T; 9],
    /// Of the horizontal components of u.
    u: [[T; 9]; 2],
    /// (2) at the state.
    pub(crate) pull: Pull<T>,
    /// (4), (5) at the state.
    pub(crate) chart: Chart<T>,
}

impl<T: Real> Sensitivity<T> {
    /// δq̈_h = (δu_h − q_h δs − s η)/L.
    pub(crate) fn acceleration(&self, params: &PayloadParams<T>, q: &Vector3<T>) -> [[T; 9]; 2] {
        let per_length = T::one() / params.cable_length;
        let mut rows = self.u;
        for (axis, (row, q_h)) in rows.iter_mut().zip([q.x, q.y]).enumerate() {
            for (entry, &s) in row.iter_mut().zip(&self.tension) {
                *entry = (*entry - q_h * s) * per_length;
            }
            if let Some(entry) = row.get_mut(axis) {
                *entry -= self.pull.tension * per_length;
            }
        }
        rows
    }
}

/// Rᵀ v.
#[inline(always)]
pub(crate) fn into_body<T: Real>(attitude: &Matrix3<T>, v: &Vector3<T>) -> Vector3<T> {
    let [b1, b2, b3] = axes(attitude);
    Vector3::new(b1.dot(v), b2.dot(v), b3.dot(v))
}
