//! `route`: a mission of a ground station or a map as a route.

use autopilot::Settings;
use clap::Args;
use controller::{End, Vehicle, VehicleParams};
use hil_sim::describe::input::argument;
use hil_sim::describe::mission::{self, Defaults, Home, Local};
use hil_sim::describe::path::RouteSpec;
use hil_sim::describe::scenario::{Law, Scenario};
use hil_sim::report;
use hil_sim::study::check::{Limits, Report};
use rig::parameter;
use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use super::{Common, Ended};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim route mission.plan --out route.toml
  hil-sim route survey.kml --home 53.5270,-113.5290,668 --out route.toml --svg map.svg
  hil-sim route points.csv --corner 5 --speed 3 --out route.toml
  hil-sim route mission.waypoints --rust > route.rs    the table for firmware; --c for C

Read are QGroundControl's .plan, MAVLink's .waypoints, KML, GPX, GeoJSON, and CSV with a line of names: north, east, up or
down; x, y, z (down); lat, lon, alt (above the sea) or alt_rel (above home); each with a unit, as in up_ft, if it is not
metres or degrees. What the file leads along the waypoints is the payload. A .plan or .waypoints is read as the flight program
reads it when a ground station sends it, and refused as there. The file that is written is a scenario: run, check, and
campaign fly its [path]. Heights count from home; n1 and n2 are WGS 84's, about home, to rounding.";

/// What to read, and what to write.
#[derive(Args)]
pub struct RouteArguments {
    /// The mission.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The origin of N: latitude and longitude in degrees, height in m above the sea; in place of
    /// the file's own.
    #[arg(long, value_name = "LAT,LON,ALT", value_parser = mission::home, allow_hyphen_values = true)]
    home: Option<Home>,
    /// Height of the ground, m above the sea, for heights that the file counts from the terrain.
    #[arg(long, value_name = "METRES", value_parser = argument(-1e4..=1e4, "m"))]
    terrain: Option<f64>,
    /// Speed where the file says none, m/s: a vehicle's MIS_SPEED.
    #[arg(long, default_value_t = Defaults::default().speed, value_name = "M/S", value_parser = argument(0.05..=100.0, "m/s"))]
    speed: f64,
    /// How far from a waypoint its corner's blend begins where the file does not say, m: a
    /// vehicle's MIS_CORNER.
    #[arg(long, default_value_t = Defaults::default().corner_m, value_name = "METRES", value_parser = argument(0.02..=1000.0, "m"))]
    corner: f64,
    /// The last waypoint leads back to the first.
    #[arg(long)]
    closed: bool,
    /// Print the route's table as a Rust static of the controller's types.
    #[arg(long, conflicts_with = "c")]
    rust: bool,
    /// Print the route's waypoints for C's slung_route_build.
    #[arg(long)]
    c: bool,
    /// Draw a map of legs, blends, stops and fences.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// Part of the route's time, and s, that a flight of it is given beyond.
const LONGER: (f64, f64) = (1.05, 20.0);

/// Reads, writes and reports.
pub fn route(common: &Common, arguments: &RouteArguments) -> Ended {
    let RouteArguments { file, home, terrain, speed, corner, closed, rust, c, svg } = arguments;
    let name = file.display().to_string();
    let named = |error: &dyn std::fmt::Display| format!("{name}: {error}");
    let text = std::fs::read_to_string(file).map_err(|error| named(&error))?;
    for to in [&common.out, svg].into_iter().flatten() {
        report::try_file(to)?;
    }
    let mission = mission::read(&name, &text).map_err(|error| named(&error))?;
    let defaults = Defaults { speed: *speed, corner_m: *corner, is_closed: *closed };
    let local = mission.local(*home, *terrain, &defaults).map_err(|error| named(&error))?;
    let source = file.file_name().unwrap_or_default().to_string_lossy();

    // Written with the time that the route takes, which is known once it has been read.
    let (first, _) = checked(&mission::toml(&local, &source, 1.0)).map_err(|error| named(&error))?;
    let duration_s = duration_s(&local, first.lap_time);
    let written = mission::toml(&local, &source, duration_s);
    let (report, route) = checked(&written).map_err(|error| named(&error))?;
    if let Some(to) = &common.out {
        report::write_file(to, written.as_bytes())?;
    }
    if let Some(to) = svg {
        report::write_file(to, report::map(&format!("Route of {source}"), &local, &report.lap)?.as_bytes())?;
    }
    let mut out = io::stdout().lock();
    if *rust {
        write!(out, "{}", mission::rust(&route, &source))?;
    } else if *c {
        write!(out, "{}", mission::c(&route, &source))?;
    } else if common.out.is_none() {
        write!(out, "{written}")?;
    }
    if !common.quiet {
        // Out of the way of what is to be pasted.
        for note in &local.notes {
            eprintln!("{note}");
        }
        eprint!(
            "asked of the paper's vehicle, 2.5 kg with 0.5 kg on 2 m; a [vehicle] in the file is yours\n{report}"
        );
    }
    Ok(ExitCode::SUCCESS)
}

/// How long the flight of a mission may take whose route takes `once_s`: once of what has no end.
fn duration_s(local: &Local, once_s: f64) -> f64 {
    let rounds = match local.course.end {
        End::Again(times) if times < u32::MAX => f64::from(times) + 1.0,
        _ => 1.0,
    };
    let height = local.waypoints.last().map_or(0.0, |last| -last.point[2]).max(0.0);
    let settings = Settings::default();
    let descent = f64::from(settings.rig().get(parameter!("POL_DESCENT")));
    let landing_s = if local.course.lands { height / descent } else { 0.0 };
    (LONGER.0 * (rounds * once_s + landing_s) + LONGER.1).min(1e5)
}

/// The route of a scenario's text, and what it asks of the paper's vehicle.
fn checked(text: &str) -> Result<(Report, RouteSpec), Box<dyn Error>> {
    // Its lines are those of a file that is not written.
    let scenario = Scenario::parse("route.toml", text).map_err(|error| error.message)?;
    let Law::Follow { path, .. } = scenario.controller.law else { return Err("no path".into()) };
    let vehicle = Vehicle::new(VehicleParams::paper())?;
    let report = path.check(&vehicle, &Limits::of(&vehicle))?;
    let route = path.route().cloned().ok_or("no route")?;
    Ok((report, route))
}
