//! Level ground, and what it does to a point of a body that has come into it.
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
use crate::describe::input::Invalid;

/// The ground, and how the bodies stand on it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Ground {
    /// Where it is, m; positive is lower.
    pub p3: f64,
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

    /// p3 of a payload and of a level UAV that stand on it, m.
    #[must_use]
    pub fn standing(&self) -> [f64; 2] {
        [self.payload_height, self.feet_below].map(|height| self.p3 + self.sink - height)
    }

    /// How deep a point at p3 = `down` (m) is in the ground, m; negative is above it.
    #[must_use]
    pub fn depth(&self, down: f64) -> f64 {
        down - self.p3
    }

    /// The force in N on a point of a body of `mass`, `depth` (m) in the ground and moving at
    /// `velocity` in N, N.
    #[must_use]
    pub fn reaction(&self, mass: f64, gravity: f64, depth: f64, velocity: &Vector3<f64>) -> Vector3<f64> {
        if depth <= 0.0 {
            return Vector3::zeros();
        }
        let [stiffness, damping] = self.stiffness(mass, gravity);
        let normal = (stiffness * depth + damping * velocity.z).max(0.0);
        let slip = (velocity.x * velocity.x + velocity.y * velocity.y + CREEP * CREEP).sqrt();
        let share = -self.friction * normal / slip;
        Vector3::new(share * velocity.x, share * velocity.y, -normal)
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
