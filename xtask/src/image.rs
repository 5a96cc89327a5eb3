//! Building the bench image, and what can be read from it without running it.

use std::path::PathBuf;
use std::process::Stdio;

use anyhow::{Context, Result, bail, ensure};
use object::{Object, ObjectSection, ObjectSymbol, SectionKind};

use crate::callgraph::CallGraph;
use crate::toolchain::{TRIPLE, Toolchain, root};

/// What the bench's panic handler calls, and what nobody defines.
const UNDEFINED: &str = "undefined symbol: a_panic_is_reachable";

/// A linked bench image.
pub struct Image {
    /// The ELF file.
    pub path: PathBuf,
    /// It linked with a panic handler that calls an undefined symbol.
    pub panic_free: bool,
    /// Symbols of double-precision emulation.
    pub soft_doubles: Vec<String>,
    /// Symbols of a memory allocator.
    pub allocators: Vec<String>,
    /// Code and literals, bytes.
    pub text: u64,
    /// Constant data, bytes.
    pub constants: u64,
    /// Initialized and zeroed static data, bytes.
    pub statics: u64,
    /// Its functions.
    pub calls: CallGraph,
}

impl Image {
    /// Builds the bench. If a panic is reachable it builds once more without that proof, for the
    /// other numbers' sake.
    pub fn build(toolchain: &Toolchain) -> Result<Self> {
        let panic_free = match link(toolchain, &[])? {
            Ok(()) => true,
            Err(message) if message.contains(UNDEFINED) => {
                if let Err(message) = link(toolchain, &["--features", "reachable-panics"])? {
                    bail!("the bench does not build:\n{message}");
                }
                false
            }
            Err(message) => bail!("the bench does not build:\n{message}"),
        };
        let path = root().join("firmware/target").join(TRIPLE).join("release/bench");
        let bytes = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let elf = object::File::parse(&*bytes)?;
        let names: Vec<&str> = elf.symbols().filter_map(|symbol| symbol.name().ok()).collect();
        ensure!(!names.is_empty(), "{} has no symbols: nothing could be proved of it", path.display());
        let chosen = |choose: fn(&str) -> bool| {
            names.iter().filter(|name| choose(name)).map(|name| (*name).to_owned()).collect()
        };
        let bytes_of = |kinds: &[SectionKind]| -> u64 {
            elf.sections().filter(|section| kinds.contains(&section.kind())).map(|section| section.size()).sum()
        };
        Ok(Self {
            panic_free,
            soft_doubles: chosen(is_soft_double),
            allocators: chosen(is_allocator),
            text: bytes_of(&[SectionKind::Text]),
            constants: bytes_of(&[SectionKind::ReadOnlyData]),
            statics: bytes_of(&[SectionKind::Data, SectionKind::UninitializedData]),
            calls: CallGraph::read(&elf)?,
            path,
        })
    }
}

/// Runs the build; the inner error is what cargo printed.
fn link(toolchain: &Toolchain, features: &[&str]) -> Result<Result<(), String>> {
    let arguments: Vec<String> = ["build", "--quiet", "--release", "--package", "bench"]
        .iter()
        .chain(features)
        .map(ToString::to_string)
        .collect();
    let output = toolchain.cargo(&arguments).stdout(Stdio::null()).output().context("cannot run cargo")?;
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    Ok(if output.status.success() { Ok(()) } else { Err(message) })
}

/// Names of the ARM run-time ABI (`__aeabi_dadd`, `__aeabi_f2d`, …) and of the compiler's own
/// (`__adddf3`, `__extendsfdf2`, …).
fn is_soft_double(name: &str) -> bool {
    match name.strip_prefix("__aeabi_") {
        Some(name) => {
            ["dadd", "dsub", "drsub", "dmul", "ddiv", "dneg", "dcmp", "d2"].iter().any(|op| name.starts_with(op))
                || name.ends_with("2d")
        }
        None => {
            name.starts_with("__")
                && (name.contains("df2")
                    || name.contains("df3")
                    || name.contains("dfs")
                    || name.contains("dfd")
                    || name.ends_with("df"))
        }
    }
}

fn is_allocator(name: &str) -> bool {
    ["malloc", "free", "calloc", "realloc"].contains(&name)
        || name.contains("__rust_alloc")
        || name.contains("__rdl_alloc")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn double_precision_is_told_from_single() {
        for name in [
            "__aeabi_dmul",
            "__aeabi_f2d",
            "__aeabi_ui2d",
            "__aeabi_d2iz",
            "__muldf3",
            "__floatsidf",
            "__fixdfsi",
            "__gedf2",
        ] {
            assert!(is_soft_double(name), "{name}");
        }
        for name in
            ["__aeabi_memcpy", "__aeabi_uldivmod", "__aeabi_f2lz", "__aeabi_idiv", "__mulsf3", "__sidata", "main"]
        {
            assert!(!is_soft_double(name), "{name}");
        }
    }
}
