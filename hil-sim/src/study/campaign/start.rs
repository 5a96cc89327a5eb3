//! Where flights start.

use controller::{Matrix3, State, Vector3};
use serde::Deserialize;

use crate::describe::input::{Invalid, within};
use crate::world::multibody::rotation;
use crate::world::random::Stream;

/// Where and how flights start: about a random point of the path, each quantity uniform up to
/// these.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct StartFields {
    /// Distance of the payload from that point, m, 0 to 1000: uniform in a ball.
    pub distance_m: f64,
    /// Speed of the payload, m/s, 0 to 100: velocity uniform in a ball.
    pub speed: f64,
    /// Tilt of the body, degrees, 0 to 180, about any horizontal axis.
    pub tilt_deg: f64,
    /// Yaw, degrees, 0 to 180, either way.
    pub yaw_deg: f64,
    /// Angle of the rod from the vertical, degrees, 0 to 180, in any direction.
    pub rod_deg: f64,
    /// Body rate, rad/s, 0 to 100: uniform in a ball.
    pub body_rate: f64,
    /// Rate of the rod's direction, 1/s, 0 to 100: what lies across the rod of a vector uniform in
    /// a ball.
    pub rod_rate: f64,
}

/// A drawn start, and how far it is from the path's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The state.
    pub state: State<f64>,
    /// Degrees.
    pub tilt_deg: f64,
    /// Degrees.
    pub rod_deg: f64,
}

impl StartFields {
    pub(super) fn check(&self) -> Result<(), Invalid> {
        let limits = [1e3, 100.0, 180.0, 180.0, 180.0, 100.0, 100.0];
        for ((name, _, value), high) in self.sizes().into_iter().zip(limits) {
            within(&format!("start.{name}"), value, 0.0..=high)?;
        }
        Ok(())
    }

    /// How far a start is off the path's motion.
    pub(super) fn draw(&self, random: &mut Stream) -> Deviation {
        let tilt_deg = random.uniform(0.0, self.tilt_deg);
        let rod_deg = random.uniform(0.0, self.rod_deg);
        let (tilt_about, rod_about) = (direction(random), direction(random));
        Deviation {
            tilt: Turn { about: tilt_about, degrees: tilt_deg },
            rod: Turn { about: rod_about, degrees: rod_deg },
            yaw_deg: random.uniform(-self.yaw_deg, self.yaw_deg),
            rod_rate: random.ball() * self.rod_rate,
            offset: random.ball() * self.distance_m,
            velocity: random.ball() * self.speed,
            body_rate: random.ball() * self.body_rate,
        }
    }

    /// The keys' names, how many numbers of [`Deviation::numbers`] are each one's, in that order,
    /// and how large they may be.
    pub(super) fn sizes(&self) -> [(&'static str, usize, f64); 7] {
        [
            ("distance_m", 3, self.distance_m),
            ("speed", 3, self.speed),
            ("tilt_deg", 2, self.tilt_deg),
            ("yaw_deg", 1, self.yaw_deg),
            ("rod_deg", 2, self.rod_deg),
            ("body_rate", 3, self.body_rate),
            ("rod_rate", 3, self.rod_rate),
        ]
    }
}

/// A turn about a horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    about: Vector3<f64>,
    degrees: f64,
}

impl Turn {
    fn matrix(&self) -> Matrix3<f64> {
        turned(&self.about, self.degrees.to_radians())
    }

    /// Its vector, degrees.
    fn vector(&self) -> [f64; 2] {
        [self.degrees * self.about.x, self.degrees * self.about.y]
    }

    fn of([x, y]: [f64; 2]) -> Self {
        let degrees = libm::hypot(x, y);
        let about =
            if degrees > 0.0 { Vector3::new(x / degrees, y / degrees, 0.0) } else { Vector3::new(1.0, 0.0, 0.0) };
        Self { about, degrees }
    }
}

/// What a start has beyond rest on the path with hanging rod and level body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Deviation {
    offset: Vector3<f64>,
    velocity: Vector3<f64>,
    tilt: Turn,
    yaw_deg: f64,
    rod: Turn,
    body_rate: Vector3<f64>,
    rod_rate: Vector3<f64>,
}

impl Deviation {
    /// All of it as numbers, in the units of the keys.
    pub(super) fn numbers(&self) -> Vec<f64> {
        let Self { offset, velocity, tilt, yaw_deg, rod, body_rate, rod_rate } = self;
        [
            offset.as_slice(),
            velocity.as_slice(),
            &tilt.vector(),
            &[*yaw_deg],
            &rod.vector(),
            body_rate.as_slice(),
            rod_rate.as_slice(),
        ]
        .concat()
    }

    /// What has these numbers.
    pub(super) fn of(numbers: &[f64; 17]) -> Self {
        let [x, y, z, vx, vy, vz, tx, ty, yaw_deg, rx, ry, wx, wy, wz, qx, qy, qz] = *numbers;
        Self {
            offset: Vector3::new(x, y, z),
            velocity: Vector3::new(vx, vy, vz),
            tilt: Turn::of([tx, ty]),
            yaw_deg,
            rod: Turn::of([rx, ry]),
            body_rate: Vector3::new(wx, wy, wz),
            rod_rate: Vector3::new(qx, qy, qz),
        }
    }

    /// The start so far off a `point` of the path.
    pub(super) fn about(&self, point: &Vector3<f64>) -> Start {
        let attitude = self.tilt.matrix() * turned(&Vector3::new(0.0, 0.0, 1.0), self.yaw_deg.to_radians());
        let rod: Vector3<f64> = self.rod.matrix().column(2).into();
        let state = State {
            position: point + self.offset,
            velocity: self.velocity,
            rod,
            rod_rate: self.rod_rate - rod * rod.dot(&self.rod_rate),
            attitude,
            body_rate: self.body_rate,
        };
        Start { state, tilt_deg: self.tilt.degrees, rod_deg: self.rod.degrees }
    }
}

/// Any horizontal direction.
fn direction(random: &mut Stream) -> Vector3<f64> {
    let angle = random.uniform(0.0, std::f64::consts::TAU);
    Vector3::new(libm::cos(angle), libm::sin(angle), 0.0)
}

/// The rotation by `angle` (rad) about the unit vector `axis`.
fn turned(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (sin, cos) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    rotation([cos, sin * axis.x, sin * axis.y, sin * axis.z])
}
