//! The slung-load system on R³ × S² × SO(3), with forces from outside on either body and a
//! disturbing torque: what campaigns fly. A tumbling vehicle has no chart to fall off, and no step
//! takes a sine.
//!
//! By virtual work, with the payload at p and the UAV at p − L q, for all δp and all δq ⊥ q,
//!
//! ```text
//! (m_L v̇ − F_L − m_L g e3)·δp + (m_Q (v̇ − L q̈) − F_Q − m_Q g e3 + T b3)·(δp − L δq) = 0
//! ```
//!
//! δp gives the motion of the centre of mass, δq the rod's across itself, and |q| = 1 the rest,
//! q·q̈ = −|q̇|²:
//!
//! ```text
//! M v̇ = F_L + F_Q + M g e3 − T b3 + m_Q L q̈
//! q̈ = (1 − q qᵀ)(F_L/m_L − F_Q/m_Q + T b3/m_Q)/L − |q̇|² q
//! J ω̇ = J ω × ω + τ + τ_d,   Ṙ = R ω^
//! ```
//!
//! Neither [`plant`](witness::plant) nor the `controller` crate has a part in it; the former is its
//! witness in the tests. Attitude is carried as a quaternion; after each Runge-Kutta step rod, rod
//! rate and quaternion are projected back, which keeps the method's order.

use controller::{Command, Matrix3, State, Vector3};

use crate::world::integrate::rk4_step;
use witness::plant::VehicleParameters;

/// Forces and torque from outside: neither gravity nor the rotors'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads {
    /// F_L on the payload in N, N.
    pub payload_force: Vector3<f64>,
    /// F_Q on the UAV in N, N.
    pub uav_force: Vector3<f64>,
    /// τ_d on the UAV in body axes, N·m.
    pub torque: Vector3<f64>,
}

impl Loads {
    /// None.
    #[must_use]
    pub fn none() -> Self {
        Self { payload_force: Vector3::zeros(), uav_force: Vector3::zeros(), torque: Vector3::zeros() }
    }
}

/// Time derivatives of the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceleration {
    /// v̇ of the payload in N, m/s².
    pub payload: Vector3<f64>,
    /// q̈ in N, 1/s².
    pub rod: Vector3<f64>,
    /// ω̇ in body axes, rad/s².
    pub body: Vector3<f64>,
}

/// Position p, velocity v, rod q, rod rate q̇, attitude quaternion, body rate ω.
const COORDINATES: usize = 19;

/// A moving slung-load system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multibody {
    vehicle: VehicleParameters,
    x: [f64; COORDINATES],
}

impl Multibody {
    /// `vehicle` in `state`, whose rod and attitude are put back on S² and SO(3) to within
    /// rounding.
    #[must_use]
    pub fn new(vehicle: VehicleParameters, state: &State<f64>) -> Self {
        let mut x = [0.0; COORDINATES];
        x[..3].copy_from_slice(state.position.as_slice());
        x[3..6].copy_from_slice(state.velocity.as_slice());
        x[6..9].copy_from_slice(state.rod.as_slice());
        x[9..12].copy_from_slice(state.rod_rate.as_slice());
        x[12..16].copy_from_slice(&quaternion(&state.attitude));
        x[16..].copy_from_slice(state.body_rate.as_slice());
        project(&mut x);
        Self { vehicle, x }
    }

    /// The vehicle that moves.
    #[must_use]
    pub fn vehicle(&self) -> &VehicleParameters {
        &self.vehicle
    }

    /// Another payload mass, kg, from now on, all velocities kept: the mass joins or leaves at the
    /// payload's velocity.
    pub fn set_payload_mass(&mut self, mass: f64) {
        self.vehicle.payload_mass = mass;
    }

    /// The state as the law takes it.
    #[must_use]
    pub fn state(&self) -> State<f64> {
        let x = &self.x;
        State {
            position: vector(x, 0),
            velocity: vector(x, 3),
            rod: vector(x, 6),
            rod_rate: vector(x, 9),
            attitude: rotation([x[12], x[13], x[14], x[15]]),
            body_rate: vector(x, 16),
        }
    }

