//! A compiler for thumbv7em: rustup's installed target, or else a system compiler that builds the
//! core library itself.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

/// The target of everything under `firmware/`.
pub const TRIPLE: &str = "thumbv7em-none-eabihf";
/// Where Debian's rustc-web and rust-web-src install to.
const SYSTEM_RUSTC: &str = "/usr/bin/rustc";

/// The repository's root.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies one level below the root")
}

/// What cargo needs to be told so that it builds for [`TRIPLE`].
pub enum Toolchain {
    /// The active toolchain has the target.
    Rustup,
    /// The system's compiler with its own library source, linked by the active toolchain's linker.
    System {
        /// rust-lld.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// The installed target where there is one.
    pub fn find() -> Result<Self> {
        let active = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
        let installed = print(&active, &["--print", "target-libdir", "--target", TRIPLE]);
        if installed.is_ok_and(|library| library.is_dir()) {
            return Ok(Self::Rustup);
        }
        let library =
            print(SYSTEM_RUSTC, &["--print", "sysroot"]).map(|root| root.join("lib/rustlib/src/rust/library"));
        if library.is_ok_and(|library| library.is_dir()) {
            let host = print(&active, &["--print", "target-libdir"])?;
            let linker = host.parent().context("a library folder has a parent")?.join("bin/rust-lld");
            if linker.is_file() {
                return Ok(Self::System { linker });
            }
        }
        bail!("no compiler for {TRIPLE}: run `rustup target add {TRIPLE}`, or on Debian `.ci/install-target`")
    }

    /// A cargo command in `firmware/`, its first argument the subcommand.
    pub fn cargo(&self, arguments: &[String]) -> Command {
        let firmware = root().join("firmware");
        let mut cargo = self.cargo_in(&firmware, arguments);
        cargo.arg("--target-dir").arg(firmware.join("target"));
        cargo
    }

    /// A cargo command in `folder`, whose own configuration it then sees.
    pub fn cargo_in(&self, folder: &Path, arguments: &[String]) -> Command {
        let mut cargo = Command::new("cargo");
        cargo.args(arguments).args(["--target", TRIPLE]).current_dir(folder);
        if let Self::System { linker } = self {
            cargo
                .args(["-Z", "build-std=core"])
                .env("RUSTC", SYSTEM_RUSTC)
                .env("RUSTC_BOOTSTRAP", "1")
                .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", linker);
        }
        cargo
    }
}

/// The path that a compiler prints when asked for one.
fn print(rustc: &str, arguments: &[&str]) -> Result<PathBuf> {
    let output = Command::new(rustc).args(arguments).output().with_context(|| format!("cannot run {rustc}"))?;
    anyhow::ensure!(output.status.success(), "{rustc} failed: {}", String::from_utf8_lossy(&output.stderr));
    Ok(PathBuf::from(String::from_utf8(output.stdout)?.trim()))
}
