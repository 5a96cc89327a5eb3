//! `hil` and `target`: the controller at the other end of a line, and this program at that end.

use hil_sim::describe::mission::Home;
use hil_sim::describe::reference::Reference;
use hil_sim::describe::scenario::{FIGURES, STATION};
use hil_sim::fly::flight::Control;
use hil_sim::hil::{self, Arguments, Flown};
use hil_sim::report;
use hil_sim::report::live::Live;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::{Common, Ended, Logs, fly, load, many};

pub const EXAMPLES: &str = "Examples:
  hil-sim hil --port /dev/ttyUSB0                      the paper's figures on a board
  hil-sim hil fig3a --port /dev/ttyUSB0 --real-time    by the board's own clock
  hil-sim hil fig3a --port /dev/ttyUSB0 --real-time --live    and watch it in a browser
  hil-sim hil fig3a --connect udp:192.168.1.7:14550    over a wireless bridge
  hil-sim hil fig3a --emulate firmware/target/thumbv7em-none-eabihf/release/firmware
  hil-sim hil on-instruments --connect here            on its IMU and receiver: the flight program finds the load itself
  hil-sim hil --station                                a vehicle for QGroundControl, MAVProxy, …, without a board
  hil-sim hil my.toml --station=192.168.1.7:14550 --home 53.527,-113.529,668    for one elsewhere
  hil-sim hil --station --port /dev/ttyUSB0            the vehicle simulated, the flight program on a board";

pub const TARGET_EXAMPLES: &str = "Examples:
  hil-sim target --listen tcp:127.0.0.1:5760
  hil-sim hil fig3a --connect tcp:127.0.0.1:5760       in another terminal";

/// Flies on a target, prints both tables, and writes the report with the link's numbers in hil.json
/// beside it.
pub fn fly(common: &Common, arguments: &Arguments, logs: &Logs) -> Ended {
    let scenarios = match (&arguments.files[..], &arguments.station) {
        ([], None) => load::built_in(&[FIGURES])?,
        ([], Some(_)) => vec![load::one(Path::new(STATION))?],
        ([_, another, ..], Some(_)) => {
            return Err(format!("{}: a ground station flies one scenario", another.display()).into());
        }
        (files, _) => load::all(files)?,
    };
    let stop = many::interrupt()?;

    super::check::refuse(&scenarios, arguments.unchecked)?;
    common.tried()?;
    let planned = scenarios.len();
    let is_hidden = common.quiet || arguments.station.is_some();
    let bar = many::progress_bar(is_hidden, scenarios.iter().map(|scenario| scenario.duration_s).sum());
    let control = Control { stop: &stop, progress: &many::progress(&bar) };
    let live = arguments.live.map(Live::serve).transpose().map_err(|error| format!("--live: {error}"))?;
    if let Some(live) = live.as_ref().filter(|_| !common.quiet) {
        eprintln!("hil-sim: live at http://{}", live.address());
    }
    if let Some(station) = arguments.station.as_ref().filter(|_| !common.quiet) {
        let Home { latitude, longitude, altitude } = arguments.home;
        eprintln!(
            "hil-sim: a vehicle for a ground station at udp:{station}, home {latitude}, {longitude}, {altitude} m"
        );
        eprintln!("hil-sim: Ctrl-C ends the flight and writes its report");
    }
    let flown = hil::fly_all(arguments, scenarios, control, &mut |scenario, log, end| {
        if let Some(live) = &live {
            live.show(scenario, log, end);
        }
    })?;
    bar.finish_and_clear();
    if let Some(live) = live {
        live.finish();
    }
    let Flown { outcomes, links, failure } = flown;

    let reference = Reference::builtin();
    let page = report::write(common.folder(), &outcomes, &reference, &logs.log)?;
    fs::write(common.folder().join("hil.json"), serde_json::to_vec_pretty(&links)?)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{}\n{}", report::table(&outcomes, &reference, many::width()), hil::table(&links))?;
        for sentence in hil::lateness(&links) {
            writeln!(out, "{sentence}")?;
        }
        writeln!(out, "Report: {}", page.display())?;
    }
    match failure {
        Some(failure) => Err(failure.into()),
        None => Ok(fly::verdict(&outcomes, planned)),
    }
}

/// Is a target, until the line's other end closes it.
pub fn target(common: &Common, listen: &str) -> Ended {
    let listener = hil::Listener::open(&listen.parse()?)?;
    if !common.quiet {
        eprintln!("hil-sim: a target at {listen}");
    }
    loop {
        hil::serve(listener.accept()?)?;
    }
}
