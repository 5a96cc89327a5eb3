//! The table's values.

use controller::{OutOfRange, Real};

use crate::curve::ROUTE;
use crate::entry::{Entry, Refused};
use crate::parameter;
use crate::table::{COUNT, Parameter, Run, Tabled};

/// A value for each parameter, within its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters<T>([T; COUNT]);

impl<T: Tabled> Default for Parameters<T> {
    /// All at their defaults: the paper's vehicle on the paper's circle.
    fn default() -> Self {
        Self(T::table().each_ref().map(|entry| entry.default))
    }
}

impl<T: Tabled> Parameters<T> {
    /// Sets a value.
    ///
    /// # Errors
    /// [`Refused`], and the value is then what it was.
    pub fn set(&mut self, parameter: Parameter, value: T) -> Result<(), Refused<T>> {
        let entry = T::table().get(parameter.0).ok_or(Refused::Unknown)?;
        *self.0.get_mut(parameter.0).ok_or(Refused::Unknown)? = entry.accept(value)?;
        Ok(())
    }

    /// Sets the values of a run.
    ///
    /// # Errors
    /// [`Refused`] at the first value that is; those before it are set.
    pub fn set_run<const N: usize>(&mut self, run: Run<N>, values: [T; N]) -> Result<(), Refused<T>> {
        run.parameters().zip(values).try_for_each(|(parameter, value)| self.set(parameter, value))
    }

    /// The entry and value at an index of the table.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static Entry<T>, T)> {
        Some((T::table().get(index)?, *self.0.get(index)?))
    }

    /// A parameter's entry, and its default.
    #[must_use]
    pub fn entry(parameter: Parameter) -> Option<(&'static Entry<T>, T)> {
        T::table().get(parameter.0).map(|entry| (entry, entry.default))
    }

    /// All entries with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Entry<T>, T)> + '_ {
        T::table().iter().zip(self.0)
    }
}

impl<T: Real> Parameters<T> {
    /// A value.
    #[must_use]
    pub fn get(&self, parameter: Parameter) -> T {
        self.0.get(parameter.0).copied().unwrap_or_default()
    }

    /// The values of a run.
    #[must_use]
    pub fn run<const N: usize>(&self, run: Run<N>) -> [T; N] {
        let mut parameters = run.parameters();
        core::array::from_fn(|_| parameters.next().map_or_else(T::zero, |parameter| self.get(parameter)))
    }

    /// A choice or a whole number up to 255.
    #[must_use]
    pub fn whole(&self, parameter: Parameter) -> u8 {
        // By counting, since a number of any scalar is not turned into an integer without double
        // precision.
        let (value, mut count) = (self.get(parameter), T::zero());
        (0..u8::MAX)
            .find(|_| {
                count += T::one();
                count > value
            })
            .unwrap_or(u8::MAX)
    }

    /// Whether `PATH_KIND` chooses a route.
    #[must_use]
    pub fn is_route(&self) -> bool {
        self.whole(parameter!("PATH_KIND")) == ROUTE
    }

    /// Whether a switch is on.
    #[must_use]
    pub fn is_on(&self, parameter: Parameter) -> bool {
        self.get(parameter) > T::zero()
    }

    /// The same in another scalar, each number rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Parameters<U> {
        Parameters(self.0.map(|value| U::lit(value.to_f64())))
    }

    /// Names the parameter, of those whose names begin with one of `prefixes`, whose value the
    /// controller refused.
    pub(crate) fn naming(&self, prefixes: &'static [&'static str]) -> impl Fn(OutOfRange<T>) -> OutOfRange<T> + '_ {
        move |error| OutOfRange { field: self.name_of(&error, prefixes), ..error }
    }

    // Kept apart: set-up asks in many places, and none of them is in a hurry.
    #[inline(never)]
    fn name_of(&self, refused: &OutOfRange<T>, prefixes: &[&str]) -> &'static str {
        let named = f32::table().iter().zip(self.0).find(|(entry, value)| {
            prefixes.iter().any(|prefix| entry.name.as_str().starts_with(prefix))
                && entry.field == refused.field
                && *value == refused.value
        });
        named.map_or(refused.field, |(entry, _)| entry.name.as_str())
    }
}
