//! Writes the dialect's Rust code from its XML, and the number by which both ends know that they
//! speak the same one.

use std::path::PathBuf;
use std::{env, fs};

const XML: &str = "dialect/slung_load.xml";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo:rerun-if-changed={XML}");
    // Features that generated code asks for and this crate does not have.
    println!("cargo:rustc-check-cfg=cfg(feature, values(\"arbitrary\", \"serde\", \"ts-rs\"))");
    let out = PathBuf::from(env::var("OUT_DIR").map_err(|_| "cargo did not set OUT_DIR")?);
    mavlink_bindgen::generate(mavlink_bindgen::XmlDefinitions::Files(vec![XML]), &out)?;
    // Included, so that the generated file stays a file of its own with its inner attributes;
    // bindgen's mod.rs is for its own crate's features.
    fs::write(out.join("modules.rs"), "pub mod slung_load;")?;
    fs::write(out.join("fingerprint.rs"), fingerprint(&fs::read(XML)?).to_string())?;
    Ok(())
}

/// FNV-1a, folded to the 24 bits that a float holds exactly: a parameter carries it.
fn fingerprint(text: &[u8]) -> u32 {
    let hash = text.iter().fold(0x811C_9DC5_u32, |hash, &byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    (hash >> 24) ^ (hash & 0x00FF_FFFF)
}
