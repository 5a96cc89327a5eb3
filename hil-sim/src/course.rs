//! What a vehicle is told to fly: a path for the path-following law, or a reference in time for the tracking law.
//!
//! [`parse_path`] is the one place where a path's description, from a scenario file or from a line of JSON, becomes a
//! path. A new kind of path is one variant here: its fields, its curve for the law, its formulas for the witness.

use controller::path::{ConstantSpeed, FixedYaw, Outputs, Profiled};
use controller::{Circle, OutOfRange, Path, Real, Reference};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};
use std::f64::consts::TAU;

use crate::input::{Invalid, join, read, within};
use crate::plant::distance_to_circle;
use crate::witness::{self, Evaluation, Operating, OutputGains, Singular};

/// Largest speed along a path or of a reference, m/s.
const SPEED_LIMIT: f64 = 1e3;

/// A path as described by a user, validated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathSpec {
    /// The paper's horizontal circle about n3, (16), yaw 0.
    Circle {
        /// d1, m.
        radius: f64,
        /// d2, m; negative is above the origin.
        p3: f64,
        /// v_d, m/s along ρ of (16), which turns from n1 to n2.
        speed: f64,
    },
}

/// The one field that every kind of path has.
#[derive(Deserialize)]
struct Kind {
    kind: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CircleFields {
    #[serde(rename = "kind")]
    _kind: IgnoredAny,
    radius: f64,
    p3: f64,
    speed: f64,
}

/// Reads the path described by `value`, the field `at` of the input.
///
/// # Errors
/// [`Invalid`] for an unknown kind, an unknown or missing field, or one out of range.
pub fn parse_path<'de, V: Deserializer<'de> + Clone>(at: &str, value: V) -> Result<PathSpec, Invalid> {
    let Kind { kind } = read(at, value.clone())?;
    let path = match kind.as_str() {
        "circle" => {
            let CircleFields { radius, p3, speed, .. } = read(at, value)?;
            within(&join(at, "speed"), speed, -SPEED_LIMIT..=SPEED_LIMIT)?;
            PathSpec::Circle { radius, p3, speed }
        }
        other => return Err(Invalid::new(join(at, "kind"), format_args!("no path of kind \"{other}\": circle"))),
    };
    path.build::<f64>().map_err(|error| Invalid::out_of_range(at, error))?;
    Ok(path)
}

impl PathSpec {
    /// The path as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if the curve refuses a parameter.
    pub fn build<T: Real>(&self) -> Result<Route<T>, OutOfRange<T>> {
        match *self {
            Self::Circle { radius, p3, speed } => {
                Ok(Route::Circle(Circle::new(T::lit(radius), T::lit(p3))?.at_speed(T::lit(speed))))
            }
        }
    }

    /// d_C, m: distance of a point of N from the curve.
    #[must_use]
    pub fn distance(&self, position: [f64; 3]) -> f64 {
        match *self {
            Self::Circle { radius, p3, .. } => distance_to_circle(position, radius, p3),
        }
    }

    /// The curve as points of N, m, the last equal to the first.
    #[must_use]
    pub fn outline(&self, points: usize) -> Vec<[f64; 3]> {
        match *self {
            Self::Circle { radius, p3, .. } => circle_outline(radius, p3, points),
        }
    }

    /// The path-following law by the witness, for this path's formulas.
    ///
    /// # Errors
    /// [`Singular`] where the law has no value.
    pub fn witness(
        &self,
        at: Operating<'_>,
        gains: &OutputGains,
        integral_gains: &[f64; 3],
        integral: &[f64; 3],
    ) -> Result<Evaluation<19>, Singular> {
        match *self {
            Self::Circle { radius, p3, speed } => {
                witness::follow(at, &witness::Circle { radius, p3, speed }, gains, integral_gains, integral)
            }
        }
    }

    /// (∇h1 × ∇h2)·ρ at a point of N, by this path's formulas.
    #[must_use]
    pub fn determinant(&self, position: [f64; 3]) -> f64 {
        match *self {
            Self::Circle { radius, p3, speed } => {
                witness_determinant(&witness::Circle { radius, p3, speed }, position)
            }
        }
    }
}

/// ±|∇h1 × ∇h2| of a path given by formulas, the sign that of its direction against (3).
fn witness_determinant<P: witness::WitnessPath>(path: &P, position: [f64; 3]) -> f64 {
    use crate::jet::{Dual, cross, dot};
    let [h1, h2] = path.surfaces(std::array::from_fn(|axis| Dual::<f64, 3>::variable(position[axis], axis)));
    let normal = cross(h1.parts, h2.parts);
    path.direction() * dot(normal, normal).sqrt()
}

/// A path of any kind, chosen at run time.
#[derive(Clone, Debug)]
pub enum Route<T> {
    /// The paper's circle.
    Circle(Profiled<Circle<T>, ConstantSpeed<T>, FixedYaw<T>>),
}

impl<T: Real> Path<T> for Route<T> {
    #[inline]
    fn outputs(&mut self, position: &controller::lift::PositionSeries<T>) -> Outputs<T> {
        match self {
            Self::Circle(path) => path.outputs(position),
        }
    }
}

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
    /// The reference about time `t_s`. The phase is reduced to one turn in f64 first, as a counter on the target would.
    #[must_use]
    pub fn at<T: Real>(&self, t_s: f64) -> Reference<T> {
        let phase = (self.rate * t_s) % TAU;
        Reference::circle(T::lit(self.radius), T::lit(self.p3), T::lit(self.rate), T::lit(phase))
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
