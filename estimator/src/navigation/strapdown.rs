//! Position, velocity and attitude by integrating an IMU.
//!
//! At the IMU's place, with the gyro's trapezoid φ = h (ω⁻ + ω)/2 and the mean specific force f of
//! the period
//!
//! ```text
//! R ← R Exp(φ),   f_N = R⁻ (f + φ × f/2),   v ← v + h (f_N + g e3),   x ← x + h (v⁻ + v)/2
//! ```
//!
//! Errors are δx, δv, δθ (R = Exp(δθ) R̂, in N), δb_g, δb_a:
//!
//! ```text
//! δẋ = δv,   δv̇ = −[f_N]× δθ − R δb_a,   δθ̇ = −R δb_g                                          (10)
//! ```

use model::{Matrix3, Real, Vector3};

use crate::lever::axes;

/// Error states.
pub(crate) const ERRORS: usize = 15;

/// Where each error stands.
pub(crate) mod index {
    pub(crate) const POSITION: usize = 0;
    pub(crate) const VELOCITY: usize = 3;
    pub(crate) const ATTITUDE: usize = 6;
    pub(crate) const GYRO: usize = 9;
    pub(crate) const ACCELEROMETER: usize = 12;
}

/// An IMU's reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imu<T> {
    /// The newest sample of ω in body axes, rad/s.
    pub body_rate: Vector3<T>,
    /// Mean specific force of the period, body axes, m/s².
    pub specific_force: Vector3<T>,
}

/// What a correction does to the motion, in N.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved<T> {
    pub(crate) position: Vector3<T>,
    pub(crate) velocity: Vector3<T>,
    pub(crate) acceleration: Vector3<T>,
    /// δθ.
    pub(crate) turn: Vector3<T>,
}

/// The nominal state, of the IMU's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strapdown<T> {
    pub(crate) position: Vector3<T>,
    pub(crate) velocity: Vector3<T>,
    pub(crate) attitude: Matrix3<T>,
    pub(crate) gyro_bias: Vector3<T>,
    pub(crate) accelerometer_bias: Vector3<T>,
    /// ω and f of the last period, biases taken off.
    pub(crate) body_rate: Vector3<T>,
    pub(crate) force: Vector3<T>,
    /// v̇ of the last period in N.
    pub(crate) acceleration: Vector3<T>,
}

/// An error turns the attitude no further about an axis at a time, rad: what Exp to second order
/// leaves of right angles and lengths is then straightened.
const TURN: f64 = 0.3;

impl<T: Real> Strapdown<T> {
    /// One period.
    #[inline(always)]
    pub(crate) fn advance(&mut self, imu: &Imu<T>, period: T, gravity: T) {
        let half = T::lit(0.5);
        let rate = imu.body_rate - self.gyro_bias;
        let force = imu.specific_force - self.accelerometer_bias;
        let angle = (self.body_rate + rate) * (period * half);
        let mut acceleration = self.attitude * (force + angle.cross(&force) * half);
        acceleration.z += gravity;
        let before = self.velocity;
        self.velocity += acceleration * period;
        self.position += (before + self.velocity) * (period * half);
        // Exp to third order: a hundredth of a radian to the fourth is 1e-9.
        let square = angle.dot(&angle);
        let sine = angle * (T::one() - square * T::lit(1.0 / 6.0));
        let cosine = T::one() - square * half;
        let [b1, b2, b3] = axes(&self.attitude);
        let outer = angle * half;
        self.attitude = Matrix3::from_columns(&[
            b1 * (cosine + outer.x * angle.x) + b2 * (sine.z + outer.x * angle.y) + b3 * (outer.x * angle.z - sine.y),
            b1 * (outer.y * angle.x - sine.z) + b2 * (cosine + outer.y * angle.y) + b3 * (sine.x + outer.y * angle.z),
            b1 * (sine.y + outer.z * angle.x) + b2 * (outer.z * angle.y - sine.x) + b3 * (cosine + outer.z * angle.z),
        ]);
        self.body_rate = rate;
        self.force = force;
        self.acceleration = acceleration;
    }

    /// Takes rounding out of the attitude: right angles to first order, then length one by a Newton
    /// step.
    pub(crate) fn straighten(&mut self) {
        let half = T::lit(0.5);
        let [b1, b2, _] = axes(&self.attitude);
        let off = b1.dot(&b2) * half;
        let unit = |b: Vector3<T>| b * (T::lit(1.5) - b.dot(&b) * half);
        let (b1, b2) = (unit(b1 - b2 * off), unit(b2 - b1 * off));
        self.attitude = Matrix3::from_columns(&[b1, b2, b1.cross(&b2)]);
    }

    /// Adds an error. Returns how the motion has moved, for what remembers it.
    pub(crate) fn inject(&mut self, error: &[T; ERRORS]) -> Moved<T> {
        let [x1, x2, x3, v1, v2, v3, t1, t2, t3, g1, g2, g3, a1, a2, a3] = *error;
        let (position, velocity) = (Vector3::new(x1, x2, x3), Vector3::new(v1, v2, v3));
        let turn = Vector3::new(t1, t2, t3).map(|angle| angle.clamp(T::lit(-TURN), T::lit(TURN)));
        let bias = Vector3::new(a1, a2, a3);
        let force = self.attitude * self.force;
        let acceleration = turn.cross(&force) - self.attitude * bias;
        self.position += position;
        self.velocity += velocity;
        self.acceleration += acceleration;
        // Exp(δθ) to second order: it is straightened within the cycle.
        let columns = axes(&self.attitude).map(|b| {
            let turned = turn.cross(&b);
            b + turned + turn.cross(&turned) * T::lit(0.5)
        });
        self.attitude = Matrix3::from_columns(&columns);
        self.straighten();
        let drift = Vector3::new(g1, g2, g3);
        self.gyro_bias += drift;
        self.body_rate -= drift;
        self.accelerometer_bias += bias;
        self.force -= bias;
        Moved { position, velocity, acceleration, turn }
    }
}
