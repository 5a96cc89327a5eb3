//! The law to fall back on: brings UAV and payload to rest and keeps their altitude, from any state
//! whatever.
//!
//! It steers the UAV, at r = p − L q, and divides by nothing that can vanish. With D = d − L δ
//! the disturbances' part in r̈, the force f = T b3 that gives the UAV an acceleration a is, from
//! (12.1),
//!
//! ```text
//! f = m_Q u + m_L (q·u) q,   u = g e3 + D − a + (m_L/M) L |q̇|² q               (14.1)
//! a = −k_p sat(r − r*) − k_d (ṙ − ṙ*) − ∫k_i sat(r − r*) + k_s L q̇   (14.2)
//! ω̇ = k_R θ − k_ω ω,   T = f·b3                                                    (14.3)
//! ```
//!
//! with f within a cone about e3, θ the rotation from b3 to it, and only the level part of k_s L
//! q̇: to yield to the swing damps it. So the rod's pull on the UAV is made good whatever its
//! direction, up to the thrust there is. The target r* starts at the UAV and at its level velocity,
//! which it loses within [`BRAKING`]; a fall is stopped as hard as the rotors can.

use model::{Command, Disturbance, Real, State, Vehicle};
use nalgebra::Vector3;

/// Time constant with which the target loses the UAV's level velocity, s.
const BRAKING: f64 = 1.0;
/// k_p, 1/s², k_d, 1/s, and k_i, 1/s³: poles at −0.27 ± 0.36 j and −1.45.
const POSITION_GAIN: f64 = 1.0;
const VELOCITY_GAIN: f64 = 2.0;
const INTEGRAL_GAIN: f64 = 0.3;
/// k_s, 1/s: about a fifth of critical damping for rods of metres.
const SWING_GAIN: f64 = 0.8;
/// Largest position error that counts, m.
const REACH: f64 = 2.0;
/// Faster than this, m/s, the integral waits, since a transient is no steady error; and it stays
/// below this, m/s².
const SETTLING: f64 = 1.0;
const INTEGRAL_BOUND: f64 = 3.0;
/// A rod that stands on its head, within 8°, may be in balance: an acceleration, m/s², topples it.
const BALANCED: f64 = -0.99;
const TOPPLING: f64 = 0.5;
/// Largest disturbance that is made good, as a share of g: estimates of a tumbling vehicle are not
/// to be trusted further.
const DISTURBANCE_BOUND: f64 = 0.5;
/// Tangent of the cone's angle, 35°.
const CONE: f64 = 0.7;
/// Vertical force between these shares of the weight.
const LEAST_LIFT: f64 = 0.4;
const MOST_LIFT: f64 = 2.0;
/// k_R, 1/s², and k_ω, 1/s: 8 rad/s, critically damped; yaw rate, 1/s.
const ATTITUDE_GAIN: f64 = 64.0;
const RATE_GAIN: f64 = 16.0;
const YAW_RATE_GAIN: f64 = 3.0;

/// The hold law's memory: its target and integral.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold<T> {
    target: Vector3<T>,
    velocity: Vector3<T>,
    integral: Vector3<T>,
}

impl<T: Real> Hold<T> {
    /// From where `state` is and as fast as it is.
    pub(crate) fn from(vehicle: &Vehicle<T>, state: &State<T>) -> Self {
        let length = vehicle.params().rod_length;
        Self {
            target: state.position - state.rod * length,
            velocity: level(&(state.velocity - state.rod_rate * length)),
            integral: Vector3::zeros(),
        }
    }

    /// How far, m, the UAV is above where it should be by now: more than a metre or two of it means
    /// that the ground carries it.
    pub(crate) fn left_above(&self, vehicle: &Vehicle<T>, state: &State<T>) -> T {
        self.target.z - (state.position.z - state.rod.z * vehicle.params().rod_length)
    }

    /// The command at `state` against `disturbance`, and the target one `period` (s) on, sinking at
    /// `descent` (m/s).
    pub(crate) fn step(
        &mut self,
        vehicle: &Vehicle<T>,
        state: &State<T>,
        disturbance: &Disturbance<T>,
        descent: T,
        period: T,
    ) -> Command<T> {
        let params = vehicle.params();
        let State { position, velocity, rod: q, rod_rate: w, attitude, body_rate: omega } = state;
        let uav = position - q * params.rod_length;
        let uav_velocity = velocity - w * params.rod_length;
        let error = limited(&(uav - self.target), T::lit(REACH));
        let late = uav_velocity - self.velocity;
        let integral = self.integral + error * (T::lit(INTEGRAL_GAIN) * period);
        let is_settling = late.dot(&late) < T::lit(SETTLING * SETTLING);
        if is_settling && integral.dot(&integral) < T::lit(INTEGRAL_BOUND * INTEGRAL_BOUND) {
            self.integral = integral;
        }
        let swing = level(&(w * params.rod_length));
        let mut acceleration =
            swing * T::lit(SWING_GAIN) - error * T::lit(POSITION_GAIN) - late * T::lit(VELOCITY_GAIN) - self.integral;
        if q.z < T::lit(BALANCED) {
            acceleration.x += T::lit(TOPPLING);
        }

        self.target += self.velocity * period;
        let share = period / T::lit(BRAKING);
        let mut wanted = self.velocity * (T::one() - share);
        wanted.z += descent * share;
        self.velocity = wanted;

        let gravity = params.gravity;
        let felt = disturbance.payload - disturbance.rod * params.rod_length;
        let pull = params.payload_mass * vehicle.per_total_mass() * params.rod_length * w.dot(w);
        let mut needed = limited(&felt, gravity * T::lit(DISTURBANCE_BOUND)) - acceleration + q * pull;
        needed.z += gravity;
        let force = needed * params.uav_mass + q * (params.payload_mass * q.dot(&needed));
        let weight = vehicle.hover_thrust();
        let lift = force.z.clamp(weight * T::lit(LEAST_LIFT), weight * T::lit(MOST_LIFT));
        let sideways = limited(&level(&force), lift * T::lit(CONE));
        let force = Vector3::new(sideways.x, sideways.y, lift);

        // The angle to the wanted direction, about the level axis of the body that turns to it;
        // upside down, about any.
        let body = attitude.tr_mul(&force);
        let across = (body.x * body.x + body.y * body.y).sqrt();
        let angle = across.atan2(body.z);
        let (x, y) = if across > T::lit(1e-3) * weight {
            (body.x * (angle / across), body.y * (angle / across))
        } else if body.z > T::zero() {
            (T::zero(), T::zero())
        } else {
            (angle, T::zero())
        };
        let (attitude, rate) = (T::lit(ATTITUDE_GAIN), T::lit(RATE_GAIN));
        let omega_dot = Vector3::new(
            -attitude * y - rate * omega.x,
            attitude * x - rate * omega.y,
            -T::lit(YAW_RATE_GAIN) * omega.z,
        );
        let inertia = vehicle.inertia();
        Command {
            thrust: body.z.max(T::zero()),
            torque: inertia.component_mul(&omega_dot) + omega.cross(&inertia.component_mul(omega)),
        }
    }
}

/// The level part of `v`.
fn level<T: Real>(v: &Vector3<T>) -> Vector3<T> {
    Vector3::new(v.x, v.y, T::zero())
}

/// `v`, shortened to length `most` if it is longer.
#[inline(never)]
fn limited<T: Real>(v: &Vector3<T>, most: T) -> Vector3<T> {
    let squared = v.dot(v);
    if squared <= most * most { *v } else { v * (most / squared.sqrt()) }
}
