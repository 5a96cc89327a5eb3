//! `policies`: path following against trajectory tracking.

use clap::Args;
use hil_sim::compare;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{Common, Ended, fly};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim policies                   200 starts a trial, in out/
  hil-sim policies --runs 50 --seed 7 --out /tmp/policies";

/// How much to compare.
#[derive(Args)]
pub struct PolicyArguments {
    /// Starts for each trial.
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    runs: u32,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1, value_name = "S")]
    seed: u64,
    /// Threads; all cores if left out.
    #[arg(long, value_name = "J", value_parser = clap::value_parser!(u16).range(1..=4096))]
    jobs: Option<u16>,
}

/// Flies, prints, writes policies.json.
pub fn policies(common: &Common, arguments: &PolicyArguments) -> Ended {
    let PolicyArguments { runs, seed, jobs } = arguments;
    let runs = *runs as usize;
    let stop = Arc::new(AtomicBool::new(false));
    let handler = Arc::clone(&stop);
    ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.map_or(0, usize::from)).build()?;
    let bar = fly::progress_bar(common.quiet, compare::policies_work_s(runs));
    // The bar counts milliseconds of flight.
    let progress = |flown_s: f64| bar.inc((1e3 * flown_s).round() as u64);
    let compared = pool.install(|| compare::policies(runs, *seed, &stop, &progress))?;
    bar.finish_and_clear();
    let Some(policies) = compared else {
        eprintln!("hil-sim: interrupted: nothing is reported");
        return Ok(ExitCode::from(130));
    };
    let folder = common.folder();
    let path = folder.join("policies.json");
    let text = serde_json::to_string_pretty(&policies)?;
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text + "\n"))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}\nNumbers: {}", policies.text(), path.display())?;
    }
    Ok(ExitCode::SUCCESS)
}
