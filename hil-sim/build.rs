//! Names the build: a hash of all sources that decide what a flight does.

use std::io;
use std::path::{Path, PathBuf};

/// The crates beside this one.
const CRATES: [&str; 6] = ["controller", "estimator", "fpu", "model", "rig", "witness"];
/// The folders of this one.
const FOLDERS: [&str; 4] = ["src/describe", "src/fly", "src/study", "src/world"];

fn main() -> io::Result<()> {
    let root = Path::new("..");
    let mut files = vec![root.join("Cargo.lock")];
    for folder in CRATES.map(|name| root.join(name).join("src")).into_iter().chain(FOLDERS.map(PathBuf::from)) {
        println!("cargo:rerun-if-changed={}", folder.display());
        collect(&folder, &mut files)?;
    }
    println!("cargo:rerun-if-changed=../Cargo.lock");
    files.sort();
    let mut hash = Fnv::new();
    for file in files {
        // Without its folders' separators, which differ between systems.
        file.iter().for_each(|part| hash.take(part.as_encoded_bytes()));
        // Nor do line ends count.
        std::fs::read(&file)?.split(|&byte| byte == b'\n').for_each(|line| hash.take(line.trim_ascii_end()));
    }
    println!("cargo:rustc-env=BUILD={}+{:016x}", env!("CARGO_PKG_VERSION"), hash.0);
    Ok(())
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    // A crate that is packaged has its neighbours elsewhere.
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { collect(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

/// Fowler's, Noll's and Vo's hash FNV-1a, 64 bits.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Takes a piece and its end.
    fn take(&mut self, piece: &[u8]) {
        for &byte in piece.iter().chain(b"\n") {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
