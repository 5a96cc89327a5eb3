//! A scenario's controller as the target's parameters.

use autopilot::{HARMONICS, Parameter, Parameters};
use controller::{ApproachLimits, Gains, ObserverParams, TrackGains, Vehicle};

use super::HilError;
use crate::describe::route::{CurveSpec, PathSpec, SpeedSpec, YawSpec};
use crate::describe::scenario::{ControllerSpec, Law};

/// Sets a run of parameters.
type Set<'a> = &'a mut dyn FnMut(Parameter, &[f32]) -> Result<(), HilError>;

/// The parameters with which the target makes the law that `spec` describes, number by number as this program's f32 law has it. That is the law
/// alone: so the target's supervisor gets the widest envelope there is, and rotors that give whatever the law's own limits let through.
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
    let vehicle = spec.vehicle.cast::<f32>();
    set(Parameter::PayloadMass, &[vehicle.payload_mass, vehicle.uav_mass, vehicle.rod_length])?;
    set(Parameter::Inertia1, &vehicle.inertia)?;
    set(Parameter::Gravity, &[vehicle.gravity])?;
    let sampling = spec.sampling().cast::<f32>();
    set(Parameter::Period, &[sampling.period, sampling.latency, sampling.rotor_lag, on(sampling.look_ahead)])?;
    set_observer(&spec.observer.cast(), &mut set)?;
    let limits = spec.limits.cast::<f32>();
    // No limits are 10⁶ of either kind; the target's range ends sooner, and further off than any flight.
    set(Parameter::ThrustMin, &[limits.min_thrust.max(0.0), limits.max_thrust.min(1e4)])?;
    set(Parameter::TorqueMax1, &limits.max_torque.map(|torque| torque.min(1e3)))?;
    let told = Vehicle::new(vehicle).map_err(|error| HilError::Unsupported(error.to_string()))?;
    set_supervisor(&told, &mut set)?;
    match &spec.law {
        Law::Follow { path, gains } => {
            let Gains { k1, k2, k3, k4, integral } = gains.cast::<f32>();
            set(Parameter::Law, &[0.0])?;
            set(Parameter::K1D0, &k1)?;
            set(Parameter::K2D0, &k2)?;
            set(Parameter::K3D0, &k3)?;
            set(Parameter::K4D0, &k4)?;
            set(Parameter::KI1, &integral)?;
            set_path(path, &mut set)?;
        }
        Law::Track { reference, gains } => {
            let TrackGains { position: [k1, k2, k3], yaw } = gains.cast::<f32>();
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

/// A switch as a parameter.
fn on(switch: bool) -> f32 {
    f32::from(u8::from(switch))
}

fn set_observer(params: &ObserverParams<f32>, set: Set<'_>) -> Result<(), HilError> {
    set(Parameter::ObserverPayload, &[params.payload_bandwidth, params.rod_bandwidth, params.torque_bandwidth])?;
    set(Parameter::ObserverPayloadBound, &[params.payload_bound, params.rod_bound, params.torque_bound])
}

/// What the law alone does not have: nothing that would ever change what it does.
fn set_supervisor(vehicle: &Vehicle<f32>, set: Set<'_>) -> Result<(), HilError> {
    let angles = [1.5; 2];
    set(Parameter::RodAngleWarning, &angles)?;
    set(Parameter::ThrustAngleWarning, &angles)?;
    set(Parameter::RollWarning, &angles)?;
    // Tension, thrust, path and reach.
    set(Parameter::TensionWarning, &[0.0; 8])?;
    set(Parameter::PayloadLost, &[-1.0])?;
    let ApproachLimits { min_thrust, max_thrust, .. } = ApproachLimits::gentle(vehicle);
    set(Parameter::ApproachThrustMin, &[min_thrust, max_thrust])?;
    // 10 kN at full speed each, on arms of 10 m, with as much torque as thrust.
    set(Parameter::RotorArm, &[10.0, 1e-4, 1e-4, 0.0, 1e4])
}

fn set_path(path: &PathSpec, set: Set<'_>) -> Result<(), HilError> {
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
