//! The table on disk: rows in the order of their flights, so that it is the same whatever the
//! number of threads or interruptions.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use super::fly::Row;

/// What a folder's results are of. Two folders with equal identities and shards hold equal tables.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// Text of the campaign's file.
    pub campaign: String,
    /// Flights in the whole campaign.
    pub runs: u64,
    /// Of all random numbers.
    pub seed: u64,
    /// Which part of it: flights whose number leaves `index` when divided by `of`.
    pub shard: Shard,
    /// Version and hash of the sources that the program was built from.
    pub build: String,
}

impl Identity {
    /// What makes this another campaign than `other`; `None` if it is the same, or a part of the
    /// same.
    fn differs(&self, other: &Self) -> Option<String> {
        if self.campaign != other.campaign {
            return Some("the campaign's file differs".to_owned());
        }
        let named = |name: &str, ours: &dyn Display, theirs: &dyn Display| {
            let (ours, theirs) = (ours.to_string(), theirs.to_string());
            (ours != theirs).then(|| format!("the {name} differs: {theirs}, not {ours}"))
        };
        named("number of flights", &self.runs, &other.runs)
            .or_else(|| named("seed", &self.seed, &other.seed))
            .or_else(|| named("number of shards", &self.shard.of, &other.shard.of))
            .or_else(|| named("program", &self.build, &other.build))
    }
}

/// A part of a campaign.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// From 0.
    pub index: u64,
    /// Number of parts.
    pub of: u64,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { index: 0, of: 1 };

    /// The flights of this part, in order.
    pub fn runs(self, runs: u64) -> impl Iterator<Item = u64> {
        (self.index..runs).step_by(self.of.max(1) as usize)
    }
}

/// A table that cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A file.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file's contents.
    #[error("{}: {message}", path.display())]
    Contents {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        message: String,
    },
}

/// A folder's table.
pub struct Store {
    path: PathBuf,
    writer: csv::Writer<BufWriter<File>>,
}

impl Store {
    /// Opens the table of `identity` in `folder`, with the rows that are there already. A torn last
    /// line is cut off.
    ///
    /// # Errors
    /// [`StoreError`] if the folder holds another campaign's results, or cannot be read or written.
    pub fn open(folder: &Path, identity: &Identity) -> Result<(Self, Vec<Row>), StoreError> {
        let path = folder.join("runs.csv");
        let fail = |error| StoreError::File { path: path.clone(), error };
        std::fs::create_dir_all(folder).map_err(fail)?;
        let known = folder.join("campaign.json");
        let rows = match read_identity(folder)? {
            Some(other) if other == *identity => read_rows(&path, identity)?,
            Some(other) => {
                let why = identity.differs(&other).unwrap_or_else(|| "the shard differs".to_owned());
                let message =
                    format!("another campaign's results are here ({why}): give another folder, or delete it");
                return Err(StoreError::Contents { path: known, message });
            }
            None if path.exists() => {
                let message = "results, but no campaign.json that says of what: give another folder, or delete them";
                return Err(StoreError::Contents { path, message: message.to_owned() });
            }
            None => {
                let text = serde_json::to_string_pretty(identity).unwrap_or_default();
                crate::report::write_file(&known, text.as_bytes())
                    .map_err(|error| StoreError::File { path: known.clone(), error: io::Error::other(error) })?;
                Vec::new()
            }
        };
        // What is whole is written again in one piece, so that a torn line leaves no trace.
        let mut text = encode(&rows);
        if rows.is_empty() {
            text = header();
        }
        crate::report::write_file(&path, &text).map_err(|error| fail(io::Error::other(error)))?;
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        let writer = csv::WriterBuilder::new().has_headers(false).from_writer(BufWriter::new(file));
        Ok((Self { path, writer }, rows))
    }

    /// Appends rows and has them reach the disk.
    ///
    /// # Errors
    /// [`StoreError`] if they do not.
    pub fn append(&mut self, rows: &[Row]) -> Result<(), StoreError> {
        let written = rows.iter().try_for_each(|row| self.writer.serialize(row).map_err(io::Error::other));
        written
            .and_then(|()| self.writer.flush())
            .map_err(|error| StoreError::File { path: self.path.clone(), error })
    }
}

