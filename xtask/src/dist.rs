//! `cargo xtask dist`: everything that others install, into dist/, with what they have to know of
//! it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use sha2::{Digest, Sha256};

use crate::object::{self, Extent, Machine};
use crate::sbom::{self, Product};
use crate::toolchain::{Toolchain, root};

/// Boards that a firmware image is made for, as features of firmware/app.
const BOARDS: [&str; 3] = ["stm32f405", "stm32h743", "mps2"];

/// What is shipped, and the package whose dependencies are in it.
const PRODUCTS: [Product; 4] = [
    Product { name: "slung-object", manifest: "capi/object/Cargo.toml", package: "slung" },
    Product { name: "slung-python", manifest: "Cargo.toml", package: "slung-python" },
    Product { name: "hil-sim", manifest: "Cargo.toml", package: "hil-sim" },
    Product { name: "firmware", manifest: "firmware/Cargo.toml", package: "firmware" },
];

/// Builds objects, wheel and firmware images, and writes their bills of materials, the licences of
/// what is in them, and checksums of all.
pub fn run() -> Result<()> {
    let dist = root().join("dist");
    if dist.exists() {
        std::fs::remove_dir_all(&dist).with_context(|| format!("cannot empty {}", dist.display()))?;
    }
    object::run(&[Machine::Host, Machine::CortexM4f, Machine::CortexM7], &[Extent::Whole, Extent::Lean])?;
    wheel(&dist)?;
    firmware(&dist.join("firmware"))?;

    let mut bills = Vec::new();
    for product in &PRODUCTS {
        let bill = sbom::bill(product)?;
        let text = serde_json::to_string_pretty(&bill.json())? + "\n";
        write(&dist.join("sbom").join(format!("{}.cdx.json", product.name)), text.as_bytes())?;
        bills.push(bill);
    }
    write(&dist.join("THIRD-PARTY-LICENSES.txt"), sbom::notices(&bills)?.as_bytes())?;
    for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
        write(&dist.join(licence), &std::fs::read(root().join(licence))?)?;
    }

    let sums = checksums(&dist)?;
    write(&dist.join("SHA256SUMS"), sums.as_bytes())?;
    print!("{sums}");
    Ok(())
}

/// Builds each object twice, in folders of their own, and compares the bytes.
pub fn reproduce(machines: &[Machine]) -> Result<()> {
    let scratch = root().join("target/reproduce");
    for &machine in machines {
        let builds = ["first", "second"].map(|name| scratch.join(name));
        let objects =
            builds.each_ref().map(|folder| object::build(machine, Extent::Whole, folder, &folder.join("out")));
        let [first, second] = objects;
        let [first, second] = [first?, second?].map(|path| std::fs::read(&path).map(|bytes| hex(&bytes)));
        let (first, second) = (first?, second?);
        ensure!(first == second, "two builds of {machine:?} differ: {first} and {second}");
        println!("{machine:?}: two builds, the same bytes, {first}");
    }
    std::fs::remove_dir_all(&scratch)?;
    Ok(())
}

/// The wheel, for every Python from 3.10 on.
fn wheel(dist: &Path) -> Result<()> {
    let mut maturin = Command::new("maturin");
    maturin.args(["build", "--manifest-path", "python/Cargo.toml", "--out"]).arg(dist.join("wheels"));
    maturin.arg("--target-dir").arg(root().join("target/dist")).current_dir(root());
    // Neither where this computer keeps its sources nor when it built is in the wheel.
    let home = std::env::var("CARGO_HOME").or_else(|_| std::env::var("HOME").map(|home| format!("{home}/.cargo")))?;
    let remap = |from: &str, to: &str| format!("--remap-path-prefix={from}={to}");
    maturin.env("RUSTFLAGS", [remap(&home, "cargo"), remap(&root().display().to_string(), "slung")].join(" "));
    maturin.env("SOURCE_DATE_EPOCH", committed()?);
    let status = maturin.status().context("cannot run maturin: `pip install maturin` brings it")?;
    ensure!(status.success(), "the wheel does not build");
    Ok(())
}

/// When what is checked out was committed, s since 1970.
fn committed() -> Result<String> {
    let output = Command::new("git").args(["log", "-1", "--format=%ct"]).current_dir(root()).output()?;
    ensure!(output.status.success(), "git does not say when this was committed");
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}

/// An ELF image a board, with its debug information left out.
fn firmware(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for board in BOARDS {
        let arguments =
            ["build", "--release", "--quiet", "--package", "firmware", "--no-default-features", "--features", board];
        let mut cargo = Toolchain::find()?.cargo(&arguments.map(str::to_owned));
        // Another board's image lies in the same place: it is copied before the next is built.
        ensure!(cargo.status()?.success(), "the firmware does not build for {board}");
        let built = root().join("firmware/target").join(crate::toolchain::TRIPLE).join("release/firmware");
        let image = folder.join(format!("firmware-{board}.elf"));
        let strip = Command::new("arm-none-eabi-objcopy").arg("--strip-debug").arg(&built).arg(&image).status();
        ensure!(strip.context("cannot run arm-none-eabi-objcopy")?.success(), "{} is not written", image.display());
    }
    Ok(())
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().context("a file has a folder")?;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

/// A line for each file, as `sha256sum --check` reads it.
fn checksums(folder: &Path) -> Result<String> {
    let mut files = Vec::new();
    list(folder, &mut files)?;
    files.sort();
    let mut text = String::new();
    for file in files {
        let bytes = std::fs::read(&file)?;
        writeln!(text, "{}  {}", hex(&bytes), file.strip_prefix(folder)?.display())?;
    }
    Ok(text)
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { list(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
