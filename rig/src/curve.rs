//! `PATH_*`, `FOU_*`: the controller's curves, any of them chosen at run time.
//!
//! A new curve is a shape here: its name, the parameters that its numbers come from, and how it is
//! made of them. Scenario files, the line to a target and the reference page of parameters have it
//! from here.

use controller::{
    Analytic, Bent, Circle, Curve, Curved, Ellipse, Formula, FourierPath, Harmonics, Implicit, Located, OutOfRange,
    PositionSeries, Real, Series, Superellipse, Tilted, Vector3, ranges,
};

use crate::entry::{Entry, Kind, Name};
use crate::parameters::Parameters;
use crate::table::{Parameter, Run, concatenated};
use crate::{parameter, run};

/// Harmonics of a Fourier curve that has its numbers from parameters.
pub const HARMONICS: usize = 8;

/// Of every component of a centre, a direction or a Fourier coefficient.
const FAR: (f64, f64) = (ranges::COORDINATE.min, ranges::COORDINATE.max);
const AMPLITUDES: usize = 3 * HARMONICS;

/// What `PATH_KIND` chooses from: the shapes, and a route, which has no numbers here but a table.
const KINDS: &[&str] = &["circle", "ellipse", "bent", "superellipse", "tilted", "fourier", "route"];

/// The value of `PATH_KIND` that chooses a route.
pub const ROUTE: u8 = Shape::ALL.len() as u8;

/// Three components `<name>_1` to `<name>_3`.
const fn vector(
    name: &str,
    field: &'static str,
    unit: &'static str,
    default: [f64; 3],
    text: &'static str,
) -> [Entry<f64>; 3] {
    let mut entries = [Entry::real("X", field, unit, 0.0, FAR, text); 3];
    let mut axis = 0;
    while axis < 3 {
        entries[axis].name = Name::new(name).with("_").with_digit(axis + 1);
        entries[axis].default = default[axis];
        axis += 1;
    }
    entries
}

/// `<name><harmonic>_<axis>`, all zero but the first harmonic's component along `axis`, which is 5
/// m.
const fn amplitudes(name: &str, field: &'static str, axis: usize, text: &'static str) -> [Entry<f64>; AMPLITUDES] {
    let mut entries = [Entry::real("X", field, "m", 0.0, FAR, text); AMPLITUDES];
    let mut index = 0;
    while index < AMPLITUDES {
        entries[index].name = Name::new(name).with_digit(index / 3 + 1).with("_").with_digit(index % 3 + 1);
        index += 1;
    }
    entries[axis].default = 5.0;
    entries
}

pub(crate) const ENTRIES: &[Entry<f64>] = &concatenated::<65>(&[
    &[
        Entry::choice("PATH_KIND", "kind", KINDS, 0, "The curve; a route is the mission's."),
        Entry::of("PATH_RADIUS", ranges::RADIUS, "m", "Circle, of a path or of the tracking law: radius."),
        Entry::of("PATH_P3", ranges::P3, "m", "Circle: p3; negative is above the origin."),
        Entry::of(
            "PATH_A",
            ranges::HALF_AXIS_A,
            "m",
            "Half axis along n1; of a tilted ellipse along its major axis.",
        ),
        Entry::of(
            "PATH_B",
            ranges::HALF_AXIS_B,
            "m",
            "Half axis along n2; of a tilted ellipse across its major axis.",
        ),
        Entry::of("PATH_C0", ranges::HEIGHT, "m", "Height c0 at p1 = 0."),
        Entry::of("PATH_C1", ranges::SLOPE, "", "Slope c1 along n1."),
        Entry {
            kind: Kind::Whole,
            ..Entry::of("PATH_EXP2", ranges::HALF_EXPONENT, "", "Superellipse: half of its exponent.")
        },
    ],
    &vector("PATH_CTR", "center", "m", [0.0, 0.0, -10.0], "Tilted, Fourier: the centre's component."),
    &vector("PATH_NRM", "normal", "", [0.0, 0.0, 1.0], "Tilted: component of the normal, of any length."),
    &vector(
        "PATH_MAJ",
        "major",
        "",
        [1.0, 0.0, 0.0],
        "Tilted: component of the direction of the half axis a, of any length.",
    ),
    &amplitudes(
        "FOU_C",
        "cos",
        0,
        "Fourier: cosine of the harmonic of the first digit along the axis of the second.",
    ),
    &amplitudes("FOU_S", "sin", 1, "Fourier: sine of the harmonic of the first digit along the axis of the second."),
]);

