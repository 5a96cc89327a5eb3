//! Campaigns as their users meet them: the same table whatever the threads, interruptions and
//! shards.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// Flights of a second through everything that is random: start, vehicle, path, gusts, noise,
/// timing, a rotor.
const CAMPAIGN: &str = r#"
title = "short"
[scenario]
duration_s = 1.0
substeps = 1
[scenario.controller]
law = "follow"
rate_hz = 500.0
poles = [[-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5, -6], [-1, -2, -3, -4, -5], [-2, -3]]
limits = { thrust = [3.0, 60.0], torque = [3.0, 3.0, 3.0] }
observer = { payload = 4.0, rod = 4.0, torque = 4.0 }
vehicle = { payload_mass = 0.5 }
latency_s = 0.01
rotor_lag_s = 0.05
[scenario.sensors]
position = { noise = 0.02, quantum = 0.001, drop_out = { at_s = 0.3, for_s = 0.02 } }
velocity = { noise = 0.03, jitter_s = 0.002 }
body_rate = { noise = 0.01, nan = { at_s = 0.5, for_s = 0.02 } }
[scenario.actuators]
lag_s = 0.05
latency_s = 0.0105
rotors = { layout = "quad-x", arm_m = 0.3, drag_m = 0.02, max_thrust = 15.0 }
[scenario.timing]
jitter = 0.2
missed = 0.02
[start]
distance_m = 5.0
speed = 2.0
tilt_deg = 30.0
yaw_deg = 180.0
rod_deg = 40.0
[draw]
path = { choice = [
    { kind = "circle", radius = 5.0, p3 = -10.0, speed = 1.0 },
    { kind = "circle", radius = 3.0, p3 = -12.0, speed = -1.0 },
] }
"vehicle.payload_mass" = { uniform = [0.25, 0.75] }
"environment.air.wind" = { disc = 5.0 }
"environment.air.gusts.speed_at_6m" = { uniform = [0.0, 5.0] }
"actuators.rotors.failure" = { choice = [
    { rotor = 1, at_s = 0.5, effectiveness = 0.9 },
    { rotor = 3, at_s = 0.2, effectiveness = 0.8 },
] }
"#;

const RUNS: &str = "150";

/// A folder of this test's own, empty, with the campaign's file in it.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("campaign-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder for the test");
    fs::write(folder.join("campaign.toml"), CAMPAIGN).expect("a file");
    folder
}

fn command(folder: &Path, out: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hil-sim"));
    command.args(["campaign", "--runs", RUNS, "--seed", "5", "--quiet"]).arg(folder.join("campaign.toml"));
    command.arg("--out").arg(folder.join(out)).args(more);
    command
}

