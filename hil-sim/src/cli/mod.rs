//! The command line: one file a command.

mod calibrate;
mod campaign;
mod check;
mod compare;
mod estimate;
mod eval;
mod fit;
mod fly;
mod hil;
mod load;
mod many;
mod plant;
mod policies;
mod replay;
mod route;
mod tune;
mod view;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use hil_sim::describe::scenario::{CURVES, FIGURES};
use hil_sim::fly::run::Arithmetic;
use hil_sim::report::log::Format;
use std::error::Error;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What a command ends with: an exit status, or an error to be printed.
type Ended = Result<ExitCode, Box<dyn Error>>;

/// Flies a payload-following multirotor in simulation: the f32 controller in the loop with an f64
/// plant.
///
/// Without a command it does `figures`.
#[derive(Parser)]
#[command(
    version,
    after_help = "Examples:
  hil-sim                            fly the paper's figures, report in out/
  hil-sim run my-flight.toml         fly a scenario of your own
  hil-sim fit waypoints.csv --out path.toml    a closed curve through waypoints
  hil-sim route mission.plan --out route.toml  a route from a ground station
  hil-sim check my-flight.toml       can its path be flown, and how fast?
  hil-sim eval < points.jsonl        evaluate the law, one JSON object a line
  hil-sim hil --port /dev/ttyUSB0    fly with the controller on a board

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
    /// Folder for reports, made if it is not there (out if not given); for `fit` and `route`,
    /// the file of the path.
    #[arg(long, global = true, value_name = "PATH")]
    out: Option<PathBuf>,
}

impl Common {
    /// The folder for reports, once it is known that it can be written to.
    fn tried(&self) -> Result<&Path, hil_sim::report::ReportError> {
        hil_sim::report::try_folder(self.folder()).map(|()| self.folder())
    }

    /// The folder for reports.
    fn folder(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("out"))
    }
}

/// The formats of flights' logs.
#[derive(clap::Args)]
struct Logs {
    /// Formats of the flights' logs.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "csv", value_name = "FORMAT,…")]
    log: Vec<Format>,
}

