//! The program: flies scenarios with the controller in the loop, and evaluates the law for other programs.

use clap::{Parser, Subcommand};
use hil_sim::batch::{self, Outcome};
use hil_sim::reference::Reference;
use hil_sim::run::End;
use hil_sim::scenario::{self, Scenario};
use hil_sim::{eval, report};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Flies a payload-following multirotor in simulation: the f32 controller in the loop with an f64 plant.
///
/// Without a command it does `figures`.
#[derive(Parser)]
#[command(version, after_help = "Examples:\n  hil-sim                            fly the paper's figures, report in out/\n  \
    hil-sim run my-flight.toml         fly a scenario of your own\n  \
    hil-sim eval < points.jsonl        evaluate the law, one JSON object a line\n\n\
    Each command has its own --help with examples.")]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Print nothing but errors.
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Folder for reports; made if it is not there.
    #[arg(long, global = true, default_value = "out", value_name = "DIR")]
    out: PathBuf,
}

#[derive(Subcommand)]
enum Command {
    /// Fly scenario files and report on them.
    ///
    /// A FILE is a TOML file, or the name of a built-in scenario. Writes a CSV log of each flight, figures, report.html and
    /// summary.json.
    #[command(after_help = "Examples:\n  hil-sim run my-flight.toml\n  hil-sim run a.toml b.toml --out results\n  \
        hil-sim run fig3a fig3b            built-in scenarios by name")]
    Run {
        /// Scenario files, or names of built-in scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Fly every figure of the paper and compare with the reference numbers.
    #[command(after_help = "Examples:\n  hil-sim figures                    report in out/\n  \
        hil-sim figures --quiet --out /tmp/figures")]
    Figures,
    /// Evaluate the law for JSON objects, one a line, on standard input.
    ///
    /// Writes one JSON object a line, in order. A bad line gives {"error": "..."} in its place and a non-zero exit status at
    /// the end. "arithmetic" is "f32" or "f64" (the controller) or "witness" (Lie derivatives in the paper's coordinates;
    /// adds "b" and "A"). The state is taken as it is, without prediction; "integral" and "k_integral" may be left out.
    #[command(after_help = concat!("Examples:\n  hil-sim eval < points.jsonl > answers.jsonl\n\n  hil-sim eval <<'END'\n  ",
        r#"{"law":"follow","arithmetic":"f32","#, "\n   ",
        r#""vehicle":{"payload_mass":0.5,"uav_mass":2.5,"inertia":[0.03,0.03,0.05],"rod_length":2.0,"gravity":9.81},"#, "\n   ",
        r#""path":{"kind":"circle","radius":5.0,"p3":-10.0,"speed":1.0},"#, "\n   ",
        r#""x":[0,9,-10,0,0,0,0,0,0,0,0,0,0,0,0,0],"zeta":[0,0,0,0],"#, "\n   ",
        r#""gains":{"k":[[64,192,240,160,60,12],[64,192,240,160,60,12],[1,5,10,10,5],[1,2]]}}"#, "\n  END\n\n",
        "(each object on one line; shown on several here)\n\n",
        r#"For "law":"track": "time" and "reference":{"kind":"circle","radius":5.0,"p3":-10.0,"rate":1.0} in place of "#,
        r#""path", and "gains":{"k":[[6 numbers],[6],[6],[2]]}."#))]
    Eval,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match &cli.command {
        Some(Command::Eval) => evaluate_lines(),
        Some(Command::Run { files }) => load(files).and_then(|scenarios| fly(&cli, scenarios)),
        Some(Command::Figures) | None => figures().and_then(|scenarios| fly(&cli, scenarios)),
    };
    done.unwrap_or_else(|error| {
        eprintln!("hil-sim: {error}");
        ExitCode::FAILURE
    })
}

type Outcomes<T> = Result<T, Box<dyn Error>>;

fn figures() -> Outcomes<Vec<Scenario>> {
    let names = scenario::FIGURES.iter().map(|(name, _)| *name);
    Ok(names.filter_map(scenario::builtin).collect::<Result<_, _>>()?)
}

fn load(files: &[PathBuf]) -> Outcomes<Vec<Scenario>> {
    let mut scenarios: Vec<Scenario> = Vec::new();
    for file in files {
        let scenario = load_one(file)?;
        if scenarios.iter().any(|other| other.name == scenario.name) {
            return Err(format!("{}: a second scenario named {}", file.display(), scenario.name).into());
        }
        scenarios.push(scenario);
    }
    Ok(scenarios)
}

fn load_one(file: &Path) -> Outcomes<Scenario> {
    match std::fs::read_to_string(file) {
        Ok(text) => Ok(Scenario::parse(&file.to_string_lossy(), &text)?),
        Err(error) => match file.to_str().filter(|_| error.kind() == io::ErrorKind::NotFound).and_then(scenario::builtin) {
            Some(scenario) => Ok(scenario?),
            None => Err(format!("{}: {error}", file.display()).into()),
        },
    }
}

fn fly(cli: &Cli, scenarios: Vec<Scenario>) -> Outcomes<ExitCode> {
    let stop = Arc::new(AtomicBool::new(false));
    let handler = Arc::clone(&stop);
    ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed))?;

    let planned = scenarios.len();
    let bar = progress_bar(cli.quiet, batch::work_s(&scenarios));
    // The bar counts milliseconds of flight.
    let outcomes = batch::fly_all(scenarios, &stop, &|flown_s| bar.inc((1e3 * flown_s).round() as u64))?;
    bar.finish_and_clear();

    let reference = Reference::builtin();
    let page = report::write(&cli.out, &outcomes, &reference)?;
    if !cli.quiet {
        let slowest = outcomes.iter().map(|outcome| outcome.times_real_time).fold(f64::INFINITY, f64::min);
        let mut out = io::stdout().lock();
        writeln!(out, "{}", report::table(&outcomes, &reference))?;
        if slowest.is_finite() {
            writeln!(out, "One core flies the f32 law at {slowest:.0} times real time or more.")?;
        }
        writeln!(out, "Report: {}", page.display())?;
    }
    Ok(verdict(&outcomes, planned))
}