/// A kind of curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// [`Circle`].
    Circle,
    /// [`Ellipse`].
    Ellipse,
    /// [`Bent`].
    Bent,
    /// [`Superellipse`].
    Superellipse,
    /// [`Tilted`].
    Tilted,
    /// [`FourierPath`].
    Fourier,
}

impl Shape {
    /// All, each at the value of `PATH_KIND` that chooses it.
    pub const ALL: [Self; 6] =
        [Self::Circle, Self::Ellipse, Self::Bent, Self::Superellipse, Self::Tilted, Self::Fourier];

    /// Their names, as in scenario files.
    pub const NAMES: &[&str] = KINDS.split_at(Self::ALL.len()).0;

    /// The shape that `parameters` choose.
    #[must_use]
    pub fn of<T: Real>(parameters: &Parameters<T>) -> Self {
        let kind = usize::from(parameters.whole(parameter!("PATH_KIND")));
        Self::ALL.get(kind).copied().unwrap_or(Self::Circle)
    }

    /// The shape of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.get(self as usize).copied().unwrap_or_default()
    }

    /// Its numbers, as scenario files name them.
    #[must_use]
    pub fn fields(self) -> &'static [Field] {
        const A: Field = Field::number("a", "PATH_A");
        const B: Field = Field::number("b", "PATH_B");
        const C0: Field = Field::number("c0", "PATH_C0");
        const C1: Field = Field::optional("c1", "PATH_C1");
        const CENTER: Field = Field::numbers("center", "PATH_CTR_1", "PATH_CTR_3");
        match self {
            Self::Circle => const { &[Field::number("radius", "PATH_RADIUS"), Field::number("p3", "PATH_P3")] },
            Self::Ellipse => &[A, B, C0, C1],
            Self::Bent => &[A, B, C0],
            Self::Superellipse => const { &[A, B, Field::number("half_exponent", "PATH_EXP2"), C0, C1] },
            Self::Tilted => {
                const {
                    &[
                        CENTER,
                        Field::numbers("normal", "PATH_NRM_1", "PATH_NRM_3"),
                        Field::numbers("major", "PATH_MAJ_1", "PATH_MAJ_3"),
                        A,
                        B,
                    ]
                }
            }
            Self::Fourier => {
                const {
                    &[
                        CENTER,
                        Field::numbers("cos", "FOU_C1_1", "FOU_C8_3"),
                        Field::numbers("sin", "FOU_S1_1", "FOU_S8_3"),
                        Field::numbers("reference", "PATH_NRM_1", "PATH_NRM_3"),
                    ]
                }
            }
        }
    }
}

/// A field of a curve's description: the parameters that hold its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// What it is called.
    pub name: &'static str,
    first: usize,
    /// How many numbers it has.
    pub count: usize,
    /// It may be left out, and is zero then.
    pub optional: bool,
}

impl Field {
    const fn number(name: &'static str, parameter: &str) -> Self {
        Self::numbers(name, parameter, parameter)
    }

    const fn optional(name: &'static str, parameter: &str) -> Self {
        Self { optional: true, ..Self::number(name, parameter) }
    }

    const fn numbers(name: &'static str, first: &str, last: &str) -> Self {
        let (first, last) = (Parameter::named(first).index(), Parameter::named(last).index());
        Self { name, first, count: last + 1 - first, optional: false }
    }

    /// The parameters.
    pub fn parameters(self) -> impl Iterator<Item = Parameter> {
        (self.first..self.first + self.count).map(Parameter)
    }
}

/// No formula: what a program is made with whose curves and profiles all come from numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoFormula {}

impl<T: Real> Implicit<T> for NoFormula {
    fn surfaces<A: Analytic<T>>(&self, _: [A; 3]) -> [A; 2] {
        match *self {}
    }
}

