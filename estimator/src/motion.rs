//! How the UAV moves: what any navigation filter gives, and what the payload filter stands on.

use model::{Matrix3, Real, Vector3};

/// The UAV's motion at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T> {
    /// x_Q, the UAV's centre of mass in N, m.
    pub position: Vector3<T>,
    /// v_Q, its velocity in N, m/s.
    pub velocity: Vector3<T>,
    /// R, body to N; n3 points down, b3 too.
    pub attitude: Matrix3<T>,
    /// ω in body axes, rad/s: the newest sample less its bias.
    pub body_rate: Vector3<T>,
    /// Specific force where the accelerometer sits, body axes, m/s²: **mean over the period that
    /// ends now**, less its bias. −g e3 at rest.
    pub specific_force: Vector3<T>,
}

impl<T: Real> Motion<T> {
    /// At rest at `position`, level, yaw 0, in gravity `g`, m/s².
    pub fn at_rest(position: Vector3<T>, g: T) -> Self {
        Self {
            position,
            velocity: Vector3::zeros(),
            attitude: Matrix3::identity(),
            body_rate: Vector3::zeros(),
            specific_force: Vector3::new(T::zero(), T::zero(), -g),
        }
    }

    /// Whether a filter can use it: position within 90 km, velocity within 900 m/s, body rate
    /// within 100 rad/s, specific force within 1 km/s², and an attitude whose nine numbers are a
    /// frame's in sum, to 1 %. No NaN is.
    pub fn is_usable(&self) -> bool {
        let within = |v: &Vector3<T>, most: f64| v.dot(v) <= T::lit(most * most);
        let off = self.attitude.dot(&self.attitude) - T::lit(3.0);
        within(&self.position, 9e4)
            && within(&self.velocity, 9e2)
            && within(&self.body_rate, 1e2)
            && within(&self.specific_force, 1e3)
            && off * off <= T::lit(9e-4)
    }
}
