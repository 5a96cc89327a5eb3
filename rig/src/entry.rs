//! An entry of the table: what a parameter is called, means and may be.

use core::fmt;

use controller::Range;

use crate::table::Tabled;

/// A parameter's name, at most 16 characters, as MAVLink has them. It is made at compile time, also
/// from parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    bytes: [u8; 16],
    length: usize,
}

impl Name {
    /// A name from its text. Longer text is refused by the compiler.
    pub const fn new(text: &str) -> Self {
        Self { bytes: [0; 16], length: 0 }.with(text)
    }

    /// With `text` behind it.
    #[must_use]
    pub const fn with(self, text: &str) -> Self {
        let mut name = self;
        let mut rest = text.as_bytes();
        while let [first, others @ ..] = rest {
            name = name.with_byte(*first);
            rest = others;
        }
        name
    }

    /// With a `digit`, 0 to 9, behind it.
    #[must_use]
    pub const fn with_digit(self, digit: usize) -> Self {
        assert!(digit < 10);
        self.with_byte(b'0' + digit as u8)
    }

    // Only ever evaluated by the compiler, for which a panic is an error.
    #[allow(clippy::indexing_slicing)]
    const fn with_byte(mut self, byte: u8) -> Self {
        assert!(self.length < 16, "a MAVLink parameter's name has at most 16 characters");
        assert!(byte.is_ascii_uppercase() || byte.is_ascii_digit() || byte == b'_');
        self.bytes[self.length] = byte;
        self.length += 1;
        self
    }

    /// The name's text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        self.bytes.get(..self.length).and_then(|bytes| core::str::from_utf8(bytes).ok()).unwrap_or_default()
    }

    /// Whether it is `text`; for the compiler, which has no `==` here.
    pub(crate) const fn is(&self, text: &str) -> bool {
        let mut own: &[u8] = &self.bytes;
        let mut other = text.as_bytes();
        let mut length = 0;
        while let ([a, others_a @ ..], [b, others_b @ ..]) = (own, other) {
            if *a != *b {
                return false;
            }
            (own, other) = (others_a, others_b);
            length += 1;
        }
        other.is_empty() && length == self.length
    }
}

/// Which values within its range a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Any.
    Real,
    /// Whole numbers.
    Whole,
    /// One of these, as its index.
    Choice(&'static [&'static str]),
}

/// A parameter: its name, meaning, range and default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry<T = f32> {
    /// What it is called.
    pub name: Name,
    /// What the controller's struct that it goes into calls it, as in the controller's errors and
    /// in scenario files.
    pub field: &'static str,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// Which values it takes.
    pub kind: Kind,
    /// Value after a reset.
    pub default: T,
    /// Least allowed value.
    pub min: T,
    /// Largest allowed value.
    pub max: T,
    /// What it means, in one line; empty without the feature `texts`.
    pub text: &'static str,
}

impl Entry<f64> {
    /// A number of a `unit` within `range`.
    pub const fn real(
        name: &str,
        field: &'static str,
        unit: &'static str,
        default: f64,
        range: (f64, f64),
        text: &'static str,
    ) -> Self {
        let (min, max) = range;
        assert!(min <= default && default <= max, "a default outside its range");
        let text = if cfg!(feature = "texts") { text } else { "" };
        Self { name: Name::new(name), field, unit, kind: Kind::Real, default, min, max, text }
    }

    /// A number that the controller checks against `range`, with its default.
    pub const fn of(name: &str, range: Range, unit: &'static str, text: &'static str) -> Self {
        let Range { field, min, max, default } = range;
        Self::real(name, field, unit, default, (min, max), text)
    }

    /// A whole number within `range`.
    pub const fn whole(name: &str, field: &'static str, default: f64, range: (f64, f64), text: &'static str) -> Self {
        Self { kind: Kind::Whole, ..Self::real(name, field, "", default, range, text) }
    }

    /// One of `choices`.
    pub const fn choice(
        name: &str,
        field: &'static str,
        choices: &'static [&'static str],
        default: usize,
        text: &'static str,
    ) -> Self {
        let range = (0.0, (choices.len() - 1) as f64);
        Self { kind: Kind::Choice(choices), ..Self::real(name, field, "", default as f64, range, text) }
    }

    /// Off (0) or on (1).
    pub const fn switch(name: &str, field: &'static str, default: bool, text: &'static str) -> Self {
        Self::choice(name, field, &["off", "on"], default as usize, text)
    }

    /// The entry in single precision, as it flies.
    pub const fn narrow(self) -> Entry<f32> {
        let Self { name, field, unit, kind, default, min, max, text } = self;
        Entry { name, field, unit, kind, default: default as f32, min: min as f32, max: max as f32, text }
    }
}

impl<T: Tabled> Entry<T> {
    /// `value`, if the parameter may have it.
    ///
    /// # Errors
    /// It is outside the range, as a NaN always is, or not one of the choices.
    pub fn accept(&'static self, value: T) -> Result<T, Refused<T>> {
        if !(value >= self.min && value <= self.max) {
            return Err(Refused::OutOfRange(self, value));
        }
        if self.kind != Kind::Real && !value.is_whole() {
            return Err(Refused::NotWhole(self, value));
        }
        Ok(value)
    }
}

/// Why a parameter was not set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused<T: 'static> {
    /// No parameter has that name.
    Unknown,
    /// The value is outside the parameter's range, or not a number.
    OutOfRange(&'static Entry<T>, T),
    /// The parameter takes whole numbers only.
    NotWhole(&'static Entry<T>, T),
}

impl<T: Tabled> fmt::Display for Refused<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("no such parameter"),
            Self::OutOfRange(entry, value) => {
                write!(f, "{} = {value} is outside {} to {}", entry.name.as_str(), entry.min, entry.max)
            }
            Self::NotWhole(entry, value) => write!(f, "{} = {value} is not a whole number", entry.name.as_str()),
        }
    }
}

impl<T: Tabled> core::error::Error for Refused<T> {}
