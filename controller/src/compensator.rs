//! The dynamic compensator (7), (9): ζ, its propagation over a sample, and the look ahead to the middle of the hold.
//!
//! ζ1 stands for v̇3, and ζ1˙ = ζ2, ζ2˙ = ζ3, ζ3˙ = ζ4, ζ4˙ = u_ζ. **Hover is ζ = 0.**
//!
//! Thrust and torque are held between samples, so a law evaluated at the sample acts half a period late. Here it is
//! evaluated for the middle of the coming hold (and a known latency later), which makes its error second order in the period.

use nalgebra::{Matrix3, Vector3};

use crate::error::OutOfRange;
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

/// When the law is called and when its command acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling<T> {
    /// Control period h, s.
    pub period: T,
    /// Known time from the state's sample to its command's start, s.
    pub latency: T,
    /// Evaluate the law for the middle of the coming hold, `latency` + h/2 ahead. Off, it is evaluated at the sample.
    pub look_ahead: bool,
}

impl<T: Real> Sampling<T> {
    /// A period of 10⁻⁴ to 0.2 s, no latency, looking ahead.
    pub fn every(period: T) -> Self {
        Self { period, latency: T::zero(), look_ahead: true }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("period", self.period, 1e-4, 0.2)?;
        OutOfRange::check("latency", self.latency, 0.0, 0.2)
    }
}

/// ζ and the last command, with the sampling they advance by.
#[derive(Clone, Copy, Debug)]
pub struct Compensator<T> {
    sampling: Sampling<T>,
    horizon: T,
    zeta: [T; 4],
    u_zeta: T,
    command: Command<T>,
}

impl<T: Real> Compensator<T> {
    /// At hover: ζ = 0.
    pub(crate) fn new(vehicle: &Vehicle<T>, sampling: Sampling<T>) -> Result<Self, OutOfRange<T>> {
        sampling.check()?;
        let horizon = if sampling.look_ahead { sampling.latency + sampling.period * T::lit(0.5) } else { T::zero() };
        Ok(Self {
            sampling,
            horizon,
            zeta: [T::zero(); 4],
            u_zeta: T::zero(),
            command: Command { thrust: vehicle.hover_thrust(), torque: Vector3::zeros() },
        })
    }

    /// ζ at the next sample, m/s²⁺ᵏ.
    pub fn zeta(&self) -> &[T; 4] {
        &self.zeta
    }

    /// The control period h, s.
    pub fn period(&self) -> T {
        self.sampling.period
    }

    /// How far ahead of the sample the law is evaluated, s.
    pub fn horizon(&self) -> T {
        self.horizon
    }

    /// Sets ζ; the thrust that is on until the first command is then (9).
    pub(crate) fn start(&mut self, vehicle: &Vehicle<T>, state: &State<T>, zeta: [T; 4]) {
        self.zeta = zeta;
        self.u_zeta = T::zero();
        let lift = crate::lift::lift(vehicle, state, &zeta);
        self.command = Command { thrust: lift.thrust(vehicle), torque: Vector3::zeros() };
    }

    /// Sets ζ1, ζ2, ζ3 to the payload's vertical acceleration, jerk and snap under `applied` held constant, and ζ4 = 0, so
    /// that (9) returns the applied thrust with its first two derivatives zero.
    pub(crate) fn engage(&mut self, vehicle: &Vehicle<T>, state: &State<T>, applied: Command<T>) {
        self.zeta = vertical_motion(vehicle, state, &applied);
        self.u_zeta = T::zero();
        self.command = applied;
    }

    /// `state` and ζ at the instant the coming command is evaluated for.
    #[inline]
    pub(crate) fn ahead(&self, vehicle: &Vehicle<T>, state: &State<T>) -> (State<T>, [T; 4]) {
        if self.sampling.look_ahead {
            (predict(vehicle, state, &self.command, self.horizon), propagate(&self.zeta, self.u_zeta, self.horizon))
        } else {
            (*state, self.zeta)
        }
    }

    /// Takes u_ζ and the command for the coming hold, and moves ζ over it.
    #[inline]
    pub(crate) fn advance(&mut self, u_zeta: T, command: Command<T>) {
        self.zeta = propagate(&self.zeta, u_zeta, self.sampling.period);
        self.u_zeta = u_zeta;
        self.command = command;
    }
}

