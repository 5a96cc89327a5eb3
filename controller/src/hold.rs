//! The law to fall back on: brings UAV and payload to rest and keeps their altitude, from any state whatever.
//!
//! It steers the UAV, at r = p − L q, as a point with a load it does not model, and divides by nothing that can vanish:
//!
//! ```text
//! a = −k_p sat(r − r*) − k_d (ṙ − ṙ*) − ∫k_i sat(r − r*) + k_s L q̇     (the last: yield to the swing, which damps it)
//! f = M (g e3 − a), limited to a cone about e3;   T = f·b3
//! ω̇ = k_R e3 × Rᵀf/|f| − k_ω ω
//! ```
//!
//! The target r* starts at the UAV and at its velocity, which it loses within [`BRAKING`]. M is the mass that the disturbance observer implies, so
//! the load may have been dropped.

use nalgebra::Vector3;

use crate::compensator::Command;
use crate::scalar::Real;
use crate::state::State;
use crate::vehicle::Vehicle;

/// Time constant with which the target loses the UAV's velocity, s.
const BRAKING: f64 = 1.0;
/// k_p, 1/s², k_d, 1/s, and k_i, 1/s³: poles near −0.5, −0.75 ± 0.2 j.
const POSITION_GAIN: f64 = 1.0;
const VELOCITY_GAIN: f64 = 2.0;
const INTEGRAL_GAIN: f64 = 0.3;
/// k_s, 1/s: about a fifth of critical damping for rods of metres.
const SWING_GAIN: f64 = 0.8;
/// Largest position error that counts, m, and largest integral, m/s².
const REACH: f64 = 2.0;
const INTEGRAL_BOUND: f64 = 3.0;
/// Tangent of the cone's angle, 35°.
const CONE: f64 = 0.7;
/// Vertical specific thrust between these shares of g.
const LEAST_LIFT: f64 = 0.4;
const MOST_LIFT: f64 = 1.6;
/// k_R, 1/s², and k_ω, 1/s: 6 rad/s, critically damped; yaw rate, 1/s.
const ATTITUDE_GAIN: f64 = 36.0;
const RATE_GAIN: f64 = 12.0;
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
            velocity: limited(&(state.velocity - state.rod_rate * length), T::lit(10.0)),
            integral: Vector3::zeros(),
        }
    }

    /// How far, m, the UAV is above where it should be by now: more than a metre or two of it means that the ground carries it.
    pub(crate) fn left_above(&self, vehicle: &Vehicle<T>, state: &State<T>) -> T {
        self.target.z - (state.position.z - state.rod.z * vehicle.params().rod_length)
    }

    /// The command at `state` for a vehicle of `mass` (kg), and the target one `period` (s) on, sinking at `descent` (m/s).
    pub(crate) fn step(
        &mut self,
        vehicle: &Vehicle<T>,
        state: &State<T>,
        mass: T,
        descent: T,
        period: T,
    ) -> Command<T> {
        let params = vehicle.params();
        let uav = state.position - state.rod * params.rod_length;
        let uav_velocity = state.velocity - state.rod_rate * params.rod_length;
        let error = limited(&(uav - self.target), T::lit(REACH));
        let integral = self.integral + error * (T::lit(INTEGRAL_GAIN) * period);
        self.integral = limited(&integral, T::lit(INTEGRAL_BOUND));
        let swing = limited(&(state.rod_rate * params.rod_length), T::lit(REACH));
        let acceleration = swing * T::lit(SWING_GAIN)
            - error * T::lit(POSITION_GAIN)
            - limited(&(uav_velocity - self.velocity), T::lit(REACH)) * T::lit(VELOCITY_GAIN)
            - self.integral;

        self.target += self.velocity * period;
        let mut wanted = self.velocity * (T::one() - period / T::lit(BRAKING)).max(T::zero());
        wanted.z += descent * (period / T::lit(BRAKING)).min(T::one());
        self.velocity = wanted;

        let gravity = params.gravity;
        let lift = (gravity - acceleration.z).clamp(gravity * T::lit(LEAST_LIFT), gravity * T::lit(MOST_LIFT));
        let sideways = limited(&Vector3::new(-acceleration.x, -acceleration.y, T::zero()), lift * T::lit(CONE));
        let force = Vector3::new(sideways.x, sideways.y, lift);

        // The wanted direction in body axes; past a right angle the error stays as large as at it.
        let body = state.attitude.tr_mul(&force);
        let across = (body.x * body.x + body.y * body.y).sqrt();
        let scale = if body.z > T::zero() {
            T::one() / force.dot(&force).sqrt()
        } else if across > T::lit(1e-3) {
            T::one() / across
        } else {
            T::zero()
        };
        let (x, y) = if scale > T::zero() { (body.x * scale, body.y * scale) } else { (T::one(), T::zero()) };
        let (attitude, rate) = (T::lit(ATTITUDE_GAIN), T::lit(RATE_GAIN));
        let omega = &state.body_rate;
        let omega_dot = Vector3::new(
            -attitude * y - rate * omega.x,
            attitude * x - rate * omega.y,
            -T::lit(YAW_RATE_GAIN) * omega.z,
        );
        let inertia = &vehicle.inertia;
        Command {
            thrust: (body.z * mass).max(T::zero()),
            torque: inertia.component_mul(&omega_dot) + omega.cross(&inertia.component_mul(omega)),
        }
    }
}

/// `v`, or as much of it as has length `most`.
fn limited<T: Real>(v: &Vector3<T>, most: T) -> Vector3<T> {
    let squared = v.dot(v);
    if squared <= most * most { *v } else { v * (most / squared.sqrt()) }
}
