//! What pulls at the UAV, observed from its own motion alone: the cable first of all, whatever
//! hangs from it and wherever it points.
//!
//! ```text
//! v̂˙ = g e3 − (T/m_Q) b3 + f + 2 o e,   f˙ = o² e,   e = v_Q − v̂
//! ```
//!
//! with T the thrust that is applied, discretized with both poles at e^(−o h); or, where an
//! accelerometer tells the specific force f_B and that leads to v_Q, f follows R f_B + (T/m_Q) b3
//! with the bandwidth o.

use model::{Real, Vehicle, is_within};
use nalgebra::{Matrix3, Vector3};

/// o, rad/s: faster than a swing, slower than noise; less where a cable stretches.
pub(crate) const BANDWIDTH: f64 = 10.0;
/// Largest pull that is believed, in payload weights, and how much of it may be level beside what
/// is vertical: a cable pulls down, wind sideways, and nothing lifts.
const STRONGEST: f64 = 3.0;
const LEVEL: f64 = 0.3;
/// Largest specific force, m/s², that an accelerometer is believed; and while the velocity is no
/// further from where that leads than this, m/s, a difference being forgotten over this time, s: one
/// that is wrong by 1 m/s² for ever is let pass, and so is the jolt of a cable that pulls taut.
const MOST_SPECIFIC: f64 = 200.0;
const OFF: f64 = 0.5;
const FORGOTTEN: f64 = 0.5;

/// The observer of the pull on the UAV.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull<T> {
    velocity_gain: T,
    force_gain: T,
    follow_gain: T,
    period: T,
    /// v̂ at the last sample, and f, both in N.
    velocity: Vector3<T>,
    force: Vector3<T>,
    /// Where the specific force has led the velocity, m/s.
    led: Vector3<T>,
}

impl<T: Real> Pull<T> {
    /// Of no more than the bandwidth `most`, rad/s.
    pub(crate) fn new(period: T, most: T) -> Self {
        let pole = (-period * most.min(T::lit(BANDWIDTH))).exp();
        let gap = T::one() - pole;
        Self {
            velocity_gain: gap * (T::one() + pole),
            force_gain: gap * gap / period,
            follow_gain: gap,
            period,
            velocity: Vector3::zeros(),
            force: Vector3::zeros(),
            led: Vector3::zeros(),
        }
    }

    /// The same with no more than the bandwidth `most`, rad/s, from now on.
    pub(crate) fn with_bandwidth(self, period: T, most: T) -> Self {
        Self { velocity: self.velocity, force: self.force, led: self.led, ..Self::new(period, most) }
    }

    /// Starts at `velocity`, with a pull of `force` (m/s², per UAV mass).
    pub(crate) fn start(&mut self, velocity: &Vector3<T>, force: Vector3<T>) {
        self.velocity = *velocity;
        self.force = force;
        self.led = *velocity;
    }

    /// Goes on at `velocity`, with the pull as it is.
    pub(crate) fn resume(&mut self, velocity: &Vector3<T>) {
        self.velocity = *velocity;
    }

    /// v̂ at the end of a period in which `thrust` (N) acted along −`b3`, m/s.
    #[inline]
    fn predicted(&self, vehicle: &Vehicle<T>, attitude: &Matrix3<T>, thrust: T) -> Vector3<T> {
        let b3: Vector3<T> = attitude.column(2).into();
        let params = vehicle.params();
        let mut acceleration = self.force - b3 * (thrust / params.uav_mass);
        acceleration.z += params.gravity;
        self.velocity + acceleration * self.period
    }

    /// The velocity, m/s, that is to be sampled where none is measured: where the `specific` force
    /// (body axes, m/s²) leads, if it has led to the velocity so far, or v̂.
    #[cold]
    pub(crate) fn carried(
        &self,
        vehicle: &Vehicle<T>,
        attitude: &Matrix3<T>,
        thrust: T,
        specific: Option<&Vector3<T>>,
    ) -> Vector3<T> {
        match specific.and_then(|specific| self.led_by(vehicle, attitude, specific)) {
            Some(step) if is_within(&(self.velocity - self.led), T::lit(OFF * OFF)) => self.led + step,
            _ => self.predicted(vehicle, attitude, thrust),
        }
    }

    /// The change of the velocity, m/s, over a period with a `specific` force that may be one.
    #[inline]
    fn led_by(&self, vehicle: &Vehicle<T>, attitude: &Matrix3<T>, specific: &Vector3<T>) -> Option<Vector3<T>> {
        let down = Vector3::new(T::zero(), T::zero(), vehicle.params().gravity);
        let is_possible = is_within(specific, T::lit(MOST_SPECIFIC * MOST_SPECIFIC));
        is_possible.then(|| (attitude * specific + down) * self.period)
    }

    /// Ends a period in which `thrust` (N) acted along −`b3`, with the UAV's sampled `velocity`.
    #[inline(never)]
    pub(crate) fn sample(&mut self, vehicle: &Vehicle<T>, velocity: &Vector3<T>, attitude: &Matrix3<T>, thrust: T) {
        let predicted = self.predicted(vehicle, attitude, thrust);
        let error = velocity - predicted;
        self.velocity = predicted + error * self.velocity_gain;
        self.force += error * self.force_gain;
    }

    /// The same where the accelerometer's `specific` force (body axes, m/s²) is known.
    #[cold]
    pub(crate) fn sample_specific(
        &mut self,
        vehicle: &Vehicle<T>,
        velocity: &Vector3<T>,
        attitude: &Matrix3<T>,
        thrust: T,
        specific: &Vector3<T>,
    ) {
        let Some(step) = self.led_by(vehicle, attitude, specific) else {
            return self.sample(vehicle, velocity, attitude, thrust);
        };
        let led = self.led + step;
        let off = velocity - led;
        self.led = led + off * (self.period * T::lit(1.0 / FORGOTTEN));
        if !is_within(&off, T::lit(OFF * OFF)) {
            return self.sample(vehicle, velocity, attitude, thrust);
        }
        let b3: Vector3<T> = attitude.column(2).into();
        let pull = attitude * specific + b3 * (thrust / vehicle.params().uav_mass);
        self.force += (pull - self.force) * self.follow_gain;
        self.velocity = *velocity;
    }

    /// Its part along n3, N: what hangs from the UAV, less what the rotors give beyond what they
    /// are told.
    pub(crate) fn down(&self, vehicle: &Vehicle<T>) -> T {
        self.force.z * vehicle.params().uav_mass
    }

    /// What of it a cable and some wind can be, per UAV mass, m/s², and at least `least` down.
    pub(crate) fn believed(&self, vehicle: &Vehicle<T>, least: T) -> Vector3<T> {
        let params = vehicle.params();
        let weight = params.payload_mass * params.gravity / params.uav_mass;
        let down = self.force.z.clamp(least, weight * T::lit(STRONGEST));
        let most = down.max(T::zero()) + weight * T::lit(LEVEL);
        let level = self.force.x * self.force.x + self.force.y * self.force.y;
        let share = if level <= most * most { T::one() } else { most / level.sqrt() };
        Vector3::new(self.force.x * share, self.force.y * share, down)
    }
}
