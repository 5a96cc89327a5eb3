//! The fields of a path's description, and their way into a validated [`PathSpec`].

use controller::{Harmonics, OutOfRange};
use rig::{Field, Parameter, Parameters, Shape, parameter};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};
use std::collections::BTreeMap;

use super::{CurveSpec, HARMONICS, PathKind, PathSpec, ProfiledSpec, SpeedSpec, Surfaces, YawSpec, route};
use crate::describe::formula::{Constants, Formula};
use crate::describe::input::{Invalid, all_within, join, read, within};

/// Largest speed along a path, m/s.
pub(crate) const SPEED_LIMIT: f64 = controller::ranges::SPEED.max;
/// Largest yaw given as a number, rad: any representative of an angle, but no mistake.
const YAW_LIMIT: f64 = controller::ranges::YAW.max;

#[derive(Deserialize)]
struct Kind {
    kind: String,
}

/// The fields that every curve has.
#[derive(Deserialize)]
struct Common {
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

/// p1 and p2 of the vertical line that the nose points to.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LineFields {
    pub x: f64,
    pub y: f64,
}

/// The own fields of a kind that is not one of the controller's; the common ones are read apart.
macro_rules! own_fields {
    ($name:ident { $($field:ident: $type:ty),* $(,)? }) => {
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
            $($field: $type,)*
        }
    };
}
own_fields!(ImplicitFields { h1: String, h2: String });
own_fields!(FourierFields { center: [f64; 3], cos: Vec<[f64; 3]>, sin: Vec<[f64; 3]>, reference: [f64; 3] });

/// Reads the path described by `value`, the field `at` of the input.
///
/// # Errors
/// [`Invalid`] for an unknown kind, an unknown or missing field, one out of range, or text that is
/// not a formula.
pub fn parse_path<'de, V: Deserializer<'de> + Clone>(at: &str, value: V) -> Result<PathSpec, Invalid> {
    let Kind { kind } = read(at, value.clone())?;
    let kind = if kind == "route" {
        PathKind::Route(route::parse(at, value)?)
    } else {
        PathKind::Profiled(profiled(at, &kind, value)?)
    };
    PathSpec::new(kind).map_err(|error| Invalid::out_of_range(at, error))
}

/// Reads a curve of this `kind` with its profiles.
fn profiled<'de, V: Deserializer<'de> + Clone>(at: &str, kind: &str, value: V) -> Result<ProfiledSpec, Invalid> {
    let Common { speed, yaw, constants } = read(at, value.clone())?;
    for (name, constant) in &constants {
        within(&join(at, &format!("constants.{name}")), *constant, f64::MIN..=f64::MAX)?;
    }
    let parse = |field: &str, text: &str| {
        Formula::parse(text, &constants).map_err(|error| Invalid::new(join(at, field), error))
    };
    let mut speed = speed.map(|speed| speed_of(at, speed, parse)).transpose()?;
    let mut yaw = yaw.map(|yaw| yaw_of(at, yaw, parse)).transpose()?;
    let curve = match (kind, Shape::named(kind)) {
        ("implicit", _) => {
            let ImplicitFields { h1, h2, .. } = read(at, value)?;
            CurveSpec::Implicit(Surfaces { h1: parse("h1", &h1)?, h2: parse("h2", &h2)? })
        }
        ("fourier", _) => CurveSpec::Fourier(Box::new(harmonics(at, read(at, value)?)?)),
        (_, Some(shape)) => {
            let numbers = Numbers::read(at, shape, value)?;
            if shape == Shape::Bent {
                match (&speed, numbers.extra("v0")?, numbers.extra("v1")?) {
                    (None, Some(v0), Some(v1)) => {
                        speed = Some(linear_speed(at, v0, v1, numbers.parameters.get(parameter!("PATH_A")))?);
                    }
                    (Some(_), None, None) => {}
                    _ => return Err(Invalid::new(join(at, "speed"), "give either speed, or v0 and v1")),
                }
                if yaw.is_none() {
                    yaw = Some(YawSpec::Formula(parse("yaw", "0.2*x")?));
                }
            }
            if shape == Shape::Ellipse {
                yaw.get_or_insert(YawSpec::Tangent);
            }
            CurveSpec::Numbers(Box::new(numbers.parameters))
        }
        (other, None) => {
            let kinds = Shape::NAMES.join(", ");
            let message = format_args!("no path of kind \"{other}\": {kinds}, implicit, route");
            return Err(Invalid::new(join(at, "kind"), message));
        }
    };
    let speed = speed.ok_or_else(|| Invalid::new(join(at, "speed"), "missing"))?;
    let yaw = yaw.unwrap_or(YawSpec::Fixed(0.0));
    let spec = ProfiledSpec { curve, speed, yaw };
    match spec.build::<f64>() {
        Ok(_) => Ok(spec),
        Err(error) => Err(named(at, kind, error)),
    }
}