    /// Position of the payload in N, m.
    #[must_use]
    pub fn position(&self) -> Vector3<f64> {
        vector(&self.x, 0)
    }

    /// Velocity of the UAV in N, m/s: v − L q̇.
    #[must_use]
    pub fn uav_velocity(&self) -> Vector3<f64> {
        vector(&self.x, 3) - vector(&self.x, 9) * self.vehicle.rod_length
    }

    /// Position of the UAV in N, m: p − L q.
    #[must_use]
    pub fn uav_position(&self) -> Vector3<f64> {
        vector(&self.x, 0) - vector(&self.x, 6) * self.vehicle.rod_length
    }

    /// Accelerations now, under `command` and `loads`.
    #[must_use]
    pub fn acceleration(&self, command: &Command<f64>, loads: &Loads) -> Acceleration {
        acceleration(&self.vehicle, &self.x, command, loads)
    }

    /// One Runge-Kutta step over `step` seconds, then the projection. `command` gives thrust and
    /// torque, and `loads` what the velocities of payload and UAV (N, m/s) bring with them, at a
    /// time since the step's start.
    #[inline]
    pub fn advance(
        &mut self,
        step: f64,
        command: impl Fn(f64) -> Command<f64>,
        loads: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Loads,
    ) {
        let vehicle = &self.vehicle;
        // The two stages in the middle share theirs.
        let acting = [0.0, 0.5 * step, step].map(command);
        let derivative = |t: f64, x: &[f64; COORDINATES]| {
            let (v, w) = (vector(x, 3), vector(x, 9));
            let loads = loads(&v, &(v - w * vehicle.rod_length));
            let stage = usize::from(t > 0.0) + usize::from(t == step);
            let Acceleration { payload, rod, body } = acceleration(vehicle, x, &acting[stage], &loads);
            let turn = quaternion_rate([x[12], x[13], x[14], x[15]], &vector(x, 16));
            [
                v.x, v.y, v.z, payload.x, payload.y, payload.z, w.x, w.y, w.z, rod.x, rod.y, rod.z, turn[0], turn[1],
                turn[2], turn[3], body.x, body.y, body.z,
            ]
        };
        self.x = rk4_step(derivative, 0.0, &self.x, step);
        project(&mut self.x);
    }

    /// Kinetic and potential energy, J; the latter is zero with both bodies at height zero.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let VehicleParameters { payload_mass, uav_mass, inertia, gravity, .. } = self.vehicle;
        let spin: f64 = inertia.iter().zip(&self.x[16..]).map(|(j, o)| j * o * o).sum();
        let payload = square(&vector(&self.x, 3)) * payload_mass;
        let uav = square(&self.uav_velocity()) * uav_mass;
        let down = self.x[2] * payload_mass + self.uav_position().z * uav_mass;
        0.5 * (payload + uav + spin) - down * gravity
    }

    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        // Nothing but an infinity and a NaN makes something of zero.
        self.x.iter().map(|value| 0.0 * value).sum::<f64>() == 0.0
    }
}

/// Three coordinates in a row.
#[inline]
pub(super) fn vector(x: &[f64], first: usize) -> Vector3<f64> {
    Vector3::new(x[first], x[first + 1], x[first + 2])
}

/// |v|²: nalgebra has it for scalars with a standard library behind them only.
#[inline]
pub(super) fn square(v: &Vector3<f64>) -> f64 {
    v.dot(v)
}

