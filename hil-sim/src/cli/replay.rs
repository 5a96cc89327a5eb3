//! `replay`: a flown log through estimator and law.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::describe::reference::Reference;
use hil_sim::report;
use hil_sim::study::replay::{self, Part};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{Common, Ended, Logs, fly, load, many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim run fig3a --log ulog && hil-sim replay out/fig3a.ulg --out again
  hil-sim replay flight.ulg --with my-flight.toml --full-thrust 48 --from 30 --to 90

CSV by the columns' names, or ULog, SI units, n3 down, the path in the log's own frame. Of the UAV it takes uav_p1 … uav_p3, uav_v1 … uav_v3, att_w … att_z and
omega1 … omega3; for the estimator f1 … f3 and thrust; of the load, where it was measured, p1 … p3 and v1 … v3. Of PX4 these are
vehicle_local_position, vehicle_attitude, vehicle_angular_velocity, vehicle_acceleration or sensor_combined, and
vehicle_thrust_setpoint, actuator_motors or actuator_outputs, whose shares are taken for linear in thrust.";

/// The log, and what it is replayed with.
#[derive(Args)]
pub struct ReplayArguments {
    /// The flight's log, CSV or ULog.
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// Scenario file, or name of a built-in scenario: vehicle, estimator, controller, path and
    /// requests. The built-in one of the log's name if left out.
    #[arg(long, value_name = "FILE")]
    with: Option<PathBuf>,
    /// What all rotors give together at most, N, for logs that have thrust as a share; four times
    /// that of [actuators] rotors if left out.
    #[arg(long, value_name = "N", value_parser = argument(1e-3..=1e6, "N"))]
    full_thrust: Option<f64>,
    /// Begin at so many seconds of the log.
    #[arg(long, value_name = "S", value_parser = argument(-1e10..=1e10, "s"))]
    from: Option<f64>,
    /// End at so many.
    #[arg(long, value_name = "S", value_parser = argument(-1e10..=1e10, "s"))]
    to: Option<f64>,
}

/// Replays, prints, and writes the report.
pub fn replay(common: &Common, arguments: &ReplayArguments, logs: &Logs) -> Ended {
    let ReplayArguments { file, with, full_thrust, from, to } = arguments;
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let named = file.file_stem().map(Path::new).unwrap_or(Path::new(""));
    let mut scenario = load::one(with.as_deref().unwrap_or(named)).map_err(|error| match with {
        Some(_) => error,
        None => format!(
            "{}: no built-in scenario is called {}: give the one that was flown by --with FILE",
            file.display(),
            named.display()
        )
        .into(),
    })?;
    // Beside the log that it is of, not in its place.
    scenario.name = format!("{}-replay", named.display());
    common.tried()?;
    let part = Part { from_s: *from, to_s: *to, full_thrust: *full_thrust };
    let outcome = replay::replay(scenario, &bytes, &part).map_err(|error| format!("{}: {error}", file.display()))?;
    let sentences = outcome.flight.replayed.as_ref().map(replay::Replayed::sentences).unwrap_or_default();

    let (outcomes, reference) = ([outcome], Reference::builtin());
    let page = report::write(common.folder(), &outcomes, &reference, &logs.log)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}", report::table(&outcomes, &reference, many::width()))?;
        for sentence in sentences {
            writeln!(out, "{sentence}")?;
        }
        writeln!(out, "Report: {}", page.display())?;
    }
    Ok(fly::verdict(&outcomes, 1))
}
