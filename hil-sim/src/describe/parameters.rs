//! A scenario's controller as the parameters of the controller that flies it: here, on a board and
//! in C the same.

use controller::{ActuatorLimits, Gains, ObserverParams, Sampling, TrackGains, VehicleParams};
use rig::{HARMONICS, Parameter, Parameters, ROUTE, Refused, Run, Shape, parameter, run};

use crate::describe::input::{Invalid, join};
use crate::describe::path::{CurveSpec, PathKind, PathSpec, SpeedSpec, YawSpec};
use crate::describe::scenario::{ControllerSpec, Law};

/// A controller that has no parameters, or a number outside a parameter's range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Unsupported(pub String);

/// The parameters with which a [`Rig`](rig::Rig) makes the controller that `spec` describes. A law
/// that is to fly alone gets the widest envelope there is. Rotors give whatever the law's own
/// limits let through.
///
/// # Errors
/// [`Unsupported`] for a path that has no parameters, or a number outside a parameter's range.
pub fn parameters(spec: &ControllerSpec) -> Result<Parameters<f64>, Unsupported> {
    let mut parameters = without_path(spec)?;
    if let Law::Follow { path, .. } = &spec.law {
        set_path(path, &mut parameters)?;
    }
    Ok(parameters)
}

/// The same for any path: all but the path's own.
///
/// # Errors
/// [`Unsupported`] for a number outside a parameter's range.
pub fn without_path(spec: &ControllerSpec) -> Result<Parameters<f64>, Unsupported> {
    let mut parameters = Parameters::default();
    let all = &mut parameters;
    let VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity } = spec.vehicle;
    run_of(all, run!("VEH_M_LOAD" to "VEH_ROD"), [payload_mass, uav_mass, rod_length])?;
    run_of(all, run!("VEH_J1" to "VEH_J3"), inertia)?;
    one(all, parameter!("VEH_G"), gravity)?;
    let Sampling { period, latency, rotor_lag, look_ahead } = spec.sampling();
    run_of(all, run!("CTL_PERIOD" to "CTL_AHEAD"), [period, latency, rotor_lag, f64::from(u8::from(look_ahead))])?;
    if let Some(times) = spec.rate_loop_s {
        run_of(all, run!("INN_T_1" to "INN_T_3"), times)?;
    }
    let ObserverParams { payload_bandwidth, along_bandwidth, cable_stiffness, .. } = spec.observer;
    run_of(all, run!("OBS_W_LOAD" to "OBS_EA"), [payload_bandwidth, along_bandwidth, cable_stiffness])?;
    let ObserverParams { rod_bandwidth, torque_bandwidth, .. } = spec.observer;
    run_of(all, run!("OBS_W_ROD" to "OBS_W_TAU"), [rod_bandwidth, torque_bandwidth])?;
    let ObserverParams { payload_bound, rod_bound, torque_lever, .. } = spec.observer;
    run_of(all, run!("OBS_MAX_LOAD" to "OBS_MAX_LEVER"), [payload_bound, rod_bound, torque_lever])?;
    let ActuatorLimits { min_thrust, max_thrust, max_torque } = spec.limits;
    // No limits are 10⁶ of either kind; the table's range ends sooner, and further off than any
    // flight.
    run_of(all, run!("LIM_T_MIN" to "LIM_T_MAX"), [min_thrust.max(0.0), max_thrust.min(1e4)])?;
    run_of(all, run!("LIM_TAU_1" to "LIM_TAU_3"), max_torque.map(|torque| torque.min(1e3)))?;
    // 10 kN at full speed each, on arms of 10 m, with as much torque as thrust.
    run_of(all, run!("ROT_ARM" to "ROT_W_MAX"), [10.0, 1e-4, 1e-4, 0.0, 1e4])?;
    if !spec.supervised {
        open_up(all)?;
    }
    match &spec.law {
        Law::Follow { gains, .. } => {
            let Gains { k1, k2, k3, k4, integral } = *gains;
            one(all, parameter!("CTL_LAW"), 0.0)?;
            run_of(all, run!("K1_0" to "K1_5"), k1)?;
            run_of(all, run!("K2_0" to "K2_5"), k2)?;
            run_of(all, run!("K3_0" to "K3_4"), k3)?;
            run_of(all, run!("K4_0" to "K4_1"), k4)?;
            run_of(all, run!("KI_1" to "KI_3"), integral)?;
        }
        Law::Track { reference, gains } => {
            let TrackGains { position: [k1, k2, k3], yaw } = *gains;
            one(all, parameter!("CTL_LAW"), 1.0)?;
            run_of(all, run!("K1_0" to "K1_5"), k1)?;
            run_of(all, run!("K2_0" to "K2_5"), k2)?;
            run_of(all, run!("K3_0" to "K3_5"), k3)?;
            run_of(all, run!("K4_0" to "K4_1"), yaw)?;
            run_of(all, run!("PATH_RADIUS" to "PATH_P3"), [reference.radius, reference.p3])?;
            one(all, parameter!("REF_RATE"), reference.rate)?;
        }
    }
    set_named("", &spec.parameters, all).map_err(|invalid| Unsupported(invalid.to_string()))?;
    Ok(parameters)
}

