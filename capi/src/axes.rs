//! From what an autopilot or a motion-capture system reports to a [`State`], in the axes that it
//! reports in.
//!
//! The payload hangs on a hook at r_h from the UAV's centre of mass x_Q. With the cable of length
//! L_c along the unit vector q_c from the hook,
//!
//! ```text
//! p = x_Q + R r_h + L_c q_c,   v = v_Q + R (ω × r_h) + L_c q̇_c
//! ```
//!
//! The law's rod is the line from the **centre of mass** to the payload, not the cable's: with
//! l = |p − x_Q|
//!
//! ```text
//! q = (p − x_Q)/l,   q̇ = (v − v_Q − q (q·(v − v_Q)))/l
//! ```
//!
//! With a hook below or beside the centre of mass the two differ, and a law that is given q_c in
//! place of q loses the vehicle from a decimetre on. The vehicle's rod length is then the distance
//! l at hover.

use controller::{Matrix3, Real, State, Vector3};

/// The axes of a world and of a body, all right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frames {
    /// North, east, down; body forward, right, down: this library's own, PX4's and ArduPilot's.
    NedFrd,
    /// East, north, up; body forward, left, up: ROS (REP 103).
    EnuFlu,
    /// North, west, up; body forward, left, up: motion capture, Crazyflie, MuJoCo.
    NwuFlu,
}

impl Frames {
    /// A vector of this world in N.
    #[inline]
    #[must_use]
    pub fn world<T: Real>(self, v: &Vector3<T>) -> Vector3<T> {
        match self {
            Self::NedFrd => *v,
            Self::EnuFlu => Vector3::new(v.y, v.x, -v.z),
            Self::NwuFlu => Vector3::new(v.x, -v.y, -v.z),
        }
    }

    /// A vector in this body's axes in those of B, or the other way: the exchange is its own
    /// inverse.
    #[inline]
    #[must_use]
    pub fn body<T: Real>(self, v: &Vector3<T>) -> Vector3<T> {
        match self {
            Self::NedFrd => *v,
            Self::EnuFlu | Self::NwuFlu => Vector3::new(v.x, -v.y, -v.z),
        }
    }

    /// R, from B to N, of a unit quaternion (w, x, y, z) from this body to this world.
    #[must_use]
    pub fn attitude<T: Real>(self, quaternion: &[T; 4]) -> Matrix3<T> {
        let rotation = rotation(quaternion);
        let column = |index| self.world(&rotation.column(index).into());
        match self {
            Self::NedFrd => Matrix3::from_columns(&[column(0), column(1), column(2)]),
            Self::EnuFlu | Self::NwuFlu => Matrix3::from_columns(&[column(0), -column(1), -column(2)]),
        }
    }
}

/// The rotation of a unit quaternion; of one of another length, its square times a rotation, which
/// a check can find.
fn rotation<T: Real>(quaternion: &[T; 4]) -> Matrix3<T> {
    let [w, x, y, z] = *quaternion;
    let twice = |a: T| a + a;
    Matrix3::new(
        w * w + x * x - y * y - z * z,
        twice(x * y - w * z),
        twice(x * z + w * y),
        twice(x * y + w * z),
        w * w - x * x + y * y - z * z,
        twice(y * z - w * x),
        twice(x * z - w * y),
        twice(y * z + w * x),
        w * w - x * x - y * y + z * z,
    )
}

/// The UAV as its navigation reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uav<T> {
    /// The axes of the numbers below.
    pub frames: Frames,
    /// Position of the centre of mass in the world, m.
    pub position: Vector3<T>,
    /// Its velocity in the world, m/s.
    pub velocity: Vector3<T>,
    /// Unit quaternion (w, x, y, z) from body to world. The state's [check](State::check) refuses
    /// any other length.
    pub quaternion: [T; 4],
    /// Angular velocity in body axes, rad/s.
    pub body_rate: Vector3<T>,
}

impl<T: Real> Uav<T> {
    /// With the payload's position (m) and velocity (m/s) in the same world, from motion capture,
    /// say.
    ///
    /// Any numbers are allowed. Those that make no state, as a payload in the UAV's place, are
    /// found by [`State::check`].
    #[must_use]
    pub fn with_payload(&self, position: &Vector3<T>, velocity: &Vector3<T>) -> State<T> {
        let Self { frames, .. } = *self;
        let (p, v) = (frames.world(position), frames.world(velocity));
        let away = p - frames.world(&self.position);
        let parting = v - frames.world(&self.velocity);
        let per_length = T::one() / away.dot(&away).sqrt();
        let rod = away * per_length;
        State {
            position: p,
            velocity: v,
            rod,
            rod_rate: (parting - rod * rod.dot(&parting)) * per_length,
            attitude: frames.attitude(&self.quaternion),
            body_rate: frames.body(&self.body_rate),
        }
    }

