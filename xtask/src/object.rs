//! `cargo xtask object`: the C interface as one relocatable object for a linker, with nothing
//! global but its own functions.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail, ensure};
use clap::ValueEnum;
use object::{Object, ObjectSection, ObjectSymbol, SectionKind};

use crate::toolchain::{Toolchain, root};

/// What an object is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Machine {
    /// This computer.
    Host,
    /// Cortex-M4 with its floating-point unit, hard-float calls; links into a Cortex-M7 program
    /// too.
    CortexM4f,
    /// Cortex-M7, hard-float calls.
    CortexM7,
}

impl Machine {
    const fn name(self) -> &'static str {
        match self {
            Self::Host => "host",
            Self::CortexM4f => "cortex-m4f",
            Self::CortexM7 => "cortex-m7",
        }
    }

    /// A binutils program for this machine's objects.
    fn tool(self, name: &str) -> Command {
        Command::new(if self == Self::Host { name.to_owned() } else { format!("arm-none-eabi-{name}") })
    }
}

/// What the linker of whoever uses an object must bring, and no more: what GCC takes for granted of
/// any environment, and their names by ARM's ABI and on hosts.
const MEMORY: [&str; 6] = ["memcpy", "memmove", "memset", "memcmp", "memclr", "bcmp"];
/// What the panic handler calls.
const PANIC: &str = "slung_a_panic_is_reachable";

/// How much is in an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All of the interface.
    Whole,
    /// The path-following law on the circle and on routes, and the estimator.
    Lean,
}

impl Extent {
    const fn file(self) -> &'static str {
        match self {
            Self::Whole => "slung.o",
            Self::Lean => "slung-lean.o",
        }
    }
}

/// Builds the objects for `machines` into dist/, with header, CMake and pkg-config files, and says
/// what they take.
pub fn run(machines: &[Machine], extents: &[Extent]) -> Result<()> {
    let dist = root().join("dist");
    let include = dist.join("include");
    std::fs::create_dir_all(&include).with_context(|| format!("cannot make {}", include.display()))?;
    for (from, to) in [
        ("capi/include/slung.h", "include/slung.h"),
        ("capi/slungConfig.cmake", "slungConfig.cmake"),
        ("capi/slung.pc", "slung.pc"),
    ] {
        std::fs::copy(root().join(from), dist.join(to)).with_context(|| format!("cannot copy {from} to dist/"))?;
    }
    for (&machine, &extent) in machines.iter().flat_map(|machine| extents.iter().map(move |extent| (machine, extent)))
    {
        let target = root().join("capi/object/target").join(machine.name());
        let object = build(machine, extent, &target, &dist.join(machine.name()))?;
        let (text, data) = inspect(&object)?;
        println!("{}: {text} B of code and constants, {data} B of data", object.strip_prefix(root())?.display());
    }
    Ok(())
}

/// Builds the object for `machine` by cargo's folder `target` into `folder`, and says where it is.
pub fn build(machine: Machine, extent: Extent, target: &Path, folder: &Path) -> Result<PathBuf> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let object = folder.join(extent.file());
    prelink(machine, &archive(machine, extent, target)?, &object)?;
    Ok(object)
}

/// Builds the static library.
fn archive(machine: Machine, extent: Extent, target: &Path) -> Result<PathBuf> {
    let folder = root().join("capi/object");
    let features = (extent == Extent::Lean).then_some("--no-default-features");
    let arguments: Vec<String> =
        ["build", "--release", "--quiet"].into_iter().chain(features).map(str::to_owned).collect();
    let (mut cargo, triple) = match machine {
        Machine::Host => {
            let mut cargo = Command::new("cargo");
            cargo.args(&arguments);
            (cargo, None)
        }
        Machine::CortexM4f | Machine::CortexM7 => {
            let mut cargo = Toolchain::find()?.cargo_in(&folder, &arguments);
            if machine == Machine::CortexM7 {
                // In place of the folder's own flags, which it repeats.
                cargo.env(
                    "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS",
                    "-C target-cpu=cortex-m7 -C target-feature=-fp64",
                );
            }
            (cargo, Some(crate::toolchain::TRIPLE))
        }
    };
    let status = cargo.current_dir(&folder).arg("--target-dir").arg(target).status().context("cannot run cargo")?;
    ensure!(status.success(), "the C interface does not build for {}", machine.name());
    let target = triple.map_or_else(|| target.to_owned(), |triple| target.join(triple));
    Ok(target.join("release/libslung.a"))
}

