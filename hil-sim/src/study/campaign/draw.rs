//! What differs from flight to flight: any key of the scenario, and the start.

use controller::{Matrix3, State, Vector3};
use serde::Deserialize;
use toml::{Table, Value};

use crate::describe::formula::{Constants, Formula};
use crate::describe::input::{Invalid, within};
use crate::world::multibody::rotation;
use crate::world::random::Stream;

/// How a key of the scenario is drawn.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum Distribution {
    /// A number, uniform between two.
    Uniform([f64; 2]),
    /// A number, normal with this mean and standard deviation.
    Normal([f64; 2]),
    /// A list of numbers, each uniform between two.
    Box(Vec<[f64; 2]>),
    /// A horizontal vector, uniform in a disc of this radius.
    Disc(f64),
    /// A vector, uniform in a ball of this radius.
    Ball(f64),
    /// One of these values, each as likely.
    Choice(Vec<Value>),
    /// A number, or a list of them, computed from the campaign's variables.
    Formula(Computed),
}

/// One formula, or one for each number of a list.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Computed {
    /// A number.
    Number(String),
    /// A list of numbers.
    List(Vec<String>),
}

impl Distribution {
    /// A value, given the `variables` drawn before, or what is wrong with the distribution.
    pub(super) fn draw(&self, field: &str, variables: &Constants, random: &mut Stream) -> Result<Value, Invalid> {
        let compute = |text: &String| {
            let formula = Formula::parse(text, variables).map_err(|error| Invalid::new(field, error))?;
            Ok(Value::Float(formula.evaluate([0.0; 3])))
        };
        let numbers = |numbers: &[f64]| Value::Array(numbers.iter().map(|&number| Value::Float(number)).collect());
        Ok(match self {
            Self::Uniform([low, high]) => Value::Float(random.uniform(*low, *high)),
            Self::Normal([mean, deviation]) => Value::Float(mean + deviation * random.normal()),
            Self::Box(spans) => {
                numbers(&spans.iter().map(|[low, high]| random.uniform(*low, *high)).collect::<Vec<_>>())
            }
            Self::Disc(radius) => loop {
                let point = random.cube(1.0);
                if point.x * point.x + point.y * point.y <= 1.0 {
                    break numbers(&[radius * point.x, radius * point.y, 0.0]);
                }
            },
            Self::Formula(Computed::Number(text)) => compute(text)?,
            Self::Formula(Computed::List(texts)) => {
                Value::Array(texts.iter().map(compute).collect::<Result<_, Invalid>>()?)
            }
            Self::Ball(radius) => numbers((random.ball() * *radius).as_slice()),
            Self::Choice(values) => {
                let index = (random.unit() * values.len() as f64) as usize;
                values.get(index).cloned().ok_or_else(|| Invalid::new(field, "nothing to choose from"))?
            }
        })
    }
}

/// Sets the key with this dotted path, making the tables on the way. A number leads to an entry of a
/// list.
pub(super) fn set(table: &mut Table, path: &str, value: Value) -> Result<(), Invalid> {
    let mut steps = path.split('.');
    let first = steps.next().unwrap_or_default();
    let mut slot = table.entry(first).or_insert_with(|| Value::Table(Table::new()));
    for step in steps {
        let none = |what: &str| Invalid::new(format!("draw.\"{path}\""), format_args!("{what} {step}"));
        slot = match slot {
            Value::Table(table) => table.entry(step).or_insert_with(|| Value::Table(Table::new())),
            Value::Array(list) => {
                let entry = step.parse::<usize>().ok().and_then(|index| list.get_mut(index));
                entry.ok_or_else(|| none("the list has no entry"))?
            }
            _ => return Err(none("no table to have")),
        };
    }
    *slot = value;
    Ok(())
}

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
        for (name, value, high) in [
            ("distance_m", self.distance_m, 1e3),
            ("speed", self.speed, 100.0),
            ("tilt_deg", self.tilt_deg, 180.0),
            ("yaw_deg", self.yaw_deg, 180.0),
            ("rod_deg", self.rod_deg, 180.0),
            ("body_rate", self.body_rate, 100.0),
            ("rod_rate", self.rod_rate, 100.0),
        ] {
            within(&format!("start.{name}"), value, 0.0..=high)?;
        }
        Ok(())
    }

    /// A start about a `point` of the path.
    pub(super) fn draw(&self, point: &Vector3<f64>, random: &mut Stream) -> Start {
        let tilt_deg = random.uniform(0.0, self.tilt_deg);
        let rod_deg = random.uniform(0.0, self.rod_deg);
        let (tilt_axis, rod_axis) = (direction(random), direction(random));
        let yaw = random.uniform(-self.yaw_deg, self.yaw_deg).to_radians();
        let tilted = turned(&tilt_axis, tilt_deg.to_radians());
        let attitude = tilted * turned(&Vector3::new(0.0, 0.0, 1.0), yaw);
        let rod: Vector3<f64> = turned(&rod_axis, rod_deg.to_radians()).column(2).into();
        let rate = random.ball() * self.rod_rate;
        let state = State {
            position: point + random.ball() * self.distance_m,
            velocity: random.ball() * self.speed,
            rod,
            rod_rate: rate - rod * rod.dot(&rate),
            attitude,
            body_rate: random.ball() * self.body_rate,
        };
        Start { state, tilt_deg, rod_deg }
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
