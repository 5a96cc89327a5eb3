//! `hil-sim hil`: its arguments, its flights, and what it has to say about the link.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use comfy_table::Table;
use serde::Serialize;

use super::{Emulator, Endpoint, HilError, Options, Pace, Station, Statistics, Target, USUAL, mission};
use crate::describe::input::argument;
use crate::describe::mission::{Home, home};
use crate::describe::parameters::{Unsupported, parameters};
use crate::describe::scenario::Scenario;
use crate::fly::batch::Outcome;
use crate::fly::flight::{Control, End};
use crate::fly::run;
use crate::fly::sample::Sample;

/// Where N has its origin unless it is told otherwise, LAT,LON,ALT.
pub const HOME: &str = "53.527,-113.529,668";

/// Where the target is: one of these; or, for a ground station, in this program.
#[derive(Args, Clone, Debug)]
#[group(multiple = false)]
pub struct Place {
    /// Serial port of the target.
    #[arg(long)]
    pub port: Option<String>,
    /// Socket of the target: unix:PATH, tcp:HOST:PORT or udp:HOST:PORT; or here, in this program.
    #[arg(long, value_name = "ENDPOINT")]
    pub connect: Option<String>,
    /// Image to start in QEMU.
    #[arg(long, value_name = "IMAGE")]
    pub emulate: Option<PathBuf>,
}

/// Where the target is and how to speak with it.
#[derive(Args, Clone, Debug)]
pub struct Arguments {
    /// Scenario files, or names of built-in scenarios; none for the paper's figures.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the target is.
    #[command(flatten)]
    pub place: Place,
    /// Baud rate of the serial port.
    #[arg(long, default_value_t = 921_600, value_parser = argument(300..=20_000_000_u32, "baud"))]
    pub baud: u32,
    /// QEMU's machine for the image: netduinoplus2 or olimex-stm32-h405 (STM32F405), mps2-an386
    /// (Cortex-M4F), mps2-an500 (Cortex-M7).
    #[arg(long, default_value = "netduinoplus2")]
    pub machine: String,
    /// Let QEMU count instructions: cycle counts are then exact and repeatable, and flights slower.
    #[arg(long)]
    pub count: bool,
    /// Fly by the target's own timer and the clock on the wall, not in lockstep.
    #[arg(long)]
    pub real_time: bool,
    /// Fly even what asks more of the vehicle than its limits or its actuators allow.
    #[arg(long)]
    pub unchecked: bool,
    /// Do not ask for ξ, ν, margins and what the observers found, which come with the samples that
    /// are logged: for slow lines.
    #[arg(long)]
    pub no_telemetry: bool,
    /// Show the flights while they fly, in the report's page at http://127.0.0.1:PORT; any free
    /// port if it is 0.
    #[arg(long, value_name = "PORT", num_args = 0..=1, require_equals = true, default_missing_value = "8420")]
    pub live: Option<u16>,
    /// Leave the vehicle to a ground station that listens at udp:HOST:PORT: it arms, asks for modes
    /// and sends missions, and the scenario's requests do not count. The flight goes by the clock
    /// on the wall until Ctrl-C, or the scenario's end.
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, require_equals = true, default_missing_value = USUAL)]
    pub station: Option<String>,
    /// Where on the earth N has its origin, for a ground station and a receiver: latitude and
    /// longitude in degrees, height in m above the sea.
    #[arg(long, value_name = "LAT,LON,ALT", value_parser = home, allow_hyphen_values = true, default_value = HOME)]
    pub home: Home,
    /// Seconds without an answer after which the target is lost.
    #[arg(long, default_value_t = 5.0, value_name = "S", value_parser = argument(0.1..=3600.0, "s"))]
    pub patience: f64,
}

