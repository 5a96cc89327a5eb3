//! Curves as described by a user: any of the controller's by its numbers, a Fourier series, or
//! formulas.

use controller::{Analytic, Formula as Formulas, FourierPath, Harmonics, Implicit, OutOfRange, Real};
use rig::{AnyCurve, Parameter, Parameters, Shape};

use crate::describe::formula::Formula;

/// Most harmonics of a Fourier curve; those that are not given are zero.
pub const HARMONICS: usize = crate::study::fit::MAX_HARMONICS;

/// A curve as described by a user.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveSpec {
    /// One of the controller's, by the parameters that describe it. Of any shape but the Fourier
    /// series', which may have more harmonics here.
    Numbers(Box<Parameters<f64>>),
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

impl CurveSpec {
    /// The curve as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if it refuses a parameter.
    pub fn build<T: Real>(&self) -> Result<AnyCurve<T, Surfaces, HARMONICS>, OutOfRange<T>> {
        Ok(match self {
            Self::Numbers(parameters) => AnyCurve::new(&parameters.cast())?,
            Self::Implicit(surfaces) => AnyCurve::Formula(Formulas(surfaces.clone())),
            Self::Fourier(harmonics) => {
                let rows = |rows: &[[f64; 3]; HARMONICS]| rows.map(|row| row.map(T::lit));
                AnyCurve::Fourier(FourierPath::new(Harmonics {
                    center: harmonics.center.map(T::lit),
                    cos: rows(&harmonics.cos),
                    sin: rows(&harmonics.sin),
                    reference: harmonics.reference.map(T::lit),
                })?)
            }
        })
    }

    /// The shape of a curve by numbers, with the value of each of its parameters.
    pub(super) fn shape(&self) -> Option<(Shape, impl Fn(Parameter) -> f64 + '_)> {
        match self {
            Self::Numbers(parameters) => Some((Shape::of(parameters), |parameter| parameters.get(parameter))),
            _ => None,
        }
    }
}
