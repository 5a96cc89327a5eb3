//! What a vehicle is told to fly: a [path](crate::describe::path) for the path-following law, or a
//! reference in time for the tracking law.

use controller::{Circle, Real, Reference};
use serde::Deserialize;
use serde::de::Deserializer;
use std::f64::consts::TAU;

use crate::describe::input::{Invalid, join, read, within};
pub use crate::describe::path::{FlownPath, PathSpec, RouteSpec, parse_path};
use witness::plant::distance_to_circle;

/// Largest speed of a reference, m/s.
const SPEED_LIMIT: f64 = 1e3;

/// Section V's reference, y_ref = (r sin Ωt, r cos Ωt, p3, 0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceSpec {
    /// r, m.
    pub radius: f64,
    /// m; negative is above the origin.
    pub p3: f64,
    /// Ω, rad/s, positive from n2 to n1.
    pub rate: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReferenceFields {
    kind: String,
    radius: f64,
    p3: f64,
    rate: f64,
}

/// Reads the reference described by `value`, the field `at` of the input.
///
/// # Errors
/// [`Invalid`] for an unknown kind, an unknown or missing field, or one out of range.
pub fn parse_reference<'de, V: Deserializer<'de>>(at: &str, value: V) -> Result<ReferenceSpec, Invalid> {
    let ReferenceFields { kind, radius, p3, rate } = read(at, value)?;
    if kind != "circle" {
        return Err(Invalid::new(join(at, "kind"), format_args!("no reference of kind \"{kind}\": circle")));
    }
    // The same circle, and the same limits, as the path of that name.
    Circle::new(radius, p3).map_err(|error| Invalid::out_of_range(at, error))?;
    within(&join(at, "rate"), rate, -SPEED_LIMIT / radius..=SPEED_LIMIT / radius)?;
    Ok(ReferenceSpec { radius, p3, rate })
}

impl ReferenceSpec {
    /// Where on its circle the reference is at `t_s`, rad, reduced to one turn in f64, as a counter
    /// on the target would.
    #[must_use]
    pub fn phase<T: Real>(&self, t_s: f64) -> T {
        T::lit((self.rate * t_s) % TAU)
    }

    /// The reference about time `t_s`.
    #[must_use]
    pub fn at<T: Real>(&self, t_s: f64) -> Reference<T> {
        Reference::circle(T::lit(self.radius), T::lit(self.p3), T::lit(self.rate), self.phase(t_s))
    }

    /// Distance of a point of N from the circle, m.
    #[must_use]
    pub fn distance(&self, position: [f64; 3]) -> f64 {
        distance_to_circle(position, self.radius, self.p3)
    }

    /// The circle as points of N, m, the last equal to the first.
    #[must_use]
    pub fn outline(&self, points: usize) -> Vec<[f64; 3]> {
        circle_outline(self.radius, self.p3, points)
    }
}

fn circle_outline(radius: f64, p3: f64, points: usize) -> Vec<[f64; 3]> {
    (0..=points)
        .map(|i| {
            let (sin, cos) = (TAU * i as f64 / points as f64).sin_cos();
            [radius * cos, radius * sin, p3]
        })
        .collect()
}