    /// With a taut cable of `length` m from a `hook` (m from the centre of mass, in body axes),
    /// along the unit vector `cable` in the world, from hook to payload, and its rate, 1/s.
    #[must_use]
    pub fn with_cable(&self, hook: &Vector3<T>, length: T, cable: &Vector3<T>, cable_rate: &Vector3<T>) -> State<T> {
        let rotation = rotation(&self.quaternion);
        let position = self.position + rotation * hook + cable * length;
        let velocity = self.velocity + rotation * self.body_rate.cross(hook) + cable_rate * length;
        self.with_payload(&position, &velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A UAV with a yaw of 30° from north to east and a pitch of 10° nose up, in each frame by
    /// hand.
    fn uav(frames: Frames) -> Uav<f64> {
        // Yaw about down is minus yaw about up; east-north counts from east. A pitch about right is
        // minus that about left.
        let (yaw, pitch) = match frames {
            Frames::NedFrd => (30.0_f64, 10.0_f64),
            Frames::EnuFlu => (60.0, -10.0),
            Frames::NwuFlu => (-30.0, -10.0),
        };
        let ((sy, cy), (sp, cp)) = (half(yaw), half(pitch));
        let vector = |n: f64, e: f64, d: f64| match frames {
            Frames::NedFrd => Vector3::new(n, e, d),
            Frames::EnuFlu => Vector3::new(e, n, -d),
            Frames::NwuFlu => Vector3::new(n, -e, -d),
        };
        Uav {
            frames,
            position: vector(1.0, 2.0, -12.0),
            velocity: vector(0.3, -0.2, 0.1),
            quaternion: [cy * cp, -sy * sp, cy * sp, sy * cp],
            body_rate: frames.body(&Vector3::new(0.1, 0.2, -0.3)),
        }
    }

    fn squared(v: &Vector3<f64>) -> f64 {
        v.dot(v)
    }

    fn half(degrees: f64) -> (f64, f64) {
        let angle = degrees.to_radians() / 2.0;
        (libm::sin(angle), libm::cos(angle))
    }

    #[test]
    fn every_frame_tells_the_same_state() {
        // q = Rz(ψ) Ry(θ): nose at 30° to the east, 10° up.
        let (sin, cos) = (0.5, libm::cos(30.0_f64.to_radians()));
        let (sin_up, cos_up) = (libm::sin(10.0_f64.to_radians()), libm::cos(10.0_f64.to_radians()));
        let states = [Frames::NedFrd, Frames::EnuFlu, Frames::NwuFlu].map(|frames| {
            let cable = match frames {
                Frames::NedFrd => [Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.08, 0.3, -0.06)],
                Frames::EnuFlu => [Vector3::new(0.0, 0.6, -0.8), Vector3::new(0.3, 0.08, 0.06)],
                Frames::NwuFlu => [Vector3::new(0.6, 0.0, -0.8), Vector3::new(0.08, -0.3, 0.06)],
            };
            let hook = frames.body(&Vector3::new(0.05, 0.0, 0.2));
            uav(frames).with_cable(&hook, 2.0, &cable[0], &cable[1])
        });
        let [first, ..] = states;
        assert_eq!(first.check(), Ok(()));
        let nose = first.attitude.column(0).into_owned();
        assert!(squared(&(nose - Vector3::new(cos * cos_up, sin * cos_up, -sin_up))) < 1e-30);
        for state in states {
            // A handful of products in either: some 1e-16 each.
            assert!(squared(&(state.position - first.position)) < 1e-28, "{state:?}");
            assert!(squared(&(state.velocity - first.velocity)) < 1e-28);
            assert!(squared(&(state.rod - first.rod)) + squared(&(state.rod_rate - first.rod_rate)) < 1e-28);
            assert!((state.attitude - first.attitude).iter().all(|difference| difference.abs() < 1e-14));
            assert!(squared(&(state.body_rate - first.body_rate)) < 1e-28);
        }
    }

    #[test]
    fn rod_and_rate_are_the_lines_own_derivatives() {
        // The same rigid motion a little later, by differences: position of UAV and payload move
        // with their velocities.
        let dt = 1e-6;
        let now = uav(Frames::NedFrd).with_payload(&Vector3::new(1.5, 2.4, -10.1), &Vector3::new(-0.2, 0.5, 0.0));
        let mut later = uav(Frames::NedFrd);
        later.position += later.velocity * dt;
        let then = later.with_payload(
            &(Vector3::new(1.5, 2.4, -10.1) + Vector3::new(-0.2, 0.5, 0.0) * dt),
            &Vector3::new(-0.2, 0.5, 0.0),
        );
        // The difference's own error is dt |q̈|/2, below 1e-6.
        assert!(squared(&((then.rod - now.rod) / dt - now.rod_rate)) < 1e-12);
        assert!(now.rod.dot(&now.rod_rate).abs() < 1e-15);
    }

    #[test]
    fn what_makes_no_state_is_found() {
        let uav = uav(Frames::NedFrd);
        assert!(uav.with_payload(&uav.position, &uav.velocity).check().is_err());
        let long = Uav { quaternion: [2.0, 0.0, 0.0, 0.0], ..uav };
        assert!(long.with_payload(&Vector3::zeros(), &Vector3::zeros()).check().is_err());
        let nan = Uav { position: Vector3::repeat(f64::NAN), ..uav };
        assert!(nan.with_payload(&Vector3::zeros(), &Vector3::zeros()).check().is_err());
    }
}