/// The interface's functions, read from the header.
fn functions() -> Result<Vec<String>> {
    let header = root().join("capi/include/slung.h");
    let text = std::fs::read_to_string(&header).with_context(|| format!("cannot read {}", header.display()))?;
    let names: Vec<String> = text
        .lines()
        .filter(|line| line.starts_with(char::is_alphabetic) && line.contains('('))
        .filter_map(|line| {
            let name = line.split('(').next()?.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next()?;
            name.starts_with("slung_").then(|| name.to_owned())
        })
        .collect();
    ensure!(!names.is_empty(), "{} declares no function", header.display());
    Ok(names)
}

/// Links `archive` into one relocatable object that keeps the header's functions global, and no
/// others.
fn prelink(machine: Machine, archive: &Path, object: &Path) -> Result<()> {
    let functions = functions()?;
    let whole = object.with_extension("whole.o");
    let mut ld = machine.tool("ld");
    ld.args(["-r", "--gc-sections", "--no-warn-rwx-segments"]);
    ld.args(functions.iter().map(|name| format!("--undefined={name}")));
    finish(ld.arg(archive).arg("-o").arg(&whole))?;
    let mut objcopy = machine.tool("objcopy");
    objcopy.args(["--strip-debug", "--remove-section=.comment", "--remove-section=.llvmbc"]);
    objcopy.args(functions.iter().map(|name| format!("--keep-global-symbol={name}")));
    finish(objcopy.arg(&whole).arg(object))?;
    std::fs::remove_file(&whole)?;
    Ok(())
}

fn finish(command: &mut Command) -> Result<()> {
    let output = command.output().with_context(|| format!("cannot run {}", command.get_program().display()))?;
    ensure!(output.status.success(), "{command:?} failed:\n{}", String::from_utf8_lossy(&output.stderr));
    Ok(())
}

/// Sizes of code and data, bytes. An error if the object defines or needs what it must not.
fn inspect(path: &Path) -> Result<(u64, u64)> {
    let bytes = std::fs::read(path)?;
    let elf = object::File::parse(&*bytes)?;
    let functions = functions()?;
    for symbol in elf.symbols() {
        let name = symbol.name()?;
        if symbol.is_undefined() && !name.is_empty() {
            if name == PANIC {
                bail!("{}: a panic is reachable", path.display());
            }
            let plain = name.trim_start_matches("__aeabi_").trim_end_matches(|c: char| c.is_ascii_digit());
            ensure!(MEMORY.contains(&plain), "{}: {name} is needed, and must not be", path.display());
        } else if symbol.is_global() {
            ensure!(functions.iter().any(|known| known == name), "{}: {name} is global", path.display());
        }
    }
    for name in &functions {
        ensure!(
            elf.symbols().any(|symbol| symbol.is_definition() && symbol.name() == Ok(name)),
            "{}: {name} is declared and missing",
            path.display()
        );
    }
    let (mut constant, mut data) = (0, 0);
    for section in elf.sections() {
        match section.kind() {
            SectionKind::Text | SectionKind::ReadOnlyData | SectionKind::ReadOnlyString => constant += section.size(),
            // Constants with addresses in them: a loader that moves programs writes those, and
            // nobody else does.
            SectionKind::Data if section.name()?.starts_with(".data.rel.ro") => constant += section.size(),
            SectionKind::Data | SectionKind::UninitializedData => data += section.size(),
            _ => {}
        }
    }
    ensure!(data == 0, "{}: {data} B of data, where none is to be", path.display());
    Ok((constant, data))
}
