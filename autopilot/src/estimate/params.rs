//! `EST_*`: what the estimator is told of sensors, air and noise. Masses, cable, gravity and period
//! are the law's own.

use controller::Vector3;
use estimator::{Drag, NavigationNoise, NavigationParams, OutOfRange, PayloadNoise, PayloadParams};
use rig::{Entry, parameter};

use super::Source;
use crate::settings::{Setting, Settings};

const LEVER: (f64, f64) = (-2.0, 2.0);
const AREA: (f64, f64) = (0.0, 10.0);
/// ½ ρ of the standard atmosphere at sea level, kg/m³.
const HALF_DENSITY: f32 = 0.5 * 1.225;

pub const ENTRIES: &[Entry<f64>] = &[
    Entry::choice(
        "EST_LOAD",
        "source",
        &["off", "behind navigation by message", "from IMU and receiver"],
        0,
        "Find the load's state from the UAV's own sensors where no LOAD_STATE brings it.",
    ),
    Entry::real("EST_CDA_LOAD", "payload_drag", "m^2", 0.01, AREA, "Drag area C_d A of the payload. Calibrate it."),
    Entry::real("EST_CDA_UAV", "uav_drag", "m^2", 0.05, AREA, "Drag area C_d A of the UAV. Calibrate it."),
    Entry::real(
        "EST_ROTOR_DRAG",
        "uav_drag.linear",
        "N.s/m",
        0.0,
        (0.0, 100.0),
        "Drag of the UAV's rotors over airspeed.",
    ),
    Entry::real("EST_HOOK_X", "hook", "m", 0.0, LEVER, "Where the cable hangs, forward of the UAV's centre of mass."),
    Entry::real("EST_HOOK_Y", "hook", "m", 0.0, LEVER, "To the right of it."),
    Entry::real("EST_HOOK_Z", "hook", "m", 0.0, LEVER, "Below it."),
    Entry::real("EST_IMU_X", "imu", "m", 0.0, LEVER, "Where the IMU sits, forward of the UAV's centre of mass."),
    Entry::real("EST_IMU_Y", "imu", "m", 0.0, LEVER, "To the right of it."),
    Entry::real("EST_IMU_Z", "imu", "m", 0.0, LEVER, "Below it."),
    Entry::real(
        "EST_ANT_X",
        "antenna",
        "m",
        0.0,
        LEVER,
        "Where the antenna sits, forward of the UAV's centre of mass.",
    ),
    Entry::real("EST_ANT_Y", "antenna", "m", 0.0, LEVER, "To the right of it."),
    Entry::real("EST_ANT_Z", "antenna", "m", 0.0, LEVER, "Below it."),
    Entry::real(
        "EST_ACC_N",
        "noise.accelerometer",
        "m/s^2/Hz^0.5",
        0.015,
        (1e-4, 1.0),
        "Noise of the accelerometer in flight. Measure it.",
    ),
    Entry::real("EST_NOISE", "noise", "", 1.0, (0.01, 100.0), "Every noise figure times this."),
    Entry::real(
        "EST_RESIDUAL",
        "noise.residual",
        "m/s^2",
        0.04,
        (1e-3, 10.0),
        "Specific force on the payload that drag does not explain.",
    ),
    Entry::real(
        "EST_LATERAL",
        "noise.lateral",
        "m/s^2",
        0.05,
        (1e-3, 10.0),
        "Error of the thrust's model across its axis, over 40 ms.",
    ),
    Entry::real("EST_WIND", "noise.wind", "m/s", 4.0, (0.1, 50.0), "Wind that may blow."),
    Entry::real(
        "EST_OFFSET",
        "noise.offset",
        "m/s^2",
        0.02,
        (1e-4, 10.0),
        "Lateral bias of accelerometer and thrust's axis.",
    ),
    Entry::real(
        "EST_FIX_H",
        "noise.position",
        "m",
        0.012,
        (1e-3, 100.0),
        "Least horizontal error of a fix that is believed.",
    ),
    Entry::real(
        "EST_FIX_V",
        "noise.position",
        "m",
        0.019,
        (1e-3, 100.0),
        "Least vertical error of a fix that is believed.",
    ),
    Entry::real("EST_FIX_AGE", "age", "s", 0.1, (0.0, 0.3), "How old a receiver's fix is when it comes."),
    Entry::real(
        "EST_FIX_T",
        "outage",
        "s",
        10.0,
        (0.5, 600.0),
        "Without a fix for so long, position and velocity count as lost.",
    ),
    Entry::real(
        "EST_DECL",
        "declination",
        "rad",
        0.0,
        (-3.15, 3.15),
        "Magnetic declination: where a compass points, from n1 toward n2.",
    ),
];

