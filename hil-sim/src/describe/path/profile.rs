//! Speeds and yaws as described by a user.

use controller::{
    AlongTangent, ConstantSpeed, CurvatureLimited, FixedYaw, Formula as OfPosition, PointingAt, Profiled, ScalarField,
};
use controller::{Analytic, OutOfRange, Real};
use rig::{AnyCurve, AnySpeed, AnyYaw};

use super::{CurveSpec, HARMONICS, Surfaces};
use crate::describe::formula::Formula;

/// A curve with its profiles, as the law takes it.
pub type ProfiledPath<T> = Profiled<AnyCurve<T, Surfaces, HARMONICS>, AnySpeed<T, Formula>, AnyYaw<T, Formula>>;

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

/// A curve with its profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfiledSpec {
    /// The curve.
    pub curve: CurveSpec,
    /// v_d.
    pub speed: SpeedSpec,
    /// ψ_d.
    pub yaw: YawSpec,
}

impl ProfiledSpec {
    /// The path as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if rounding to `T` takes a parameter out of range.
    pub fn build<T: Real>(&self) -> Result<ProfiledPath<T>, OutOfRange<T>> {
        Ok(Profiled { curve: self.curve.build()?, speed: self.speed.build()?, yaw: self.yaw.build()? })
    }
}

impl<T: Real> ScalarField<T> for Formula {
    fn at<A: Analytic<T>>(&self, p: [A; 3]) -> A {
        self.evaluate_analytic(p)
    }
}

impl SpeedSpec {
    fn build<T: Real>(&self) -> Result<AnySpeed<T, Formula>, OutOfRange<T>> {
        Ok(match self {
            Self::Constant(speed) => AnySpeed::Constant(ConstantSpeed::new(T::lit(*speed))?),
            Self::Formula(formula) => AnySpeed::Formula(OfPosition(formula.clone())),
            Self::CurvatureLimited { max, acceleration } => {
                AnySpeed::CurvatureLimited(CurvatureLimited::new(T::lit(*max), T::lit(*acceleration))?)
            }
        })
    }
}

impl YawSpec {
    fn build<T: Real>(&self) -> Result<AnyYaw<T, Formula>, OutOfRange<T>> {
        Ok(match self {
            Self::Fixed(yaw) => AnyYaw::Fixed(FixedYaw::new(T::lit(*yaw))?),
            Self::Tangent => AnyYaw::Tangent(AlongTangent),
            Self::Formula(formula) => AnyYaw::Formula(OfPosition(formula.clone())),
            Self::PointingAt { target: [x, y] } => {
                AnyYaw::PointingAt(OfPosition(PointingAt::new(T::lit(*x), T::lit(*y))?))
            }
        })
    }
}
