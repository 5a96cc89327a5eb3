//! Lift: from the state and ζ to the payload's Taylor series, p to p⁽⁵⁾, with one line of
//! algebra an order.
//!
//! With λ the payload's specific force along the rod, s = λ q, κ = T/(m_Q L) and c = M/(m_Q L),
//! the model with the [disturbances](crate::sampled::observer) d and δ is
//!
//! ```text
//! v̇ = g e3 + d + s,           s3 = ζ1 − g − d3
//! q̈ = κ b3 + c s + δ,         κ (b3·q) = −(|q̇|² + c λ + δ·q)                    (12.1)
//! ```
//!
//! Each time derivative of these lines is linear in the highest derivative it brings, (4.1) to
//! (4.7) with (12.2): λ⁽ⁿ⁾ follows from s3⁽ⁿ⁾ = ζ_{n+1} − d3⁽ⁿ⁾, κ⁽ⁿ⁾
//! from the last equation, q⁽ⁿ⁺²⁾ from the pendulum line, and p⁽ⁿ⁺²⁾ = s⁽ⁿ⁾ +
//! d⁽ⁿ⁾. Of d and δ the first derivatives are known, and the others zero. It divides by q3 and
//! by b3·q, which are zero where the rod is horizontal and where the thrust is across it.

use model::{Disturbance, Real, Series, State, Vehicle};
use nalgebra::Vector3;

use crate::path::PositionSeries;

/// The payload's motion to fifth order, with what [`lower`](crate::law::lower::lower) needs to go
/// back.
#[derive(Clone, Copy, Debug)]
pub struct Lift<T> {
    /// p in N, m.
    pub position: PositionSeries<T>,
    /// p⁗ in N, m/s⁴.
    pub snap: Vector3<T>,
    /// λ, λ̇, λ̈, λ⃛: specific force along the rod, m/s²⁺ᵏ; λ = −g when hanging at rest.
    pub lambda: [T; 4],
    /// κ = T/(m_Q L), 1/s².
    pub kappa: T,
    /// κ̇, 1/s³.
    pub kappa_dot: T,
    /// q̈ in N, 1/s².
    pub rod_2: Vector3<T>,
    /// q⃛ in N, 1/s³.
    pub rod_3: Vector3<T>,
    /// b3·q, 1 when the thrust acts along the rod.
    pub b3_rod: T,
}

impl<T: Real> Lift<T> {
    /// Thrust (3.5), T = κ m_Q L, N.
    #[inline]
    pub fn thrust(&self, vehicle: &Vehicle<T>) -> T {
        self.kappa * vehicle.thrust_per_kappa()
    }

    /// p⁽ᵏ⁾ in N, m/sᵏ, k from 0 to 5.
    #[inline]
    pub fn derivative(&self, k: usize) -> Vector3<T> {
        let [x, y, z] = &self.position;
        Vector3::new(x.derivative(k), y.derivative(k), z.derivative(k))
    }
}

/// Lifts `state` and the compensator's ζ = (v̇3, v̈3, …), m/s²⁺ᵏ, to the payload's series.
///
/// Needs |`rod`| = 1, `rod_rate` ⊥ `rod` and an orthonormal attitude.
#[inline(never)]
pub fn lift<T: Real>(vehicle: &Vehicle<T>, state: &State<T>, zeta: &[T; 4], disturbance: &Disturbance<T>) -> Lift<T> {
    let (d, delta) = (&disturbance.payload, &disturbance.rod);
    let (d_1, delta_1) = (&disturbance.payload_rate, &disturbance.rod_rate);
    let two = T::lit(2.0);
    let three = T::lit(3.0);
    let c = vehicle.coupling();
    let gravity = vehicle.params().gravity;
    let [zeta1, zeta2, zeta3, zeta4] = *zeta;
    let (q, w) = (&state.rod, &state.rod_rate);
    let b1: Vector3<T> = state.attitude.column(0).into();
    let b2: Vector3<T> = state.attitude.column(1).into();
    let b3: Vector3<T> = state.attitude.column(2).into();
    let b3_dot = b1 * state.body_rate.y - b2 * state.body_rate.x;

    let b3_rod = b3.dot(q);
    let per_q3 = T::one() / q.z;
    let per_b3_rod = T::one() / b3_rod;

    // Order 0: specific force, thrust, rod acceleration.
    let lambda = (zeta1 - gravity - d.z) * per_q3;
    let s = q * lambda;
    let kappa = -(w.dot(w) + c * lambda + delta.dot(q)) * per_b3_rod;
    let rod_2 = b3 * kappa + s * c + delta;

    // Order 1. Here and below the third component of s⁽ⁿ⁾ is what ζ says, free of rounding.
    let s_1_z = zeta2 - d_1.z;
    let lambda_1 = (s_1_z - lambda * w.z) * per_q3;
    let mut s_1 = q * lambda_1 + w * lambda;
    s_1.z = s_1_z;
    let kappa_dot =
        -(w.dot(&(rod_2 * two + delta)) + delta_1.dot(q) + c * lambda_1 + kappa * (b3_dot.dot(q) + b3.dot(w)))
            * per_b3_rod;
    let rod_3 = b3 * kappa_dot + b3_dot * kappa + s_1 * c + delta_1;

    // Orders 2 and 3 of the specific force need no more of the rod than q⃛.
    let lambda_2 = (zeta3 - two * lambda_1 * w.z - lambda * rod_2.z) * per_q3;
    let mut s_2 = q * lambda_2 + w * (two * lambda_1) + rod_2 * lambda;
    s_2.z = zeta3;
    let lambda_3 = (zeta4 - three * (lambda_2 * w.z + lambda_1 * rod_2.z) - lambda * rod_3.z) * per_q3;
    let mut s_3 = q * lambda_3 + (w * lambda_2 + rod_2 * lambda_1) * three + rod_3 * lambda;
    s_3.z = zeta4;

    let (p, v) = (&state.position, &state.velocity);
    let zero = T::zero();
    Lift {
        position: [
            Series::from_derivatives([p.x, v.x, s.x + d.x, s_1.x + d_1.x, s_2.x, s_3.x, zero]),
            Series::from_derivatives([p.y, v.y, s.y + d.y, s_1.y + d_1.y, s_2.y, s_3.y, zero]),
            Series::from_derivatives([p.z, v.z, zeta1, zeta2, zeta3, zeta4, zero]),
        ],
        snap: s_2,
        lambda: [lambda, lambda_1, lambda_2, lambda_3],
        kappa,
        kappa_dot,
        rod_2,
        rod_3,
        b3_rod,
    }
}
