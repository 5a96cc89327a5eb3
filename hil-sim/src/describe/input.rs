//! Fields given by a user: read with the path to each, so that an error names the field that caused
//! it.

use controller::{OutOfRange, Real};
use rig::Refused;
use serde::de::{DeserializeOwned, Deserializer};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A field that cannot be used, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field}{}{message}", if field.is_empty() { "" } else { ": " })]
pub struct Invalid {
    /// Path to the field, as in `controller.poles[0][2]`; empty for the whole.
    pub field: String,
    /// What is wrong with it.
    pub message: String,
}

impl Invalid {
    /// An error of one field.
    pub fn new(field: impl Into<String>, message: impl Display) -> Self {
        Self { field: field.into(), message: message.to_string().trim_end().to_owned() }
    }

    /// A parameter that the controller refused, inside the table `at`.
    pub fn out_of_range<T: Real>(at: &str, error: OutOfRange<T>) -> Self {
        let OutOfRange { field, value, min, max } = error;
        Self::new(join(at, field), format_args!("{value} is outside {min} to {max}"))
    }
}

impl Invalid {
    /// A value that a parameter does not take, given as `field`.
    pub fn refused(field: String, refused: Refused<f64>) -> Self {
        match refused {
            Refused::OutOfRange(entry, value) => {
                Self::new(field, format_args!("{value} is outside {} to {}", entry.min, entry.max))
            }
            Refused::NotWhole(_, value) => Self::new(field, format_args!("{value} is not a whole number")),
            Refused::Unknown => Self::new(field, refused),
        }
    }
}

/// Path of `field` inside the table `at`; either may be empty.
#[must_use]
pub fn join(at: &str, field: &str) -> String {
    match (at, field) {
        ("", _) => field.to_owned(),
        (_, "") => at.to_owned(),
        _ if field.starts_with('[') => format!("{at}{field}"),
        _ => format!("{at}.{field}"),
    }
}

/// Reads `value`, the field `at`, as a `T`.
///
/// # Errors
/// [`Invalid`] with the path to what does not fit.
pub fn read<'de, T: DeserializeOwned>(at: &str, value: impl Deserializer<'de>) -> Result<T, Invalid> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        // The root shows as ".", a part that has no name as "?".
        let path = path.trim_end_matches('?').trim_end_matches('.');
        Invalid::new(join(at, path), in_words(&error.inner().to_string()))
    })
}

/// What a parser says, without the path that stands in front of it already, and without the names of
/// this program's types.
fn in_words(message: &str) -> String {
    let said = message.split_once("\nin `").map_or(message, |(said, _)| said).trim_end();
    // A word of a list, where something else stands.
    if said.contains("unit variant") || said.starts_with("wanted exactly 1 element") {
        return "one word is wanted".to_owned();
    }
    let Some((said, wanted)) = said.rsplit_once(", expected ") else { return said.to_owned() };
    let wanted = match wanted {
        "f64" => "a number",
        "u32" | "u64" | "usize" => "a whole number of at least 0",
        wanted if wanted.starts_with("struct ") => "a table",
        wanted => wanted,
    };
    format!("{said}, expected {wanted}")
}

/// `value` if it lies in `range`, which a NaN does not.
///
/// # Errors
/// [`Invalid`] with the field, the value and the range.
pub fn within<N: PartialOrd + Display + Copy>(field: &str, value: N, range: RangeInclusive<N>) -> Result<N, Invalid> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(Invalid::new(field, format_args!("{value} is outside {} to {}", range.start(), range.end())))
    }
}

/// Reads an argument of the command line, a number in `range`, or says which it may be.
pub fn argument<N>(
    range: RangeInclusive<N>,
    unit: &'static str,
) -> impl Fn(&str) -> Result<N, String> + Clone + Send + Sync + 'static
where
    N: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let inside = text.parse().ok().filter(|value| range.contains(value));
        inside.ok_or_else(|| {
            let whole = if "0.5".parse::<N>().is_ok() { "" } else { "whole " };
            format!("a {whole}number from {} to {} {unit}", range.start(), range.end()).trim_end().to_owned()
        })
    }
}

/// `values` if each lies within ±`limit`.
///
/// # Errors
/// [`Invalid`] with the element, its value and the range.
pub fn all_within<const N: usize>(field: &str, values: [f64; N], limit: f64) -> Result<[f64; N], Invalid> {
    for (index, value) in values.into_iter().enumerate() {
        within(&format!("{field}[{index}]"), value, -limit..=limit)?;
    }
    Ok(values)
}
