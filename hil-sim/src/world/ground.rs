//! The ground, a plane, and what it does to a point of a body that has come into it.
//!
//! At a depth δ and with a velocity v, whose part into the ground is δ̇ and whose part along it is
//! v_t:
//!
//! ```text
//! N = max(0, k δ + c δ̇)                   a spring and a damper that do not pull
//! F = −μ N v_t/√(|v_t|² + v_0²)           Coulomb's friction, but for a creep far below v_0 where it would hold
//! ```
//!
//! k and c are given by what they mean for the body that stands on them: δ = m g/k is how far it
//! sinks in by its own weight, and c is 2 ζ √(k m). A body that falls on it keeps this share of its
//! speed (Schwager and Pöschel, *Coefficient of restitution and linear-dashpot model revisited*,
//! Granular Matter 9, 2007; ζ below ½√2, gravity neglected):
//!
//! ```text
//! e = exp(−ζ/√(1−ζ²) (π − atan(2 ζ √(1−ζ²)/(1 − 2 ζ²))))
//! ```

use controller::Vector3;
use serde::Deserialize;

use super::check;
use crate::describe::input::{Invalid, all_within, join};

/// The ground, and how the bodies stand on it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Ground {
    /// Where it is at p1 = p2 = 0, m; positive is lower.
    pub p3: f64,
    /// By how much p3 grows along p1 and p2, each within ±1.
    pub slope: [f64; 2],
    /// Of a box on which the payload comes to stand, m, −100 to 100; negative is a pit.
    pub box_height: f64,
    /// How far a body sinks in by its own weight, m, 10⁻⁵ to 0.1.
    pub sink: f64,
    /// ζ of a body that bounces on it, 0 to 2.
    pub damping_ratio: f64,
    /// μ, 0 to 2.
    pub friction: f64,
    /// From the payload's centre to what touches the ground, m, 0 to 10.
    pub payload_height: f64,
    /// From the UAV's centre of mass down to the plane of its four feet, m, 0 to 10.
    pub feet_below: f64,
    /// From the middle of that plane to each foot, at 45° to the body's axes, m, 0 to 10.
    pub feet_apart: f64,
    /// A UAV that comes to it faster than this has crashed, m/s, 0 to 100.
    pub crash_speed: f64,
}

impl Default for Ground {
    /// Firm soil; a payload that is a cube of 10 cm, and the feet of a quadrotor of 2.5 kg.
    fn default() -> Self {
        Self {
            p3: 0.0,
            slope: [0.0; 2],
            box_height: 0.0,
            sink: 0.002,
            damping_ratio: 0.5,
            friction: 0.5,
            payload_height: 0.05,
            feet_below: 0.15,
            feet_apart: 0.2,
            crash_speed: 2.0,
        }
    }
}

/// v_0, m/s: a load on a slope of a tenth of what friction holds creeps by a tenth of it.
pub(super) const CREEP: f64 = 0.01;

impl Ground {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "p3", self.p3, -1e5, 1e5)?;
        all_within(&join(at, "slope"), self.slope, 1.0)?;
        check(at, "box_height", self.box_height, -100.0, 100.0)?;
        check(at, "sink", self.sink, 1e-5, 0.1)?;
        check(at, "damping_ratio", self.damping_ratio, 0.0, 2.0)?;
        check(at, "friction", self.friction, 0.0, 2.0)?;
        check(at, "payload_height", self.payload_height, 0.0, 10.0)?;
        check(at, "feet_below", self.feet_below, 0.0, 10.0)?;
        check(at, "feet_apart", self.feet_apart, 0.0, 10.0)?;
        check(at, "crash_speed", self.crash_speed, 0.0, 100.0)
    }

    /// The feet in body axes, m.
    #[must_use]
    pub fn feet(&self) -> [Vector3<f64>; 4] {
        let side = self.feet_apart * 0.5_f64.sqrt();
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]| Vector3::new(side * x, side * y, self.feet_below))
    }

    /// k, N/m, and c, N·s/m, under a body, or a foot's share of one, of this mass (kg).
    #[must_use]
    pub fn stiffness(&self, mass: f64, gravity: f64) -> [f64; 2] {
        let stiffness = mass * gravity / self.sink;
        [stiffness, 2.0 * self.damping_ratio * (stiffness * mass).sqrt()]
    }

    /// p3 of a payload and of a level UAV that stand on it at these places, m; on a slope that of a
    /// UAV whose feet are all above it.
    #[must_use]
    pub fn standing(&self, payload: &Vector3<f64>, uav: &Vector3<f64>) -> [f64; 2] {
        let [s1, s2] = self.slope;
        let at = |place: &Vector3<f64>, height: f64| self.level(place) + self.sink - height;
        [
            at(payload, self.payload_height) - self.box_height,
            at(uav, self.feet_below) - self.feet_apart * s1.hypot(s2),
        ]
    }

    /// p3 of the ground at a point's p1 and p2, m.
    fn level(&self, point: &Vector3<f64>) -> f64 {
        let [s1, s2] = self.slope;
        self.p3 + s1 * point.x + s2 * point.y
    }

    /// The unit normal, into the ground.
    fn normal(&self) -> Vector3<f64> {
        let [s1, s2] = self.slope;
        Vector3::new(-s1, -s2, 1.0) / (1.0 + s1 * s1 + s2 * s2).sqrt()
    }

    /// How deep a point is in the ground, m; negative is above it.
    #[must_use]
    pub fn depth(&self, point: &Vector3<f64>) -> f64 {
        (point.z - self.level(point)) * self.normal().z
    }

    /// How deep what the payload stands with is in the ground, or in its box, m.
    #[must_use]
    pub fn payload_depth(&self, position: &Vector3<f64>) -> f64 {
        self.depth(&(position + Vector3::z() * (self.payload_height + self.box_height)))
    }

    /// The force in N on a point of a body of `mass`, `depth` (m) in the ground and moving at
    /// `velocity` in N, N.
    #[must_use]
    pub fn reaction(&self, mass: f64, gravity: f64, depth: f64, velocity: &Vector3<f64>) -> Vector3<f64> {
        if depth <= 0.0 {
            return Vector3::zeros();
        }
        let [stiffness, damping] = self.stiffness(mass, gravity);
        let into = self.normal();
        let sinking = velocity.dot(&into);
        let normal = (stiffness * depth + damping * sinking).max(0.0);
        let along = velocity - into * sinking;
        let slip = (along.dot(&along) + CREEP * CREEP).sqrt();
        along * (-self.friction * normal / slip) - into * normal
    }

    /// ½ k δ² of a point `depth` (m) in the ground, J.
    #[must_use]
    pub fn energy(&self, mass: f64, gravity: f64, depth: f64) -> f64 {
        let [stiffness, _] = self.stiffness(mass, gravity);
        0.5 * stiffness * depth.max(0.0) * depth.max(0.0)
    }

    /// The fastest rate, 1/s, at which the ground moves a body of this mass, or turns one whose
    /// least moment of inertia is `inertia` (kg·m²) about a foot at `lever` (m).
    pub(super) fn rate(&self, mass: f64, gravity: f64, per_inertia: f64, lever: f64) -> f64 {
        let [stiffness, _] = self.stiffness(mass, gravity);
        // The inverse of the mass that a foot feels.
        let moved = 1.0 / mass + lever * lever * per_inertia;
        let bounce = (stiffness * moved).sqrt() * (1.0 + 2.0 * self.damping_ratio);
        // Some four times the weight stands on the ground at the height of a landing at 0.6 m/s.
        let slip = 4.0 * self.friction * mass * gravity * moved / CREEP;
        bounce.max(slip)
    }
}
