//! Model (1), free of charts and with the disturbances: accelerations under a held command. The look ahead and the observers
//! run on it; the law itself inverts it by [lift](mod@crate::lift) and [lower](mod@crate::lower).

use nalgebra::{Matrix3, Vector3};

use crate::compensator::Command;
use crate::disturbance::Disturbance;
use crate::scalar::Real;
use crate::state::State;
use crate::vehicle::Vehicle;

/// Time derivatives of the velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Acceleration<T> {
    /// v̇ in N, m/s².
    pub payload: Vector3<T>,
    /// q̈ in N, 1/s².
    pub rod: Vector3<T>,
    /// ω̇ in body axes, rad/s².
    pub body: Vector3<T>,
}

impl<T: Real> Acceleration<T> {
    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { payload: self.payload + other.payload, rod: self.rod + other.rod, body: self.body + other.body }
    }
}

/// The model at one state, ready for any command.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a, T> {
    vehicle: &'a Vehicle<T>,
    state: &'a State<T>,
    b3: Vector3<T>,
    b3_rod: T,
    rod_speed_squared: T,
    gyroscopic: Vector3<T>,
}

impl<'a, T: Real> Model<'a, T> {
    /// The model of `vehicle` at `state`.
    #[inline]
    pub fn at(vehicle: &'a Vehicle<T>, state: &'a State<T>) -> Self {
        let b3: Vector3<T> = state.attitude.column(2).into();
        let omega = &state.body_rate;
        Self {
            vehicle,
            state,
            b3,
            b3_rod: b3.dot(&state.rod),
            rod_speed_squared: state.rod_rate.dot(&state.rod_rate),
            gyroscopic: vehicle.inertia.component_mul(omega).cross(omega),
        }
    }

    /// λ, the payload's specific force along the rod under `thrust` (N), without d, m/s².
    #[inline]
    pub fn lambda(&self, thrust: T) -> T {
        let kappa = thrust * self.vehicle.kappa_per_thrust;
        -(self.rod_speed_squared + kappa * self.b3_rod) * self.vehicle.inverse_coupling
    }

    /// Accelerations under `command` and `disturbance`, whose δ is orthogonal to the rod.
    #[inline]
    pub fn acceleration(&self, command: &Command<T>, disturbance: &Disturbance<T>) -> Acceleration<T> {
        let vehicle = self.vehicle;
        let q = &self.state.rod;
        let lambda = self.lambda(command.thrust);
        let mut payload = q * lambda + disturbance.payload;
        payload.z += vehicle.params().gravity;
        let torque = command.torque + disturbance.torque + self.gyroscopic;
        Acceleration {
            payload,
            rod: self.b3 * (command.thrust * vehicle.kappa_per_thrust)
                + q * (vehicle.coupling * lambda)
                + disturbance.rod,
            body: torque.component_mul(&vehicle.inverse_inertia),
        }
    }

    /// What `difference` more of a command adds to the accelerations, which are affine in it.
    #[inline]
    pub fn response(&self, difference: &Command<T>) -> Acceleration<T> {
        let vehicle = self.vehicle;
        let q = &self.state.rod;
        let kappa = difference.thrust * vehicle.kappa_per_thrust;
        let coupled = -(kappa * self.b3_rod);
        Acceleration {
            payload: q * (coupled * vehicle.inverse_coupling),
            rod: self.b3 * kappa + q * coupled,
            body: difference.torque.component_mul(&vehicle.inverse_inertia),
        }
    }

    /// The state `dt` later at constant `acceleration`: second order in position, rod and attitude, and back on S² × SO(3) to
    /// within the cube of the angles turned.
    #[inline]
    pub fn ahead(&self, acceleration: &Acceleration<T>, dt: T) -> State<T> {
        let half_dt = dt * T::lit(0.5);
        let State { position, velocity, rod, rod_rate, attitude, body_rate } = self.state;
        let mut q = rod + (rod_rate + acceleration.rod * half_dt) * dt;
        // One Newton step of 1/|q| about 1.
        q *= T::lit(1.5) - T::lit(0.5) * q.dot(&q);
        let w = rod_rate + acceleration.rod * dt;
        State {
            position: position + (velocity + acceleration.payload * half_dt) * dt,
            velocity: velocity + acceleration.payload * dt,
            rod: q,
            rod_rate: w - q * q.dot(&w),
            attitude: attitude * small_rotation(&((body_rate + acceleration.body * half_dt) * dt)),
            body_rate: body_rate + acceleration.body * dt,
        }
    }
}

/// exp of the rotation vector `v` to second order: I + v^ + v^²/2, orthonormal to |v|⁴/4.
#[inline]
fn small_rotation<T: Real>(v: &Vector3<T>) -> Matrix3<T> {
    let half = T::lit(0.5);
    let one = T::one();
    let (xx, yy, zz) = (v.x * v.x * half, v.y * v.y * half, v.z * v.z * half);
    let (xy, xz, yz) = (v.x * v.y * half, v.x * v.z * half, v.y * v.z * half);
    Matrix3::new(
        one - yy - zz,
        xy - v.z,
        xz + v.y,
        xy + v.z,
        one - xx - zz,
        yz - v.x,
        xz - v.y,
        yz + v.x,
        one - xx - yy,
    )
}
