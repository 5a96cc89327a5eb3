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

use crate::world::integrate::{rk4_end, rk4_rates};
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

/// All but the position, which nothing depends on: attitude quaternion, velocity v, body rate ω,
/// rod q, rod rate q̇.
type Coordinates = [f64; 16];
const ATTITUDE: std::ops::Range<usize> = 0..4;
const VELOCITY: usize = 4;
const BODY_RATE: usize = 7;
const ROD: usize = 10;
const ROD_RATE: usize = 13;

/// A moving slung-load system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Multibody {
    vehicle: VehicleParameters,
    inertias: Inertias,
    /// Of the payload in N, m.
    position: Vector3<f64>,
    x: Coordinates,
}

impl Multibody {
    /// `vehicle` in `state`, whose rod and attitude are put back on S² and SO(3) to within
    /// rounding.
    #[must_use]
    pub fn new(vehicle: VehicleParameters, state: &State<f64>) -> Self {
        let mut x = coordinates(
            quaternion(&state.attitude),
            [&state.velocity, &state.body_rate, &state.rod, &state.rod_rate],
        );
        project(&mut x);
        Self { vehicle, inertias: Inertias::of(&vehicle), position: state.position, x }
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
        self.inertias = Inertias::of(&self.vehicle);
    }

    /// The state as the law takes it.
    #[inline]
    #[must_use]
    pub fn state(&self) -> State<f64> {
        let x = &self.x;
        State {
            position: self.position,
            velocity: vector(x, VELOCITY),
            rod: vector(x, ROD),
            rod_rate: vector(x, ROD_RATE),
            attitude: rotation(attitude(x)),
            body_rate: vector(x, BODY_RATE),
        }
    }

    /// Position of the payload in N, m.
    #[must_use]
    pub fn position(&self) -> Vector3<f64> {
        self.position
    }

    /// Velocity of the UAV in N, m/s: v − L q̇.
    #[must_use]
    pub fn uav_velocity(&self) -> Vector3<f64> {
        vector(&self.x, VELOCITY) - vector(&self.x, ROD_RATE) * self.vehicle.rod_length
    }

    /// Position of the UAV in N, m: p − L q.
    #[must_use]
    pub fn uav_position(&self) -> Vector3<f64> {
        self.position - vector(&self.x, ROD) * self.vehicle.rod_length
    }

    /// Accelerations now, under `command` and `loads`.
    #[must_use]
    pub fn acceleration(&self, command: &Command<f64>, loads: &Loads) -> Acceleration {
        self.inertias.acceleration(&self.x, command, loads)
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
        let inertias = &self.inertias;
        let derivative = |acting: &Command<f64>, x: &Coordinates| {
            let (v, w) = (vector(x, VELOCITY), vector(x, ROD_RATE));
            let loads = loads(&v, &(v - w * inertias.rod_length));
            let Acceleration { payload, rod, body } = inertias.acceleration(x, acting, &loads);
            coordinates(quaternion_rate(attitude(x), &vector(x, BODY_RATE)), [&payload, &body, &w, &rod])
        };
        let acting = [command(0.0), command(0.5 * step), command(step)];
        let rates = rk4_rates(derivative, &acting, &self.x, step);
        // Its own rates are the velocities of the stages, each from the one before.
        let [a1, a2, a3] = [0, 1, 2].map(|stage| vector(&rates[stage], VELOCITY));
        self.position += (vector(&self.x, VELOCITY) + (a1 + a2 + a3) * (step / 6.0)) * step;
        self.x = rk4_end(&self.x, &rates, step);
        project(&mut self.x);
    }

    /// Kinetic and potential energy, J; the latter is zero with both bodies at height zero.
    #[must_use]
    pub fn energy(&self) -> f64 {
        let VehicleParameters { payload_mass, uav_mass, inertia, gravity, .. } = self.vehicle;
        let spin: f64 = inertia.iter().zip(&vector(&self.x, BODY_RATE)).map(|(j, o)| j * o * o).sum();
        let payload = square(&vector(&self.x, VELOCITY)) * payload_mass;
        let uav = square(&self.uav_velocity()) * uav_mass;
        let down = self.position.z * payload_mass + self.uav_position().z * uav_mass;
        0.5 * (payload + uav + spin) - down * gravity
    }

