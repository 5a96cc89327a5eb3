//! Hands the linker the memory map of the chosen board, cortex-m-rt's script that reads it, and
//! defmt's.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let chosen = |board: &str| env::var(format!("CARGO_FEATURE_{board}")).is_ok();
    let maps = [
        ("STM32F405", here.join("../../memory.x")),
        ("STM32H743", here.join("memory/stm32h743.x")),
        ("MPS2", here.join("memory/mps2.x")),
    ];
    let maps: Vec<&Path> = maps.iter().filter(|(board, _)| chosen(board)).map(|(_, map)| map.as_path()).collect();
    let [map] = maps[..] else {
        return Err("choose one board, as in: --no-default-features --features stm32h743".into());
    };
    fs::copy(map, out.join("memory.x"))?;
    if chosen("MPS2") {
        // This board has no peripheral access crate to bring its vectors' defaults.
        fs::copy(here.join("memory/mps2-device.x"), out.join("device.x"))?;
    }
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=-Tdefmt.x");
    println!("cargo:rerun-if-changed={}", map.display());
    println!("cargo:rerun-if-changed=memory");
    Ok(())
}
