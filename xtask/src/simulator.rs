//! `cargo xtask simulator`: what a control period of a campaign's flight costs the host, counted by
//! valgrind, so that it is the same on every machine with the same compiler.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::toolchain::root;

/// The built-in campaign, whose flights are `FULL` s long.
const CAMPAIGN: &str = include_str!("../../hil-sim/scenarios/campaign.toml");
const FULL: f64 = 40.0;
const SHORT: f64 = 10.0;
/// Control periods in a second.
const RATE: f64 = 500.0;

/// Flies the campaign's first flight in whole and in part, and prints what the difference makes.
pub fn run() -> Result<()> {
    let status =
        Command::new("cargo").args(["build", "--release", "--package", "hil-sim"]).current_dir(root()).status()?;
    ensure!(status.success(), "hil-sim does not build");
    let folder = root().join("target/simulator");
    let [full, short] = [FULL, SHORT].map(|seconds| count(&folder, seconds));
    let (full, short) = (full?, short?);
    let step = (full - short) / ((FULL - SHORT) * RATE);
    println!("instructions a control period: {step:.0}");
    println!("of a flight's set-up and a campaign's report: {:.1} million", (full - step * FULL * RATE) * 1e-6);
    Ok(())
}

/// Host instructions of a campaign of one flight of so many seconds.
fn count(folder: &Path, seconds: f64) -> Result<f64> {
    let full = format!("duration_s = {FULL:.1}");
    ensure!(CAMPAIGN.contains(&full), "the built-in campaign's flights are not of {FULL} s");
    let out = folder.join(format!("{seconds}"));
    // Nothing is flown again that is there already.
    if out.exists() {
        std::fs::remove_dir_all(&out)?;
    }
    std::fs::create_dir_all(&out)?;
    let file = out.join("campaign.toml");
    std::fs::write(&file, CAMPAIGN.replace(&full, &format!("duration_s = {seconds:.1}")))?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(root().join("target/release/hil-sim"))
        .args(["campaign", "--runs", "1", "--jobs", "1", "--quiet", "--out"])
        .arg(&out)
        .arg(&file)
        .output()
        .context("cannot start valgrind (Debian's package valgrind)")?;
    let text = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "valgrind ended with {}:\n{text}", output.status);
    let number = text.lines().find_map(|line| line.split_once("Collected :")).map(|(_, number)| number.trim());
    number.and_then(|number| number.parse().ok()).with_context(|| format!("valgrind counted nothing:\n{text}"))
}
