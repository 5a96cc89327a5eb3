//! Running an image in QEMU, and what it prints.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Read};
use std::ops::Range;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

/// The emulated boards: one core each.
pub const MACHINES: [(&str, &str); 2] = [("Cortex-M4F", "mps2-an386"), ("Cortex-M7", "mps2-an500")];

/// A bench runs for a second or two; one that takes this long hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// What the target measured of one case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Measured {
    /// Address of the step's entry, where the call graph starts.
    pub entry: u32,
    /// Instructions of the fastest step.
    pub best: u64,
    /// Instructions of the slowest step.
    pub worst: u64,
    /// Instructions in the mean over all steps, rounded up.
    pub mean: u64,
    /// High water of the painted stack, bytes.
    pub stack: u64,
    /// Size of the law's whole state, bytes.
    pub ram: u64,
    /// Digest of all commands.
    pub digest: u64,
}

/// What the bench printed.
pub struct Output {
    /// By case, in the order of the cases.
    pub cases: Vec<(String, Measured)>,
    /// Digest of the square roots.
    pub roots: u64,
}

/// Runs the bench on a machine.
pub fn bench(machine: &str, image: &Path) -> Result<Output> {
    // 2⁷ ns of virtual time an instruction: the bench's probe reckons with it.
    let text = run(machine, image, &["-icount", "shift=7"])?;
    parse(&text).with_context(|| format!("{machine} printed:\n{text}"))
}

/// Runs the bench on a few states only, and hands over the address of every instruction in `shown`
/// that it comes by.
pub fn trace(machine: &str, image: &Path, shown: &[Range<u32>], mut pass: impl FnMut(u32)) -> Result<()> {
    let shown: Vec<String> = shown.iter().map(|at| format!("{:#x}..{:#x}", at.start, at.end - 1)).collect();
    let mut child = qemu(machine, image)
        .args(["-semihosting-config", "enable=on,target=native,arg=few", "-icount", "shift=7"])
        .args(one_by_one()?)
        .args(["-d", "exec,nochain", "-dfilter", &shown.join(",")])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start qemu-system-arm (package qemu-system-arm)")?;
    let pipe = child.stderr.take().context("the pipe was just asked for")?;
    for line in BufReader::new(pipe).lines() {
        // Trace 0: 0x7f0c48000100 [00000000/00000400/00000110/ff000201] symbol
        let line = line?;
        let address = line.strip_prefix("Trace ").and_then(|line| line.split('/').nth(1));
        if let Some(address) = address {
            pass(u32::from_str_radix(address, 16)?);
        }
    }
    let status = child.wait()?;
    ensure!(status.success(), "{machine} ended with {status} while it was traced");
    Ok(())
}

/// What makes QEMU translate each instruction by itself: another word from version 9 on.
fn one_by_one() -> Result<&'static [&'static str]> {
    let output = Command::new("qemu-system-arm").arg("--version").output().context("cannot start qemu-system-arm")?;
    let text = String::from_utf8_lossy(&output.stdout);
    let version = text.split_whitespace().find_map(|word| word.split('.').next()?.parse::<u32>().ok());
    let version = version.with_context(|| format!("qemu-system-arm --version printed {text}"))?;
    Ok(if version < 9 { &["-singlestep"] } else { &["-accel", "tcg,one-insn-per-tb=on"] })
}

/// The emulator with `image` on `machine`, without a screen and ports.
fn qemu(machine: &str, image: &Path) -> Command {
    let mut qemu = Command::new("qemu-system-arm");
    qemu.args(["-machine", machine, "-display", "none", "-serial", "none", "-monitor", "none"]);
    qemu.arg("-kernel").arg(image).stdin(Stdio::null());
    qemu
}

/// Runs `image` to its end, which has to be a success, and returns its standard output.
fn run(machine: &str, image: &Path, arguments: &[&str]) -> Result<String> {
    let mut child = qemu(machine, image)
        .args(["-semihosting-config", "enable=on,target=native"])
        .args(arguments)
        .stdout(Stdio::piped())
        .spawn()
        .context("cannot start qemu-system-arm (package qemu-system-arm)")?;
    let mut pipe = child.stdout.take().context("the pipe was just asked for")?;
    // Read apart, so that a full pipe doesn't stall the emulator while it is waited for.
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        pipe.read_to_string(&mut text).map(|_| text)
    });
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if start.elapsed() > PATIENCE {
            child.kill()?;
            child.wait()?;
            bail!("{machine} did not end within {} s", PATIENCE.as_secs());
        }
        std::thread::sleep(Duration::from_millis(10));
    };
    let text = reader.join().expect("the reader does not panic")?;
    ensure!(status.success(), "{machine} ended with {status} after printing:\n{text}");
    Ok(text)
}

/// Lines of `key=value`: one for each case, and one for the end.
fn parse(text: &str) -> Result<Output> {
    let (mut cases, mut roots) = (Vec::new(), None);
    for line in text.lines() {
        let fields: HashMap<&str, &str> = line.split_whitespace().filter_map(|field| field.split_once('=')).collect();
        let number = |key: &str| -> Result<u64> {
            let digits = fields.get(key).with_context(|| format!("`{line}` has no {key}"))?;
            Ok(u64::from_str_radix(digits, 16)?)
        };
        if let Some(name) = fields.get("refused") {
            bail!("the law refused the parameters of {name}");
        } else if let Some(name) = fields.get("case") {
            let measured = Measured {
                // Bit 0 of a function's address says Thumb.
                entry: u32::try_from(number("entry")?)? & !1,
                best: number("best")?,
                worst: number("worst")?,
                mean: number("total")?.div_ceil(number("steps")?.max(1)),
                stack: number("stack")?,
                ram: number("ram")?,
                digest: number("digest")?,
            };
            cases.push(((*name).to_owned(), measured));
        } else if fields.contains_key("roots") {
            roots = Some(number("roots")?);
        }
    }
    Ok(Output { cases, roots: roots.context("the last line is missing")? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bench_that_stops_early_is_an_error() {
        let line = "case=circle entry=401 best=10 worst=11 total=21 steps=2 stack=20 ram=30 digest=ff \n";
        assert!(parse(line).is_err());
        let output = parse(&format!("{line}roots=7 \n")).unwrap();
        let expected = Measured { entry: 0x400, best: 16, worst: 17, mean: 17, stack: 32, ram: 48, digest: 255 };
        assert_eq!(output.cases, [("circle".to_owned(), expected)]);
        assert!(parse("refused=bent \nroots=7 \n").is_err());
    }
}