fn read_identity(folder: &Path) -> Result<Option<Identity>, StoreError> {
    let path = folder.join("campaign.json");
    match std::fs::read_to_string(&path) {
        Ok(text) => serde_json::from_str(&text)
            .map(Some)
            .map_err(|error| StoreError::Contents { path, message: error.to_string() }),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(StoreError::File { path, error }),
    }
}

/// The whole rows of a table: the flights of the shard, in order, up to the first that is not
/// there.
fn read_rows(path: &Path, identity: &Identity) -> Result<Vec<Row>, StoreError> {
    let text = match std::fs::read(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(StoreError::File { path: path.to_owned(), error }),
    };
    let whole = text.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let mut reader = csv::Reader::from_reader(&text[..whole]);
    let mut rows = Vec::new();
    for (row, run) in reader.deserialize::<Row>().zip(identity.shard.runs(identity.runs)) {
        let contents = |message: String| StoreError::Contents { path: path.to_owned(), message };
        let row = row.map_err(|error| contents(error.to_string()))?;
        if row.run != run {
            return Err(contents(format!("flight {} stands where {run} should", row.run)));
        }
        rows.push(row);
    }
    Ok(rows)
}

/// Puts the tables of all shards of one campaign together.
///
/// # Errors
/// [`StoreError`] if they are not the shards of one campaign, all there, once, and complete, or a
/// file cannot be read. It names every folder that is not complete, and every shard that is
/// missing.
pub fn merge(folders: &[PathBuf]) -> Result<(Identity, Vec<Row>), StoreError> {
    let wrong = |folder: &Path, message: String| StoreError::Contents { path: folder.to_owned(), message };
    let merged = |message: String| wrong(Path::new("merge"), message);
    let mut whole: Option<Identity> = None;
    let mut places: BTreeMap<u64, &Path> = BTreeMap::new();
    let (mut rows, mut incomplete) = (Vec::new(), Vec::new());
    for folder in folders {
        let identity =
            read_identity(folder)?.ok_or_else(|| wrong(folder, "there are no results of a campaign".to_owned()))?;
        let Shard { index, of } = identity.shard;
        let found = read_rows(&folder.join("runs.csv"), &identity)?;
        let expected = identity.shard.runs(identity.runs).count();
        if found.len() != expected {
            incomplete.push(format!("{} has {} of its {expected} flights", folder.display(), found.len()));
        }
        // All but which part of it.
        let identity = Identity { shard: Shard { index: 0, of }, ..identity };
        if let Some(why) = whole.get_or_insert_with(|| identity.clone()).differs(&identity) {
            return Err(wrong(folder, format!("not of the same campaign: {why}")));
        }
        if let Some(other) = places.insert(index, folder) {
            return Err(wrong(
                folder,
                format!("shard {}/{of} again, which {} holds, too", index + 1, other.display()),
            ));
        }
        rows.extend(found);
    }
    let identity = whole.ok_or_else(|| merged("no folders".to_owned()))?;
    let of = identity.shard.of;
    let missing = (0..of)
        .filter(|index| !places.contains_key(index))
        .map(|index| format!("shard {}/{of} is missing", index + 1));
    incomplete.extend(missing);
    if !incomplete.is_empty() {
        return Err(merged(format!("{}: the same `campaign` command flies what is left", incomplete.join("; "))));
    }
    rows.sort_by_key(|row| row.run);
    Ok((Identity { shard: Shard::WHOLE, ..identity }, rows))
}

fn encode(rows: &[Row]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("plain fields into memory");
    }
    writer.into_inner().expect("a vector can be flushed")
}

/// The line of names alone.
fn header() -> Vec<u8> {
    let mut text = encode(std::slice::from_ref(&Row::nothing()));
    text.truncate(text.iter().position(|&byte| byte == b'\n').map_or(0, |end| end + 1));
    text
}
