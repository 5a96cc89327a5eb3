//! `estimate`: the law on an estimate of its state.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::fly::flight::Control;
use hil_sim::study::estimate::{self, CASES};
use std::io::{self, Write};
use std::process::ExitCode;

use super::{Common, Ended, many, many::Many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim estimate                   16 flights of 60 s a case, estimate.json in out/
  hil-sim estimate --runs 4 --case rtk-calm --case rtk-gusts
  hil-sim estimate --runs 1000 --case rod-start-60 --seed 7 --jobs 2 --out results";

/// How much to fly.
#[derive(Args)]
pub struct EstimateArguments {
    /// Flights for each case.
    #[arg(long, default_value_t = 16, value_name = "N", value_parser = argument(1..=100_000_u32, ""))]
    runs: u32,
    #[command(flatten)]
    many: Many,
    /// Only this case; may be given several times.
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
}

/// Flies, prints the table, writes the file.
pub fn estimate(common: &Common, arguments: &EstimateArguments) -> Ended {
    let EstimateArguments { runs, many, cases } = arguments;
    if let Some(unknown) = cases.iter().find(|name| !CASES.iter().any(|case| case.name == **name)) {
        let known: Vec<&str> = CASES.iter().map(|case| case.name).collect();
        return Err(format!("--case {unknown}: no such case; there are {}", known.join(", ")).into());
    }
    let wanted = |name: &str| cases.is_empty() || cases.iter().any(|case| case == name);
    let runs = *runs as usize;
    let stop = many::interrupt()?;
    common.tried()?;
    let pool = many.pool()?;
    let bar = many::progress_bar(common.quiet, estimate::work_s(runs, &wanted));
    let flown = pool.install(|| {
        estimate::estimate(runs, many.seed, &wanted, Control { stop: &stop, progress: &many::progress(&bar) })
    })?;
    bar.finish_and_clear();
    let Some(table) = flown else {
        return Ok(many::nothing_reported());
    };
    let file = estimate::write(common.folder(), &table)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}\n", estimate::table(&table))?;
        writeln!(out, "Report: {}", file.display())?;
    }
    Ok(ExitCode::SUCCESS)
}
