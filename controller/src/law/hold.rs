//! The law to fall back on: brings the UAV to rest and keeps its altitude, from any state whatever,
//! with nothing but its own position, velocity, attitude and rates. It knows no cable: what hangs
//! from the UAV is an [observed](crate::sampled::pull) pull f, which has a sign and a bound, so
//! that neither a slack cable nor a wrong rod can mislead it.
//!
//! The force T b3 that gives the UAV an acceleration a is
//!
//! ```text
//! T b3 = m_Q (g e3 + f − a)
//! a = −k_p sat(r − r*) − k_d (ṙ − ṙ*) − ∫k_i sat(r − r*) + k_s s˙ + k_q s,   s = L q − l    (s level, while the rod is trusted)
//! ω̇ = k_R θ − k_ω ω,   T = f·b3,   T b3 within a cone about e3, θ the rotation from b3 to it
//! ```
//!
//! Vertically k_p, k_d and k_i are constants. Level they are those of a pole p, twice, that is no
//! faster than the pendulum ω = √(g/L) which hangs from the UAV, and k_s and k_q are what damps it
//! by d (14.8): the load at y = r + L q obeys ÿ = −ω² L q, and a gives it the polynomial
//! (s² + 2 d s + ω²)(s + p)².
//!
//! Wind lets the load hang at rest aside of the UAV, by the lean l (14.9). So that it is the load
//! which stays where it is, r* is where the UAV would be in still air: in a, r + l stands for r.
//!
//! The target r* starts at the UAV and at its level velocity, which it loses over 1/p; a fall is
//! stopped as hard as the rotors can. A position that jumps takes its target along: what has moved
//! then is where it is measured from.

use model::{Command, Real, State, Uav, Vehicle, is_within};
use nalgebra::Vector3;

/// p, 1/s, vertically and at most; level no faster than the pendulum. The target loses the UAV's
/// velocity over 1/p.
const POLE: f64 = 1.0;
/// k_i over p³: with it the poles are near −0.5 p, (−0.75 ± 0.2 j) p.
const INTEGRAL: f64 = 0.3;
/// d, 1/s, and as a share of ω.
const DAMPING: f64 = 0.3;
/// k_q is all of (14.8) from this length on, m: the body turns too slowly for shorter pendulums.
const LONG: f64 = 1.0;
/// The lean follows what is observed of the wind by this, 1/s, and is at most this share of the
/// cable: the wind a third of the load's weight.
const LEANING: f64 = 2.0;
const LEAN: f64 = 0.3;
/// Largest position error that counts, m.
const REACH: f64 = 2.0;
/// A position that is further from the last than this, m, and than it could have flown in this
/// time, s, has jumped.
const JUMP: f64 = 1.0;
const JUMP_TIME: f64 = 0.2;
/// Faster than this, m/s, the integral waits, since what is going on is no steady error; and it
/// stays below this, m/s².
const SETTLING: f64 = 1.0;
const INTEGRAL_BOUND: f64 = 3.0;
/// Tangent of the cone's angle, 35°.
const CONE: f64 = 0.7;
/// Vertical force: at least this share of the UAV's weight, at most this of all weight.
const LEAST_LIFT: f64 = 0.4;
const MOST_LIFT: f64 = 2.0;
/// A rod that stands on its head, within 8°, may be in balance: as if it hung so far aside, m, and
/// moved as fast, m/s, the UAV yields and topples it.
const BALANCED: f64 = -0.99;
const TOPPLING: f64 = 0.6;
/// k_R, 1/s², and k_ω, 1/s: 6 rad/s, critically damped; yaw rate, 1/s.
const ATTITUDE_GAIN: f64 = 64.0;
const RATE_GAIN: f64 = 16.0;
const YAW_RATE_GAIN: f64 = 3.0;

/// What hangs from the UAV: L q and L q̇, m and m/s, and where in the wind it would hang at rest,
/// m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swing<T> {
    offset: Vector3<T>,
    rate: Vector3<T>,
    lean: Vector3<T>,
}

/// k_p, k_d, k_i and p, of an axis.
#[derive(Clone, Copy, Debug)]
struct Gains<T> {
    position: T,
    velocity: T,
    integral: T,
    pole: T,
}

/// The hold law's memory: its target and integral, and the gains for the vehicle at hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold<T> {
    vertical: Gains<T>,
    level: Gains<T>,
    /// k_s and k_q.
    swing_rate: T,
    swing_offset: T,
    target: Vector3<T>,
    /// Where the UAV was last, m.
    last: Vector3<T>,
    /// What the target's rounding has left out: its steps may be smaller than its last digit.
    remainder: Vector3<T>,
    velocity: Vector3<T>,
    integral: Vector3<T>,
    /// By how much the UAV is to be aside of its target, so that the load is not, m.
    lean: Vector3<T>,
    /// The yaw rate that is wanted, rad/s.
    yaw_rate: T,
}

impl<T: Real> Hold<T> {
    /// For `vehicle`, from where the UAV is and as fast as it is, with what is known of the
    /// `swing`.
    #[inline(never)]
    pub(crate) fn from(vehicle: &Vehicle<T>, uav: &Uav<T>, swing: &Swing<T>) -> Self {
        let params = vehicle.params();
        let per_length = params.gravity / params.rod_length;
        let omega = per_length.sqrt();
        let pole = T::lit(POLE).min(omega);
        let damping = T::lit(DAMPING).min(omega * T::lit(DAMPING));
        let gains = |pole: T, yielding: T| Gains {
            position: pole * pole,
            velocity: pole * T::lit(2.0) + yielding,
            integral: pole * pole * pole * T::lit(INTEGRAL),
            pole,
        };
        let yielding = damping * T::lit(2.0) * (pole * pole / per_length);
        let lean = swing.lean;
        Self {
            vertical: gains(T::lit(POLE), T::zero()),
            level: gains(pole, yielding),
            swing_rate: damping * T::lit(2.0) - yielding,
            swing_offset: damping * pole * T::lit(4.0) * (params.rod_length / T::lit(LONG)).min(T::one()),
            target: uav.position + lean,
            last: uav.position,
            remainder: Vector3::zeros(),
            velocity: level(&uav.velocity),
            integral: Vector3::zeros(),
            lean,
            yaw_rate: T::zero(),
        }
    }

