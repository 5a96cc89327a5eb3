//! Speeds and yaws of any kind, chosen at run time.

use controller::law::lift::PositionSeries;
use controller::path::{
    AlongTangent, ConstantSpeed, CurvatureLimited, FixedYaw, Formula as OfPosition, Located, PointingAt, ScalarField,
    SpeedProfile, YawProfile,
};
use controller::{Analytic, OutOfRange, Real, Series};

use super::AnyCurve;
use crate::describe::formula::Formula;

/// v_d as described by a user, m/s along ρ.
#[derive(Clone, Debug, PartialEq)]
pub enum SpeedSpec {
    /// The same everywhere.
    Constant(f64),
    /// A function of position.
    Formula(Formula),
    /// Slower where the curve bends.
    CurvatureLimited {
        /// On a straight piece, m/s.
        max: f64,
        /// Bound of the centripetal acceleration, m/s².
        acceleration: f64,
    },
}

/// ψ_d as described by a user, rad.
#[derive(Clone, Debug, PartialEq)]
pub enum YawSpec {
    /// The same everywhere.
    Fixed(f64),
    /// b1 along the tangent's horizontal part.
    Tangent,
    /// A function of position.
    Formula(Formula),
    /// b1 towards a vertical line.
    PointingAt {
        /// Its p1 and p2, m.
        target: [f64; 2],
    },
}

impl<T: Real> ScalarField<T> for Formula {
    fn at<A: Analytic<T>>(&self, p: [A; 3]) -> A {
        self.evaluate_analytic(p)
    }
}

/// v_d of any kind, as the law takes it.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum AnySpeed<T> {
    Constant(ConstantSpeed<T>),
    Formula(OfPosition<Formula>),
    CurvatureLimited(CurvatureLimited<T>),
}

/// ψ_d of any kind, as the law takes it.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum AnyYaw<T> {
    Fixed(FixedYaw<T>),
    Tangent(AlongTangent),
    Formula(OfPosition<Formula>),
    PointingAt(OfPosition<PointingAt<T>>),
}

impl SpeedSpec {
    pub(super) fn build<T: Real>(&self) -> Result<AnySpeed<T>, OutOfRange<T>> {
        Ok(match self {
            Self::Constant(speed) => AnySpeed::Constant(ConstantSpeed(T::lit(*speed))),
            Self::Formula(formula) => AnySpeed::Formula(OfPosition(formula.clone())),
            Self::CurvatureLimited { max, acceleration } => {
                AnySpeed::CurvatureLimited(CurvatureLimited::new(T::lit(*max), T::lit(*acceleration))?)
            }
        })
    }
}

impl YawSpec {
    pub(super) fn build<T: Real>(&self) -> AnyYaw<T> {
        match self {
            Self::Fixed(yaw) => AnyYaw::Fixed(FixedYaw(T::lit(*yaw))),
            Self::Tangent => AnyYaw::Tangent(AlongTangent),
            Self::Formula(formula) => AnyYaw::Formula(OfPosition(formula.clone())),
            Self::PointingAt { target: [x, y] } => {
                AnyYaw::PointingAt(OfPosition(PointingAt { x: T::lit(*x), y: T::lit(*y) }))
            }
        }
    }
}

impl<T: Real> SpeedProfile<T, AnyCurve<T>> for AnySpeed<T> {
    #[inline]
    fn speed(&self, curve: &AnyCurve<T>, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 6> {
        match self {
            Self::Constant(speed) => speed.speed(curve, position, located),
            Self::Formula(speed) => speed.speed(curve, position, located),
            Self::CurvatureLimited(speed) => speed.speed(curve, position, located),
        }
    }
}

impl<T: Real> YawProfile<T> for AnyYaw<T> {
    #[inline]
    fn yaw(&self, position: &PositionSeries<T>, located: &Located<T>) -> Series<T, 3> {
        match self {
            Self::Fixed(yaw) => yaw.yaw(position, located),
            Self::Tangent(yaw) => yaw.yaw(position, located),
            Self::Formula(yaw) => yaw.yaw(position, located),
            Self::PointingAt(yaw) => yaw.yaw(position, located),
        }
    }
}