#[inline]
fn acceleration(
    vehicle: &VehicleParameters,
    x: &[f64; COORDINATES],
    command: &Command<f64>,
    loads: &Loads,
) -> Acceleration {
    let VehicleParameters { payload_mass, uav_mass, rod_length, inertia: [j1, j2, j3], gravity } = *vehicle;
    let (q, w, omega) = (vector(x, 6), vector(x, 9), vector(x, 16));
    let [q0, q1, q2, q3] = [x[12], x[13], x[14], x[15]];
    let b3 =
        Vector3::new(2.0 * (q1 * q3 + q0 * q2), 2.0 * (q2 * q3 - q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3);
    // What acts on the UAV but for gravity and rod.
    let uav = loads.uav_force - b3 * command.thrust;
    let apart = (loads.payload_force / payload_mass - uav / uav_mass) / rod_length;
    let rod = apart - q * (q.dot(&apart) + square(&w));
    let mut payload = (loads.payload_force + uav + rod * (uav_mass * rod_length)) / (payload_mass + uav_mass);
    payload.z += gravity;
    let torque = command.torque + loads.torque;
    let body = Vector3::new(
        (torque.x + (j2 - j3) * omega.y * omega.z) / j1,
        (torque.y + (j3 - j1) * omega.z * omega.x) / j2,
        (torque.z + (j1 - j2) * omega.x * omega.y) / j3,
    );
    Acceleration { payload, rod, body }
}

/// Back to |q| = 1, q̇ ⊥ q and a unit quaternion.
#[inline]
fn project(x: &mut [f64; COORDINATES]) {
    let q = vector(x, 6);
    let q = q / square(&q).sqrt();
    let w = vector(x, 9);
    let w = w - q * q.dot(&w);
    x[6..9].copy_from_slice(q.as_slice());
    x[9..12].copy_from_slice(w.as_slice());
    let per_norm = 1.0 / (x[12] * x[12] + x[13] * x[13] + x[14] * x[14] + x[15] * x[15]).sqrt();
    for part in &mut x[12..16] {
        *part *= per_norm;
    }
}

/// R of a unit quaternion (scalar first).
#[must_use]
pub fn rotation([w, x, y, z]: [f64; 4]) -> Matrix3<f64> {
    Matrix3::new(
        w * w + x * x - y * y - z * z,
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        w * w - x * x + y * y - z * z,
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        w * w - x * x - y * y + z * z,
    )
}

/// Half the quaternion times (0, ω), ω in body axes.
#[inline]
pub(super) fn quaternion_rate(quaternion: [f64; 4], omega: &Vector3<f64>) -> [f64; 4] {
    let [q0, q1, q2, q3] = quaternion.map(|part| 0.5 * part);
    let [o1, o2, o3] = [omega.x, omega.y, omega.z];
    [
        -q1 * o1 - q2 * o2 - q3 * o3,
        q0 * o1 + q2 * o3 - q3 * o2,
        q0 * o2 + q3 * o1 - q1 * o3,
        q0 * o3 + q1 * o2 - q2 * o1,
    ]
}

/// A quaternion (scalar first, unit to within rounding) of a rotation: by the largest of its four
/// parts, as Shepperd (1978).
pub(super) fn quaternion(r: &Matrix3<f64>) -> [f64; 4] {
    // Four times the products of each part with all parts.
    let trace = r.m11 + r.m22 + r.m33;
    let rows = [
        [1.0 + trace, r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12],
        [r.m32 - r.m23, 1.0 + 2.0 * r.m11 - trace, r.m12 + r.m21, r.m13 + r.m31],
        [r.m13 - r.m31, r.m12 + r.m21, 1.0 + 2.0 * r.m22 - trace, r.m23 + r.m32],
        [r.m21 - r.m12, r.m13 + r.m31, r.m23 + r.m32, 1.0 + 2.0 * r.m33 - trace],
    ];
    let largest = (1..4).fold(0, |best, i| if rows[i][i] > rows[best][best] { i } else { best });
    let per_largest = 0.5 / rows[largest][largest].sqrt();
    rows[largest].map(|product| product * per_largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_of_rotations_by_half_turns_come_back() {
        for quaternion_in in [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.6, 0.8, 0.0], [0.5, -0.5, 0.5, 0.5]]
        {
            let back = quaternion(&rotation(quaternion_in));
            let sign =
                if back.iter().zip(&quaternion_in).map(|(a, b)| a * b).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
            for (part, wanted) in back.iter().zip(&quaternion_in) {
                assert!((sign * part - wanted).abs() < 4.0 * f64::EPSILON, "{back:?}");
            }
        }
    }
}
