//! The model (12.1) solved for the accelerations under a held command, free of charts. The look
//! ahead and the observers run on it; the law itself inverts it.

use nalgebra::{Matrix3, Vector3};

use crate::command::Command;
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

/// λ, the payload's specific force along the rod of `state` under `thrust` (N), without d, m/s²:
/// −(|q̇|² + κ b3·q)/c.
#[inline]
pub fn lambda<T: Real>(vehicle: &Vehicle<T>, state: &State<T>, thrust: T) -> T {
    let b3: Vector3<T> = state.attitude.column(2).into();
    let turning = state.rod_rate.dot(&state.rod_rate);
    -(turning + thrust * vehicle.kappa_per_thrust() * b3.dot(&state.rod)) * vehicle.inverse_coupling()
}

/// The model at one state. Accelerations are affine in the command: with λ = −(|q̇|² + κ
/// b3·q)/c and κ = T/(m_Q L)
///
/// ```text
/// v̇ = g e3 + d − (|q̇|²/c) q − (b3·q) q T/M
/// q̈ = δ − |q̇|² q + (b3 − (b3·q) q) T/(m_Q L)
/// ω̇ = J⁻¹ (J ω × ω + τ_d + τ)                                  (2.7)
/// ```
///
/// ```
/// use model::{Command, Disturbance, State, Vector3, Vehicle, VehicleParams, dynamics::Model};
///
/// let vehicle = Vehicle::new(VehicleParams::<f64>::paper())?;
/// let state = State::at_rest(Vector3::zeros());
/// let hover = Command::of_thrust(vehicle.hover_thrust());
/// let acceleration = Model::at(&vehicle, &state).acceleration(&hover, &Disturbance::none());
/// assert!(acceleration.payload.dot(&acceleration.payload) < 1e-20);
/// # Ok::<(), model::OutOfRange<f64>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Model<'a, T> {
    vehicle: &'a Vehicle<T>,
    state: &'a State<T>,
    /// b3·q.
    along: T,
    /// |q̇|².
    turning: T,
}

impl<'a, T: Real> Model<'a, T> {
    /// The model of `vehicle` at `state`.
    #[inline]
    pub fn at(vehicle: &'a Vehicle<T>, state: &'a State<T>) -> Self {
        let b3: Vector3<T> = state.attitude.column(2).into();
        Self { vehicle, state, along: b3.dot(&state.rod), turning: state.rod_rate.dot(&state.rod_rate) }
    }

    /// v̇ under `thrust` (N) and d, and its change with a newton more, which is along the rod.
    #[inline]
    pub fn payload(&self, thrust: T, d: &Vector3<T>) -> (Vector3<T>, T) {
        let (vehicle, q) = (self.vehicle, &self.state.rod);
        let per_newton = -(self.along * vehicle.per_total_mass());
        let mut acceleration = d + q * (per_newton * thrust - self.turning * vehicle.inverse_coupling());
        acceleration.z += vehicle.params().gravity;
        (acceleration, per_newton)
    }

    /// q̈ under `thrust` (N) and δ, and its change with a newton more.
    #[inline]
    pub fn rod(&self, thrust: T, delta: &Vector3<T>) -> (Vector3<T>, Vector3<T>) {
        let (q, r) = (&self.state.rod, &self.state.attitude);
        // Not as a column, which is a slice whose pointer some compilations check for null.
        let per_newton = (Vector3::new(r.m13, r.m23, r.m33) - q * self.along) * self.vehicle.kappa_per_thrust();
        (delta - q * self.turning + per_newton * thrust, per_newton)
    }

    /// ω̇ under `torque` and τ_d (N·m), and its change with a newton metre more about each axis.
    #[inline]
    pub fn body(&self, torque: &Vector3<T>, disturbing: &Vector3<T>) -> (Vector3<T>, Vector3<T>) {
        (turning(self.vehicle, &self.state.body_rate, torque, disturbing), *self.vehicle.inverse_inertia())
    }

