//! What a parameter is, for whoever reads it elsewhere: MAVLink's component metadata, which ground
//! stations fetch as files, and a page for people. Both are written from the table as they are
//! asked for, and stand nowhere in memory.

use core::fmt::{self, Write};

use rig::{Entry, Kind};

use crate::settings::entries;

/// A file that ground stations may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum File {
    /// Where the others are: what COMPONENT_METADATA names.
    General,
    /// Every parameter.
    Parameters,
}

impl File {
    const ALL: [Self; 2] = [Self::General, Self::Parameters];

    /// Its name, as a path.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::General => "/general.json",
            Self::Parameters => "/parameters.json",
        }
    }

    /// The file of that name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|file| file.name() == name)
    }

    /// Writes all of it.
    ///
    /// # Errors
    /// The writer's.
    pub fn write(self, out: &mut impl Write) -> fmt::Result {
        match self {
            Self::General => {
                let (name, crc) = (Self::Parameters.name(), Self::Parameters.checksum());
                // 1: COMP_METADATA_TYPE_PARAMETER.
                write!(
                    out,
                    r#"{{"version":1,"vendorName":"","modelName":"slung load","metadataTypes":[{{"type":1,"uri":"mftp://{name}","fileCrc":{crc}}}]}}"#
                )
            }
            Self::Parameters => {
                out.write_str("{\"version\":1,\"parameters\":[")?;
                for (index, entry) in entries().enumerate() {
                    out.write_str(if index == 0 { "\n" } else { ",\n" })?;
                    parameter(entry, out)?;
                }
                out.write_str("\n]}\n")
            }
        }
    }

    /// How long it is, bytes.
    pub(crate) fn length(self) -> u32 {
        let mut window = Window { at: 0, from: u32::MAX, bytes: &mut [] };
        // It takes everything.
        let _ = self.write(&mut window);
        window.at
    }

    /// Its bytes from `offset` on, as many as fit; how many those are.
    pub(crate) fn read(self, offset: u32, bytes: &mut [u8]) -> usize {
        let room = bytes.len() as u32;
        let mut window = Window { at: 0, from: offset, bytes };
        let _ = self.write(&mut window);
        window.at.saturating_sub(offset).min(room) as usize
    }

    /// MAVLink's CRC-32 of it: that of IEEE 802.3, begun at 0 and not inverted.
    #[must_use]
    pub fn checksum(self) -> u32 {
        let mut checksum = Checksum(0);
        let _ = self.write(&mut checksum);
        checksum.0
    }
}

/// A parameter as an object of JSON. No text of the table needs an escape: a test reads all.
fn parameter(entry: &Entry, out: &mut impl Write) -> fmt::Result {
    let Entry { unit, kind, default, min, max, text, .. } = *entry;
    let name = entry.name.as_str();
    write!(
        out,
        r#"{{"name":"{name}","type":"Float","group":"{}","shortDesc":"{text}","units":"{unit}","default":{default},"min":{min},"max":{max}"#,
        group(name)
    )?;
    if kind != Kind::Real {
        out.write_str(r#","decimalPlaces":0,"increment":1"#)?;
    }
    if let Kind::Choice(choices) = kind {
        out.write_str(r#","values":["#)?;
        for (value, choice) in choices.iter().enumerate() {
            let comma = if value == 0 { "" } else { "," };
            write!(out, r#"{comma}{{"value":{value},"description":"{choice}"}}"#)?;
        }
        out.write_str("]")?;
    }
    out.write_str("}")
}

/// The part of a name before its first underscore.
fn group(name: &str) -> &str {
    name.split_once('_').map_or(name, |(group, _)| group)
}

/// Writes the page of all parameters, in Markdown.
///
/// # Errors
/// The writer's.
pub fn page(out: &mut impl Write) -> fmt::Result {
    out.write_str(
        "# Parameters of the flight program\n\nMade by `cargo run --package autopilot --example parameters -- --page`; as MAVLink's \
         component metadata without `--page`.\n\n| parameter | unit | range | default | meaning |\n|---|---|---|---|---|\n",
    )?;
    for entry in entries() {
        let Entry { unit, kind, default, min, max, text, .. } = *entry;
        write!(out, "| `{}` | {unit} | ", entry.name.as_str())?;
        if let Kind::Choice(choices) = kind {
            for (value, choice) in choices.iter().enumerate() {
                let comma = if value == 0 { "" } else { "; " };
                write!(out, "{comma}{value}: {choice}")?;
            }
        } else {
            write!(out, "{min} to {max}{}", if kind == Kind::Whole { ", whole" } else { "" })?;
        }
        // A bar ends a cell.
        write!(out, " | {default} | ")?;
        for part in text.split_inclusive('|') {
            match part.strip_suffix('|') {
                Some(before) => write!(out, "{before}\\|")?,
                None => out.write_str(part)?,
            }
        }
        out.write_str(" |\n")?;
    }
    Ok(())
}

/// Keeps what is written from `from` on, as far as there is room.
struct Window<'a> {
    at: u32,
    from: u32,
    bytes: &'a mut [u8],
}

impl Write for Window<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            if let Some(slot) = self.at.checked_sub(self.from).and_then(|index| self.bytes.get_mut(index as usize)) {
                *slot = byte;
            }
            self.at += 1;
        }
        Ok(())
    }
}

struct Checksum(u32);

impl Write for Checksum {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 ^= u32::from(byte);
            for _ in 0..8 {
                self.0 = if self.0 & 1 == 1 { self.0 >> 1 ^ 0xEDB8_8320 } else { self.0 >> 1 };
            }
        }
        Ok(())
    }
}
