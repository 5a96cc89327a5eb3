//! `tune`: poles and observer bandwidths for a scenario.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::describe::scenario::{self, Scenario};
use hil_sim::fly::flight::Control;
use hil_sim::report;
use hil_sim::study::tune;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use super::{Common, Ended, many, many::Many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim tune                       for the paper's vehicle with slow rotors and noisy sensors in gusts
  hil-sim tune my-flight.toml --runs 50 --seed 7 --jobs 2 --out results
  hil-sim tune my-flight.toml --scales 0.8,1,1.2,1.4,1.6 --bandwidths 4,8,16";

/// What to tune for.
#[derive(Args)]
pub struct TuneArguments {
    /// Scenario file, or name of a built-in scenario, that follows a path; left out: one made for
    /// this.
    #[arg(value_name = "SCENARIO")]
    file: Option<PathBuf>,
    /// Flights for each setting.
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = argument(1..=100_000_u32, ""))]
    runs: u32,
    #[command(flatten)]
    many: Many,
    /// s of the poles s·{-1, ..., -6} to try.
    #[arg(long, value_name = "S,S,...", value_delimiter = ',', default_values_t = tune::SCALES, allow_hyphen_values = true, value_parser = argument(0.01..=100.0, ""))]
    scales: Vec<f64>,
    /// Bandwidths of the observers to try, rad/s; 0 is off.
    #[arg(long, value_name = "RAD_S,...", value_delimiter = ',', default_values_t = tune::BANDWIDTHS, allow_hyphen_values = true, value_parser = argument(0.0..=100.0, "rad/s"))]
    bandwidths: Vec<f64>,
}

/// Flies, prints the table and the trade, writes the files.
pub fn tune(common: &Common, arguments: &TuneArguments) -> Ended {
    let TuneArguments { file, runs, many, scales, bandwidths } = arguments;
    let (name, text) = match file {
        Some(file) => {
            let name = file.display().to_string();
            let built_in = scenario::FIGURES.iter().chain(scenario::CURVES).find(|(known, _)| *known == name);
            let text = match (fs::read_to_string(file), built_in) {
                (Ok(text), _) => text,
                (Err(error), Some((_, text))) if error.kind() == io::ErrorKind::NotFound => (*text).to_owned(),
                (Err(error), None) if error.kind() == io::ErrorKind::NotFound => {
                    return Err(super::load::absent(file, "scenario", scenario::builtin_names()));
                }
                (Err(error), _) => return Err(format!("{name}: {error}").into()),
            };
            (name, text)
        }
        None => ("hil-sim/scenarios/tune.toml".to_owned(), tune::SCENARIO.to_owned()),
    };
    // Refuses with the line what is wrong before anything is put in its place.
    let duration_s = Scenario::parse(&name, &text)?.duration_s;
    let table: toml::Table = toml::from_str(&text)?;
    let stop = many::interrupt()?;

    let runs = *runs as usize;
    common.tried()?;
    let pool = many.pool()?;
    let bar = many::progress_bar(common.quiet, (scales.len() * bandwidths.len() * runs) as f64 * duration_s);
    let tuned = pool.install(|| {
        tune::tune(
            &table,
            (scales, bandwidths),
            (runs, many.seed),
            Control { stop: &stop, progress: &many::progress(&bar) },
        )
    });
    bar.finish_and_clear();
    let Some(tuning) = tuned.map_err(|error| format!("{name}: {error}"))? else {
        return Ok(many::nothing_reported());
    };
    let folder = common.folder();
    let snippet = folder.join("tune.toml");
    let trade = tune::trade(&tuning);
    let comment: String = trade.lines().map(|line| format!("# {line}\n")).collect();
    report::write_file(&snippet, format!("{comment}{}", tuning.snippet).as_bytes())?;
    report::write_file(&folder.join("tune.json"), serde_json::to_string_pretty(&tuning)?.as_bytes())?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}\n\n{trade}", tune::table(&tuning))?;
        writeln!(out, "Put {} in place of the scenario's [controller].", snippet.display())?;
    }
    Ok(ExitCode::SUCCESS)
}
