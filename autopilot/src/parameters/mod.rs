//! The parameters, by the names that MAVLink's parameter protocol gives them. All are floats.

mod table;

pub use table::Parameter;
use table::TABLE;

/// A parameter's name and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// At most 16 characters.
    pub name: &'static str,
    /// Value after a reset.
    pub default: f32,
    /// Least allowed value.
    pub min: f32,
    /// Largest allowed value.
    pub max: f32,
}

/// Why a parameter was not set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// There is none of that name.
    Unknown,
    /// The value is outside the parameter's range, or no number.
    OutOfRange,
}

/// The table's values.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters([f32; TABLE.len()]);

impl Default for Parameters {
    fn default() -> Self {
        Self(core::array::from_fn(|index| TABLE.get(index).map_or(0.0, |entry| entry.default)))
    }
}

impl Parameters {
    /// How many there are.
    pub const COUNT: usize = TABLE.len();

    /// A value.
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> f32 {
        self.0.get(parameter as usize).copied().unwrap_or_default()
    }

    /// Whether a switch is on.
    pub(crate) fn is_on(&self, parameter: Parameter) -> bool {
        self.get(parameter) > 0.5
    }

    /// Sets a value in code, where its range is known to hold: a value outside is moved to the range's end.
    pub fn set(&mut self, parameter: Parameter, value: f32) {
        if let (Some(slot), Some(entry)) = (self.0.get_mut(parameter as usize), TABLE.get(parameter as usize)) {
            *slot = if value >= entry.min { value.min(entry.max) } else { entry.min };
        }
    }

    /// Sets a value by name. Returns its index.
    ///
    /// # Errors
    /// [`Refused`]; the value is then what it was.
    pub fn set_by_name(&mut self, name: &str, value: f32) -> Result<usize, Refused> {
        let index = Self::index(name).ok_or(Refused::Unknown)?;
        let entry = TABLE.get(index).ok_or(Refused::Unknown)?;
        if !(value >= entry.min && value <= entry.max) {
            return Err(Refused::OutOfRange);
        }
        *self.0.get_mut(index).ok_or(Refused::Unknown)? = value;
        Ok(index)
    }

    /// Where the parameter of that name stands.
    #[must_use]
    pub fn index(name: &str) -> Option<usize> {
        TABLE.iter().position(|entry| entry.name == name)
    }

    /// The entry and value at an index.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static Entry, f32)> {
        Some((TABLE.get(index)?, *self.0.get(index)?))
    }

    /// All entries with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Entry, f32)> + '_ {
        TABLE.iter().zip(self.0)
    }

    /// A run of consecutive parameters from `first` on, as the gains of one output are.
    #[must_use]
    pub(crate) fn run<const N: usize>(&self, first: Parameter) -> [f32; N] {
        core::array::from_fn(|offset| self.0.get(first as usize + offset).copied().unwrap_or_default())
    }

    /// Sets a run of consecutive parameters from `first` on.
    ///
    /// # Errors
    /// [`Refused::OutOfRange`] at the first value outside its range.
    pub fn set_run(&mut self, first: Parameter, values: &[f32]) -> Result<(), Refused> {
        for (offset, &value) in values.iter().enumerate() {
            let entry = TABLE.get(first as usize + offset).ok_or(Refused::Unknown)?;
            self.set_by_name(entry.name, value)?;
        }
        Ok(())
    }
}

const _: () = {
    let mut index = 0;
    while index < TABLE.len() {
        #[allow(clippy::indexing_slicing)]
        let entry = &TABLE[index];
        assert!(entry.name.len() <= 16, "a MAVLink parameter's name has at most 16 characters");
        assert!(entry.min <= entry.default && entry.default <= entry.max);
        index += 1;
    }
};
