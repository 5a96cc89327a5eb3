//! Curves of any kind, chosen at run time.

use controller::law::lift::PositionSeries;
use controller::path::{
    Bent, Curve, Curved, Ellipse, Formula as Formulas, FourierPath, Harmonics, Implicit, Located, Superellipse,
    Tilted,
};
use controller::{Analytic, Circle, OutOfRange, Real, Series, Vector3};

use crate::describe::formula::Formula;

/// Most harmonics of a Fourier curve; those that are not given are zero.
pub const HARMONICS: usize = crate::study::fit::MAX_HARMONICS;

/// A curve as described by a user.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveSpec {
    /// The paper's horizontal circle about n3, (16); ρ turns from n1 to n2.
    Circle {
        /// d1, m.
        radius: f64,
        /// d2, m; negative is above the origin.
        p3: f64,
    },
    /// h1 = (p1/a)² + (p2/b)² − 1, h2 = p3 − c0 − c1 p1.
    Ellipse {
        /// Half axis along n1, m.
        a: f64,
        /// Half axis along n2, m.
        b: f64,
        /// Height at p1 = 0, m.
        c0: f64,
        /// Slope along n1.
        c1: f64,
    },
    /// h1 = (p1/a)⁴ + (p2/b)⁴ − 1, h2 = p3 − c0 − ½ sin(p1/2).
    Bent {
        /// Half width along n1, m.
        a: f64,
        /// Half width along n2, m.
        b: f64,
        /// Mean height, m.
        c0: f64,
    },
    /// h1 = (p1/a)ⁿ + (p2/b)ⁿ − 1, h2 = p3 − c0 − c1 p1.
    Superellipse {
        /// Half width along n1, m.
        a: f64,
        /// Half width along n2, m.
        b: f64,
        /// n/2.
        half_exponent: u8,
        /// Height at p1 = 0, m.
        c0: f64,
        /// Slope along n1.
        c1: f64,
    },
    /// An ellipse in any plane, right-handed about `normal`.
    Tilted {
        /// In N, m.
        center: [f64; 3],
        /// Direction across the plane.
        normal: [f64; 3],
        /// Direction of the half axis a.
        major: [f64; 3],
        /// m.
        a: f64,
        /// m.
        b: f64,
    },
    /// h1 = 0 and h2 = 0 by formulas.
    Implicit(Surfaces),
    /// A Fourier series.
    Fourier(Box<Harmonics<f64, HARMONICS>>),
}

/// h1 and h2 as formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    /// h1.
    pub h1: Formula,
    /// h2.
    pub h2: Formula,
}

impl<T: Real> Implicit<T> for Surfaces {
    fn surfaces<A: Analytic<T>>(&self, p: [A; 3]) -> [A; 2] {
        [self.h1.evaluate_analytic(p), self.h2.evaluate_analytic(p)]
    }
}

/// A curve of any kind, as the law takes it.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum AnyCurve<T> {
    Circle(Circle<T>),
    Ellipse(Ellipse<T>),
    Bent(Bent<T>),
    Superellipse(Superellipse<T>),
    Tilted(Tilted<T>),
    Implicit(Formulas<Surfaces>),
    Fourier(Box<FourierPath<T, HARMONICS>>),
}

impl CurveSpec {
    /// The curve as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if it refuses a parameter.
    pub fn build<T: Real>(&self) -> Result<AnyCurve<T>, OutOfRange<T>> {
        let t = T::lit;
        let vector = |v: &[f64; 3]| Vector3::from(v.map(t));
        Ok(match self {
            Self::Circle { radius, p3 } => AnyCurve::Circle(Circle::new(t(*radius), t(*p3))?),
            Self::Ellipse { a, b, c0, c1 } => AnyCurve::Ellipse(Ellipse::new(t(*a), t(*b), t(*c0), t(*c1))?),
            Self::Bent { a, b, c0 } => AnyCurve::Bent(Bent::new(t(*a), t(*b), t(*c0))?),
            Self::Superellipse { a, b, half_exponent, c0, c1 } => {
                AnyCurve::Superellipse(Superellipse::new(t(*a), t(*b), *half_exponent, t(*c0), t(*c1))?)
            }
            Self::Tilted { center, normal, major, a, b } => {
                AnyCurve::Tilted(Tilted::new(vector(center), vector(normal), vector(major), t(*a), t(*b))?)
            }
            Self::Implicit(surfaces) => AnyCurve::Implicit(Formulas(surfaces.clone())),
            Self::Fourier(harmonics) => {
                let rows = |rows: &[[f64; 3]; HARMONICS]| rows.map(|row| row.map(t));
                AnyCurve::Fourier(Box::new(FourierPath::new(Harmonics {
                    center: harmonics.center.map(t),
                    cos: rows(&harmonics.cos),
                    sin: rows(&harmonics.sin),
                    reference: harmonics.reference.map(t),
                })?))
            }
        })
    }

    /// A point on or near the curve, in N, m.
    pub(super) fn hint(&self) -> Vector3<f64> {
        match self {
            Self::Circle { radius, p3 } => Vector3::new(*radius, 0.0, *p3),
            Self::Ellipse { a, c0, .. } | Self::Bent { a, c0, .. } | Self::Superellipse { a, c0, .. } => {
                Vector3::new(*a, 0.0, *c0)
            }
            Self::Tilted { center, normal, major, a, .. } => {
                let (normal, major) = (Vector3::from(*normal), Vector3::from(*major));
                let across = major - normal * (major.dot(&normal) / normal.dot(&normal));
                Vector3::from(*center) + across * (a / across.dot(&across).sqrt())
            }
            Self::Implicit(_) => Vector3::zeros(),
            Self::Fourier(harmonics) => harmonics.point(0.0),
        }
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
            AnyCurve::Implicit($curve) => $value,
            AnyCurve::Fourier($curve) => $value,
        }
    };
}

impl<T: Real> Curve<T> for AnyCurve<T> {
    #[inline]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        each!(self, curve => curve.locate(position))
    }

    fn search(&mut self, position: &Vector3<T>) {
        each!(self, curve => curve.search(position));
    }
}

impl<T: Real> Curved<T> for AnyCurve<T> {
    fn turning(&self, position: &PositionSeries<T>, located: &Located<T>) -> [Series<T, 6>; 3] {
        each!(self, curve => curve.turning(position, located))
    }
}
