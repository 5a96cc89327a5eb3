//! The UAV by itself, as its own navigation has it: what remains known when cable and payload are
//! not.

use nalgebra::{Matrix3, Vector3};

use crate::scalar::Real;
use crate::state::{Channel, State, is_frame, is_within};
use crate::vehicle::Vehicle;

/// Position, velocity, attitude and body rate of the UAV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uav<T> {
    /// Position x_Q of the centre of mass in N, m.
    pub position: Vector3<T>,
    /// Its velocity v_Q in N, m/s.
    pub velocity: Vector3<T>,
    /// Attitude R, body to N.
    pub attitude: Matrix3<T>,
    /// Angular velocity ω in body axes, rad/s.
    pub body_rate: Vector3<T>,
}

impl<T: Real> Uav<T> {
    /// The UAV of `state` with a taut cable: x_Q = p − L q, v_Q = v − L q̇.
    #[must_use]
    pub fn of(state: &State<T>, vehicle: &Vehicle<T>) -> Self {
        let length = vehicle.params().rod_length;
        Self {
            position: state.position - state.rod * length,
            velocity: state.velocity - state.rod_rate * length,
            attitude: state.attitude,
            body_rate: state.body_rate,
        }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Uav<U> {
        Uav {
            position: self.position.map(T::cast),
            velocity: self.velocity.map(T::cast),
            attitude: self.attitude.map(T::cast),
            body_rate: self.body_rate.map(T::cast),
        }
    }

    /// `Ok` if every number is finite and within the ranges of [`State::check`].
    ///
    /// # Errors
    /// The first [`Channel`] that is not.
    pub fn check(&self) -> Result<(), Channel> {
        let within = |v: &Vector3<T>, most: f64| is_within(v, T::lit(most * most));
        if !within(&self.position, 1e5) {
            Err(Channel::UavPosition)
        } else if !within(&self.velocity, 1e3) {
            Err(Channel::UavVelocity)
        } else if !is_frame(&self.attitude) {
            Err(Channel::Attitude)
        } else if !within(&self.body_rate, 1e2) {
            Err(Channel::BodyRate)
        } else {
            Ok(())
        }
    }

    /// The state with the load at `position`, moving at `velocity` (N, m and m/s), as motion
    /// capture has it.
    ///
    /// The law's q is the line from the centre of mass to the load, and its L their distance: where
    /// the hook is does not matter.
    #[must_use]
    pub fn with_load(&self, position: Vector3<T>, velocity: Vector3<T>) -> State<T> {
        let line = position - self.position;
        let per_length = T::one() / line.dot(&line).sqrt();
        let rod = line * per_length;
        let rate = (velocity - self.velocity) * per_length;
        State {
            position,
            velocity,
            rod,
            rod_rate: rate - rod * rod.dot(&rate),
            attitude: self.attitude,
            body_rate: self.body_rate,
        }
    }

    /// The state with the load at the end of a taut cable of `length` (m) from the `hook` (in body
    /// axes from the centre of mass, m) along the unit vector `direction` (N), which turns at
    /// `rate` (1/s).
    #[must_use]
    pub fn with_cable(&self, hook: Vector3<T>, length: T, direction: Vector3<T>, rate: Vector3<T>) -> State<T> {
        let arm = self.attitude * hook;
        let arm_rate = self.attitude * self.body_rate.cross(&hook);
        self.with_load(self.position + arm + direction * length, self.velocity + arm_rate + rate * length)
    }
}
