//! `run` and `figures`: fly, print, report.

use hil_sim::describe::reference::Reference;
use hil_sim::describe::scenario::Scenario;
use hil_sim::fly::batch::{self, Outcome};
use hil_sim::fly::flight::Control;
use hil_sim::fly::run::Arithmetic;
use hil_sim::report;
use std::io::{self, Write};
use std::process::ExitCode;

use super::{Common, Ended, Logs, many};

/// Flies, prints the table, and writes the report; on an interrupt, of the flights that are done.
pub fn fly(common: &Common, scenarios: Vec<Scenario>, arithmetic: Arithmetic, unchecked: bool, logs: &Logs) -> Ended {
    let stop = many::interrupt()?;

    super::check::refuse(&scenarios, unchecked)?;
    common.tried()?;
    let planned = scenarios.len();
    let bar = many::progress_bar(common.quiet, scenarios.iter().map(|scenario| scenario.duration_s).sum());
    let control = Control { stop: &stop, progress: &many::progress(&bar) };
    let outcomes = batch::fly_all(scenarios, arithmetic, control)?;
    bar.finish_and_clear();

    let reference = Reference::builtin();
    let page = report::write(common.folder(), &outcomes, &reference, &logs.log)?;
    if !common.quiet {
        let slowest = outcomes.iter().map(|outcome| outcome.flight.times_real_time).fold(f64::INFINITY, f64::min);
        let mut out = io::stdout().lock();
        writeln!(out, "{}", report::table(&outcomes, &reference, many::width()))?;
        if slowest.is_finite() {
            writeln!(out, "One core flies the f32 law at {slowest:.0} times real time or more.")?;
        }
        writeln!(out, "Report: {}", page.display())?;
    }
    Ok(verdict(&outcomes, planned))
}

/// Complete or not, on standard error and as exit status; 130 after an interrupt, as shells have
/// it.
pub fn verdict(outcomes: &[Outcome], planned: usize) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for outcome in outcomes {
        if let Some(failure) = outcome.flight.end.failure() {
            eprintln!("hil-sim: {}: {failure}", outcome.scenario.name);
            code = ExitCode::FAILURE;
        }
    }
    if outcomes.len() < planned {
        eprintln!("hil-sim: interrupted: {} of {planned} flights are complete and reported", outcomes.len());
        code = many::interrupted();
    }
    code
}
