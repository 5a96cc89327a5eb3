//! The law to fall back on: brings the UAV to rest and keeps its altitude, from any state whatever,
//! with nothing but its own position, velocity, attitude and rates. It knows no cable: what hangs
//! from the UAV is an [observed](crate::sampled::pull) pull f, which has a sign and a bound, so
//! that neither a slack cable nor a wrong rod can mislead it.
//!
//! The force T b3 that gives the UAV an acceleration a is
//!
//! ```text
//! T b3 = m_Q (g e3 + f − a)
//! a = −k_p sat(r − r*) − k_d (ṙ − ṙ*) − ∫k_i sat(r − r*) + k_s L q̇     (the last, level and only while the rod is trusted)
//! ω̇ = k_R θ − k_ω ω,   T = f·b3,   T b3 within a cone about e3, θ the rotation from b3 to it
//! ```
//!
//! The target r* starts at the UAV and at its level velocity, which it loses within [`BRAKING`]; a
//! fall is stopped as hard as the rotors can.

use model::{Command, Real, State, Uav, Vehicle};
use nalgebra::Vector3;

/// Time constant with which the target loses the UAV's level velocity, s.
const BRAKING: f64 = 1.0;
/// k_p, 1/s², k_d, 1/s, and k_i, 1/s³: poles near −0.5, −0.75 ± 0.2 j.
const POSITION_GAIN: f64 = 1.0;
const VELOCITY_GAIN: f64 = 2.0;
const INTEGRAL_GAIN: f64 = 0.3;
/// k_s, 1/s: about a fifth of critical damping for rods of metres.
const SWING_GAIN: f64 = 0.8;
/// Largest position error that counts, m.
const REACH: f64 = 2.0;
/// Faster than this, m/s, the integral waits, since what is going on is no steady error; and it
/// stays below this, m/s².
const SETTLING: f64 = 1.0;
const INTEGRAL_BOUND: f64 = 3.0;
/// Tangent of the cone's angle, 35°.
const CONE: f64 = 0.7;
/// Vertical force: at least this share of the UAV's weight, at most this of all weight.
const LEAST_LIFT: f64 = 0.4;
const MOST_LIFT: f64 = 2.0;
/// A rod that stands on its head, within 8°, may be in balance: an acceleration, m/s², topples it.
const BALANCED: f64 = -0.99;
const TOPPLING: f64 = 0.5;
/// k_R, 1/s², and k_ω, 1/s: 6 rad/s, critically damped; yaw rate, 1/s.
const ATTITUDE_GAIN: f64 = 64.0;
const RATE_GAIN: f64 = 16.0;
const YAW_RATE_GAIN: f64 = 3.0;

/// The hold law's memory: its target and integral.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold<T> {
    target: Vector3<T>,
    /// What the target's rounding has left out: its steps may be smaller than its last digit.
    remainder: Vector3<T>,
    velocity: Vector3<T>,
    integral: Vector3<T>,
}

impl<T: Real> Hold<T> {
    /// From where the UAV is and as fast as it is.
    pub(crate) fn from(uav: &Uav<T>) -> Self {
        Self {
            target: uav.position,
            remainder: Vector3::zeros(),
            velocity: level(&uav.velocity),
            integral: Vector3::zeros(),
        }
    }

    /// The target, and how fast it moves, from now on.
    pub(crate) fn aim(&mut self, target: Vector3<T>, velocity: Vector3<T>) {
        (self.target, self.velocity, self.remainder) = (target, velocity, Vector3::zeros());
    }

    /// How far, m, the UAV is above where it should be by now: more than a metre or two of it means
    /// that the ground carries it.
    pub(crate) fn left_above(&self, uav: &Uav<T>) -> T {
        self.target.z - uav.position.z
    }

    /// The command at `uav` under a `pull` (m/s², per UAV mass), and the target one `period` (s)
    /// on, on its way to `velocity` (N, m/s). `swing` is L q̇ of a trusted rod.
    pub(crate) fn step(
        &mut self,
        vehicle: &Vehicle<T>,
        uav: &Uav<T>,
        pull: &Vector3<T>,
        swing: &Vector3<T>,
        velocity: &Vector3<T>,
        period: T,
    ) -> Command<T> {
        let params = vehicle.params();
        let Uav { position, velocity: uav_velocity, attitude, body_rate: omega } = uav;
        let error = limited(&(position - self.target), T::lit(REACH));
        let rate_error = uav_velocity - self.velocity;
        let integral = self.integral + error * (T::lit(INTEGRAL_GAIN) * period);
        let is_settling = rate_error.dot(&rate_error) < T::lit(SETTLING * SETTLING);
        if is_settling && integral.dot(&integral) < T::lit(INTEGRAL_BOUND * INTEGRAL_BOUND) {
            self.integral = integral;
        }
        let acceleration = level(swing) * T::lit(SWING_GAIN)
            - error * T::lit(POSITION_GAIN)
            - rate_error * T::lit(VELOCITY_GAIN)
            - self.integral;
        self.advance(velocity, period);

        let mut needed = pull - acceleration;
        needed.z += params.gravity;
        let force = needed * params.uav_mass;
        let weight = vehicle.hover_thrust();
        let least = params.uav_mass * params.gravity * T::lit(LEAST_LIFT);
        let lift = force.z.clamp(least, weight * T::lit(MOST_LIFT));
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

    /// The target one `period` on; its velocity is on its way to `wanted`.
    fn advance(&mut self, wanted: &Vector3<T>, period: T) {
        let step = self.velocity * period + self.remainder;
        let target = self.target + step;
        self.remainder = step - (target - self.target);
        self.target = target;
        self.velocity += (wanted - self.velocity) * (period / T::lit(BRAKING));
    }
}

/// What the UAV yields to: L q̇ of the rod, or, while that may stand on its head in balance, some
/// motion to topple it.
pub(crate) fn swing<T: Real>(vehicle: &Vehicle<T>, state: &State<T>) -> Vector3<T> {
    let mut swing = state.rod_rate * vehicle.params().rod_length;
    if state.rod.z < T::lit(BALANCED) {
        swing.x += T::lit(TOPPLING / SWING_GAIN);
    }
    swing
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
