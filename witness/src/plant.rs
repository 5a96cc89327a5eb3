//! The slung-load system (1.3), (2.5), (2.8), in the paper's own 16 coordinates.
//!
//! x = (p, α, β, φ, θ, ψ, v, α̇, β̇, ω): position p (m) and velocity v (m/s) of the payload
//! in N (n3 down); rod angles α, β (rad) with q = Rx(α) Ry(β) e3 from the UAV to the payload;
//! attitude R = Ry(θ) Rx(φ) Rz(ψ), body to inertial; body rate ω (rad/s) in body axes. The inputs
//! are the thrust T (N) along −b3 and the torque τ (N·m) in body axes.
//!
//! The chart ends at cos β = 0 and at cos φ = 0, where the derivative is not finite.
//!
//! All is generic over [`Scalar`], so that the witness can differentiate the same equation; nothing
//! here comes from the `controller` crate.

use crate::jet::{Scalar, add, cross, dot, scale};

/// Number of coordinates.
pub const STATES: usize = 16;

/// First index of each group of coordinates in the state.
pub mod index {
    /// Payload position p in N, m.
    pub const POSITION: usize = 0;
    /// Rod angle α, rad; β follows.
    pub const ALPHA: usize = 3;
    /// Roll φ, rad; θ and ψ follow.
    pub const PHI: usize = 5;
    /// Yaw ψ, rad.
    pub const PSI: usize = 7;
    /// Payload velocity v in N, m/s.
    pub const VELOCITY: usize = 8;
    /// Rod rate α̇, rad/s; β̇ follows.
    pub const ALPHA_DOT: usize = 11;
    /// Body rate ω in body axes, rad/s.
    pub const BODY_RATE: usize = 13;
}

/// The vehicle the plant simulates; the controller may be told another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleParameters {
    /// m_L, kg.
    pub payload_mass: f64,
    /// m_Q, kg.
    pub uav_mass: f64,
    /// L, m.
    pub rod_length: f64,
    /// Diagonal of J in body axes, kg·m².
    pub inertia: [f64; 3],
    /// g, m/s².
    pub gravity: f64,
}

impl Default for VehicleParameters {
    /// The paper's Table I.
    fn default() -> Self {
        Self { payload_mass: 0.5, uav_mass: 2.5, rod_length: 2.0, inertia: [0.03, 0.03, 0.05], gravity: 9.81 }
    }
}

impl VehicleParameters {
    /// M = m_L + m_Q, kg.
    #[must_use]
    pub fn total_mass(&self) -> f64 {
        self.payload_mass + self.uav_mass
    }
}

/// What the actuators do to the vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input<S = f64> {
    /// T, total thrust along −b3, N.
    pub thrust: S,
    /// τ in body axes, N·m.
    pub torque: [S; 3],
}

/// The sines and cosines of one state and the directions they give.
struct Geometry<S> {
    alpha: (S, S),
    beta: (S, S),
    phi: (S, S),
    theta: (S, S),
    psi: (S, S),
    /// q, from the UAV to the payload, in N.
    rod: [S; 3],
    /// b3 in N.
    b3: [S; 3],
}

impl<S: Scalar> Geometry<S> {
    #[inline]
    fn of(x: &[S; STATES]) -> Self {
        let (alpha, beta) = (x[index::ALPHA].sin_cos(), x[index::ALPHA + 1].sin_cos());
        let (phi, theta) = (x[index::PHI].sin_cos(), x[index::PHI + 1].sin_cos());
        Self {
            rod: [beta.0, -(alpha.0 * beta.1), alpha.1 * beta.1],
            b3: [theta.0 * phi.1, -phi.0, theta.1 * phi.1],
            psi: x[index::PSI].sin_cos(),
            alpha,
            beta,
            phi,
            theta,
        }
    }

    /// q̇ = α̇ ∂q/∂α + β̇ ∂q/∂β.
    #[inline]
    fn rod_rate(&self, x: &[S; STATES]) -> [S; 3] {
        let (sin_alpha, cos_alpha) = self.alpha;
        let (sin_beta, cos_beta) = self.beta;
        let (alpha_dot, beta_dot) = (x[index::ALPHA_DOT], x[index::ALPHA_DOT + 1]);
        [
            cos_beta * beta_dot,
            sin_alpha * sin_beta * beta_dot - cos_alpha * cos_beta * alpha_dot,
            -(cos_alpha * sin_beta * beta_dot) - sin_alpha * cos_beta * alpha_dot,
        ]
    }

