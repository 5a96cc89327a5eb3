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

/// Moves a state and a disturbance that grows on by `dt` under a held `command`, to second order:
/// the accelerations are those halfway, where the rates bring rod and attitude.
#[inline(never)]
pub fn pass<T: Real>(
    vehicle: &Vehicle<T>,
    state: &mut State<T>,
    disturbance: &mut Disturbance<T>,
    command: &Command<T>,
    dt: T,
) {
    let half = dt * T::lit(0.5);
    let known = Disturbance {
        payload: disturbance.payload + disturbance.payload_rate * half,
        rod: disturbance.rod + disturbance.rod_rate * half,
        ..*disturbance
    };
    let spin = turning(vehicle, &state.body_rate, &command.torque, &known.torque);
    let (attitude, body_rate) = turn(&state.attitude, &state.body_rate, &spin, half);
    let mut halfway = State { rod: state.rod + state.rod_rate * half, attitude, body_rate, ..*state };
    let model = Model::at(vehicle, &halfway);
    let (body, _) = model.body(&command.torque, &known.torque);
    let (rod, _) = model.rod(command.thrust, &known.rod);
    let (q, w) = advance(&state.rod, &state.rod_rate, &rod, dt);
    // What the rate did to the rod's acceleration was along the rod, and goes here.
    let (q, w) = across((unit(&q), w));
    halfway.rod_rate = (state.rod_rate + w) * T::lit(0.5);
    let (payload, _) = Model::at(vehicle, &halfway).payload(command.thrust, &known.payload);
    (state.position, state.velocity) = advance(&state.position, &state.velocity, &payload, dt);
    (state.rod, state.rod_rate) = (q, w);
    let (angle, body_rate) = advance(&Vector3::zeros(), &state.body_rate, &body, dt);
    (state.attitude, state.body_rate) = (turned(&state.attitude, &angle), body_rate);
    disturbance.payload += disturbance.payload_rate * dt;
    disturbance.rod += disturbance.rod_rate * dt;
    disturbance.rod -= q * q.dot(&disturbance.rod);
}

fn unit<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    v / v.dot(v).sqrt()
}

/// R e^(θ^), a rotation to within the cube of the angle θ (body axes, rad).
fn turned<T: Real>(attitude: &Matrix3<T>, angle: &Vector3<T>) -> Matrix3<T> {
    let b1: Vector3<T> = attitude.column(0).into();
    let b2: Vector3<T> = attitude.column(1).into();
    let b3: Vector3<T> = attitude.column(2).into();
    let half = angle * T::lit(0.5);
    // What the lengths lose of the second order, they are given back.
    let third = unit(&(b3 + b1 * (angle.y + half.x * angle.z) + b2 * (half.y * angle.z - angle.x)));
    let first = b1 + b2 * (angle.z + half.x * angle.y) + b3 * (half.x * angle.z - angle.y);
    let first = unit(&(first - third * third.dot(&first)));
    Matrix3::from_columns(&[first, third.cross(&first), third])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::VehicleParams;

    /// 60 ms of a vehicle that swings, turns about all axes and is pushed harder and harder, in so
    /// many steps.
    fn flown(steps: u32) -> State<f64> {
        let vehicle = Vehicle::new(VehicleParams::paper()).expect("the paper's");
        let rod: Vector3<f64> = unit(&Vector3::new(0.3, -0.2, 1.0));
        let (rod, rod_rate) = across((rod, Vector3::new(0.8, -0.6, 0.3)));
        let mut state = State {
            velocity: Vector3::new(1.0, -2.0, 0.5),
            rod,
            rod_rate,
            attitude: turned(&Matrix3::identity(), &Vector3::new(0.2, -0.3, 0.5)),
            body_rate: Vector3::new(0.7, -0.9, 0.8),
            ..State::at_rest(Vector3::zeros())
        };
        let mut disturbance = Disturbance {
            payload: Vector3::new(0.5, -0.3, 0.2),
            rod: rod.cross(&Vector3::new(0.2, 0.1, 0.0)),
            torque: Vector3::new(0.1, -0.1, 0.05),
            payload_rate: Vector3::new(3.0, 2.0, -1.0),
            rod_rate: Vector3::new(-1.0, 2.0, 0.0),
        };
        let command = Command { thrust: 1.2 * vehicle.hover_thrust(), torque: Vector3::new(0.3, 0.2, -0.1) };
        for _ in 0..steps {
            pass(&vehicle, &mut state, &mut disturbance, &command, 0.06 / f64::from(steps));
        }
        state
    }

    /// Of second order in every part of the state: twice the steps make a quarter of the error.
    #[test]
    fn halving_the_step_quarters_the_error() {
        let parts = |state: &State<f64>| {
            let State { position, velocity, rod, rod_rate, attitude, body_rate } = *state;
            let columns = [0, 1, 2].map(|i| attitude.column(i).into_owned());
            [position, velocity, rod, rod_rate, columns[0], columns[1], columns[2], body_rate]
        };
        let truth = parts(&flown(20_000));
        let errors = |steps| {
            let flown = parts(&flown(steps));
            core::array::from_fn::<f64, 8, _>(|i| (flown[i] - truth[i]).amax())
        };
        let (coarse, fine) = (errors(4), errors(8));
        for (part, (coarse, fine)) in coarse.iter().zip(fine).enumerate() {
            let ratio = coarse / fine;
            // The next order is a share of about the step, 15 ms, times what turns at 2 rad/s.
            assert!((3.7..4.3).contains(&ratio), "part {part}: {coarse:e} to {fine:e}, {ratio}");
        }
    }
}
