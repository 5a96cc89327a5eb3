//! The command line: one file a command.

mod eval;
mod fly;

use clap::{Parser, Subcommand};
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// What a command ends with: an exit status, or an error to be printed.
type Ended = Result<ExitCode, Box<dyn Error>>;

/// Flies a payload-following multirotor in simulation: the f32 controller in the loop with an f64 plant.
///
/// Without a command it does `figures`.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  hil-sim                            fly the paper's figures, report in out/
  hil-sim run my-flight.toml         fly a scenario of your own
  hil-sim eval < points.jsonl        evaluate the law, one JSON object a line

Each command has its own --help with examples."
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    common: Common,
}

/// Options of every command.
#[derive(clap::Args)]
struct Common {
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
    #[command(after_help = "Examples:
  hil-sim run my-flight.toml
  hil-sim run a.toml b.toml --out results
  hil-sim run fig3a fig3b            built-in scenarios by name")]
    Run {
        /// Scenario files, or names of built-in scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Fly every figure of the paper and compare with the reference numbers.
    #[command(after_help = "Examples:
  hil-sim figures                    report in out/
  hil-sim figures --quiet --out /tmp/figures")]
    Figures,
    /// Evaluate the law for JSON objects, one a line, on standard input.
    ///
    /// Writes one JSON object a line, in order. A bad line gives {"error": "..."} in its place and a non-zero exit status at
    /// the end. "arithmetic" is "f32" or "f64" (the controller) or "witness" (Lie derivatives in the paper's coordinates;
    /// adds "b" and "A"). The state is taken as it is, without prediction; "integral" and "k_integral" may be left out.
    #[command(after_help = eval::EXAMPLES)]
    Eval,
}

/// Does what the command line says.
pub fn run() -> Ended {
    let Cli { command, common } = Cli::parse();
    match command {
        Some(Command::Run { files }) => fly::fly(&common, fly::load(&files)?),
        Some(Command::Figures) | None => fly::fly(&common, fly::figures()?),
        Some(Command::Eval) => eval::evaluate_lines(),
    }
}