macro_rules! get {
    ($settings:expr, $name:literal) => {
        $settings.get(const { Setting::named($name) })
    };
}

/// Where the UAV's motion is from; none where the estimator is off.
pub fn source(settings: &Settings) -> Option<Source> {
    match get!(settings, "EST_LOAD") as u8 {
        1 => Some(Source::Messages),
        2 => Some(Source::Sensors),
        _ => None,
    }
}

/// How old a fix is when it comes, s.
pub fn fix_age_s(settings: &Settings) -> f32 {
    get!(settings, "EST_FIX_AGE")
}

/// For how long navigation is believed without a fix, s.
pub fn outage_s(settings: &Settings) -> f32 {
    get!(settings, "EST_FIX_T")
}

/// What the payload filter is told.
pub fn payload(settings: &Settings) -> Result<PayloadParams<f32>, OutOfRange<f32>> {
    let rig = settings.rig();
    let vehicle = rig.vehicle()?;
    let noise = PayloadNoise {
        accelerometer: get!(settings, "EST_ACC_N"),
        residual: get!(settings, "EST_RESIDUAL"),
        lateral: get!(settings, "EST_LATERAL"),
        wind: get!(settings, "EST_WIND"),
        offset: get!(settings, "EST_OFFSET"),
        ..PayloadNoise::default()
    };
    let drag = |area: f32, linear| Drag { linear, quadratic: HALF_DENSITY * area };
    Ok(PayloadParams {
        uav_drag: drag(get!(settings, "EST_CDA_UAV"), get!(settings, "EST_ROTOR_DRAG")),
        payload_drag: drag(get!(settings, "EST_CDA_LOAD"), 0.0),
        hook: Vector3::new(get!(settings, "EST_HOOK_X"), get!(settings, "EST_HOOK_Y"), get!(settings, "EST_HOOK_Z")),
        imu: imu(settings),
        noise: noise.times(get!(settings, "EST_NOISE")),
        ..PayloadParams::of(vehicle.params(), rig.get(parameter!("CTL_PERIOD")))
    })
}

/// What navigation is told.
pub fn navigation(settings: &Settings) -> NavigationParams<f32> {
    let rig = settings.rig();
    let noise = NavigationNoise {
        accelerometer: get!(settings, "EST_ACC_N"),
        position: [get!(settings, "EST_FIX_H"), get!(settings, "EST_FIX_V")],
        ..NavigationNoise::default()
    };
    NavigationParams {
        gravity: rig.get(parameter!("VEH_G")),
        imu: imu(settings),
        antenna: Vector3::new(get!(settings, "EST_ANT_X"), get!(settings, "EST_ANT_Y"), get!(settings, "EST_ANT_Z")),
        declination: get!(settings, "EST_DECL"),
        noise: noise.times(get!(settings, "EST_NOISE")),
        ..NavigationParams::every(rig.get(parameter!("CTL_PERIOD")))
    }
}

fn imu(settings: &Settings) -> Vector3<f32> {
    Vector3::new(get!(settings, "EST_IMU_X"), get!(settings, "EST_IMU_Y"), get!(settings, "EST_IMU_Z"))
}