    /// R, body to inertial, as its columns b1, b2, b3.
    fn attitude(&self) -> [[S; 3]; 3] {
        let (sin_phi, cos_phi) = self.phi;
        let (sin_theta, cos_theta) = self.theta;
        let (sin_psi, cos_psi) = self.psi;
        // The first two columns of Ry(θ) Rx(φ), turned by Rz(ψ).
        let a1 = [cos_theta, S::constant(0.0), -sin_theta];
        let a2 = [sin_theta * sin_phi, cos_phi, cos_theta * sin_phi];
        [add(scale(a1, cos_psi), scale(a2, sin_psi)), add(scale(a2, cos_psi), scale(a1, -sin_psi)), self.b3]
    }

    /// The part of ẋ that no input enters: f of ẋ = f(x) + G(x) u.
    #[inline]
    fn drift(&self, vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; STATES] {
        let velocity = group(x, index::VELOCITY);
        let (alpha_dot, beta_dot) = (x[index::ALPHA_DOT], x[index::ALPHA_DOT + 1]);
        let omega = group(x, index::BODY_RATE);
        let (sin_beta, cos_beta) = self.beta;
        let (sin_psi, cos_psi) = self.psi;

        let turn = (sin_psi * omega[0] + cos_psi * omega[1]) / self.phi.1;
        let rod_rate_squared = cos_beta * cos_beta * alpha_dot * alpha_dot + beta_dot * beta_dot;
        let pull = -(rod_rate_squared * (vehicle.rod_length * vehicle.uav_mass / vehicle.total_mass()));
        let [j1, j2, j3] = vehicle.inertia;
        [
            velocity[0],
            velocity[1],
            velocity[2],
            alpha_dot,
            beta_dot,
            cos_psi * omega[0] - sin_psi * omega[1],
            turn,
            omega[2] + self.phi.0 * turn,
            pull * self.rod[0],
            pull * self.rod[1],
            pull * self.rod[2] + vehicle.gravity,
            sin_beta / cos_beta * alpha_dot * beta_dot * 2.0,
            -(sin_beta * cos_beta * alpha_dot * alpha_dot),
            omega[1] * omega[2] * ((j2 - j3) / j1),
            omega[2] * omega[0] * ((j3 - j1) / j2),
            omega[0] * omega[1] * ((j1 - j2) / j3),
        ]
    }

    /// The five non-zero entries of G's first column: ∂v̇/∂T, ∂α̈/∂T, ∂β̈/∂T.
    #[inline]
    fn thrust_effect(&self, vehicle: &VehicleParameters) -> [S; 5] {
        let (sin_alpha, cos_alpha) = self.alpha;
        let (sin_beta, cos_beta) = self.beta;
        let pendulum = 1.0 / (vehicle.rod_length * vehicle.uav_mass);
        let m2_b3 = cos_alpha * self.b3[1] + sin_alpha * self.b3[2];
        let m1_b3 = cos_beta * self.b3[0] + sin_beta * (sin_alpha * self.b3[1] - cos_alpha * self.b3[2]);
        let pull = scale(self.rod, -dot(self.rod, self.b3) / vehicle.total_mass());
        [pull[0], pull[1], pull[2], -(m2_b3 / cos_beta) * pendulum, m1_b3 * pendulum]
    }
}

#[inline]
fn group<S: Scalar>(x: &[S; STATES], first: usize) -> [S; 3] {
    [x[first], x[first + 1], x[first + 2]]
}

/// ẋ = f(x) + G(x) u.
#[inline]
pub fn derivative<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES], input: &Input<S>) -> [S; STATES] {
    let geometry = Geometry::of(x);
    let mut rate = geometry.drift(vehicle, x);
    for (slot, effect) in rate[index::VELOCITY..].iter_mut().zip(geometry.thrust_effect(vehicle)) {
        *slot = *slot + effect * input.thrust;
    }
    for axis in 0..3 {
        let slot = &mut rate[index::BODY_RATE + axis];
        *slot = *slot + input.torque[axis] / vehicle.inertia[axis];
    }
    rate
}