/// Sets what the law alone does not have: to nothing that would ever change what it does.
fn open_up(all: &mut Parameters<f64>) -> Result<(), Unsupported> {
    // Rod, thrust axis and roll; tension, thrust, path and reach.
    run_of(all, run!("ENV_ROD_WARN" to "ENV_ROLL_LIM"), [1.5; 6])?;
    run_of(all, run!("ENV_TENS_WARN" to "ENV_REACH_LIM"), [0.0; 8])?;
    one(all, parameter!("POL_LOAD_LOST"), -1.0)
}

/// Sets the path's curve, speed and yaw.
fn set_path(path: &PathSpec, all: &mut Parameters<f64>) -> Result<(), Unsupported> {
    let formula = |what: &str| Err(Unsupported(format!("{what} by formula is for simulation only")));
    let path = match &path.kind {
        PathKind::Profiled(path) => path,
        // Its points are no parameters: they come as a mission.
        PathKind::Route(_) => return one(all, parameter!("PATH_KIND"), f64::from(ROUTE)),
    };
    match &path.curve {
        CurveSpec::Numbers(described) => {
            one(all, parameter!("PATH_KIND"), described.get(parameter!("PATH_KIND")))?;
            for parameter in Shape::of(described).fields().iter().flat_map(|field| field.parameters()) {
                one(all, parameter, described.get(parameter))?;
            }
        }
        CurveSpec::Fourier(harmonics) => {
            let rows = |rows: &[[f64; 3]]| {
                let (few, beyond) = rows.split_at(HARMONICS);
                let fits = beyond.iter().all(|row| *row == [0.0; 3]);
                fits.then(|| std::array::from_fn(|index| few[index / 3][index % 3]))
                    .ok_or_else(|| Unsupported(format!("the curve has more than {HARMONICS} harmonics")))
            };
            one(all, parameter!("PATH_KIND"), f64::from(Shape::Fourier as u8))?;
            run_of(all, run!("PATH_CTR_1" to "PATH_CTR_3"), harmonics.center)?;
            run_of(all, run!("PATH_NRM_1" to "PATH_NRM_3"), harmonics.reference)?;
            run_of::<24>(all, run!("FOU_C1_1" to "FOU_C8_3"), rows(&harmonics.cos)?)?;
            run_of::<24>(all, run!("FOU_S1_1" to "FOU_S8_3"), rows(&harmonics.sin)?)?;
        }
        CurveSpec::Implicit(_) => return formula("a curve"),
    }
    let speed = match path.speed {
        SpeedSpec::Constant(speed) => [speed, 0.0],
        SpeedSpec::CurvatureLimited { max, acceleration } => [max, acceleration],
        SpeedSpec::Formula(_) => return formula("a speed"),
    };
    run_of(all, run!("PATH_SPEED" to "PATH_ACC"), speed)?;
    let (kind, yaw, [x, y]) = match path.yaw {
        YawSpec::Fixed(yaw) => (0.0, yaw, [0.0; 2]),
        YawSpec::Tangent => (1.0, 0.0, [0.0; 2]),
        YawSpec::PointingAt { target } => (2.0, 0.0, target),
        YawSpec::Formula(_) => return formula("a yaw"),
    };
    run_of(all, run!("PATH_YAW_KIND" to "PATH_YAW_Y"), [kind, yaw, x, y])
}

/// Sets envelope, approach and policy by name; `at` is the table's.
///
/// # Errors
/// [`Invalid`] for another name, or a value that the parameter does not take.
pub fn set_named(at: &str, named: &[(String, f64)], all: &mut Parameters<f64>) -> Result<(), Invalid> {
    for (name, value) in named {
        let of_flight = ["ENV_", "APP_", "POL_"].iter().any(|prefix| name.starts_with(prefix));
        let found = Parameter::find(name).filter(|_| of_flight);
        let parameter = found.ok_or_else(|| Invalid::new(join(at, name), "no parameter ENV_*, APP_* or POL_*"))?;
        all.set(parameter, *value).map_err(|refused| Invalid::refused(join(at, name), refused))?;
    }
    Ok(())
}

fn one(all: &mut Parameters<f64>, parameter: Parameter, value: f64) -> Result<(), Unsupported> {
    all.set(parameter, value).map_err(unsupported)
}

fn run_of<const N: usize>(all: &mut Parameters<f64>, run: Run<N>, values: [f64; N]) -> Result<(), Unsupported> {
    all.set_run(run, values).map_err(unsupported)
}

fn unsupported(refused: Refused<f64>) -> Unsupported {
    Unsupported(refused.to_string())
}
