//! `campaign` and `merge`: thousands of drawn flights.

use clap::{Args, ValueEnum};
use hil_sim::describe::input::argument;
use hil_sim::fly::flight::Control;
use hil_sim::report::log;
use hil_sim::study::campaign::{self, Campaign, HuntError, Identity, Replay, Rows, Shard};
use hil_sim::world::Seed;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use super::{Common, Ended, Logs, many, many::Many};

/// Each example can be pasted into a shell.
pub const EXAMPLES: &str = "Examples:
  hil-sim campaign                               following a circle against everything at once
  hil-sim campaign ground-to-ground              take-off with a slack cable, a path, landing
  hil-sim campaign ground-to-ground-rtk          the same without a sensor on the load
  hil-sim campaign my.toml --runs 1000 --seed 7 --jobs 2 --out results
  hil-sim campaign my.toml --out results         again: goes on where it was interrupted
  hil-sim campaign my.toml --replay 412          flight 412 again, with its full log
  hil-sim campaign my.toml --hunt                the smallest fault that fails, and `hil-sim run out/fault-1.toml`
  hil-sim campaign my.toml --hunt=412            the smallest part of what flight 412 met that still fails
  hil-sim campaign my.toml --table csv,parquet --out results
  hil-sim campaign my.toml --shard 1/4 --out part1    a quarter, for a cluster; see `hil-sim merge`
  hil-sim campaign my.toml --shard $SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT --out part$SLURM_ARRAY_TASK_ID
  parallel hil-sim campaign my.toml --jobs 1 --shard {}/8 --out part{} ::: {1..8}";

/// Each example can be pasted into a shell.
pub const MERGE_EXAMPLES: &str = "Examples:
  hil-sim merge part1 part2 part3 part4 --out whole";

/// What to fly.
#[derive(Args)]
pub struct CampaignArguments {
    /// Campaign file, or the name of a built-in one: campaign (if left out), ground-to-ground,
    /// ground-to-ground-rtk.
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Flights; as the file says if left out.
    #[arg(long, value_name = "N", value_parser = argument(1..=100_000_000_u64, ""))]
    runs: Option<u64>,
    #[command(flatten)]
    many: Many,
    /// Fly this one flight again, with its full log.
    #[arg(long, value_name = "ROW", conflicts_with = "shard")]
    replay: Option<u64>,
    /// Search for the smallest fault that fails, in place of flying all: from the nominal flight,
    /// or from what flight ROW of the campaign met.
    ///
    /// Nominal is zero where a range has it, else its middle; the size of a fault is the length of
    /// the vector of its numbers, each 1 at the end of its range. Noise, gusts, choices and the
    /// place on the path are those of flight ROW, or 0, in every flight. Writes hunt.json and a
    /// scenario file for each find, which `hil-sim run` flies to the same end.
    #[arg(long, value_name = "ROW", num_args = 0..=1, require_equals = true, conflicts_with_all = ["shard", "replay"])]
    hunt: Option<Option<u64>>,
    /// Fly the i-th of n parts only.
    #[arg(long, value_name = "i/n", value_parser = shard)]
    shard: Option<Shard>,
    #[command(flatten)]
    tables: Tables,
    #[command(flatten)]
    logs: Logs,
}

/// The formats of the table.
#[derive(Args)]
pub struct Tables {
    /// Formats of the table: runs.csv is always kept, since it is where an interrupted campaign
    /// goes on.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "csv", value_name = "FORMAT,…")]
    table: Vec<TableFormat>,
}

/// A format of the table.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableFormat {
    /// runs.csv.
    Csv,
    /// runs.parquet.
    Parquet,
}

fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse::<u64>().ok()?, n.parse::<u64>().ok()?)));
    match parts {
        Some((index, of)) if 1 <= index && index <= of => Ok(Shard { index: index - 1, of }),
        _ => Err("not of the form i/n with 1 <= i <= n".to_owned()),
    }
}