/// Complete or not, on standard error and as exit status; 130 after an interrupt, as shells have it.
fn verdict(outcomes: &[Outcome], planned: usize) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for outcome in outcomes {
        if let End::NotFinite(at_s) = outcome.flight.end {
            eprintln!("hil-sim: {}: the flight was lost at {at_s} s", outcome.scenario.name);
            code = ExitCode::FAILURE;
        }
    }
    if outcomes.len() < planned {
        eprintln!("hil-sim: interrupted: {} of {planned} flights are complete and reported", outcomes.len());
        code = ExitCode::from(130);
    }
    code
}

/// A bar on standard error; none where that is no terminal.
fn progress_bar(quiet: bool, work_s: f64) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new((1e3 * work_s).round() as u64);
    let style = ProgressStyle::with_template("{wide_bar} {percent}% of the flights, {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn evaluate_lines() -> Outcomes<ExitCode> {
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let mut code = ExitCode::SUCCESS;
    let mut line = Vec::new();
    while input.read_until(b'\n', &mut line)? > 0 {
        if !line.trim_ascii().is_empty() {
            match eval::evaluate(&line) {
                Ok(answer) => serde_json::to_writer(&mut output, &answer)?,
                Err(invalid) => {
                    code = ExitCode::FAILURE;
                    serde_json::to_writer(&mut output, &serde_json::json!({ "error": invalid.to_string() }))?;
                }
            }
            output.write_all(b"\n")?;
            // Someone may be waiting for the answer before asking on.
            if input.buffer().is_empty() {
                output.flush()?;
            }
        }
        line.clear();
    }
    output.flush()?;
    Ok(code)
}
