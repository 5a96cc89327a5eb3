//! `check`: can a path be flown?

use controller::{Vehicle, VehicleParams};
use hil_sim::describe::scenario::{Law, Scenario};
use hil_sim::study::check::{Reason, Report, way_breaches};
use std::error::Error;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use witness::plant::VehicleParameters;

use super::{Common, Ended, load};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim check fig3a                a built-in scenario
  hil-sim check my-flight.toml       the path of a scenario
  hil-sim check path.toml            a [path] alone, as `hil-sim fit` writes it, for the paper's vehicle

A [limits] table states what the vehicle may be asked for: min_thrust, max_thrust (N), rod_angle_deg, tilt_deg,
body_rate (rad/s), torque (N m, per axis), tension (part of the payload's weight).";

/// Prints what each path asks of its vehicle. Fails if one can't be flown or exceeds a limit.
pub fn check(common: &Common, files: &[PathBuf]) -> Ended {
    let mut code = ExitCode::SUCCESS;
    for file in files {
        let scenario = load::one(file)?;
        let name = file.display();
        let Law::Follow { path, .. } = &scenario.controller.law else {
            return Err(format!("{name}: the law \"track\" has no path to check").into());
        };
        match path.check(&vehicle(&scenario.vehicle)?, &scenario.limits) {
            Ok(report) => {
                if !common.quiet {
                    writeln!(io::stdout().lock(), "{name}\n{report}")?;
                }
                let refused = faults(&report, &scenario)?;
                for fault in refused.iter().take(SHOWN) {
                    eprintln!("hil-sim: {name}: {fault}");
                }
                if refused.len() > SHOWN {
                    eprintln!("hil-sim: {name}: and {} more", refused.len() - SHOWN);
                }
                if !refused.is_empty() {
                    code = ExitCode::FAILURE;
                }
            }
            Err(refusal) => {
                eprintln!("hil-sim: {name}: refused: {refusal}");
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// Refuses scenarios whose vehicle can't give what their path asks for, as [`check`] does; with
/// `unchecked`, warns of it. Of a curve that is not closed, smooth and regular it warns.
pub fn refuse(scenarios: &[Scenario], unchecked: bool) -> Result<(), Box<dyn Error>> {
    let mut refused = Vec::new();
    for scenario in scenarios {
        let Law::Follow { path, .. } = &scenario.controller.law else { continue };
        // The scenario's vehicle has been validated.
        let Ok(vehicle) = vehicle(&scenario.vehicle) else { continue };
        match path.check(&vehicle, &scenario.limits) {
            Ok(report) => {
                let faults = faults(&report, scenario)?;
                refused.extend(faults.iter().take(SHOWN).map(|fault| format!("{}: {fault}", scenario.name)));
            }
            Err(refusal) if refusal.reason == Reason::FreeFall => {
                refused.push(format!("{}: {refusal}", scenario.name));
            }
            Err(refusal) => eprintln!("hil-sim: {}: warning: this path cannot be flown: {refusal}", scenario.name),
        }
    }
    match (refused.is_empty(), unchecked) {
        (true, _) => Ok(()),
        (false, true) => {
            refused.iter().for_each(|line| eprintln!("hil-sim: {line}: warning: flown all the same"));
            Ok(())
        }
        (false, false) => Err(format!(
            "{}\nNothing is flown. [limits] may allow more; --unchecked flies it all the same.",
            refused.join("\n")
        )
        .into()),
    }
}

/// Faults that are printed of a path, at most: a long route can have two a leg.
const SHOWN: usize = 20;

/// What is wrong with a path that can be walked, and with the way to it.
fn faults(report: &Report, scenario: &Scenario) -> Result<Vec<String>, Box<dyn Error>> {
    let mut faults: Vec<String> = report.excesses.iter().map(ToString::to_string).collect();
    if let Some(fence) = &scenario.fence {
        let breaches = way_breaches(scenario, fence, report)?.into_iter().chain(fence.breaches(report));
        faults.extend(breaches.map(|breach| breach.to_string()));
    }
    Ok(faults)
}

fn vehicle(params: &VehicleParameters) -> Result<Vehicle<f64>, Box<dyn Error>> {
    let VehicleParameters { payload_mass, uav_mass, rod_length, inertia, gravity } = *params;
    Ok(Vehicle::new(VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity })?)
}
