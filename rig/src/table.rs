//! The table of all parameters, in either scalar, and handles that the compiler finds by name.

use controller::Real;

use crate::entry::Entry;
use crate::{actuators, curve, flight, gains, observer, profile, setpoint, timing, vehicle};

/// The groups, in the order of the table.
const GROUPS: &[&[Entry<f64>]] = &[
    timing::ENTRIES,
    vehicle::ENTRIES,
    curve::ENTRIES,
    profile::ENTRIES,
    gains::ENTRIES,
    observer::ENTRIES,
    flight::ENTRIES,
    actuators::ENTRIES,
    setpoint::ENTRIES,
];

/// How many parameters there are.
pub const COUNT: usize = {
    let (mut count, mut group) = (0, 0);
    while group < GROUPS.len() {
        count += GROUPS[group].len();
        group += 1;
    }
    count
};

static WIDE: [Entry<f64>; COUNT] = concatenated(GROUPS);
static NARROW: [Entry<f32>; COUNT] = narrowed(&WIDE);

/// The entries of `groups`, one behind the other; N is how many there are.
///
/// # Panics
/// There are more or fewer.
#[must_use]
pub const fn concatenated<const N: usize>(groups: &[&[Entry<f64>]]) -> [Entry<f64>; N] {
    let mut all = [groups[0][0]; N];
    let (mut group, mut next) = (0, 0);
    while group < groups.len() {
        let mut index = 0;
        while index < groups[group].len() {
            all[next] = groups[group][index];
            (index, next) = (index + 1, next + 1);
        }
        group += 1;
    }
    assert!(next == N);
    all
}

/// A table in single precision.
#[must_use]
pub const fn narrowed<const N: usize>(table: &[Entry<f64>; N]) -> [Entry<f32>; N] {
    let mut narrow = [table[0].narrow(); N];
    let mut index = 0;
    while index < N {
        narrow[index] = table[index].narrow();
        index += 1;
    }
    narrow
}

/// Where the entry of this name stands in a table; for the compiler.
///
/// # Panics
/// No entry has this name.
#[must_use]
pub const fn index_of(table: &[Entry<f64>], name: &str) -> usize {
    let mut index = 0;
    while index < table.len() {
        if table[index].name.is(name) {
            return index;
        }
        index += 1;
    }
    panic!("no parameter of this name")
}

/// A scalar in which the table is kept: single precision flies, double precision is its twin in the
/// simulator.
pub trait Tabled: Real {
    /// All parameters.
    fn table() -> &'static [Entry<Self>; COUNT];

    /// Whether it is a whole number.
    fn is_whole(self) -> bool;
}

impl Tabled for f32 {
    fn table() -> &'static [Entry; COUNT] {
        &NARROW
    }

    fn is_whole(self) -> bool {
        self as i32 as Self == self
    }
}

impl Tabled for f64 {
    fn table() -> &'static [Entry<Self>; COUNT] {
        &WIDE
    }

    fn is_whole(self) -> bool {
        Self::from(self as i32) == self
    }
}

/// A parameter: its place in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter(pub(crate) usize);

impl Parameter {
    /// The parameter of this name. [`parameter!`](crate::parameter) has the compiler find it.
    ///
    /// # Panics
    /// No entry has this name.
    #[must_use]
    pub const fn named(name: &str) -> Self {
        Self(index_of(&WIDE, name))
    }

    /// The parameter of a name that is known at run time only.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        f32::table().iter().position(|entry| entry.name.as_str() == name).map(Self)
    }

    /// The parameter at a place of the table, from 0.
    #[must_use]
    pub fn at(index: usize) -> Option<Self> {
        (index < COUNT).then_some(Self(index))
    }

    /// Its place in the table, from 0.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }
}

/// N parameters one behind the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run<const N: usize>(usize);

impl<const N: usize> Run<N> {
    /// From the parameter `first` to the parameter `last`. [`run!`](crate::run) has the compiler
    /// find them.
    ///
    /// # Panics
    /// No parameter has one of the names, or they are not N entries apart.
    #[must_use]
    pub const fn between(first: &str, last: &str) -> Self {
        let (first, last) = (Parameter::named(first), Parameter::named(last));
        assert!(first.0 + N == last.0 + 1, "as many numbers as there are parameters from the first to the last");
        Self(first.0)
    }

    /// The parameters, in their order.
    pub fn parameters(self) -> impl Iterator<Item = Parameter> {
        (self.0..self.0 + N).map(Parameter)
    }
}

/// The [`Parameter`] of a name, found by the compiler, which refuses an unknown name.
#[macro_export]
macro_rules! parameter {
    ($name:literal) => {
        const { $crate::Parameter::named($name) }
    };
}

/// The [`Run`] from one name to another, found by the compiler.
#[macro_export]
macro_rules! run {
    ($first:literal to $last:literal) => {
        const { $crate::Run::between($first, $last) }
    };
}