fn run(folder: &Path, out: &str, more: &[&str]) -> Output {
    let output = command(folder, out, more).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn table(folder: &Path, out: &str) -> Vec<u8> {
    fs::read(folder.join(out).join("runs.csv")).expect("a table")
}

#[test]
fn the_table_does_not_depend_on_threads_shards_or_interruptions() {
    let folder = folder("same");
    run(&folder, "one", &["--jobs", "1"]);
    let whole = table(&folder, "one");
    assert_eq!(whole.iter().filter(|&&byte| byte == b'\n').count(), 151);
    run(&folder, "two", &["--jobs", "2"]);
    assert!(table(&folder, "two") == whole, "two threads");

    // Cut in the middle of a line, as by a crash.
    fs::create_dir(folder.join("cut")).expect("a folder");
    fs::copy(folder.join("one/campaign.json"), folder.join("cut/campaign.json")).expect("a copy");
    fs::write(folder.join("cut/runs.csv"), &whole[..whole.len() * 2 / 5]).expect("a file");
    run(&folder, "cut", &[]);
    assert!(table(&folder, "cut") == whole, "a torn table");

    // Killed while it flies.
    let mut child = command(&folder, "killed", &[]).stderr(Stdio::null()).spawn().expect("it starts");
    std::thread::sleep(Duration::from_millis(300));
    let _ = child.kill();
    let _ = child.wait();
    run(&folder, "killed", &[]);
    assert!(table(&folder, "killed") == whole, "killed");

    for shard in ["1/3", "2/3", "3/3"] {
        run(&folder, &format!("part{}", &shard[..1]), &["--shard", shard]);
    }
    let merge = |parts: &[&str]| {
        let mut merge = Command::new(env!("CARGO_BIN_EXE_hil-sim"));
        merge.arg("merge").args(parts.iter().map(|part| folder.join(part)));
        merge.arg("--out").arg(folder.join("merged")).arg("--quiet").output().expect("it starts")
    };
    let missing = merge(&["part3", "part1"]);
    assert!(!missing.status.success(), "a shard was missing");
    assert!(String::from_utf8_lossy(&missing.stderr).contains("shard 2/3 is missing"), "{missing:?}");
    let twice = merge(&["part3", "part1", "part3", "part2"]);
    assert!(String::from_utf8_lossy(&twice.stderr).contains("shard 3/3 again"), "{twice:?}");
    let other = folder.join("part2/campaign.json");
    let identity = fs::read_to_string(&other).expect("a file");
    fs::write(&other, identity.replace("\"build\": \"", "\"build\": \"another ")).expect("a file");
    let mixed = merge(&["part3", "part1", "part2"]);
    assert!(String::from_utf8_lossy(&mixed.stderr).contains("the program differs: another "), "{mixed:?}");
    fs::write(&other, identity).expect("a file");
    let merged = merge(&["part3", "part1", "part2"]);
    assert!(merged.status.success(), "{}", String::from_utf8_lossy(&merged.stderr));
    assert!(table(&folder, "merged") == whole, "merged");
    for file in ["summary.json", "campaign.html"] {
        let read = |out: &str| fs::read(folder.join(out).join(file)).expect("a file");
        assert!(read("merged") == read("one"), "{file}");
    }
}

/// 100,000 flights are merged in 64 MiB of data: their rows, held at once, need 100, and what the
/// summary is of (some 130 bytes a flight, which it states) with all else 40.
#[cfg(target_os = "linux")]
#[test]
fn a_merge_does_not_hold_its_rows() {
    const FLIGHTS: usize = 100_000;
    let folder = folder("many");
    for (part, shard) in [("part1", "1/2"), ("part2", "2/2")] {
        run(&folder, part, &["--shard", shard]);
        let identity = folder.join(part).join("campaign.json");
        let text = fs::read_to_string(&identity).expect("a file");
        let more = text.replace("\"runs\": 150", &format!("\"runs\": {FLIGHTS}"));
        assert!(more != text, "the number of flights was not found");
        fs::write(&identity, more).expect("a file");
        // The flown rows again and again, under the numbers of the flights that are not flown, and
        // called good: failed ones are kept for `summary.json`, which names them.
        let flown = String::from_utf8(table(&folder, part)).expect("text");
        let (names, rows) = flown.split_once('\n').expect("names");
        let cells: Vec<&str> = rows.lines().map(|row| row.splitn(3, ',').nth(2).expect("a row")).collect();
        let runs = (if part == "part1" { 0 } else { 1 }..FLIGHTS).step_by(2);
        let rows = runs.zip(cells.iter().cycle()).map(|(run, cells)| format!("{run},good,{cells}\n"));
        fs::write(folder.join(part).join("runs.csv"), format!("{names}\n{}", rows.collect::<String>()))
            .expect("a file");
    }
    let merged = Command::new("sh")
        .args(["-c", "ulimit -d 65536; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_hil-sim")])
        .args(["merge", "part1", "part2", "--out", "merged", "--quiet"])
        .current_dir(&folder)
        .output()
        .expect("it starts");
    assert!(merged.status.success(), "{}", String::from_utf8_lossy(&merged.stderr));
    assert_eq!(table(&folder, "merged").iter().filter(|&&byte| byte == b'\n').count(), FLIGHTS + 1);
}

