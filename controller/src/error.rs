//! Why a controller could not be made, and why it did not do what it was told.

use core::fmt;

use model::{Channel, OutOfRange, Real};

use crate::law::gains::GainError;

/// Why a controller could not be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SetupError<T> {
    /// A parameter is out of range.
    Range(OutOfRange<T>),
    /// The gains do not make a stable loop.
    Gains(GainError<T>),
}

impl<T: Real> SetupError<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    pub fn cast<U: Real>(&self) -> SetupError<U> {
        match self {
            Self::Range(error) => SetupError::Range(error.cast()),
            Self::Gains(error) => SetupError::Gains(error.cast()),
        }
    }
}

impl<T> From<OutOfRange<T>> for SetupError<T> {
    fn from(error: OutOfRange<T>) -> Self {
        Self::Range(error)
    }
}

impl<T> From<GainError<T>> for SetupError<T> {
    fn from(error: GainError<T>) -> Self {
        Self::Gains(error)
    }
}

impl<T: Real> fmt::Display for SetupError<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Gains(error) => error.fmt(f),
        }
    }
}

impl<T: Real> core::error::Error for SetupError<T> {}

/// Why a controller did not start, take over or join; it is then what it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Refused {
    /// This part of the state is not a number, or out of any range.
    State(Channel),
    /// The command applied until now is not finite.
    Applied,
    /// The stated ζ is not finite.
    Zeta,
    /// No point of the path was found from here.
    NoPath,
    /// The path has not been searched wholly yet: to be asked again in the next period.
    Searching,
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::State(channel) => write!(f, "the state's {channel:?} is not a number, or out of any range"),
            Self::Applied => f.write_str("the command applied until now is not finite"),
            Self::Zeta => f.write_str("the stated zeta is not finite"),
            Self::NoPath => f.write_str("no point of the path was found from here"),
            Self::Searching => f.write_str("the path is still being searched"),
        }
    }
}

impl core::error::Error for Refused {}