/// A curve of any [`Shape`], or by the formulas `F`; Fourier curves have `K` harmonics.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, clippy::large_enum_variant)]
pub enum AnyCurve<T, F = NoFormula, const K: usize = HARMONICS> {
    Circle(Circle<T>),
    Ellipse(Ellipse<T>),
    Bent(Bent<T>),
    Superellipse(Superellipse<T>),
    Tilted(Tilted<T>),
    Fourier(FourierPath<T, K>),
    Formula(Formula<F>),
}

impl<T: Real, F, const K: usize> AnyCurve<T, F, K> {
    /// The curve that `parameters` describe.
    ///
    /// # Errors
    /// What the curve refuses, by the parameter's name where it is one parameter's value.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, OutOfRange<T>> {
        Self::of(parameters).map_err(parameters.naming(&["PATH_"]))
    }

    fn of(parameters: &Parameters<T>) -> Result<Self, OutOfRange<T>> {
        let vector = |run| Vector3::from(parameters.run(run));
        let [a, b, c0, c1] = parameters.run(run!("PATH_A" to "PATH_C1"));
        Ok(match Shape::of(parameters) {
            Shape::Circle => {
                let [radius, p3] = parameters.run(run!("PATH_RADIUS" to "PATH_P3"));
                Self::Circle(Circle::new(radius, p3)?)
            }
            Shape::Ellipse => Self::Ellipse(Ellipse::new(a, b, c0, c1)?),
            Shape::Bent => Self::Bent(Bent::new(a, b, c0)?),
            Shape::Superellipse => {
                let half_exponent = parameters.whole(parameter!("PATH_EXP2"));
                Self::Superellipse(Superellipse::new(a, b, half_exponent, c0, c1)?)
            }
            Shape::Tilted => {
                let [center, normal, major] = [
                    run!("PATH_CTR_1" to "PATH_CTR_3"),
                    run!("PATH_NRM_1" to "PATH_NRM_3"),
                    run!("PATH_MAJ_1" to "PATH_MAJ_3"),
                ]
                .map(vector);
                Self::Tilted(Tilted::new(center, normal, major, a, b)?)
            }
            Shape::Fourier => {
                let rows = |run: Run<AMPLITUDES>| {
                    let mut rows = [[T::zero(); 3]; K];
                    for (slot, number) in rows.as_flattened_mut().iter_mut().zip(parameters.run(run)) {
                        *slot = number;
                    }
                    rows
                };
                const { assert!(K >= HARMONICS) };
                Self::Fourier(FourierPath::new(Harmonics {
                    center: parameters.run(run!("PATH_CTR_1" to "PATH_CTR_3")),
                    cos: rows(run!("FOU_C1_1" to "FOU_C8_3")),
                    sin: rows(run!("FOU_S1_1" to "FOU_S8_3")),
                    reference: parameters.run(run!("PATH_NRM_1" to "PATH_NRM_3")),
                })?)
            }
        })
    }
}

macro_rules! each {
    ($self:expr, $curve:ident => $value:expr) => {
        match $self {
            AnyCurve::Circle($curve) => $value,
            AnyCurve::Ellipse($curve) => $value,
            AnyCurve::Bent($curve) => $value,
            AnyCurve::Superellipse($curve) => $value,
            AnyCurve::Tilted($curve) => $value,
            AnyCurve::Fourier($curve) => $value,
            AnyCurve::Formula($curve) => $value,
        }
    };
}

impl<T: Real, F: Implicit<T>, const K: usize> Curve<T> for AnyCurve<T, F, K> {
    #[inline]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        each!(self, curve => locate(curve, position))
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        each!(self, curve => curve.search(position))
    }
}

impl<T: Real, F: Implicit<T>, const K: usize> Curved<T> for AnyCurve<T, F, K> {
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        each!(self, curve => turning(curve, position, located))
    }
}

// Out of line, each curve has a stack of its own, and all together need no more than the largest.
#[inline(never)]
fn locate<T: Real, C: Curve<T>>(curve: &mut C, position: &PositionSeries<T>) -> Located<T> {
    curve.locate(position)
}

#[inline(never)]
fn turning<T: Real, C: Curved<T>>(
    curve: &C,
    position: &PositionSeries<T>,
    located: &Located<T>,
) -> [Series<T, 6>; 3] {
    curve.turning(position, located)
}