#[test]
fn another_campaign_is_not_mixed_into_a_table() {
    let folder = folder("mixed");
    let short = ["--runs", "3"];
    let with = |seed: &'static str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hil-sim"));
        command.arg("campaign").arg(folder.join("campaign.toml")).args(short).args(["--seed", seed, "--quiet"]);
        command.arg("--out").arg(folder.join("out")).output().expect("it starts")
    };
    assert!(with("1").status.success());
    let other = with("2");
    assert!(!other.status.success());
    assert!(String::from_utf8_lossy(&other.stderr).contains("another campaign"), "{other:?}");
}

#[test]
fn a_replay_is_the_flight_of_the_table() {
    let folder = folder("replay");
    run(&folder, "out", &[]);
    let output = command(&folder, "out", &["--replay", "17"]).output().expect("it starts");
    assert!(output.status.success());
    let log = fs::read_to_string(folder.join("out/replay-17.csv")).expect("a log");
    // The least and largest thrust of the log are those of the row.
    let place = log.lines().next().and_then(|names| names.split(',').position(|name| name == "thrust"));
    let place = place.expect("a thrust");
    // The controller's own numbers: single precision, which the log has whole.
    let thrusts: Vec<f64> = log
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(place).and_then(|cell| cell.parse::<f32>().ok()).expect("a number").into())
        .collect();
    let text = String::from_utf8(table(&folder, "out")).expect("text");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let row: Vec<&str> = lines.nth(17).expect("a row").split(',').collect();
    let column = |name: &str| -> f64 {
        let index = names.iter().position(|other| *other == name).expect("a column");
        row[index].parse().expect("a number")
    };
    assert_eq!(column("run"), 17.0);
    assert_eq!(thrusts.iter().copied().fold(f64::INFINITY, f64::min), column("least_thrust"));
    assert_eq!(thrusts.iter().copied().fold(0.0, f64::max), column("largest_thrust"));
    assert_eq!(thrusts.len(), 500);
}

#[test]
fn a_fault_that_is_not_there_is_refused_by_name() {
    let folder = folder("refused");
    for (from, to, named) in [
        ("missed = 0.02", "late = 0.02", "late"),
        ("layout = \"quad-x\"", "layout = \"hexa-x\"", "hexa-x"),
        ("quantum = 0.001", "drift = 0.001", "drift"),
        ("\"vehicle.payload_mass\"", "\"vehicle.colour\"", "colour"),
        ("title = \"short\"", "ground_p3 = nan", "ground_p3: NaN is outside -100000 to 100000"),
        ("law = \"follow\"", "law = 1", "controller.law: one word is wanted"),
    ] {
        fs::write(folder.join("campaign.toml"), CAMPAIGN.replace(from, to)).expect("a file");
        let output = command(&folder, "out", &[]).output().expect("it starts");
        assert!(!output.status.success(), "{to} was accepted");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(named), "{named}: {message}");
    }
}

#[test]
fn results_of_an_unknown_campaign_are_not_written_over() {
    let folder = folder("nameless");
    fs::create_dir_all(folder.join("out")).expect("a folder");
    fs::write(folder.join("out/runs.csv"), "run,verdict\n").expect("a file");
    let output = command(&folder, "out", &[]).output().expect("it starts");
    assert!(!output.status.success());
    assert!(String::from_utf8_lossy(&output.stderr).contains("no campaign.json"), "{output:?}");
    assert_eq!(table(&folder, "out"), b"run,verdict\n");
}

#[test]
fn a_flight_that_the_campaign_does_not_have_is_not_replayed() {
    let folder = folder("beyond");
    let output = command(&folder, "out", &["--replay", RUNS]).output().expect("it starts");
    assert!(!output.status.success());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("--replay 150") && said.contains("0 to 149"), "{said}");
}
