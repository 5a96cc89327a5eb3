//! How the UAV moves: what any navigation filter gives, and what the payload filter stands on.

use model::{Matrix3, Real, Vector3};

use crate::lever::axes;

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

    /// Takes over `other`, word by word: of all 84 bytes at once the compiler makes a call that
    /// costs three times as much.
    #[inline(always)]
    pub(crate) fn take_over(&mut self, other: &Self) {
        self.position = other.position;
        self.velocity = other.velocity;
        self.attitude = Matrix3::from_columns(&axes(&other.attitude));
        self.body_rate = other.body_rate;
        self.specific_force = other.specific_force;
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

/// The attitude of a UAV that stands still: down is where the `specific_force` of its accelerometer
/// is not, and `ahead`, a vector in body axes, has the `heading` ψ from n1 toward n2, rad: b1 and a
/// receiver's heading, or the magnetic field and its declination. None where these tell nothing:
/// without a force, or with `ahead` along it.
pub fn attitude_at_rest<T: Real>(specific_force: &Vector3<T>, ahead: &Vector3<T>, heading: T) -> Option<Matrix3<T>> {
    let unit = |v: &Vector3<T>| {
        let length = v.dot(v).sqrt();
        (length > T::lit(1e-3) && length.is_finite()).then(|| v * (T::one() / length))
    };
    let down = unit(&-specific_force)?;
    let ahead = unit(&(ahead - down * down.dot(ahead)))?;
    let right = down.cross(&ahead);
    let (sin, cos) = heading.sin_cos();
    // Rows of R: n1, n2, n3 in body axes.
    let (north, east) = (ahead * cos - right * sin, ahead * sin + right * cos);
    heading.is_finite().then(|| Matrix3::from_rows(&[north.transpose(), east.transpose(), down.transpose()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_attitude_at_rest_turns_gravity_down_and_the_reference_to_its_heading() {
        // Pitched by 0.3 about b2, then yawed by 2.0.
        let (pitch, yaw) = (0.3f64, 2.0f64);
        let about_b2 = Matrix3::new(pitch.cos(), 0.0, pitch.sin(), 0.0, 1.0, 0.0, -pitch.sin(), 0.0, pitch.cos());
        let about_n3 = Matrix3::new(yaw.cos(), -yaw.sin(), 0.0, yaw.sin(), yaw.cos(), 0.0, 0.0, 0.0, 1.0);
        let attitude = about_n3 * about_b2;
        let force = attitude.transpose() * Vector3::new(0.0, 0.0, -9.81);
        let found = attitude_at_rest(&force, &Vector3::x(), yaw).unwrap();
        assert!((found - attitude).amax() < 1e-14, "{found}");
        // A field that points down, too, and 0.1 east of north.
        let field = attitude.transpose() * Vector3::new(0.1f64.cos(), 0.1f64.sin(), 1.5);
        let found = attitude_at_rest(&force, &field, 0.1).unwrap();
        assert!((found - attitude).amax() < 1e-14, "{found}");
        assert_eq!(attitude_at_rest(&force, &force, 0.0), None);
        assert_eq!(attitude_at_rest(&Vector3::zeros(), &Vector3::x(), 0.0), None);
        assert_eq!(attitude_at_rest(&force, &Vector3::x(), f64::NAN), None);
    }
}
