//! Why parameters make no controller.

use core::fmt;

use controller::{GainError, OutOfRange, Real};

/// Why parameters make no controller. What it says fits a line of 50 characters, reason first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetupError<T> {
    /// A number is out of range, given the others. Its field is the parameter's name where it is
    /// one parameter's value.
    Range(OutOfRange<T>),
    /// The gains do not make a stable loop.
    Gains(GainError<T>),
}

impl<T> From<OutOfRange<T>> for SetupError<T> {
    fn from(error: OutOfRange<T>) -> Self {
        Self::Range(error)
    }
}

impl<T> From<controller::SetupError<T>> for SetupError<T> {
    fn from(error: controller::SetupError<T>) -> Self {
        match error {
            controller::SetupError::Range(error) => Self::Range(error),
            controller::SetupError::Gains(error) => Self::Gains(error),
        }
    }
}

impl<T: Real> fmt::Display for SetupError<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Gains(GainError::NotHurwitz { output }) => write!(f, "K{output}_0 and on make no stable loop"),
            Self::Gains(GainError::Integral { output, value, limit }) => {
                write!(f, "KI_{output} = {value} is outside 0 to {limit}")
            }
            Self::Gains(error) => error.fmt(f),
        }
    }
}

impl<T: Real> core::error::Error for SetupError<T> {}
