//! The dynamic compensator (7): ζ, its propagation over a sample, and the ζ that continues a motion at hand.
//!
//! ζ1 stands for v̇3, and ζ1˙ = ζ2, ζ2˙ = ζ3, ζ3˙ = ζ4, ζ4˙ = u_ζ. **Hover is ζ = 0.**

use nalgebra::Vector3;

use crate::disturbance::Disturbance;
use crate::model::Model;
use crate::scalar::Real;
use crate::state::State;
use crate::vehicle::Vehicle;

/// Thrust and torque for the coming hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command<T> {
    /// Total thrust along −b3, N.
    pub thrust: T,
    /// Torque in body axes, N·m.
    pub torque: Vector3<T>,
}

impl<T: Real> Command<T> {
    /// No thrust, no torque.
    pub fn zero() -> Self {
        Self { thrust: T::zero(), torque: Vector3::zeros() }
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { thrust: self.thrust + other.thrust, torque: self.torque + other.torque }
    }

    #[inline]
    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self { thrust: self.thrust - other.thrust, torque: self.torque - other.torque }
    }

    /// No infinity, no NaN.
    #[inline]
    pub fn is_finite(&self) -> bool {
        (self.thrust + self.torque.x + self.torque.y + self.torque.z).is_finite()
    }

    #[inline]
    pub(crate) fn times(&self, factor: T) -> Self {
        Self { thrust: self.thrust * factor, torque: self.torque * factor }
    }
}

/// The integrator chain (7) over `dt` with u_ζ held: exact.
#[inline]
pub fn propagate<T: Real>(zeta: &[T; 4], u_zeta: T, dt: T) -> [T; 4] {
    let half = dt * T::lit(1.0 / 2.0);
    let third = dt * T::lit(1.0 / 3.0);
    let quarter = dt * T::lit(1.0 / 4.0);
    let [z1, z2, z3, z4] = *zeta;
    [
        z1 + dt * (z2 + half * (z3 + third * (z4 + quarter * u_zeta))),
        z2 + dt * (z3 + half * (z4 + third * u_zeta)),
        z3 + dt * (z4 + half * u_zeta),
        z4 + dt * u_zeta,
    ]
}

/// The ζ that continues the motion at hand: (v̇3, v̈3, v⃛3, 0) under `applied` held constant, so that (9) returns the applied
/// thrust with its first two derivatives zero. These are the lift's equations with κ given and κ̇ = κ̈ = 0.
pub fn continuing<T: Real>(
    vehicle: &Vehicle<T>,
    state: &State<T>,
    applied: &Command<T>,
    disturbance: &Disturbance<T>,
) -> [T; 4] {
    let two = T::lit(2.0);
    let c = vehicle.coupling;
    let per_c = vehicle.inverse_coupling;
    let (q, w, omega) = (&state.rod, &state.rod_rate, &state.body_rate);
    let (delta, delta_1) = (&disturbance.rod, &disturbance.rod_rate);
    let b1: Vector3<T> = state.attitude.column(0).into();
    let b2: Vector3<T> = state.attitude.column(1).into();
    let b3: Vector3<T> = state.attitude.column(2).into();
    let model = Model::at(vehicle, state);
    let acceleration = model.acceleration(applied, disturbance);
    let omega_dot = &acceleration.body;
    let b3_1 = b1 * omega.y - b2 * omega.x;
    let b3_2 = b1 * (omega.x * omega.z + omega_dot.y) + b2 * (omega.y * omega.z - omega_dot.x)
        - b3 * (omega.x * omega.x + omega.y * omega.y);

    let kappa = applied.thrust * vehicle.kappa_per_thrust;
    let lambda = model.lambda(applied.thrust);
    let rod_2 = &acceleration.rod;
    let lambda_1 = -(w.dot(&(rod_2 * two + delta)) + delta_1.dot(q) + kappa * (b3_1.dot(q) + b3.dot(w))) * per_c;
    let s_1 = q * lambda_1 + w * lambda;
    let rod_3 = b3_1 * kappa + s_1 * c + delta_1;
    let lambda_2 = -(rod_2.dot(&(rod_2 * two + delta))
        + two * w.dot(delta_1)
        + two * w.dot(&rod_3)
        + kappa * (b3_2.dot(q) + two * b3_1.dot(w) + b3.dot(rod_2)))
        * per_c;
    let s_2_z = lambda_2 * q.z + two * lambda_1 * w.z + lambda * rod_2.z;
    [acceleration.payload.z, s_1.z + disturbance.payload_rate.z, s_2_z, T::zero()]
}
