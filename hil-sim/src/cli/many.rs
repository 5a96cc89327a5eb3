//! What the commands that fly many flights share: options, threads, progress, and an interrupt.

use clap::Args;
use hil_sim::describe::input::argument;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Where flights are drawn from, and who flies them.
#[derive(Args)]
pub struct Many {
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1, value_name = "S", value_parser = argument(0..=u64::MAX, ""))]
    pub seed: u64,
    /// Threads; all cores if left out.
    #[arg(long, value_name = "J", value_parser = argument(1..=4096_u16, ""))]
    jobs: Option<u16>,
}

impl Many {
    /// The threads.
    pub fn pool(&self) -> Result<ThreadPool, ThreadPoolBuildError> {
        ThreadPoolBuilder::new().num_threads(self.jobs.map_or(0, usize::from)).build()
    }
}

/// Set by Ctrl-C, from now on.
pub fn interrupt() -> Result<Arc<AtomicBool>, ctrlc::Error> {
    let stop = Arc::new(AtomicBool::new(false));
    let handler = Arc::clone(&stop);
    ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;
    Ok(stop)
}

/// The exit status after an interrupt, as shells have it.
pub fn interrupted() -> ExitCode {
    ExitCode::from(130)
}

/// The end of a command that reports all or nothing.
pub fn nothing_reported() -> ExitCode {
    eprintln!("hil-sim: interrupted: nothing is reported");
    interrupted()
}

/// A bar on standard error that counts milliseconds of flight.
pub fn progress_bar(quiet: bool, work_s: f64) -> ProgressBar {
    bar(quiet, (1e3 * work_s).round() as u64, "{wide_bar} {percent}% of the flights, {eta} left")
}

/// A bar on standard error, as `template` draws it; none where that is no terminal.
pub fn bar(quiet: bool, length: u64, template: &str) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Tells `bar` of seconds flown.
pub fn progress(bar: &ProgressBar) -> impl Fn(f64) + Sync + '_ {
    |flown_s| bar.inc((1e3 * flown_s).round() as u64)
}

/// Columns of the terminal on standard output; none where that is no terminal.
pub fn width() -> Option<usize> {
    console::Term::stdout().size_checked().map(|(_, columns)| columns.into())
}
