//! `calibrate`: what a vehicle is, from logs of its flights.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::study::calibrate::{self, Known};
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use super::{Common, Ended};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim run slow.toml fast.toml                     logs in out/, with f1 f2 f3 where [estimator] flies
  hil-sim calibrate out/slow.csv out/fast.csv --uav-mass 2.5 --payload-mass 0.5

Columns of CSV, or fields of ULog (PX4's for the UAV), in SI units, n3 down: t_s, att_w … att_z, f1 … f3 (accelerometer, body axes), thrust (commanded), uav_p1 … uav_p3,
uav_v1 … uav_v3, and of the load p1 … p3, v1 … v3, as motion capture or an estimator has them. Fly in calm air, at two
speeds or more, with turns of the yaw.";

/// What is known, and the logs.
#[derive(Args)]
pub struct CalibrateArguments {
    /// CSV or ULog logs of one vehicle in one wind.
    #[arg(required = true, value_name = "LOG")]
    files: Vec<PathBuf>,
    /// Mass of the UAV, kg, 0.01 to 1000.
    #[arg(long, value_name = "KG", value_parser = argument(0.01..=1000.0, "kg"))]
    uav_mass: f64,
    /// Mass of the load, kg, 0.01 to 1000: weighed, since at hover it is one with the thrust scale.
    #[arg(long, value_name = "KG", value_parser = argument(0.01..=1000.0, "kg"))]
    payload_mass: f64,
    /// Time over which a reading of the accelerometer is the mean, s, 0.0001 to 0.1.
    #[arg(long, default_value_t = 0.002, value_name = "S", value_parser = argument(1e-4..=0.1, "s"))]
    imu_period: f64,
    /// Density of the air, kg/m³.
    #[arg(long, default_value_t = 1.225, value_name = "KG/M3", value_parser = argument(0.1..=10.0, "kg/m³"))]
    density: f64,
}

/// Reads, fits, prints.
pub fn calibrate(common: &Common, arguments: &CalibrateArguments) -> Ended {
    let CalibrateArguments { files, uav_mass, payload_mass, imu_period, density } = arguments;
    let mut logs = Vec::new();
    for file in files {
        let name = file.display();
        let bytes = std::fs::read(file).map_err(|error| format!("{name}: {error}"))?;
        logs.push(calibrate::read(&bytes).map_err(|error| format!("{name}: {error}"))?);
    }
    let known = Known {
        uav_mass: *uav_mass,
        payload_mass: *payload_mass,
        gravity: 9.81,
        density: *density,
        imu_period_s: *imu_period,
    };
    let found = calibrate::calibrate(&logs, &known)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        for number in &found {
            writeln!(out, "{number}")?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
