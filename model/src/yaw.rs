//! Yaw ψ of the 2-1-3 Euler angles R = Ry(θ) Rx(φ) Rz(ψ), its rate, and the ω̇3 that gives a
//! wanted ψ̈.
//!
//! The second row of R is (y, x, z) = (cosφ sinψ, cosφ cosψ, −sinφ), so with N = x² + y² =
//! cos²φ and n = x ω2 + y ω1
//!
//! ```text
//! ψ = atan2(y, x),   ψ̇ = ω3 − z n/N                            (6.1)
//! (ẏ, ẋ, ż) = (x ω3 − z ω2, z ω1 − y ω3, y ω2 − x ω1)          (6.2)
//! ```
//!
//! which needs no sine, cosine or tangent. It divides by N, zero where b3 is horizontal along ±n2.

use crate::scalar::Real;
use crate::state::State;

/// Yaw and what its second derivative needs.
#[derive(Clone, Copy, Debug)]
pub struct Yaw<T> {
    /// ψ, rad, in [−π, π].
    pub angle: T,
    /// ψ̇, rad/s.
    pub rate: T,
    /// cos²φ, the chart's distance from its singularity.
    pub cos_phi_squared: T,
    per_n: T,
}

impl<T: Real> Yaw<T> {
    /// Yaw and yaw rate of `state`.
    #[inline]
    pub fn of(state: &State<T>) -> Self {
        let (y, x, z) = (state.attitude.m21, state.attitude.m22, state.attitude.m23);
        let omega = &state.body_rate;
        let cos_phi_squared = x * x + y * y;
        let per_n = T::one() / cos_phi_squared;
        let rate = omega.z - z * (x * omega.y + y * omega.x) * per_n;
        Self { angle: y.atan2(x), rate, cos_phi_squared, per_n }
    }

    /// The ω̇3, rad/s², that with the given ω̇1, ω̇2 makes ψ̈ = `acceleration`: (6.3).
    #[inline]
    pub fn body_acceleration(&self, state: &State<T>, omega_dot_1: T, omega_dot_2: T, acceleration: T) -> T {
        let (y, x, z) = (state.attitude.m21, state.attitude.m22, state.attitude.m23);
        let omega = &state.body_rate;
        let y_dot = x * omega.z - z * omega.y;
        let x_dot = z * omega.x - y * omega.z;
        let z_dot = y * omega.y - x * omega.x;
        // n/N and its derivative; Ṅ = −2 z ż since the row has unit length.
        let n = (x * omega.y + y * omega.x) * self.per_n;
        let n_dot = x_dot * omega.y + y_dot * omega.x + x * omega_dot_2 + y * omega_dot_1;
        let n_rate = (n_dot + (z + z) * z_dot * n) * self.per_n;
        acceleration + z_dot * n + z * n_rate
    }
}