    /// All of them under `command` and `disturbance`, whose δ is orthogonal to the rod.
    pub fn acceleration(&self, command: &Command<T>, disturbance: &Disturbance<T>) -> Acceleration<T> {
        Acceleration {
            payload: self.payload(command.thrust, &disturbance.payload).0,
            rod: self.rod(command.thrust, &disturbance.rod).0,
            body: self.body(&command.torque, &disturbance.torque).0,
        }
    }
}

/// ω̇ (2.7) of a body that turns at `body_rate` (rad/s, body axes) under `torque` and τ_d, N·m.
#[inline]
pub fn turning<T: Real>(
    vehicle: &Vehicle<T>,
    body_rate: &Vector3<T>,
    torque: &Vector3<T>,
    disturbing: &Vector3<T>,
) -> Vector3<T> {
    let sum = vehicle.inertia().component_mul(body_rate).cross(body_rate) + disturbing + torque;
    sum.component_mul(vehicle.inverse_inertia())
}

/// A position and its rate `dt` later at constant `acceleration`.
#[inline]
pub fn advance<T: Real>(
    position: &Vector3<T>,
    rate: &Vector3<T>,
    acceleration: &Vector3<T>,
    dt: T,
) -> (Vector3<T>, Vector3<T>) {
    let mean = rate + acceleration * (dt * T::lit(0.5));
    (position + mean * dt, rate + acceleration * dt)
}

/// A rod's rate without what would make it longer.
#[inline]
pub fn across<T: Real>((q, w): (Vector3<T>, Vector3<T>)) -> (Vector3<T>, Vector3<T>) {
    (q, w - q * q.dot(&w))
}

/// An attitude and its body rate `dt` later at constant `acceleration`, to within the square of the
/// angle turned.
#[inline]
pub fn turn<T: Real>(
    attitude: &Matrix3<T>,
    body_rate: &Vector3<T>,
    acceleration: &Vector3<T>,
    dt: T,
) -> (Matrix3<T>, Vector3<T>) {
    let (angle, body_rate) = advance(&Vector3::zeros(), body_rate, acceleration, dt);
    let b1: Vector3<T> = attitude.column(0).into();
    let b2: Vector3<T> = attitude.column(1).into();
    let b3: Vector3<T> = attitude.column(2).into();
    let turned = Matrix3::from_columns(&[
        b1 + b2 * angle.z - b3 * angle.y,
        b2 + b3 * angle.x - b1 * angle.z,
        b3 + b1 * angle.y - b2 * angle.x,
    ]);
    (turned, body_rate)
}

/// What a state and a disturbance that grows become in `dt` under a held `command`: the step of
/// [`advance`] and [`turn`], with the rod and the attitude brought back to unit length and right
/// angles.
#[inline(never)]
pub fn pass<T: Real>(
    vehicle: &Vehicle<T>,
    state: &State<T>,
    disturbance: &Disturbance<T>,
    command: &Command<T>,
    dt: T,
) -> (State<T>, Disturbance<T>) {
    let Acceleration { payload, rod, body } = Model::at(vehicle, state).acceleration(command, disturbance);
    let (position, velocity) = advance(&state.position, &state.velocity, &payload, dt);
    let (q, w) = advance(&state.rod, &state.rod_rate, &rod, dt);
    let (q, w) = across((unit(&q), w));
    let (attitude, body_rate) = turn(&state.attitude, &state.body_rate, &body, dt);
    let state = State { position, velocity, rod: q, rod_rate: w, attitude: right_angled(&attitude), body_rate };
    let mut disturbance = *disturbance;
    disturbance.payload += disturbance.payload_rate * dt;
    disturbance.rod += disturbance.rod_rate * dt;
    disturbance.rod -= q * q.dot(&disturbance.rod);
    (state, disturbance)
}

fn unit<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    v / v.dot(v).sqrt()
}

/// The rotation near `attitude`, whose third column keeps its direction.
fn right_angled<T: Real>(attitude: &Matrix3<T>) -> Matrix3<T> {
    let (b1, b3): (Vector3<T>, Vector3<T>) = (attitude.column(0).into(), attitude.column(2).into());
    let b3 = unit(&b3);
    let b1 = unit(&(b1 - b3 * b3.dot(&b1)));
    Matrix3::from_columns(&[b1, b3.cross(&b1), b3])
}