/// What a curve refused. One of numbers names a parameter: what the description calls it is said.
fn named(at: &str, kind: &str, error: OutOfRange<f64>) -> Invalid {
    let fields = Shape::named(kind).map_or(&[][..], Shape::fields);
    let table = Parameters::<f64>::default();
    let name = |parameter: Parameter| table.at(parameter.index()).map(|(entry, _)| entry.name.as_str());
    let is_meant = |field: &&Field| field.parameters().any(|parameter| name(parameter) == Some(error.field));
    let field = fields.iter().find(is_meant).map_or(error.field, |field| field.name);
    Invalid::out_of_range(at, OutOfRange { field, ..error })
}

/// What is given for a field of a curve.
#[derive(Deserialize)]
#[serde(untagged)]
enum Given {
    Number(f64),
    Numbers(Vec<f64>),
    Else(IgnoredAny),
}

/// The numbers of one of the controller's curves, and what else was given.
struct Numbers {
    at: String,
    given: BTreeMap<String, Given>,
    parameters: Parameters<f64>,
}

impl Numbers {
    /// Reads the fields of `shape`.
    fn read<'de, V: Deserializer<'de>>(at: &str, shape: Shape, value: V) -> Result<Self, Invalid> {
        // Of all kinds, and of the bent curve's speed.
        let common = ["kind", "speed", "yaw", "constants"].iter().chain(if shape == Shape::Bent {
            &["v0", "v1"][..]
        } else {
            &[]
        });
        let known: Vec<&str> = shape.fields().iter().map(|field| field.name).chain(common.copied()).collect();
        let given: BTreeMap<String, Given> = read(at, value)?;
        if let Some(unknown) = given.keys().find(|name| !known.contains(&name.as_str())) {
            let message = format_args!("unknown field `{unknown}`, expected one of {}", quoted(&known));
            return Err(Invalid::new(join(at, unknown), message));
        }
        let is_missing = |field: &&Field| !field.optional && !given.contains_key(field.name);
        let missing: Vec<&str> = shape.fields().iter().filter(is_missing).map(|field| field.name).collect();
        if !missing.is_empty() {
            let fields = if missing.len() == 1 { "field" } else { "fields" };
            return Err(Invalid::new(at, format_args!("missing {fields} {}", quoted(&missing))));
        }
        let mut parameters = Parameters::default();
        let set = |parameters: &mut Parameters<f64>, parameter, field: &str, value| {
            parameters.set(parameter, value).map_err(|refused| Invalid::refused(join(at, field), refused))
        };
        set(&mut parameters, parameter!("PATH_KIND"), "kind", shape as usize as f64)?;
        for field in shape.fields() {
            match given.get(field.name) {
                None => {}
                Some(Given::Number(number)) if field.count == 1 => {
                    for parameter in field.parameters() {
                        set(&mut parameters, parameter, field.name, *number)?;
                    }
                }
                Some(Given::Numbers(numbers)) if field.count == numbers.len() => {
                    for (index, (parameter, number)) in field.parameters().zip(numbers).enumerate() {
                        set(&mut parameters, parameter, &format!("{}[{index}]", field.name), *number)?;
                    }
                }
                Some(_) if field.count == 1 => return Err(Invalid::new(join(at, field.name), "not a number")),
                Some(_) => {
                    return Err(Invalid::new(join(at, field.name), format_args!("not {} numbers", field.count)));
                }
            }
        }
        Ok(Self { at: at.to_owned(), given, parameters })
    }

    /// A number that is not one of the curve's own.
    fn extra(&self, name: &str) -> Result<Option<f64>, Invalid> {
        match self.given.get(name) {
            None => Ok(None),
            Some(Given::Number(number)) => Ok(Some(*number)),
            Some(_) => Err(Invalid::new(join(&self.at, name), "not a number")),
        }
    }
}

/// Names as a sentence lists them.
fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
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
        YawField::Formula(text) => YawSpec::Formula(parse("yaw", &text).map_err(|error| {
            let message = format!("{}; or \"tangent\", or {{ x, y }} to point to", error.message);
            Invalid::new(error.field, message)
        })?),
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
