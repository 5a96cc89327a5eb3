//! What a vehicle is, from logs of its flights: drag of UAV and load, thrust scale, noise of the
//! accelerometer in flight, length of the cable. And what the logs can't tell.

mod fit;
mod log;
mod swing;

pub use log::{LogError, Sample, read};

use serde::Serialize;
use std::fmt;

use controller::Vector3;

/// What is known beforehand: a scale and a clock say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// m_Q, kg.
    pub uav_mass: f64,
    /// m_L, kg. Thrust scale and mass are one at hover: weigh the load.
    pub payload_mass: f64,
    /// g, m/s².
    pub gravity: f64,
    /// Density of the air, kg/m³.
    pub density: f64,
    /// The accelerometer's reading is the mean over so many seconds.
    pub imu_period_s: f64,
}

/// One number found.
#[derive(Clone, Debug, Serialize)]
pub struct Found {
    /// The key of a scenario that takes it.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The number.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Why the logs don't tell it, where they don't.
    pub doubt: Option<&'static str>,
}

/// A number counts as told up to this deviation, of itself.
const TOLD: f64 = 0.25;

/// Calibrates from logs of one vehicle in one wind.
///
/// # Errors
/// [`LogError::Short`] if too little of the logs can be used.
pub fn calibrate(logs: &[Vec<Sample>], known: &Known) -> Result<Vec<Found>, LogError> {
    let blocks: Vec<fit::Block> = logs.iter().flat_map(|log| fit::blocks(log, known.gravity)).collect();
    let masses = [known.uav_mass, known.payload_mass];
    let fitted = fit::fit(&blocks, masses).ok_or(LogError::Short(blocks.len()))?;
    let (x, s) = (fitted.values, fitted.deviations);
    let per_area = 2.0 / known.density;
    let told = |value: f64, deviation: f64, doubt: &'static str| {
        (deviation.is_nan() || deviation > TOLD * value.abs()).then_some(doubt)
    };
    let mut all = vec![
        Found {
            key: "actuators.thrust_scale",
            unit: "",
            value: x[0],
            deviation: s[0],
            doubt: told(x[0], s[0], "the log has no thrust"),
        },
        Found {
            key: "estimator.uav_rotor_drag",
            unit: "N s/m",
            value: x[1],
            deviation: s[1],
            doubt: told(x[1], s[1], "not told apart from none: fly straight legs at two speeds or more"),
        },
        Found {
            key: "estimator.uav_drag_area",
            unit: "m²",
            value: x[2] * per_area,
            deviation: s[2] * per_area,
            doubt: told(x[2], s[2], "fly faster, in calm air, at two speeds or more"),
        },
        Found {
            key: "estimator.payload_drag_area",
            unit: "m²",
            value: x[3] * per_area,
            deviation: s[3] * per_area,
            doubt: told(x[3], s[3], "fly faster, in calm air, with the load seen"),
        },
    ];
    let noise = noise(logs, known);
    all.push(length(logs, known, &x, noise.value));
    all.push(noise);
    all.extend([("wind[0]", x[4], s[4], "m/s"), ("wind[1]", x[5], s[5], "m/s")].map(
        |(key, value, deviation, unit)| {
            let doubt = (deviation > 0.5).then_some("fly legs of different headings and speeds");
            Found { key, unit, value, deviation, doubt }
        },
    ));
    all.extend([("tilt[0]", x[6], s[6]), ("tilt[1]", x[7], s[7])].map(|(key, value, deviation)| {
        let doubt = (deviation > 0.03).then_some("turn the yaw: at one heading it is wind");
        Found { key, unit: "m/s²", value, deviation, doubt }
    }));
    Ok(all)
}

/// N_a by second differences across the thrust, which what a vehicle does in two samples hardly
/// touches, and by their median, which no manoeuvre moves.
fn noise(logs: &[Vec<Sample>], known: &Known) -> Found {
    let mut bends: Vec<f64> = logs
        .iter()
        .flat_map(|log| log.windows(3))
        .flat_map(|three| {
            let bend = three[2].specific_force - three[1].specific_force * 2.0 + three[0].specific_force;
            [bend.x.abs(), bend.y.abs()]
        })
        .collect();
    bends.sort_by(f64::total_cmp);
    let median = bends.get(bends.len() / 2).copied().unwrap_or(f64::NAN);
    // Three independent readings, 1 + 4 + 1; and half of a normal number's values lie within
    // 0.6745.
    let value = median / 0.674_49 / 6.0_f64.sqrt() * known.imu_period_s.sqrt();
    let count = bends.len().max(1) as f64;
    Found {
        key: "estimator.accelerometer_noise",
        unit: "m/s²/√Hz",
        value,
        // Of a median's from n values, which second differences correlate: some 2/√n.
        deviation: 2.0 * value / count.sqrt(),
        doubt: None,
    }
}

fn length(logs: &[Vec<Sample>], known: &Known, x: &[f64], noise: f64) -> Found {
    let wind = Vector3::new(x[4], x[5], 0.0);
    // Of the UAV, and of the load per its mass, which is taken to move along.
    let drag = |sample: &Sample| {
        let air = wind - sample.uav_velocity;
        let speed = air.dot(&air).sqrt();
        [air * (x[1] + x[2] * speed), air * (x[3] * speed / known.payload_mass)]
    };
    let mut weights = [0.0; 2];
    for [length, deviation] in logs.iter().filter_map(|log| swing::length(log, known.uav_mass, x[0], noise, &drag)) {
        let weight = 1.0 / (deviation * deviation).max(1e-12);
        weights = [weights[0] + weight * length, weights[1] + weight];
    }
    let [sum, weight] = weights;
    let (value, deviation) = (sum / weight, 1.0 / weight.sqrt());
    let is_told = deviation < 0.05 * value;
    Found {
        key: "vehicle.rod_length",
        unit: "m",
        value,
        deviation,
        doubt: (!is_told).then_some("too little swing: measure it"),
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, unit, value, deviation, doubt } = self;
        write!(f, "{key:<30} {value:>10.5} ± {deviation:<9.5} {unit}")?;
        doubt.map_or(Ok(()), |doubt| write!(f, "   not told by these logs: {doubt}"))
    }
}