/// What the link did in one flight.
#[derive(Clone, Debug, Serialize)]
pub struct LinkReport {
    /// The scenario.
    pub scenario: String,
    /// Control steps the target answered.
    pub steps: usize,
    /// Of them in a second of wall-clock time.
    pub steps_per_s: f64,
    /// From a state's sending to its command's arrival, median, µs.
    pub latency_median_us: f64,
    /// 99th percentile, µs.
    pub latency_p99_us: f64,
    /// Longest, µs.
    pub latency_max_us: f64,
    /// Counts of the target's cycle counter in a control step, median.
    pub cycles_median: f64,
    /// Most of them.
    pub cycles_max: u32,
    /// Instructions in a control step, where an emulator counts them: median.
    pub instructions_median: Option<f64>,
    /// Most of them.
    pub instructions_max: Option<f64>,
    /// Frames sent again.
    pub repeats: u64,
    /// Logged samples whose telemetry was lost on the line: their cells are empty.
    pub telemetry_lost: u64,
    /// Frames that could not be used.
    pub bad_frames: u64,
    /// Times the line came back.
    pub reconnections: u64,
    /// Real time: periods without a command.
    pub late: u64,
    /// Real time: how far this program was behind the clock at most, ms.
    pub behind_ms: f64,
    /// Bits of `LOAD_FAULT` in any answer.
    pub faults: u32,
}

/// Flights and what the link did in each.
#[derive(Debug)]
pub struct Flown {
    /// As of flights without a target.
    pub outcomes: Vec<Outcome>,
    /// One each.
    pub links: Vec<LinkReport>,
    /// Why the last flight ended early.
    pub failure: Option<HilError>,
}

/// Sees a flight's log whenever it has a sample more, and once more with its end.
pub type See<'a> = dyn FnMut(&Scenario, &[Sample], Option<End>) + 'a;

/// Connects and flies `scenarios` one after the other, while `see` sees them.
///
/// # Errors
/// The target can't be reached, or can't fly one of the scenarios: that is found out before the
/// first. A target that is lost ends the flights; those before are kept.
pub fn fly_all(
    arguments: &Arguments,
    scenarios: Vec<Scenario>,
    control: Control<'_>,
    see: &mut See<'_>,
) -> Result<Flown, HilError> {
    let Place { port, connect, emulate } = &arguments.place;
    let station = arguments.station.as_deref().map(Station::open).transpose()?;
    // An emulator has a clock of its own, which no real time can go by.
    let is_by_clock = arguments.real_time || station.is_some() && emulate.is_none();
    let options = Options {
        pace: if is_by_clock { Pace::RealTime } else { Pace::Lockstep },
        patience: Duration::from_secs_f64(arguments.patience),
        telemetry: !arguments.no_telemetry && station.is_none(),
        ..Options::default()
    };
    for scenario in &scenarios {
        let unsupported = |reason| HilError::Unsupported(format!("{}: {reason}", scenario.name));
        if scenario.requests.iter().any(|asked| asked.speed_factor.is_some()) {
            return Err(unsupported("factors of the speed are for flights in this program".to_owned()));
        }
        let refused = |Unsupported(reason)| unsupported(reason);
        parameters(&scenario.controller).map_err(refused)?;
        if let Some(route) = scenario.controller.law.route() {
            mission::items(route).map_err(refused)?;
        }
    }
    let mut target = match (port, connect, emulate) {
        (Some(port), ..) => {
            Target::connect(Endpoint::Serial { port: port.clone(), baud: arguments.baud }, None, options)?
        }
        (_, Some(endpoint), _) => Target::connect(endpoint.parse()?, None, options)?,
        (.., Some(image)) => Target::emulated(Emulator::start(&arguments.machine, image, arguments.count)?, options)?,
        _ if station.is_some() => Target::connect(Endpoint::Here, None, options)?,
        _ => return Err(HilError::NoTarget),
    }
    .at(arguments.home);
    let mut station = station;
    let mut flown = Flown { outcomes: Vec::new(), links: Vec::new(), failure: None };
    for scenario in scenarios {
        match fly_one(&mut target, scenario, station.take(), (options.telemetry, control), see, &mut flown) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) if flown.outcomes.is_empty() => return Err(error),
            Err(error) => {
                flown.failure = Some(error);
                break;
            }
        }
    }
    Ok(flown)
}