/// f(x) of ẋ = f(x) + G(x) u.
pub fn drift<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; STATES] {
    Geometry::of(x).drift(vehicle, x)
}

/// G(x) of ẋ = f(x) + G(x) u: sixteen rows, columns T, τ1, τ2, τ3.
pub fn input_matrix<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [[S; 4]; STATES] {
    let mut matrix = [[S::constant(0.0); 4]; STATES];
    let effect = Geometry::of(x).thrust_effect(vehicle);
    for (row, effect) in matrix[index::VELOCITY..].iter_mut().zip(effect) {
        row[0] = effect;
    }
    for axis in 0..3 {
        matrix[index::BODY_RATE + axis][1 + axis] = S::constant(1.0 / vehicle.inertia[axis]);
    }
    matrix
}

/// q, the unit vector of the rod in N, from the UAV to the payload.
pub fn rod<S: Scalar>(x: &[S; STATES]) -> [S; 3] {
    Geometry::of(x).rod
}

/// q̇, 1/s, in N.
pub fn rod_rate<S: Scalar>(x: &[S; STATES]) -> [S; 3] {
    Geometry::of(x).rod_rate(x)
}

/// R, body to inertial, as its columns b1, b2, b3 in N.
pub fn attitude<S: Scalar>(x: &[S; STATES]) -> [[S; 3]; 3] {
    Geometry::of(x).attitude()
}

/// Position of the UAV in N, m: p − L q.
pub fn uav_position<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; 3] {
    let lever = S::constant(-vehicle.rod_length);
    add(group(x, index::POSITION), scale(rod(x), lever))
}

/// Velocity of the UAV in N, m/s: v − L q̇.
pub fn uav_velocity<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; 3] {
    let lever = S::constant(-vehicle.rod_length);
    add(group(x, index::VELOCITY), scale(rod_rate(x), lever))
}

/// Kinetic and potential energy, J; the latter is zero with both bodies at height zero.
pub fn energy<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> S {
    let payload = group(x, index::VELOCITY);
    let uav = uav_velocity(vehicle, x);
    let omega = group(x, index::BODY_RATE);
    let [j1, j2, j3] = vehicle.inertia;
    let spin = omega[0] * omega[0] * j1 + omega[1] * omega[1] * j2 + omega[2] * omega[2] * j3;
    let kinetic = (dot(payload, payload) * vehicle.payload_mass + dot(uav, uav) * vehicle.uav_mass + spin) * 0.5;
    let down = x[index::POSITION + 2] * vehicle.payload_mass + uav_position(vehicle, x)[2] * vehicle.uav_mass;
    kinetic - down * vehicle.gravity
}

/// Linear momentum of both bodies in N, kg·m/s.
pub fn momentum<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; 3] {
    let payload = group(x, index::VELOCITY).map(|v| v * vehicle.payload_mass);
    let uav = uav_velocity(vehicle, x).map(|v| v * vehicle.uav_mass);
    add(payload, uav)
}

/// Angular momentum of the two point masses about the origin of N, kg·m²/s.
pub fn orbital_momentum<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; 3] {
    let payload = cross(group(x, index::POSITION), group(x, index::VELOCITY));
    let uav = cross(uav_position(vehicle, x), uav_velocity(vehicle, x));
    add(payload.map(|h| h * vehicle.payload_mass), uav.map(|h| h * vehicle.uav_mass))
}

/// Angular momentum of the UAV's body about its centre of mass, R J ω in N, kg·m²/s.
pub fn spin_momentum<S: Scalar>(vehicle: &VehicleParameters, x: &[S; STATES]) -> [S; 3] {
    let [b1, b2, b3] = attitude(x);
    let omega = group(x, index::BODY_RATE);
    let [j1, j2, j3] = vehicle.inertia;
    add(add(scale(b1, omega[0] * j1), scale(b2, omega[1] * j2)), scale(b3, omega[2] * j3))
}

/// d_C: distance (m) of a point from the horizontal circle of the paper, centred on n3 at height
/// `p3`.
#[must_use]
pub fn distance_to_circle(position: [f64; 3], radius: f64, p3: f64) -> f64 {
    (position[0].hypot(position[1]) - radius).hypot(position[2] - p3)
}
