//! The fields of a path's description, and their way into a validated [`PathSpec`].

use controller::path::Harmonics;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};

use super::curve::Surfaces;
use super::{CurveSpec, HARMONICS, PathSpec, SpeedSpec, YawSpec};
use crate::describe::formula::{Constants, Formula};
use crate::describe::input::{Invalid, all_within, join, read, within};

/// Largest speed along a path, m/s.
pub(crate) const SPEED_LIMIT: f64 = 1e3;
/// Largest yaw given as a number, rad: any representative of an angle, but no mistake.
const YAW_LIMIT: f64 = 100.0;
/// Half axes of the built-in curves, m, as the controller has them.
const KINDS: &str = "circle, ellipse, bent, superellipse, tilted, implicit, fourier";

/// The fields that every kind of path has.
#[derive(Deserialize)]
struct Common {
    kind: String,
    speed: Option<SpeedField>,
    yaw: Option<YawField>,
    #[serde(default)]
    constants: Constants,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "neither a number, nor a formula, nor { max, acceleration }")]
enum SpeedField {
    Constant(f64),
    Formula(String),
    CurvatureLimited(LimitFields),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitFields {
    max: f64,
    acceleration: f64,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "neither a number, nor \"tangent\", nor a formula, nor { x, y }")]
enum YawField {
    Fixed(f64),
    Formula(String),
    PointingAt(LineFields),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LineFields {
    x: f64,
    y: f64,
}

/// A kind's own fields; the common ones are read apart.
macro_rules! own_fields {
    ($name:ident { $($(#[$attribute:meta])* $field:ident: $type:ty),* $(,)? }) => {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $name {
            #[serde(rename = "kind")]
            _kind: IgnoredAny,
            #[serde(rename = "speed")]
            _speed: Option<IgnoredAny>,
            #[serde(rename = "yaw")]
            _yaw: Option<IgnoredAny>,
            #[serde(rename = "constants")]
            _constants: Option<IgnoredAny>,
            $($(#[$attribute])* $field: $type,)*
        }
    };
}
own_fields!(CircleFields { radius: f64, p3: f64 });
own_fields!(EllipseFields { a: f64, b: f64, c0: f64, c1: f64 });
own_fields!(BentFields { a: f64, b: f64, c0: f64, v0: Option<f64>, v1: Option<f64> });
own_fields!(SuperellipseFields {
    a: f64,
    b: f64,
    half_exponent: u8,
    c0: f64,
    #[serde(default)]
    c1: f64
});
own_fields!(TiltedFields { center: [f64; 3], normal: [f64; 3], major: [f64; 3], a: f64, b: f64 });
own_fields!(ImplicitFields { h1: String, h2: String });
own_fields!(FourierFields { center: [f64; 3], cos: Vec<[f64; 3]>, sin: Vec<[f64; 3]>, reference: [f64; 3] });

/// Reads the path described by `value`, the field `at` of the input.
///
/// # Errors
/// [`Invalid`] for an unknown kind, an unknown or missing field, one out of range, or text that is no formula.
pub fn parse_path<'de, V: Deserializer<'de> + Clone>(at: &str, value: V) -> Result<PathSpec, Invalid> {
    let Common { kind, speed, yaw, constants } = read(at, value.clone())?;
    for (name, constant) in &constants {
        within(&join(at, &format!("constants.{name}")), *constant, f64::MIN..=f64::MAX)?;
    }
    let parse = |field: &str, text: &str| {
        Formula::parse(text, &constants).map_err(|error| Invalid::new(join(at, field), error))
    };
    let mut speed = speed.map(|speed| speed_of(at, speed, parse)).transpose()?;
    let mut yaw = yaw.map(|yaw| yaw_of(at, yaw, parse)).transpose()?;
    let curve = match kind.as_str() {
        "circle" => {
            let CircleFields { radius, p3, .. } = read(at, value)?;
            CurveSpec::Circle { radius, p3 }
        }
        "ellipse" => {
            let EllipseFields { a, b, c0, c1, .. } = read(at, value)?;
            yaw.get_or_insert(YawSpec::Tangent);
            CurveSpec::Ellipse { a, b, c0, c1 }
        }
        "bent" => {
            let BentFields { a, b, c0, v0, v1, .. } = read(at, value)?;
            match (&speed, v0, v1) {
                (None, Some(v0), Some(v1)) => speed = Some(linear_speed(at, v0, v1, a)?),
                (Some(_), None, None) => {}
                _ => return Err(Invalid::new(join(at, "speed"), "give either speed, or v0 and v1")),
            }
            if yaw.is_none() {
                yaw = Some(YawSpec::Formula(parse("yaw", "0.2*x")?));
            }
            CurveSpec::Bent { a, b, c0 }
        }
        "superellipse" => {
            let SuperellipseFields { a, b, half_exponent, c0, c1, .. } = read(at, value)?;
            CurveSpec::Superellipse { a, b, half_exponent, c0, c1 }
        }
        "tilted" => {
            let TiltedFields { center, normal, major, a, b, .. } = read(at, value)?;
            CurveSpec::Tilted { center, normal, major, a, b }
        }
        "implicit" => {
            let ImplicitFields { h1, h2, .. } = read(at, value)?;
            CurveSpec::Implicit(Surfaces { h1: parse("h1", &h1)?, h2: parse("h2", &h2)? })
        }
        "fourier" => CurveSpec::Fourier(Box::new(harmonics(at, read(at, value)?)?)),
        other => return Err(Invalid::new(join(at, "kind"), format_args!("no path of kind \"{other}\": {KINDS}"))),
    };
    let speed = speed.ok_or_else(|| Invalid::new(join(at, "speed"), "missing"))?;
    let yaw = yaw.unwrap_or(YawSpec::Fixed(0.0));
    PathSpec::new(curve, speed, yaw).map_err(|error| Invalid::out_of_range(at, error))
}

fn speed_of(
    at: &str,
    speed: SpeedField,
    parse: impl Fn(&str, &str) -> Result<Formula, Invalid>,
) -> Result<SpeedSpec, Invalid> {
    let field = join(at, "speed");
    Ok(match speed {
        SpeedField::Constant(speed) => SpeedSpec::Constant(within(&field, speed, -SPEED_LIMIT..=SPEED_LIMIT)?),
        SpeedField::Formula(text) => SpeedSpec::Formula(parse("speed", &text)?),
        SpeedField::CurvatureLimited(LimitFields { max, acceleration }) => {
            SpeedSpec::CurvatureLimited { max, acceleration }
        }
    })
}

fn yaw_of(
    at: &str,
    yaw: YawField,
    parse: impl Fn(&str, &str) -> Result<Formula, Invalid>,
) -> Result<YawSpec, Invalid> {
    Ok(match yaw {
        YawField::Fixed(yaw) => YawSpec::Fixed(within(&join(at, "yaw"), yaw, -YAW_LIMIT..=YAW_LIMIT)?),
        YawField::Formula(text) if text == "tangent" => YawSpec::Tangent,
        YawField::Formula(text) => YawSpec::Formula(parse("yaw", &text)?),
        YawField::PointingAt(LineFields { x, y }) => {
            YawSpec::PointingAt { target: all_within(&join(at, "yaw"), [x, y], 1e5)? }
        }
    })
}

/// v0 + v1 p1/a.
fn linear_speed(at: &str, v0: f64, v1: f64, a: f64) -> Result<SpeedSpec, Invalid> {
    within(&join(at, "v0"), v0, -SPEED_LIMIT..=SPEED_LIMIT)?;
    within(&join(at, "v1"), v1, -SPEED_LIMIT..=SPEED_LIMIT)?;
    let constants = [("v0", v0), ("slope", v1 / a)].map(|(name, value)| (name.to_owned(), value)).into();
    let speed = Formula::parse("v0 + slope*x", &constants).map_err(|error| Invalid::new(join(at, "a"), error))?;
    Ok(SpeedSpec::Formula(speed))
}

fn harmonics(at: &str, fields: FourierFields) -> Result<Harmonics<f64, HARMONICS>, Invalid> {
    let FourierFields { center, cos, sin, reference, .. } = fields;
    if cos.len() != sin.len() {
        let message = format_args!("{} rows where cos has {}", sin.len(), cos.len());
        return Err(Invalid::new(join(at, "sin"), message));
    }
    within(&join(at, "cos.len"), cos.len(), 1..=HARMONICS)?;
    let rows = |given: &[[f64; 3]]| std::array::from_fn(|k| given.get(k).copied().unwrap_or_default());
    Ok(Harmonics { center, cos: rows(&cos), sin: rows(&sin), reference })
}
