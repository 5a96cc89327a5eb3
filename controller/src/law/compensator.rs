//! The dynamic compensator (3.4): ζ, its propagation over a sample, and the ζ that takes over a
//! motion at hand.
//!
//! ζ1 stands for v̇3, and ζ1˙ = ζ2, ζ2˙ = ζ3, ζ3˙ = ζ4, ζ4˙ = u_ζ. **Hover is ζ = 0.**

use model::{Disturbance, Real, State, Vehicle, dynamics::lambda};

/// The integrator chain over `dt` with u_ζ held, exact (11.4).
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

/// The ζ that takes over a motion at hand under `thrust`, N: (v̇3, 0, 0, 0), for which (3.5)
/// returns this thrust (11.8).
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