/// The integrator chain (7) over `dt` with u_ζ held: exact.
#[inline]
pub(crate) fn propagate<T: Real>(zeta: &[T; 4], u_zeta: T, dt: T) -> [T; 4] {
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

/// The state `dt` later under a held `command`: one step of the model, second order in position, rod and attitude, and back
/// on S² × SO(3) to within the cube of the angles turned.
#[inline]
fn predict<T: Real>(vehicle: &Vehicle<T>, state: &State<T>, command: &Command<T>, dt: T) -> State<T> {
    let half_dt = dt * T::lit(0.5);
    let (q, w, r, omega) = (&state.rod, &state.rod_rate, &state.attitude, &state.body_rate);
    let b3: Vector3<T> = r.column(2).into();

    let kappa = command.thrust * vehicle.kappa_per_thrust;
    // c λ and, from the pendulum line, q̈ and v̇.
    let coupled = -(w.dot(w) + kappa * b3.dot(q));
    let rod_2 = b3 * kappa + q * coupled;
    let mut acceleration = q * (coupled * vehicle.inverse_coupling);
    acceleration.z += vehicle.params().gravity;

    let inertia = &vehicle.inertia;
    let omega_dot =
        (command.torque - omega.cross(&inertia.component_mul(omega))).component_mul(&vehicle.inverse_inertia);

    let mut rod = q + (w + rod_2 * half_dt) * dt;
    // One Newton step of 1/|q| about 1.
    rod *= T::lit(1.5) - T::lit(0.5) * rod.dot(&rod);
    let rod_rate = w + rod_2 * dt;
    State {
        position: state.position + (state.velocity + acceleration * half_dt) * dt,
        velocity: state.velocity + acceleration * dt,
        rod,
        rod_rate: rod_rate - rod * rod.dot(&rod_rate),
        attitude: r * small_rotation(&((omega + omega_dot * half_dt) * dt)),
        body_rate: omega + omega_dot * dt,
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

/// (v̇3, v̈3, v⃛3, 0) under constant thrust and torque: the lift's equations with κ given and its derivatives zero.
fn vertical_motion<T: Real>(vehicle: &Vehicle<T>, state: &State<T>, applied: &Command<T>) -> [T; 4] {
    let two = T::lit(2.0);
    let c = vehicle.coupling;
    let per_c = vehicle.inverse_coupling;
    let (q, w, omega) = (&state.rod, &state.rod_rate, &state.body_rate);
    let b1: Vector3<T> = state.attitude.column(0).into();
    let b2: Vector3<T> = state.attitude.column(1).into();
    let b3: Vector3<T> = state.attitude.column(2).into();
    let inertia = &vehicle.inertia;
    let omega_dot =
        (applied.torque - omega.cross(&inertia.component_mul(omega))).component_mul(&vehicle.inverse_inertia);
    let b3_1 = b1 * omega.y - b2 * omega.x;
    let b3_2 = b1 * (omega.x * omega.z + omega_dot.y) + b2 * (omega.y * omega.z - omega_dot.x)
        - b3 * (omega.x * omega.x + omega.y * omega.y);

    let kappa = applied.thrust * vehicle.kappa_per_thrust;
    let lambda = -(w.dot(w) + kappa * b3.dot(q)) * per_c;
    let rod_2 = b3 * kappa + q * (c * lambda);
    let lambda_1 = -(two * w.dot(&rod_2) + kappa * (b3_1.dot(q) + b3.dot(w))) * per_c;
    let s_1 = q * lambda_1 + w * lambda;
    let rod_3 = b3_1 * kappa + s_1 * c;
    let lambda_2 = -(two * (rod_2.dot(&rod_2) + w.dot(&rod_3))
        + kappa * (b3_2.dot(q) + two * b3_1.dot(w) + b3.dot(&rod_2)))
        * per_c;
    let s_2_z = lambda_2 * q.z + two * lambda_1 * w.z + lambda * rod_2.z;
    [vehicle.params().gravity + lambda * q.z, s_1.z, s_2_z, T::zero()]
}
