//! The dynamic compensator (7): ζ, its propagation over a sample, and the ζ that takes over a motion at hand.
//!
//! ζ1 stands for v̇3, and ζ1˙ = ζ2, ζ2˙ = ζ3, ζ3˙ = ζ4, ζ4˙ = u_ζ. **Hover is ζ = 0.**

use nalgebra::Vector3;

use crate::disturbance::Disturbance;
use crate::model::lambda;
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
#[inline(never)]
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

/// The ζ that takes over a motion at hand under `thrust`, N: (v̇3, 0, 0, 0), for which (9) returns this thrust.
pub fn continuing<T: Real>(
    vehicle: &Vehicle<T>,
    state: &State<T>,
    thrust: T,
    disturbance: &Disturbance<T>,
) -> [T; 4] {
    let acceleration =
        lambda(vehicle, state, thrust) * state.rod.z + disturbance.payload.z + vehicle.params().gravity;
    [acceleration, T::zero(), T::zero(), T::zero()]
}
