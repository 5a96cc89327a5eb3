//! A scenario's controller as the target's parameters.

use autopilot::{HARMONICS, Parameter, Parameters};
use controller::{Gains, TrackGains};

use super::HilError;
use crate::pilot::cast;
use crate::route::{CurveSpec, PathSpec, SpeedSpec, YawSpec};
use crate::scenario::{ControllerSpec, Law};

/// The parameters with which the target makes the law that `spec` describes, number by number as this program's f32 law has it.
///
/// # Errors
/// [`HilError::Unsupported`] for a path that the target's program does not have, or a number outside a parameter's range.
pub fn parameters(spec: &ControllerSpec) -> Result<Parameters, HilError> {
    let mut parameters = Parameters::default();
    let mut set = |first, values: &[f32]| {
        parameters.set_run(first, values).map_err(|_| {
            HilError::Unsupported(format!("{values:?} is out of the range of the parameters from {first:?} on"))
        })
    };
    let vehicle = cast::<f32>(&spec.vehicle);
    set(Parameter::PayloadMass, &[vehicle.payload_mass, vehicle.uav_mass, vehicle.rod_length])?;
    set(Parameter::Inertia1, &vehicle.inertia)?;
    set(Parameter::Gravity, &[vehicle.gravity])?;
    set(Parameter::Period, &[(1.0 / spec.rate_hz) as f32])?;
    set(Parameter::LookAhead, &[f32::from(u8::from(spec.look_ahead))])?;
    // Figures 5 and 6 begin at twice the hover thrust: the limits must not be met, since the law in this program has none.
    set(Parameter::ThrustMax, &[1e4])?;
    set(Parameter::TorqueMax, &[1e3])?;
    match &spec.law {
        Law::Follow { path, gains } => {
            let Gains { k1, k2, k3, k4, integral } = crate::pilot::cast_gains::<f32>(gains);
            set(Parameter::Law, &[0.0])?;
            set(Parameter::K1D0, &k1)?;
            set(Parameter::K2D0, &k2)?;
            set(Parameter::K3D0, &k3)?;
            set(Parameter::K4D0, &k4)?;
            set(Parameter::KI1, &integral)?;
            set_path(path, &mut set)?;
        }
        Law::Track { reference, gains } => {
            let TrackGains { position: [k1, k2, k3], yaw } = crate::pilot::cast_track_gains::<f32>(gains);
            set(Parameter::Law, &[1.0])?;
            set(Parameter::K1D0, &k1)?;
            set(Parameter::K2D0, &k2)?;
            set(Parameter::K3D0, &k3)?;
            set(Parameter::K4D0, &yaw)?;
            set(Parameter::PathRadius, &[reference.radius as f32, reference.p3 as f32])?;
            set(Parameter::ReferenceRate, &[reference.rate as f32])?;
        }
    }
    Ok(parameters)
}

fn set_path(
    path: &PathSpec,
    set: &mut impl FnMut(Parameter, &[f32]) -> Result<(), HilError>,
) -> Result<(), HilError> {
    let unsupported = |what: &str| Err(HilError::Unsupported(format!("{what} is for simulation only")));
    let f = |x: &f64| *x as f32;
    let kind = match &path.curve {
        CurveSpec::Circle { radius, p3 } => {
            set(Parameter::PathRadius, &[f(radius), f(p3)])?;
            0
        }
        CurveSpec::Ellipse { a, b, c0, c1 } => {
            set(Parameter::PathA, &[a, b, c0, c1].map(f))?;
            1
        }
        CurveSpec::Bent { a, b, c0 } => {
            set(Parameter::PathA, &[a, b, c0].map(f))?;
            2
        }
        CurveSpec::Superellipse { a, b, half_exponent, c0, c1 } => {
            set(Parameter::PathA, &[a, b, c0, c1].map(f))?;
            set(Parameter::PathHalfExponent, &[f32::from(*half_exponent)])?;
            3
        }
        CurveSpec::Tilted { center, normal, major, a, b } => {
            set(Parameter::PathA, &[a, b].map(f))?;
            set(Parameter::PathCenter1, &center.each_ref().map(f))?;
            set(Parameter::PathNormal1, &normal.each_ref().map(f))?;
            set(Parameter::PathMajor1, &major.each_ref().map(f))?;
            4
        }
        CurveSpec::Fourier(harmonics) => {
            let beyond = harmonics.cos.iter().chain(&harmonics.sin).enumerate();
            let rows = harmonics.cos.len();
            if beyond.filter(|(row, _)| row % rows >= HARMONICS).any(|(_, row)| *row != [0.0; 3]) {
                return Err(HilError::Unsupported(format!("the curve has more than {HARMONICS} harmonics")));
            }
            let flat = |rows: &[[f64; 3]]| rows.iter().take(HARMONICS).flatten().map(f).collect::<Vec<f32>>();
            set(Parameter::PathCenter1, &harmonics.center.each_ref().map(f))?;
            set(Parameter::PathNormal1, &harmonics.reference.each_ref().map(f))?;
            set(Parameter::Cos11, &flat(&harmonics.cos))?;
            set(Parameter::Sin11, &flat(&harmonics.sin))?;
            5
        }
        CurveSpec::Implicit(_) => return unsupported("a curve by formula"),
    };
    set(Parameter::PathKind, &[kind as f32])?;
    match &path.speed {
        SpeedSpec::Constant(speed) => set(Parameter::PathSpeed, &[f(speed), 0.0])?,
        SpeedSpec::CurvatureLimited { max, acceleration } => set(Parameter::PathSpeed, &[max, acceleration].map(f))?,
        SpeedSpec::Formula(_) => return unsupported("a speed by formula"),
    }
    match &path.yaw {
        YawSpec::Fixed(yaw) => set(Parameter::PathYawKind, &[0.0, f(yaw)]),
        YawSpec::Tangent => set(Parameter::PathYawKind, &[1.0]),
        YawSpec::PointingAt { target: [x, y] } => {
            set(Parameter::PathYawKind, &[2.0])?;
            set(Parameter::PathYawX, &[f(x), f(y)])
        }
        YawSpec::Formula(_) => unsupported("a yaw by formula"),
    }
}
