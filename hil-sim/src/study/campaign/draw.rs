//! What differs from flight to flight: how any key of the scenario is drawn, and the same as
//! numbers in ±1 about the nominal.

use serde::Deserialize;
use toml::{Table, Value};

use crate::describe::formula::{Constants, Formula};
use crate::describe::input::Invalid;
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
    /// A value; none of a formula, which [`value`](Self::value) computes.
    pub(super) fn draw(&self, field: &str, random: &mut Stream) -> Result<Option<Value>, Invalid> {
        Ok(Some(match self {
            Self::Uniform([low, high]) => Value::Float(random.uniform(*low, *high)),
            Self::Normal([mean, deviation]) => Value::Float(mean + deviation * random.normal()),
            Self::Box(spans) => {
                list(&spans.iter().map(|[low, high]| random.uniform(*low, *high)).collect::<Vec<_>>())
            }
            Self::Disc(radius) => loop {
                let point = random.cube(1.0);
                if point.x * point.x + point.y * point.y <= 1.0 {
                    break list(&[radius * point.x, radius * point.y, 0.0]);
                }
            },
            Self::Ball(radius) => list((random.ball() * *radius).as_slice()),
            Self::Choice(values) => {
                let index = (random.unit() * values.len() as f64) as usize;
                values.get(index).cloned().ok_or_else(|| Invalid::new(field, "nothing to choose from"))?
            }
            Self::Formula(_) => return Ok(None),
        }))
    }

    /// What was `drawn`, or what the formula makes of the `variables`; or what is wrong with it.
    pub(super) fn value(&self, field: &str, drawn: Option<&Value>, variables: &Constants) -> Result<Value, Invalid> {
        let compute = |text: &String| {
            let formula = Formula::parse(text, variables).map_err(|error| Invalid::new(field, error))?;
            Ok(Value::Float(formula.evaluate([0.0; 3])))
        };
        match self {
            Self::Formula(Computed::Number(text)) => compute(text),
            Self::Formula(Computed::List(texts)) => {
                Ok(Value::Array(texts.iter().map(compute).collect::<Result<_, Invalid>>()?))
            }
            _ => drawn.cloned().ok_or_else(|| Invalid::new(field, "not drawn")),
        }
    }

    /// The spans of the numbers in it: nominal at 0, the ends of what is drawn at −1 and 1. A
    /// choice and a formula have none.
    pub(super) fn spans(&self) -> Vec<Span> {
        match self {
            Self::Uniform(ends) => vec![Span::between(*ends)],
            // Three standard deviations: one draw in 370 lies beyond.
            Self::Normal([mean, deviation]) => {
                vec![Span { nominal: *mean, below: 3.0 * deviation, above: 3.0 * deviation }]
            }
            Self::Box(spans) => spans.iter().map(|ends| Span::between(*ends)).collect(),
            Self::Disc(radius) => vec![Span::about_zero(*radius); 2],
            Self::Ball(radius) => vec![Span::about_zero(*radius); 3],
            Self::Choice(_) | Self::Formula(_) => Vec::new(),
        }
    }

    /// Whether its numbers are drawn from a disc or ball, not each by itself.
    pub(super) fn is_round(&self) -> bool {
        matches!(self, Self::Disc(_) | Self::Ball(_))
    }

    /// The numbers of a drawn `value`, as many as [`spans`](Self::spans).
    pub(super) fn numbers(&self, value: &Value) -> Vec<f64> {
        let numbers = match value {
            Value::Array(list) => list.iter().filter_map(Value::as_float).collect(),
            value => value.as_float().into_iter().collect::<Vec<_>>(),
        };
        numbers.into_iter().take(self.spans().len()).collect()
    }

    /// The value of these numbers.
    pub(super) fn value_of(&self, numbers: &[f64]) -> Option<Value> {
        match (self, numbers) {
            (Self::Choice(_) | Self::Formula(_), _) => None,
            (Self::Uniform(_) | Self::Normal(_), [number]) => Some(Value::Float(*number)),
            (Self::Disc(_), [x, y]) => Some(list(&[*x, *y, 0.0])),
            (_, numbers) => Some(list(numbers)),
        }
    }
}

fn list(numbers: &[f64]) -> Value {
    Value::Array(numbers.iter().map(|&number| Value::Float(number)).collect())
}

/// A number's way from its nominal value to the ends of what is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub nominal: f64,
    pub below: f64,
    pub above: f64,
}

impl Span {
    /// Nominal is zero where it lies between the ends, else the middle.
    fn between([low, high]: [f64; 2]) -> Self {
        let nominal = if low <= 0.0 && 0.0 <= high { 0.0 } else { 0.5 * (low + high) };
        Self { nominal, below: nominal - low, above: high - nominal }
    }

    pub(super) fn about_zero(radius: f64) -> Self {
        Self { nominal: 0.0, below: radius, above: radius }
    }

    /// The number at `share` of the way, −1 to 1.
    pub(super) fn at(&self, share: f64) -> f64 {
        self.nominal + share * if share < 0.0 { self.below } else { self.above }
    }

    /// The share of the way at which `number` lies.
    pub(super) fn share(&self, number: f64) -> f64 {
        let off = number - self.nominal;
        let way = if off < 0.0 { self.below } else { self.above };
        if way > 0.0 { off / way } else { 0.0 }
    }
}

/// Sets the key with this dotted path, making the tables on the way. A number leads to an entry of
/// a list.
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
