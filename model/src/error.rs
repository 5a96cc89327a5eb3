//! The one error of construction: a parameter outside its range.

use core::fmt;

use crate::scalar::Real;

/// A parameter outside its allowed range. Names the field, the value and the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRange<T> {
    /// The field's name, as in the struct that holds it, or what of several fields is out of range,
    /// in words.
    pub field: &'static str,
    /// The value given, in the field's unit.
    pub value: T,
    /// The least allowed value.
    pub min: T,
    /// The largest allowed value.
    pub max: T,
}

impl<T: Real> OutOfRange<T> {
    /// `Ok` if `min` ≤ `value` ≤ `max`, which a NaN is not.
    ///
    /// # Errors
    /// [`OutOfRange`] of these.
    pub fn check(field: &'static str, value: T, min: f64, max: f64) -> Result<(), Self> {
        Self::within(field, value, T::lit(min), T::lit(max))
    }

    /// The same with bounds that come from other parameters.
    ///
    /// # Errors
    /// [`OutOfRange`] of these.
    pub fn within(field: &'static str, value: T, min: T, max: T) -> Result<(), Self> {
        if value >= min && value <= max { Ok(()) } else { Err(Self { field, value, min, max }) }
    }
}

impl<T: Real> OutOfRange<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> OutOfRange<U> {
        OutOfRange { field: self.field, value: self.value.cast(), min: self.min.cast(), max: self.max.cast() }
    }
}

impl<T: Real> fmt::Display for OutOfRange<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {} is outside {} to {}", self.field, self.value, self.min, self.max)
    }
}

impl<T: Real> core::error::Error for OutOfRange<T> {}