/// Flies, prints, reports.
pub fn campaign(common: &Common, arguments: &CampaignArguments) -> Ended {
    let file = arguments.file.as_deref().unwrap_or(Path::new("campaign"));
    let name = file.display().to_string();
    let built_in = || campaign::builtin(&name).map(str::to_owned);
    let text = match arguments.file.as_deref().map(std::fs::read_to_string) {
        None => built_in().ok_or("no campaign is built in")?,
        Some(Ok(text)) => text,
        Some(Err(error)) if error.kind() == io::ErrorKind::NotFound => {
            let names = campaign::BUILTIN.iter().map(|(name, _)| *name);
            built_in().ok_or_else(|| super::load::absent(file, "campaign", names))?
        }
        Some(Err(error)) => return Err(format!("{name}: {error}").into()),
    };
    let campaign = Campaign::parse(&text).map_err(|invalid| format!("{name}: {invalid}"))?;
    let runs = arguments.runs.unwrap_or(campaign.runs);
    for (option, run) in [("replay", arguments.replay), ("hunt", arguments.hunt.flatten())] {
        if let Some(run) = run.filter(|run| *run >= runs) {
            return Err(format!("--{option} {run}: the campaign's flights are 0 to {}", runs - 1).into());
        }
    }
    if let Some(from) = arguments.hunt {
        common.tried()?;
        return hunt(common, &campaign, &arguments.many, from);
    }
    if let Some(run) = arguments.replay {
        common.tried()?;
        return replay(common, &campaign, Seed { batch: arguments.many.seed, run }, &arguments.logs);
    }

    let stop = many::interrupt()?;
    let identity = Identity {
        campaign: text,
        runs,
        seed: arguments.many.seed,
        shard: arguments.shard.unwrap_or(Shard::WHOLE),
        build: env!("BUILD").to_owned(),
    };
    common.tried()?;
    let pool = arguments.many.pool()?;
    let planned = identity.shard.runs(identity.runs).count();
    let bar = many::bar(common.quiet, planned as u64, "{wide_bar} {pos} of {len} flights, {eta} left");
    let started = Instant::now();
    let done = pool.install(|| campaign::run(&campaign, &identity, common.folder(), &stop, &|done| bar.inc(done)))?;
    bar.finish_and_clear();
    if done < planned {
        eprintln!("hil-sim: interrupted: {done} of {planned} flights are kept; the same command goes on");
        return Ok(many::interrupted());
    }
    report(common, &campaign, &identity, &arguments.tables)?;
    if !common.quiet {
        let wall_s = started.elapsed().as_secs_f64();
        writeln!(
            io::stdout().lock(),
            "{planned} flights in {wall_s:.0} s on {} threads",
            pool.current_num_threads()
        )?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Puts the shards of a campaign together.
pub fn merge(common: &Common, folders: &[PathBuf], tables: &Tables) -> Ended {
    let identity = campaign::merge(folders, common.folder())?;
    let campaign = Campaign::parse(&identity.campaign)?;
    report(common, &campaign, &identity, tables)?;
    Ok(ExitCode::SUCCESS)
}

/// Makes of the table in the folder whatever else is to be there, row by row.
fn report(
    common: &Common,
    campaign: &Campaign,
    identity: &Identity,
    tables: &Tables,
) -> Result<(), Box<dyn std::error::Error>> {
    let rows = || Rows::of(common.folder(), identity);
    if tables.table.contains(&TableFormat::Parquet) {
        let path = common.folder().join("runs.parquet");
        let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let file = File::create(&path).map_err(|error| failed(&error))?;
        campaign::write_parquet(BufWriter::new(file), rows()).map_err(|error| failed(&error))?;
    }
    let (summary, tally) = campaign::summarize(identity.seed, rows())?;
    let duration_s = campaign.draw(Seed { batch: identity.seed, run: 0 })?.scenario.duration_s;
    let page = campaign::write_page(common.folder(), &campaign.title, duration_s, &summary, &tally)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        write!(out, "{}", summary.text())?;
        writeln!(out, "Report: {}", page.display())?;
    }
    Ok(())
}

fn hunt(common: &Common, campaign: &Campaign, many: &Many, from: Option<u64>) -> Ended {
    let stop = many::interrupt()?;
    let pool = many.pool()?;
    let seed = Seed { batch: many.seed, run: from.unwrap_or(0) };
    let control = Control { stop: &stop, progress: &|_| {} };
    let hunt = match pool.install(|| campaign::hunt(campaign, seed, from.is_some(), control)) {
        Err(HuntError::Interrupted) => return Ok(many::nothing_reported()),
        hunt => hunt?,
    };
    let name = |index: usize| match from {
        None => format!("fault-{}.toml", index + 1),
        Some(run) => format!("fault-of-{run}.toml"),
    };
    let path = |name: &str| common.folder().join(name);
    let report = |name: String, text: &str| hil_sim::report::write_file(&path(&name), text.as_bytes());
    for (index, find) in hunt.finds.iter().enumerate() {
        report(name(index), &find.scenario)?;
    }
    report("hunt.json".to_owned(), &serde_json::to_string_pretty(&hunt)?)?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        write!(out, "{}", hunt.text(|index| path(&name(index)).display().to_string()))?;
        if !hunt.finds.is_empty() {
            writeln!(out, "Look at one: hil-sim run {} --unchecked", path(&name(0)).display())?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn replay(common: &Common, campaign: &Campaign, seed: Seed, logs: &Logs) -> Ended {
    let stop = many::interrupt()?;
    let control = Control { stop: &stop, progress: &|_| {} };
    let Some(replay) = campaign::replay(campaign, seed, control)? else { return Ok(many::nothing_reported()) };
    let Replay { row, log: table, page } = replay;
    let folder = common.folder();
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    log::write(folder, &table, &logs.log)?;
    let path = folder.join(format!("{}.html", table.name));
    std::fs::write(&path, page).map_err(|error| format!("{}: {error}", path.display()))?;
    if !common.quiet {
        let mut out = io::stdout().lock();
        writeln!(out, "{row:#?}\nPage and logs: {}.*", folder.join(&table.name).display())?;
    }
    Ok(ExitCode::SUCCESS)
}
