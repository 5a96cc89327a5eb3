//! `fit`: a closed curve through waypoints.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::report;
use hil_sim::study::fit;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use super::{Common, Ended};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim fit waypoints.csv --out path.toml
  hil-sim fit waypoints.csv --out path.toml --tolerance 0.02
  hil-sim fit waypoints.csv --rust > path.rs    a constant for firmware

The CSV file has a line x,y,z a waypoint, in metres, z down, in the order flown; the loop closes by itself. A first line of
names may say otherwise: north, east, up, down, alt, each with a unit, as in up_ft. Lines that begin with # are passed over.";

/// What to fit.
#[derive(Args)]
pub struct FitArguments {
    /// CSV file of waypoints.
    #[arg(value_name = "WAYPOINTS")]
    file: PathBuf,
    /// Largest distance of a waypoint from the curve, m.
    #[arg(long, default_value_t = 0.05, value_name = "METRES", value_parser = argument(1e-6..=1e3, "m"))]
    tolerance: f64,
    /// Print the curve as a Rust constant of the controller's type.
    #[arg(long)]
    rust: bool,
}

/// Fits and reports.
pub fn fit(common: &Common, arguments: &FitArguments) -> Ended {
    let FitArguments { file, tolerance, rust } = arguments;
    let name = file.display().to_string();
    let text = std::fs::read_to_string(file).map_err(|error| format!("{name}: {error}"))?;
    if let Some(to) = &common.out {
        report::try_file(to)?;
    }
    let waypoints = fit::read(&name, &text)?;
    for doubt in waypoints.doubts() {
        eprintln!("hil-sim: {name}: warning: {doubt}");
    }
    let fitted = fit::fit(&waypoints.points, *tolerance).map_err(|error| format!("{name}: {error}"))?;
    let source = file.file_name().unwrap_or_default().to_string_lossy();
    if let Some(to) = &common.out {
        report::write_file(to, fit::toml(&fitted, &source).as_bytes())?;
    }
    let mut out = io::stdout().lock();
    if *rust {
        write!(out, "{}", fit::rust(&fitted, &source))?;
    }
    // The report keeps out of the way of what is to be pasted.
    match (common.quiet, *rust) {
        (true, _) => {}
        (false, true) => eprint!("columns              {}\n{fitted}", waypoints.columns),
        (false, false) => write!(out, "columns              {}\n{fitted}", waypoints.columns)?,
    }
    Ok(ExitCode::SUCCESS)
}