    /// Whether every coordinate is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        // Neither an infinity nor a NaN has a finite sum with anything.
        let (pairs, _) = self.x.as_chunks();
        let [a, b] = pairs.iter().fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y]);
        (a + b + self.position.sum()).is_finite()
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

/// Quaternion and four vectors in their order.
#[inline]
fn coordinates([q0, q1, q2, q3]: [f64; 4], [v, omega, q, w]: [&Vector3<f64>; 4]) -> Coordinates {
    [q0, q1, q2, q3, v.x, v.y, v.z, omega.x, omega.y, omega.z, q.x, q.y, q.z, w.x, w.y, w.z]
}

#[inline]
fn attitude(x: &Coordinates) -> [f64; 4] {
    [x[0], x[1], x[2], x[3]]
}

/// What a vehicle's numbers make of forces and torques.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Inertias {
    rod_length: f64,
    gravity: f64,
    /// 1/(m_L L) and 1/(m_Q L), 1/(kg·m).
    per_payload: f64,
    per_uav: f64,
    /// 1/M, 1/kg, and m_Q L/M, m.
    per_total: f64,
    lever: f64,
    /// Of each axis 1/J, 1/(kg·m²), and what (J ω × ω)/J has of the product of the other two rates.
    per_inertia: Vector3<f64>,
    gyroscopic: Vector3<f64>,
}

impl Inertias {
    fn of(vehicle: &VehicleParameters) -> Self {
        let VehicleParameters { payload_mass, uav_mass, rod_length, inertia: [j1, j2, j3], gravity } = *vehicle;
        let per_total = 1.0 / (payload_mass + uav_mass);
        let per_inertia = Vector3::new(1.0 / j1, 1.0 / j2, 1.0 / j3);
        Self {
            rod_length,
            gravity,
            per_payload: 1.0 / (payload_mass * rod_length),
            per_uav: 1.0 / (uav_mass * rod_length),
            per_total,
            lever: uav_mass * rod_length * per_total,
            per_inertia,
            gyroscopic: Vector3::new(j2 - j3, j3 - j1, j1 - j2).component_mul(&per_inertia),
        }
    }

    #[inline]
    fn acceleration(&self, x: &Coordinates, command: &Command<f64>, loads: &Loads) -> Acceleration {
        let (q, w, omega) = (vector(x, ROD), vector(x, ROD_RATE), vector(x, BODY_RATE));
        let [q0, q1, q2, q3] = attitude(x);
        let b3 =
            Vector3::new(2.0 * (q1 * q3 + q0 * q2), 2.0 * (q2 * q3 - q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3);
        // What acts on the UAV but for gravity and rod.
        let uav = loads.uav_force - b3 * command.thrust;
        let apart = loads.payload_force * self.per_payload - uav * self.per_uav;
        let rod = apart - q * (q.dot(&apart) + square(&w));
        let mut payload = (loads.payload_force + uav) * self.per_total + rod * self.lever;
        payload.z += self.gravity;
        let torque = command.torque + loads.torque;
        let products = Vector3::new(omega.y * omega.z, omega.z * omega.x, omega.x * omega.y);
        let body = torque.component_mul(&self.per_inertia) + products.component_mul(&self.gyroscopic);
        Acceleration { payload, rod, body }
    }
}

/// Back to |q| = 1, q̇ ⊥ q and a unit quaternion.
#[inline]
fn project(x: &mut Coordinates) {
    let q = vector(x, ROD);
    let q = q * (1.0 / square(&q).sqrt());
    let w = vector(x, ROD_RATE);
    let w = w - q * q.dot(&w);
    let [q0, q1, q2, q3] = attitude(x);
    let per_norm = 1.0 / (q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3).sqrt();
    x[ROD..ROD + 3].copy_from_slice(q.as_slice());
    x[ROD_RATE..].copy_from_slice(w.as_slice());
    for part in &mut x[ATTITUDE] {
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
pub fn quaternion(r: &Matrix3<f64>) -> [f64; 4] {
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
