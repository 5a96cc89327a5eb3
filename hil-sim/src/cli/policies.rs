//! `policies`: path following against trajectory tracking.

use clap::Args;
use hil_sim::describe::input::argument;
use hil_sim::fly::flight::Control;
use hil_sim::study::compare;
use std::io::{self, Write};
use std::process::ExitCode;

use super::{Common, Ended, many, many::Many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim policies                   200 starts a trial, in out/
  hil-sim policies --runs 50 --seed 7 --out results";

/// How much to compare.
#[derive(Args)]
pub struct PolicyArguments {
    /// Starts for each trial.
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = argument(1..=100_000_u32, ""))]
    runs: u32,
    #[command(flatten)]
    many: Many,
}

/// Flies, prints, writes policies.json.
pub fn policies(common: &Common, arguments: &PolicyArguments) -> Ended {
    let PolicyArguments { runs, many } = arguments;
    let runs = *runs as usize;
    let stop = many::interrupt()?;
    common.tried()?;
    let pool = many.pool()?;
    let bar = many::progress_bar(common.quiet, compare::policies_work_s(runs));
    let compared = pool
        .install(|| compare::policies(runs, many.seed, Control { stop: &stop, progress: &many::progress(&bar) }))?;
    bar.finish_and_clear();
    let Some(policies) = compared else {
        return Ok(many::nothing_reported());
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
