//! Lower: from the commanded p⁽⁶⁾ and ψ̈ back to the inputs ū = (u_ζ, τ).
//!
//! The lift's inverse, one order up. With s = λ q and primes for time derivatives,
//!
//! ```text
//! p⁽⁶⁾ = s⁗ = λ⁗ q + 4 λ‴ q′ + 6 λ″ q″ + 4 λ′ q‴ + λ q⁗
//! q·q⁗ = −(4 q′·q‴ + 3 |q″|²)                                   (7.1)
//! q⁗ = κ″ b3 + 2 κ′ b3′ + κ b3″ + c s″
//! b3″ = R (ω × (ω × e3)) + ω̇2 b1 − ω̇1 b2                        (7.3)
//! ```
//!
//! The product with q gives λ⁗, hence q⁗ (7.2); the products with b1 and b2 give ω̇2 and ω̇1
//! without κ″ (7.4). It divides by λ (zero in free fall) and κ (zero without thrust).

use model::{Real, State, Vehicle, Yaw};
use nalgebra::Vector3;

use crate::law::lift::Lift;

/// The torque τ in body axes, N·m, that with u_ζ = p⁽⁶⁾·e3 gives the payload the sixth
/// derivative `position_6` (N, m/s⁶) and the UAV the yaw acceleration `yaw_2`, rad/s², against
/// `disturbing_torque`.
#[inline(always)]
pub fn lower<T: Real>(
    vehicle: &Vehicle<T>,
    state: &State<T>,
    lift: &Lift<T>,
    yaw: &Yaw<T>,
    position_6: &Vector3<T>,
    yaw_2: T,
    disturbing_torque: &Vector3<T>,
) -> Vector3<T> {
    let three = T::lit(3.0);
    let four = T::lit(4.0);
    let six = T::lit(6.0);
    let (q, w) = (&state.rod, &state.rod_rate);
    let omega = &state.body_rate;
    let [lambda, lambda_1, lambda_2, lambda_3] = lift.lambda;
    let (rod_2, rod_3) = (&lift.rod_2, &lift.rod_3);

    // The part of s⁗ that is known, and with it λ⁗ and q⁗.
    let known = w * (four * lambda_3) + rod_2 * (six * lambda_2) + rod_3 * (four * lambda_1);
    let rest = position_6 - known;
    let lambda_4 = q.dot(&rest) + lambda * (four * w.dot(rod_3) + three * rod_2.dot(rod_2));
    let rod_4 = (rest - q * lambda_4) * (T::one() / lambda);

    // What thrust direction has to bring: κ b3″ + κ″ b3 + 2 κ′ b3′.
    let bend = rod_4 - lift.snap * vehicle.coupling();
    let b1 = state.attitude.column(0);
    let b2 = state.attitude.column(1);
    let per_kappa = T::one() / lift.kappa;
    let twist = lift.kappa_dot + lift.kappa_dot;
    let omega_dot_2 = (b1.dot(&bend) - twist * omega.y) * per_kappa - omega.x * omega.z;
    let omega_dot_1 = omega.y * omega.z - (b2.dot(&bend) + twist * omega.x) * per_kappa;
    let omega_dot_3 = yaw.body_acceleration(state, omega_dot_1, omega_dot_2, yaw_2);

    let omega_dot = Vector3::new(omega_dot_1, omega_dot_2, omega_dot_3);
    let inertia = vehicle.inertia();
    inertia.component_mul(&omega_dot) + omega.cross(&inertia.component_mul(omega)) - disturbing_torque
}
