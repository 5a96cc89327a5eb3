//! Everything that is refused, as Python's `ValueError` with field, value and range.

use controller::{OutOfRange, Real};
use hil_sim::describe::input::Invalid;
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::fmt::Display;

create_exception!(slung, Refused, PyValueError, "A value that is refused, with what it may be.");

/// A [`Refused`] with this message, about a `field` with a value and a range where they are known.
pub fn refused(message: impl Display, field: &str, numbers: Option<[f64; 3]>) -> PyErr {
    let error = Refused::new_err(message.to_string());
    Python::attach(|py| {
        let value = error.value(py);
        let [given, range] = match numbers {
            Some([given, min, max]) => {
                [given.into_pyobject(py)?.into_any(), (min, max).into_pyobject(py)?.into_any()]
            }
            None => [py.None().into_bound(py), py.None().into_bound(py)],
        };
        value.setattr("field", field)?;
        value.setattr("value", given)?;
        value.setattr("range", range)
    })
    .map_or_else(|failure: PyErr| failure, |()| error)
}

/// A number that the library refuses.
pub fn out_of_range<T: Real>(error: OutOfRange<T>) -> PyErr {
    let OutOfRange { field, value, min, max } = error;
    refused(error, field, Some([value, min, max].map(T::to_f64)))
}

/// A key of a description that the simulator refuses.
#[expect(clippy::needless_pass_by_value, reason = "it stands in `map_err`")]
pub fn invalid(error: Invalid) -> PyErr {
    refused(&error, &error.field, None)
}

/// `value` if it lies between `min` and `max`, which a NaN does not.
pub fn within(field: &str, value: f64, [min, max]: [f64; 2]) -> PyResult<()> {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(refused(format!("{field} = {value} is outside {min} to {max}"), field, Some([value, min, max])))
}

/// A count of at least one, which a float is not.
pub fn count(field: &str, value: i64) -> PyResult<u64> {
    within(field, value as f64, [1.0, 1e8]).map(|()| value.unsigned_abs())
}

/// A word that is none of those that are `known`.
pub fn unknown(field: &str, word: &str, known: &[&str]) -> PyErr {
    refused(format!("{field} = \"{word}\" is none of {}", known.join(", ")), field, None)
}

/// What is refused as a whole.
pub fn whole(error: impl Display) -> PyErr {
    refused(error, "", None)
}
