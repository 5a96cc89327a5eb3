//! `compare`: four laws against the world.

use clap::Args;
use hil_sim::compare;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Common, Ended, fly};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim compare                    200 flights a case and law, in out/
  hil-sim compare --runs 20 --seed 7 --jobs 2 --out /tmp/compare
  hil-sim compare --runs 100 --case gust-5 --case all";

/// How much to compare.
#[derive(Args)]
pub struct CompareArguments {
    /// Flights for each case and law.
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    runs: u32,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1, value_name = "S")]
    seed: u64,
    /// Threads; all cores if left out.
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=4096))]
    jobs: Option<u16>,
    /// Bandwidth of the disturbance observers, rad/s.
    #[arg(long, default_value_t = compare::BANDWIDTH, value_name = "RAD_S")]
    bandwidth: f64,
    /// Only this case; may be given several times.
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
}

/// Flies, prints the table, writes the files.
pub fn compare(common: &Common, arguments: &CompareArguments) -> Ended {
    let CompareArguments { runs, seed, jobs, bandwidth, cases } = arguments;
    if !(0.01..=100.0).contains(bandwidth) {
        return Err(format!("--bandwidth {bandwidth}: outside 0.01 to 100").into());
    }
    let runs = *runs as usize;
    if let Some(unknown) = cases.iter().find(|name| !compare::CASES.iter().any(|case| case.name == **name)) {
        let known: Vec<&str> = compare::CASES.iter().map(|case| case.name).collect();
        return Err(format!("--case {unknown}: no such case; there are {}", known.join(", ")).into());
    }
    let wanted = |name: &str| cases.is_empty() || cases.iter().any(|case| case == name);
    let stop = Arc::new(AtomicBool::new(false));
    let handler = Arc::clone(&stop);
    ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;

    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.map_or(0, usize::from)).build()?;
    let bar = fly::progress_bar(common.quiet, compare::work_s(runs, &wanted));
    // The bar counts milliseconds of flight.
    let progress = |flown_s: f64| bar.inc((1e3 * flown_s).round() as u64);
    let compared = pool.install(|| compare::compare(runs, *seed, *bandwidth, &wanted, &stop, &progress))?;
    bar.finish_and_clear();
    let Some(comparison) = compared else {
        eprintln!("hil-sim: interrupted: nothing is reported");
        return Ok(ExitCode::from(130));
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