#[derive(Subcommand)]
enum Command {
    /// Fly scenario files and report on them.
    ///
    /// A FILE is a TOML file, or the name of a built-in scenario. Writes a CSV log of each flight,
    /// figures, report.html and summary.json.
    #[command(after_help = "Examples:
  hil-sim run my-flight.toml
  hil-sim run a.toml b.toml --out results
  hil-sim run fig3a fig3b            built-in scenarios by name
  hil-sim run fig3a --log csv,ulog,mcap    logs for Flight Review, PlotJuggler, Foxglove
  hil-sim run my-flight.toml --trap  stop at the first invalid operation")]
    Run {
        /// Scenario files, or names of built-in scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Stop at the first invalid floating-point operation inside the law (0/0, the root of a
        /// negative number, …), and say which and where; RUST_BACKTRACE=1 says how it came to it.
        #[arg(long)]
        trap: bool,
        /// Fly even what asks more of the vehicle than its limits or its actuators allow.
        #[arg(long)]
        unchecked: bool,
        #[command(flatten)]
        logs: Logs,
    },
    /// Fly every figure of the paper and compare with the reference numbers.
    #[command(after_help = "Examples:
  hil-sim figures                    report in out/
  hil-sim figures --quiet --out results")]
    Figures(Logs),
    /// Evaluate the law for JSON objects, one a line, on standard input.
    ///
    /// Writes one JSON object a line, in order. A bad line gives {"error": "..."} in its place and
    /// a non-zero exit status at the end. "arithmetic" is "f32" or "f64" (the controller) or
    /// "witness" (Lie derivatives in the paper's coordinates; adds "b" and "A"). The state is taken
    /// as it is, without prediction; "integral" and "k_integral" may be left out.
    #[command(after_help = eval::EXAMPLES)]
    Eval,
    /// Print every key of a scenario file, with unit, range, default and meaning.
    #[command(after_help = "Examples:\n  hil-sim keys | less")]
    Keys,
    /// Say whether paths can be flown, before anyone takes off.
    ///
    /// Walks each curve once round: is it closed, smooth, regular, free of self-crossings? Then
    /// what it asks of the vehicle at its speed, and the highest constant speed within the limits.
    /// Refuses with the place. The exit status is 0 if all can be flown within their limits.
    #[command(after_help = check::EXAMPLES)]
    Check {
        /// Scenario files, files with a [path], or names of built-in scenarios.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Fly thousands of flights, each drawn from distributions, and say how often the law does what
    /// it should.
    ///
    /// Same seed, same table, whatever the number of threads. Interrupted, the same command goes
    /// on. Writes runs.csv (a row a flight), summary.json and campaign.html.
    #[command(after_help = campaign::EXAMPLES)]
    Campaign(campaign::CampaignArguments),
    /// Put the shards of a campaign together: their tables become the whole campaign's.
    #[command(after_help = campaign::MERGE_EXAMPLES)]
    Merge {
        /// Folders of all shards.
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        #[command(flatten)]
        tables: campaign::Tables,
    },
    /// Compare the law as published, with integral action, with disturbance observers, and
    /// trajectory tracking with them.
    ///
    /// Each flies the same random starts in each case: forces, wind, gusts, wrong masses, lengths,
    /// thrust and inertia, lag, latency, noise, each alone and all together. Writes compare.json
    /// and compare.html.
    #[command(after_help = compare::EXAMPLES)]
    Compare(compare::CompareArguments),
    /// Fly the law on an estimate of its state: from RTK, motion capture or a plain receiver, in
    /// calm and gusts, told right and wrong.
    ///
    /// Each case from random starts for 60 s; the full state stands beside. Writes estimate.json.
    #[command(after_help = estimate::EXAMPLES)]
    Estimate(estimate::EstimateArguments),
    /// Find drag, thrust scale, accelerometer noise and cable length from logs of flights, and say
    /// what the logs can't tell.
    #[command(after_help = calibrate::EXAMPLES)]
    Calibrate(calibrate::CalibrateArguments),
    /// Path following against trajectory tracking, start by start: where the paper's claims hold,
    /// and where they do not.
    #[command(after_help = policies::EXAMPLES)]
    Policies(policies::PolicyArguments),
    /// Propose poles and observer bandwidths for a scenario's vehicle, rate, latency, rotor lag and
    /// noise.
    ///
    /// Flies a small campaign over a grid of both from random starts beside the path, prints what
    /// each does, and says what the proposal trades. Writes tune.toml (a [controller] to put in
    /// place of the scenario's own) and tune.json.
    #[command(after_help = tune::EXAMPLES)]
    Tune(tune::TuneArguments),
    /// Fit a closed smooth curve to waypoints.
    ///
    /// A Fourier series with as few harmonics as keep every waypoint within the tolerance, and its
    /// properties.
    #[command(after_help = fit::EXAMPLES)]
    Fit(fit::FitArguments),
    /// Make a route of a mission of a ground station or a map.
    ///
    /// Writes a scenario with the route as its [path], in metres about a home, and says what it
    /// asks of the vehicle.
    #[command(after_help = route::EXAMPLES)]
    Route(route::RouteArguments),
    /// Fly with the controller at the other end of a serial line, a socket, or in an emulator.
    ///
    /// In lockstep, each state is one control step of the target, and the flight is the same, bit
    /// by bit, as in this program. Same tables and report as `run`, and the link's and the target's
    /// numbers beside them (hil.json).
    #[command(after_help = hil::EXAMPLES)]
    Hil {
        #[command(flatten)]
        arguments: hil_sim::hil::Arguments,
        #[command(flatten)]
        logs: Logs,
    },
    /// Put a flown log through estimator and law: what would they have said?
    ///
    /// The UAV moves as the log has it, whatever the law says. Same table, report and logs as
    /// `run`, with the logged thrust, torque and load beside those replayed, and a sentence for
    /// whatever the log lacks.
    #[command(after_help = replay::EXAMPLES)]
    Replay {
        #[command(flatten)]
        arguments: replay::ReplayArguments,
        #[command(flatten)]
        logs: Logs,
    },
    /// Open a report in the browser.
    #[command(after_help = view::EXAMPLES)]
    View {
        /// A report's page, or its folder.
        #[arg(value_name = "FILE", default_value = "out")]
        file: PathBuf,
    },
    /// Be the world of a scenario for a controller of your own: one JSON command a line in, one
    /// JSON state a line out.
    ///
    /// The state at the start comes first. A line {"thrust": T, "torque": [..]} (N, N·m in body
    /// axes) passes one control period, or "periods" of them, and is answered with the state then.
    /// A bad line gives {"error": "..."}, passes nothing, and makes the exit status at the end
    /// non-zero.
    #[command(after_help = plant::EXAMPLES)]
    Plant {
        /// A scenario file, or the name of a built-in scenario.
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Step a scenario's controller from another program's plant: JSON lines.
    ///
    /// Each line of standard input is a state as `plant` answers it: "position", "velocity",
    /// "uav_position", "uav_velocity", "attitude" and "body_rate", and where it is measured
    /// "specific_force" in body axes; what else stands there is not looked at. What is not measured
    /// is null or NaN, a vector or a number of it; the rod is the line from UAV to load. The answer
    /// has "thrust", "torque", "mode" and "fault". A control period passes with every line, and the
    /// scenario's requests hold from their times on.
    #[command(after_help = plant::PILOT_EXAMPLES)]
    Pilot {
        /// Scenario file, or the name of a built-in scenario.
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Be a target: the flight program's logic on this computer, for `hil` or any MAVLink client to
    /// connect to.
    #[command(after_help = hil::TARGET_EXAMPLES)]
    Target {
        /// Where: unix:PATH or tcp:HOST:PORT.
        #[arg(long, value_name = "ENDPOINT")]
        listen: String,
    },
}

/// Does what the command line says.
pub fn run() -> Ended {
    // A number below zero is a value, which its option refuses by its range, and no option.
    let negative = |arg: clap::Arg| {
        let is_option = !arg.is_positional() && arg.get_action().takes_values();
        if is_option { arg.allow_negative_numbers(true) } else { arg }
    };
    let commands = Cli::command().mut_subcommands(|command| command.mut_args(negative));
    let Cli { command, common } = Cli::from_arg_matches(&commands.get_matches()).unwrap_or_else(|error| error.exit());
    match command {
        Some(Command::Run { files, trap, unchecked, logs }) => {
            let arithmetic = if trap { Arithmetic::Trapped } else { Arithmetic::F32 };
            fly::fly(&common, load::all(&files)?, arithmetic, unchecked, &logs)
        }
        Some(Command::Figures(logs)) => figures(&common, &logs),
        None => figures(&common, &Logs { log: vec![Format::Csv] }),
        Some(Command::Keys) => {
            write!(io::stdout().lock(), "{}", hil_sim::describe::keys::page())?;
            Ok(ExitCode::SUCCESS)
        }
        Some(Command::Eval) => eval::evaluate_lines(),
        Some(Command::Check { files }) => check::check(&common, &files),
        Some(Command::Campaign(arguments)) => campaign::campaign(&common, &arguments),
        Some(Command::Merge { folders, tables }) => campaign::merge(&common, &folders, &tables),
        Some(Command::Compare(arguments)) => compare::compare(&common, &arguments),
        Some(Command::Estimate(arguments)) => estimate::estimate(&common, &arguments),
        Some(Command::Policies(arguments)) => policies::policies(&common, &arguments),
        Some(Command::Tune(arguments)) => tune::tune(&common, &arguments),
        Some(Command::Calibrate(arguments)) => calibrate::calibrate(&common, &arguments),
        Some(Command::Fit(arguments)) => fit::fit(&common, &arguments),
        Some(Command::Route(arguments)) => route::route(&common, &arguments),
        Some(Command::Hil { arguments, logs }) => hil::fly(&common, &arguments, &logs),
        Some(Command::Replay { arguments, logs }) => replay::replay(&common, &arguments, &logs),
        Some(Command::View { file }) => view::view(&file),
        Some(Command::Plant { file }) => plant::plant(&file),
        Some(Command::Pilot { file }) => plant::pilot(&file),
        Some(Command::Target { listen }) => hil::target(&common, &listen),
    }
}

fn figures(common: &Common, logs: &Logs) -> Ended {
    fly::fly(common, load::built_in(&[FIGURES, CURVES])?, Arithmetic::F32, false, logs)
}
