//! `compare`: four laws against the world.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::fly::flight::Control;
use hil_sim::study::compare;
use std::io::{self, Write};
use std::process::ExitCode;

use super::{Common, Ended, many, many::Many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim compare                    200 flights a case and law, in out/
  hil-sim compare --runs 20 --seed 7 --jobs 2 --out results
  hil-sim compare --runs 100 --case gust-5 --case all";

/// How much to compare.
#[derive(Args)]
pub struct CompareArguments {
    /// Flights for each case and law.
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = argument(1..=100_000_u32, ""))]
    runs: u32,
    #[command(flatten)]
    many: Many,
    /// Bandwidth of the disturbance observers, rad/s.
    #[arg(long, default_value_t = compare::BANDWIDTH, value_name = "RAD_S", value_parser = argument(0.01..=100.0, "rad/s"))]
    bandwidth: f64,
    /// Only this case; may be given several times.
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
}

/// Flies, prints the table, writes the files.
pub fn compare(common: &Common, arguments: &CompareArguments) -> Ended {
    let CompareArguments { runs, many, bandwidth, cases } = arguments;
    let runs = *runs as usize;
    if let Some(unknown) = cases.iter().find(|name| !compare::CASES.iter().any(|case| case.name == **name)) {
        let known: Vec<&str> = compare::CASES.iter().map(|case| case.name).collect();
        return Err(format!("--case {unknown}: no such case; there are {}", known.join(", ")).into());
    }
    let wanted = |name: &str| cases.is_empty() || cases.iter().any(|case| case == name);
    let stop = many::interrupt()?;

    common.tried()?;
    let pool = many.pool()?;
    let bar = many::progress_bar(common.quiet, compare::work_s(runs, &wanted));
    let compared = pool.install(|| {
        compare::compare(
            runs,
            many.seed,
            *bandwidth,
            &wanted,
            Control { stop: &stop, progress: &many::progress(&bar) },
        )
    })?;
    bar.finish_and_clear();
    let Some(comparison) = compared else {
        return Ok(many::nothing_reported());
    };
    let page = compare::write(common.folder(), &comparison)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}\n", compare::table(&comparison))?;
        writeln!(out, "{}", compare::worse(&comparison))?;
        writeln!(out, "Report: {}", page.display())?;
    }
    Ok(ExitCode::SUCCESS)
}
