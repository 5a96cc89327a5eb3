//! `PATH_SPEED` to `PATH_YAW_Y`, `REF_RATE`: how fast a curve is flown and where the nose points.

use controller::{
    AlongTangent, Analytic, ConstantSpeed, CurvatureLimited, Curved, FixedYaw, Formula, Implicit, Knot, Located,
    OutOfRange, Outputs, Path, PointingAt, PositionSeries, Profiled, Real, Route, Run, ScalarField, Series,
    SpeedProfile, Table, Vector3, YawProfile, ranges,
};

use crate::curve::{AnyCurve, NoFormula, ROUTE};
use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::{parameter, run};

/// From 0, which means no limit.
const CENTRIPETAL: (f64, f64) = (0.0, ranges::CENTRIPETAL.max);

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::of("PATH_SPEED", ranges::SPEED, "m/s", "Speed along the curve; negative flies it the other way."),
    Entry::real(
        "PATH_ACC",
        "acceleration",
        "m/s^2",
        0.0,
        CENTRIPETAL,
        "Largest centripetal acceleration, from 0.01: slower where the curve bends. 0: the same speed everywhere.",
    ),
    Entry::choice(
        "PATH_YAW_KIND",
        "kind",
        &["fixed", "along the tangent", "towards a line"],
        0,
        "Yaw along the path.",
    ),
    Entry::of("PATH_YAW", ranges::YAW, "rad", "Fixed yaw."),
    Entry::of("PATH_YAW_X", ranges::POINTING[0], "m", "p1 of the vertical line that the nose points to."),
    Entry::of("PATH_YAW_Y", ranges::POINTING[1], "m", "Its p2."),
    Entry::real(
        "REF_RATE",
        "rate",
        "rad/s",
        1.0,
        (-50.0, 50.0),
        "Tracking law's circle: angular rate, from n2 to n1.",
    ),
];

/// A path of any kind, chosen at run time: a curve with its profiles, all from numbers but for
/// formulas `F` of the curve and `G` of the profiles; or a route of a table `S`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, clippy::large_enum_variant)]
pub enum AnyPath<T, F = NoFormula, G = NoFormula, const K: usize = { crate::HARMONICS }, S = NoTable> {
    Profiled(Profiled<AnyCurve<T, F, K>, AnySpeed<T, G>, AnyYaw<T, G>>),
    Route(Route<T, S>),
}

/// No table: what a program is made with that flies no routes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoTable {}

impl<T> Table<T> for NoTable {
    fn knots(&self) -> &[Knot<T>] {
        match *self {}
    }

    fn runs(&self) -> &[Run<T>] {
        match *self {}
    }
}

macro_rules! either {
    ($self:expr, $path:ident => $value:expr) => {
        match $self {
            AnyPath::Profiled($path) => $value,
            AnyPath::Route($path) => $value,
        }
    };
}

impl<T, F, G, const K: usize, S> Path<T> for AnyPath<T, F, G, K, S>
where
    T: Real,
    F: Implicit<T>,
    G: ScalarField<T>,
    S: Table<T>,
{
    #[inline]
    fn evaluate(&mut self, position: &PositionSeries<T>, outputs: &mut Outputs<T>) {
        either!(self, path => path.evaluate(position, outputs));
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        either!(self, path => path.search(position))
    }

    fn dwell(&self) -> Option<T> {
        either!(self, path => path.dwell())
    }

    fn go_on(&mut self) -> bool {
        either!(self, path => path.go_on())
    }

    fn set_backward(&mut self, is_backward: bool) -> bool {
        either!(self, path => path.set_backward(is_backward))
    }
}

/// A speed of any kind.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum AnySpeed<T, F = NoFormula> {
    Constant(ConstantSpeed<T>),
    CurvatureLimited(CurvatureLimited<T>),
    Formula(Formula<F>),
}

/// A yaw of any kind.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum AnyYaw<T, F = NoFormula> {
    Fixed(FixedYaw<T>),
    Tangent(AlongTangent),
    PointingAt(Formula<PointingAt<T>>),
    Formula(Formula<F>),
}

impl<T: Real> ScalarField<T> for NoFormula {
    fn at<A: Analytic<T>>(&self, _: [A; 3]) -> A {
        match *self {}
    }
}

/// The path that `parameters` describe.
///
/// # Errors
/// What curve or profile refuse, by the parameter's name where it is one parameter's value; a
/// route, which has no parameters.
pub fn path<T: Real, F, G, const K: usize, S>(
    parameters: &Parameters<T>,
) -> Result<AnyPath<T, F, G, K, S>, OutOfRange<T>> {
    OutOfRange::check("PATH_KIND", parameters.get(parameter!("PATH_KIND")), 0.0, f64::from(ROUTE - 1))?;
    Ok(AnyPath::Profiled(Profiled {
        curve: AnyCurve::new(parameters)?,
        speed: AnySpeed::new(parameters)?,
        yaw: AnyYaw::new(parameters)?,
    }))
}

impl<T: Real, F> AnySpeed<T, F> {
    /// The speed that `parameters` describe.
    ///
    /// # Errors
    /// What the profile refuses, by the parameter's name.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, OutOfRange<T>> {
        let [speed, acceleration] = parameters.run(run!("PATH_SPEED" to "PATH_ACC"));
        Ok(if acceleration > T::zero() {
            Self::CurvatureLimited(CurvatureLimited::new(speed, acceleration).map_err(parameters.naming(&["PATH_"]))?)
        } else {
            Self::Constant(ConstantSpeed::new(speed).map_err(parameters.naming(&["PATH_"]))?)
        })
    }
}

impl<T: Real, F> AnyYaw<T, F> {
    /// The yaw that `parameters` describe.
    ///
    /// # Errors
    /// What the profile refuses, by the parameter's name.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, OutOfRange<T>> {
        let [x, y] = parameters.run(run!("PATH_YAW_X" to "PATH_YAW_Y"));
        Ok(match parameters.whole(parameter!("PATH_YAW_KIND")) {
            0 => Self::Fixed(
                FixedYaw::new(parameters.get(parameter!("PATH_YAW"))).map_err(parameters.naming(&["PATH_"]))?,
            ),
            1 => Self::Tangent(AlongTangent),
            _ => Self::PointingAt(Formula(PointingAt::new(x, y).map_err(parameters.naming(&["PATH_YAW_"]))?)),
        })
    }
}

impl<T: Real, C: Curved<T>, F: ScalarField<T>> SpeedProfile<T, C> for AnySpeed<T, F> {
    #[inline]
    fn speed(&self, curve: &C, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 6> {
        match self {
            Self::Constant(speed) => speed.speed(curve, position, located),
            Self::CurvatureLimited(limited) => limit(limited, curve, position, located),
            Self::Formula(speed) => speed.speed(curve, position, located),
        }
    }
}

impl<T: Real, F: ScalarField<T>> YawProfile<T> for AnyYaw<T, F> {
    #[inline]
    fn yaw(&self, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 3> {
        match self {
            Self::Fixed(yaw) => yaw.yaw(position, located),
            Self::Tangent(yaw) => yaw.yaw(position, located),
            Self::PointingAt(yaw) => yaw.yaw(position, located),
            Self::Formula(yaw) => yaw.yaw(position, located),
        }
    }
}

// Out of line, what it needs of the stack is free again while a curve is located.
#[inline(never)]
fn limit<T: Real, C: Curved<T>>(
    limited: &CurvatureLimited<T>,
    curve: &C,
    position: &PositionSeries<T>,
    located: &Located<T>,
) -> Series<T, 6> {
    limited.speed(curve, position, located)
}
