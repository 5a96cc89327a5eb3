//! The path that the parameters describe: any of the controller's curves, chosen at run time.

use controller::law::lift::PositionSeries;
use controller::path::{
    AlongTangent, Bent, ConstantSpeed, CurvatureLimited, Curve, Curved, Ellipse, FixedYaw, Formula, FourierPath,
    Harmonics, Located, PointingAt, Profiled, SpeedProfile, Superellipse, Tilted, YawProfile,
};
use controller::{Circle, OutOfRange, Series, Vector3};

use crate::parameters::{Parameter, Parameters};

/// Harmonics of a Fourier curve.
pub const HARMONICS: usize = 8;

/// A path of any kind.
pub type AnyPath = Profiled<AnyCurve, AnySpeed, AnyYaw>;

/// A curve of any kind.
#[derive(Clone, Debug)]
#[allow(missing_docs, clippy::large_enum_variant)]
pub enum AnyCurve {
    Circle(Circle<f32>),
    Ellipse(Ellipse<f32>),
    Bent(Bent<f32>),
    Superellipse(Superellipse<f32>),
    Tilted(Tilted<f32>),
    Fourier(FourierPath<f32, HARMONICS>),
}

/// A speed of any kind.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum AnySpeed {
    Constant(ConstantSpeed<f32>),
    CurvatureLimited(CurvatureLimited<f32>),
}

/// A yaw of any kind.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub enum AnyYaw {
    Fixed(FixedYaw<f32>),
    Tangent(AlongTangent),
    PointingAt(Formula<PointingAt<f32>>),
}

/// The path of `parameters`.
///
/// # Errors
/// What a curve or profile refuses.
pub fn path(parameters: &Parameters) -> Result<AnyPath, OutOfRange<f32>> {
    let get = |parameter| parameters.get(parameter);
    let speed = get(Parameter::PathSpeed);
    let acceleration = get(Parameter::PathAcceleration);
    Ok(Profiled {
        curve: curve(parameters)?,
        speed: if acceleration > 0.0 {
            AnySpeed::CurvatureLimited(CurvatureLimited::new(speed, acceleration)?)
        } else {
            AnySpeed::Constant(ConstantSpeed(speed))
        },
        yaw: match get(Parameter::PathYawKind) as u8 {
            0 => AnyYaw::Fixed(FixedYaw(get(Parameter::PathYaw))),
            1 => AnyYaw::Tangent(AlongTangent),
            _ => AnyYaw::PointingAt(Formula(PointingAt { x: get(Parameter::PathYawX), y: get(Parameter::PathYawY) })),
        },
    })
}

fn curve(parameters: &Parameters) -> Result<AnyCurve, OutOfRange<f32>> {
    let get = |parameter| parameters.get(parameter);
    let vector = |first| Vector3::from(parameters.run::<3>(first));
    let (a, b, c0, c1) =
        (get(Parameter::PathA), get(Parameter::PathB), get(Parameter::PathC0), get(Parameter::PathC1));
    Ok(match get(Parameter::PathKind) as u8 {
        0 => AnyCurve::Circle(Circle::new(get(Parameter::PathRadius), get(Parameter::PathP3))?),
        1 => AnyCurve::Ellipse(Ellipse::new(a, b, c0, c1)?),
        2 => AnyCurve::Bent(Bent::new(a, b, c0)?),
        3 => AnyCurve::Superellipse(Superellipse::new(a, b, get(Parameter::PathHalfExponent) as u8, c0, c1)?),
        4 => {
            let [center, normal, major] =
                [Parameter::PathCenter1, Parameter::PathNormal1, Parameter::PathMajor1].map(vector);
            AnyCurve::Tilted(Tilted::new(center, normal, major, a, b)?)
        }
        _ => {
            let rows = |first| {
                let numbers: [f32; 3 * HARMONICS] = parameters.run(first);
                let mut rows = [[0.0; 3]; HARMONICS];
                rows.as_flattened_mut().copy_from_slice(&numbers);
                rows
            };
            AnyCurve::Fourier(FourierPath::new(Harmonics {
                center: parameters.run(Parameter::PathCenter1),
                cos: rows(Parameter::Cos11),
                sin: rows(Parameter::Sin11),
                reference: parameters.run(Parameter::PathNormal1),
            })?)
        }
    })
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
        }
    };
}

impl Curve<f32> for AnyCurve {
    #[inline]
    fn locate(&mut self, position: &PositionSeries<f32>) -> Located<f32> {
        each!(self, curve => curve.locate(position))
    }

    fn search(&mut self, position: &Vector3<f32>) {
        each!(self, curve => curve.search(position));
    }
}

impl Curved<f32> for AnyCurve {
    fn turning(&self, position: &PositionSeries<f32>, located: &Located<f32>) -> [Series<f32, 6>; 3] {
        each!(self, curve => curve.turning(position, located))
    }
}

impl SpeedProfile<f32, AnyCurve> for AnySpeed {
    #[inline]
    fn speed(&self, curve: &AnyCurve, position: &PositionSeries<f32>, located: &Located<f32>) -> Series<f32, 6> {
        match self {
            Self::Constant(speed) => speed.speed(curve, position, located),
            Self::CurvatureLimited(speed) => speed.speed(curve, position, located),
        }
    }
}

impl YawProfile<f32> for AnyYaw {
    #[inline]
    fn yaw(&self, position: &PositionSeries<f32>, located: &Located<f32>) -> Series<f32, 3> {
        match self {
            Self::Fixed(yaw) => yaw.yaw(position, located),
            Self::Tangent(yaw) => yaw.yaw(position, located),
            Self::PointingAt(yaw) => yaw.yaw(position, located),
        }
    }
}