/// One flight, from arming to disarming, or as long as a station has it; whether to go on.
fn fly_one(
    target: &mut Target,
    scenario: Scenario,
    station: Option<Station>,
    (twin, control): (bool, Control<'_>),
    see: &mut See<'_>,
    flown: &mut Flown,
) -> Result<bool, HilError> {
    let is_commanded = station.is_some();
    match station {
        Some(station) => target.leave_to(station, &scenario)?,
        None => target.prepare(&scenario)?,
    }
    let begun = Instant::now();
    // A twin is asked at the states that are sent.
    let twin = twin && scenario.estimator.is_none();
    let mut flight = run::fly_watched(&scenario, target, twin, control, &mut |log| see(&scenario, log, None))
        .map_err(|error| HilError::Unsupported(error.to_string()))?;
    see(&scenario, &flight.log, Some(flight.end));
    let elapsed_s = begun.elapsed().as_secs_f64();
    if is_commanded && flight.end == End::Interrupted {
        flight.end = End::Complete;
    }
    let end = flight.end;
    if end == End::Interrupted {
        target.disarm()?;
        return Ok(false);
    }
    let steps = target.statistics().cycles.len();
    flown.links.push(link_report(&scenario.name, target.statistics(), elapsed_s, target.counts_per_instruction()));
    // Of the target's time, not of this program's.
    flight.times_real_time = steps as f64 / scenario.controller.rate_hz / elapsed_s;
    flown.outcomes.push(Outcome { scenario, flight });
    if let End::Unanswered(_) = end {
        flown.failure = target.take_failure();
        return Ok(false);
    }
    target.disarm()?;
    Ok(true)
}

fn link_report(name: &str, statistics: &Statistics, elapsed_s: f64, counts: Option<f64>) -> LinkReport {
    let mut cycles = statistics.cycles.clone();
    cycles.sort_unstable();
    let median = cycles.get(cycles.len() / 2).copied().unwrap_or_default();
    let most = cycles.last().copied().unwrap_or_default();
    let instructions = |cycles: u32| counts.map(|counts| f64::from(cycles) / counts);
    LinkReport {
        scenario: name.to_owned(),
        steps: cycles.len(),
        steps_per_s: cycles.len() as f64 / elapsed_s,
        latency_median_us: 1e6 * statistics.latency_s(0.5),
        latency_p99_us: 1e6 * statistics.latency_s(0.99),
        latency_max_us: 1e6 * statistics.latency_s(1.0),
        cycles_median: f64::from(median),
        cycles_max: most,
        instructions_median: instructions(median),
        instructions_max: instructions(most),
        repeats: statistics.repeats,
        telemetry_lost: statistics.telemetry_lost,
        bad_frames: statistics.bad_frames,
        reconnections: statistics.reconnections,
        late: statistics.late,
        behind_ms: 1e3 * statistics.behind_s,
        faults: statistics.faults,
    }
}

/// A sentence for each flight in real time that was late.
#[must_use]
pub fn lateness(links: &[LinkReport]) -> Vec<String> {
    let late = links.iter().filter(|link| link.late > 0);
    late.map(|link| {
        let LinkReport { scenario, steps, late, behind_ms, .. } = link;
        format!(
            "{scenario}: late in {late} of {steps} periods, in which no command came: the one before went on; \
             this program was {behind_ms:.1} ms behind the clock at most"
        )
    })
    .collect()
}

/// The links as a table for the terminal.
#[must_use]
pub fn table(links: &[LinkReport]) -> Table {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::UTF8_HORIZONTAL_ONLY);
    table.set_header([
        "flight",
        "steps",
        "steps/s",
        "latency µs\nmedian",
        "\n99 %",
        "\nmax",
        "cycles\nmedian",
        "\nmax",
        "instructions\nmedian",
        "\nmax",
        "sent\nagain",
        "telemetry\nlost",
        "bad\nframes",
        "line\nmended",
        "late",
        "faults",
    ]);
    let or_none = |number: Option<f64>| number.map_or_else(|| "–".to_owned(), |number| format!("{number:.0}"));
    for link in links {
        table.add_row([
            link.scenario.clone(),
            link.steps.to_string(),
            format!("{:.0}", link.steps_per_s),
            format!("{:.0}", link.latency_median_us),
            format!("{:.0}", link.latency_p99_us),
            format!("{:.0}", link.latency_max_us),
            format!("{:.0}", link.cycles_median),
            link.cycles_max.to_string(),
            or_none(link.instructions_median),
            or_none(link.instructions_max),
            link.repeats.to_string(),
            link.telemetry_lost.to_string(),
            link.bad_frames.to_string(),
            link.reconnections.to_string(),
            link.late.to_string(),
            format!("{:#x}", link.faults),
        ]);
    }
    table
}
