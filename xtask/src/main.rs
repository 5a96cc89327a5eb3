//! The project's own commands, `cargo xtask …`: what plain cargo can't do alone.

use clap::{Parser, Subcommand};

mod callgraph;
mod cycles;
mod dist;
mod emulator;
mod image;
mod object;
mod report;
mod sbom;
mod simulator;
mod target;
mod thumb;
mod toolchain;

/// Builds for the target and measures on it.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Measures the control step on the emulated Cortex-M4F and M7 in instructions, and in cycles
    /// by published timings, and proves that host and target agree bit for bit.
    #[command(after_help = "Fails if a number exceeds firmware/bench/expected.json or a proof does not hold.\n\n\
        Examples:\n  cargo xtask target\n  cargo xtask target --json\n  cargo xtask target --refresh")]
    Target {
        /// Print one JSON object in place of the table.
        #[arg(long)]
        json: bool,
        /// Write what was measured to the expected values.
        #[arg(long)]
        refresh: bool,
    },
    /// Counts what a control period of a campaign's flight costs the host.
    #[command(after_help = "Needs valgrind, and a release build.\n\nExample:\n  cargo xtask simulator")]
    Simulator,
    /// Builds the C interface as one relocatable object, into dist/.
    #[command(after_help = "Needs binutils for the machine (Debian: binutils-arm-none-eabi).\n\n\
        Examples:\n  cargo xtask object\n  cargo xtask object host cortex-m7\n  cargo xtask object --lean cortex-m4f")]
    Object {
        /// Leave out all curves but the circle, the tracking law, and what parameters mean in
        /// words.
        #[arg(long)]
        lean: bool,
        /// What for.
        #[arg(default_values = ["host", "cortex-m4f", "cortex-m7"])]
        machines: Vec<object::Machine>,
    },
    /// Builds all that others install into dist/: objects, Python wheel, firmware images; with
    /// bills of materials, licences and checksums.
    #[command(after_help = "Needs maturin (`pip install maturin`), and what `object` and `thumb` need.\n\n\
        Examples:\n  cargo xtask dist\n  (cd dist && sha256sum --check SHA256SUMS)")]
    Dist,
    /// Builds the C interface's object twice and compares the bytes.
    #[command(after_help = "Example:\n  cargo xtask reproduce cortex-m4f")]
    Reproduce {
        /// What for.
        #[arg(default_values = ["host", "cortex-m4f", "cortex-m7"])]
        machines: Vec<object::Machine>,
    },
    /// Runs cargo in firmware/ with whichever compiler builds for thumbv7em here.
    #[command(after_help = "Example:\n  cargo xtask thumb build --release")]
    Thumb {
        /// cargo's arguments, its command first.
        #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().command {
        Command::Target { json, refresh } => target::run(json, refresh),
        Command::Simulator => simulator::run(),
        Command::Object { lean, machines } => {
            object::run(&machines, &[if lean { object::Extent::Lean } else { object::Extent::Whole }])
        }
        Command::Dist => dist::run(),
        Command::Reproduce { machines } => dist::reproduce(&machines),
        Command::Thumb { arguments } => {
            let status = toolchain::Toolchain::find()?.cargo(&arguments).status()?;
            anyhow::ensure!(status.success(), "cargo {} failed", arguments.join(" "));
            Ok(())
        }
    }
}