    /// The UAV's own target, and how fast it moves, from now on.
    pub(crate) fn aim(&mut self, target: Vector3<T>, velocity: Vector3<T>) {
        (self.target, self.velocity, self.remainder) = (target, velocity, Vector3::zeros());
        self.lean = Vector3::zeros();
    }

    /// The yaw rate, rad/s, from now on.
    pub(crate) fn turn(&mut self, yaw_rate: T) {
        self.yaw_rate = yaw_rate;
    }

    /// Whether the UAV is where it should be, to within what counts.
    pub(crate) fn has_settled(&self, uav: &Uav<T>) -> bool {
        is_within(&(uav.position + self.lean - self.target), T::lit(REACH * REACH))
    }

    /// How far, m, the UAV is above where it should be by now: more than a metre or two of it means
    /// that something carries it.
    pub(crate) fn left_above(&self, uav: &Uav<T>) -> T {
        self.target.z - uav.position.z
    }

    /// The command at `uav` under a `pull` (m/s², per UAV mass) and with the `swing`, where the rod
    /// is trusted, and the target one `period` (s) on, on its way to `velocity` (N, m/s).
    pub(crate) fn step(
        &mut self,
        vehicle: &Vehicle<T>,
        uav: &Uav<T>,
        pull: &Vector3<T>,
        swing: Option<&Swing<T>>,
        velocity: &Vector3<T>,
        period: T,
    ) -> Command<T> {
        let params = vehicle.params();
        let Uav { position, velocity: uav_velocity, attitude, body_rate: omega } = uav;
        self.follow_jump(position, uav_velocity);
        let (mut yielding, mut leaning) = (Vector3::zeros(), Vector3::zeros());
        if let Some(Swing { offset, rate, lean }) = swing {
            leaning = (lean - self.lean) * T::lit(LEANING);
            let (offset, rate) = (offset - self.lean, rate - leaning);
            yielding = level(&rate) * self.swing_rate + level(&offset) * self.swing_offset;
        }
        let error = limited(&(position + self.lean - self.target), T::lit(REACH));
        let rate_error = uav_velocity + leaning - self.velocity;
        self.lean += leaning * period;
        let along = |v: &Vector3<T>, gain: fn(&Gains<T>) -> T| {
            let (level, vertical) = (gain(&self.level), gain(&self.vertical));
            Vector3::new(v.x * level, v.y * level, v.z * vertical)
        };
        let integral = self.integral + along(&error, |gains| gains.integral) * period;
        let is_settling = rate_error.dot(&rate_error) < T::lit(SETTLING * SETTLING);
        if is_settling && integral.dot(&integral) < T::lit(INTEGRAL_BOUND * INTEGRAL_BOUND) {
            self.integral = integral;
        }
        let acceleration = yielding
            - along(&error, |gains| gains.position)
            - along(&rate_error, |gains| gains.velocity)
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
            T::lit(YAW_RATE_GAIN) * (self.yaw_rate - omega.z),
        );
        let inertia = vehicle.inertia();
        Command {
            thrust: body.z.max(T::zero()),
            torque: inertia.component_mul(&omega_dot) + omega.cross(&inertia.component_mul(omega)),
        }
    }

    /// Has the target jump with the `position`, m, of a UAV at `velocity`, m/s.
    fn follow_jump(&mut self, position: &Vector3<T>, velocity: &Vector3<T>) {
        let moved = position - self.last;
        self.last = *position;
        let flown = velocity.dot(velocity).sqrt() * T::lit(JUMP_TIME);
        let most = T::lit(JUMP).max(flown);
        if !is_within(&moved, most * most) {
            self.target += moved;
        }
    }

    /// The target one `period` on; its velocity is on its way to `wanted`.
    fn advance(&mut self, wanted: &Vector3<T>, period: T) {
        let step = self.velocity * period + self.remainder;
        let target = self.target + step;
        self.remainder = step - (target - self.target);
        self.target = target;
        let missing = wanted - self.velocity;
        let (level, vertical) = (self.level.pole * period, self.vertical.pole * period);
        self.velocity += Vector3::new(missing.x * level, missing.y * level, missing.z * vertical);
    }
}

impl<T: Real> Swing<T> {
    /// Of the rod of `state`, where it hangs, under the `wind` d on the load, m/s². Along the rod d
    /// is of another weight or thrust than told, too.
    #[inline(never)]
    pub(crate) fn of(vehicle: &Vehicle<T>, state: &State<T>, wind: &Vector3<T>) -> Self {
        let length = vehicle.params().rod_length;
        let across = wind - state.rod * state.rod.dot(wind);
        let lean = level(&across) * (length / vehicle.params().gravity);
        let mut swing = Self {
            offset: state.rod * (length * state.rod.z.max(T::zero())),
            rate: state.rod_rate * length,
            lean: limited(&lean, length * T::lit(LEAN)),
        };
        if state.rod.z < T::lit(BALANCED) {
            swing.offset.x = T::lit(TOPPLING);
            swing.rate.x += T::lit(TOPPLING);
        }
        swing
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
