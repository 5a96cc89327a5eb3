//! The table on disk: rows in the order of their flights, so that it is the same whatever the
//! number of threads or interruptions.

use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use std::fmt::Display;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, BufWriter, Seek, SeekFrom};
use std::iter::StepBy;
use std::ops::Range;
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
    pub fn runs(self, runs: u64) -> StepBy<Range<u64>> {
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

/// A folder's table, under way.
pub struct Store {
    path: PathBuf,
    writer: csv::Writer<BufWriter<File>>,
}

impl Store {
    /// Opens the table of `identity` in `folder`, and counts the flights that are there already. A
    /// torn last line is cut off.
    ///
    /// # Errors
    /// [`StoreError`] if the folder holds another campaign's results, or cannot be read or written.
    pub fn open(folder: &Path, identity: &Identity) -> Result<(Self, usize), StoreError> {
        let path = folder.join("runs.csv");
        let fail = |error| StoreError::File { path: path.clone(), error };
        std::fs::create_dir_all(folder).map_err(fail)?;
        let known = folder.join("campaign.json");
        let mut rows = Rows::of(folder, identity);
        match read_identity(folder)? {
            Some(other) if other == *identity => {}
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
            }
        }
        let done = rows.by_ref().try_fold(0, |done, row| row.map(|_| done + 1))?;
        if done == 0 {
            crate::report::write_file(&path, &header()).map_err(|error| fail(io::Error::other(error)))?;
        }
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        if done > 0 {
            file.set_len(rows.end).map_err(fail)?;
        }
        let writer = csv::WriterBuilder::new().has_headers(false).from_writer(BufWriter::new(file));
        Ok((Self { path, writer }, done))
    }

    /// Appends a row; [`Store::flush`] has it reach the disk.
    ///
    /// # Errors
    /// [`StoreError`] if it can't.
    pub fn append(&mut self, row: &Row) -> Result<(), StoreError> {
        let written = self.writer.serialize(row);
        written.map_err(|error| StoreError::File { path: self.path.clone(), error: io::Error::other(error) })
    }

    /// Has all rows reach the disk.
    ///
    /// # Errors
    /// [`StoreError`] if they do not.
    pub fn flush(&mut self) -> Result<(), StoreError> {
        self.writer.flush().map_err(|error| StoreError::File { path: self.path.clone(), error })
    }
}

fn read_identity(folder: &Path) -> Result<Option<Identity>, StoreError> {
    let path = folder.join("campaign.json");
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(StoreError::File { path, error }),
    };
    match serde_json::from_str::<Identity>(&text) {
        Ok(identity) if identity.shard.index < identity.shard.of => Ok(Some(identity)),
        Ok(Identity { shard: Shard { index, of }, .. }) => {
            let message = format!("shard.index {index} is not below shard.of {of}");
            Err(StoreError::Contents { path, message })
        }
        Err(error) => Err(StoreError::Contents { path, message: error.to_string() }),
    }
}

/// The whole rows of a table: the flights of the shard, in order, up to the first that is not
/// there. Few are held at once, and no file is open in between, so that a merge's memory does not
/// grow with its flights, nor its open files with its shards.
pub struct Rows {
    path: PathBuf,
    /// Flights that are still to come.
    runs: StepBy<Range<u64>>,
    /// Rows that have been read, and where each ends in the file.
    ahead: VecDeque<(Row, u64)>,
    /// Where the last row that was returned ends in the file.
    end: u64,
}

impl Rows {
    /// Rows read at once.
    const BLOCK: usize = 64;

    /// The rows of the campaign, or part of one, `identity` in `folder`.
    #[must_use]
    pub fn of(folder: &Path, identity: &Identity) -> Self {
        let runs = identity.shard.runs(identity.runs);
        Self { path: folder.join("runs.csv"), runs, ahead: VecDeque::new(), end: 0 }
    }

    fn contents(&self, message: String) -> StoreError {
        StoreError::Contents { path: self.path.clone(), message }
    }

    /// Reads what comes next, up to a line that is not whole.
    fn read_ahead(&mut self) -> Result<(), StoreError> {
        let mut lines = self.lines().map_err(|error| StoreError::File { path: self.path.clone(), error })?;
        let mut end = self.end;
        if end == 0 && !lines.is_empty() {
            let names = lines.remove(0);
            if names != header() {
                return Err(self.contents("its first line does not name the columns of this program".to_owned()));
            }
            end += names.len() as u64;
        }
        let text = lines.concat();
        let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_slice()).into_deserialize();
        for line in lines {
            let Some(Ok(row)) = rows.next() else {
                let line = String::from_utf8_lossy(&line);
                return Err(self.contents(format!("no flight of a campaign: {:?}", line.trim_end())));
            };
            end += line.len() as u64;
            self.ahead.push_back((row, end));
        }
        Ok(())
    }

    /// The next lines that are whole.
    fn lines(&self) -> io::Result<Vec<Vec<u8>>> {
        let mut file = match File::open(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            file => file?,
        };
        file.seek(SeekFrom::Start(self.end))?;
        let mut file = BufReader::new(file);
        let mut lines = Vec::with_capacity(Self::BLOCK);
        while lines.len() < Self::BLOCK {
            let mut line = Vec::new();
            file.read_until(b'\n', &mut line)?;
            if line.last() != Some(&b'\n') {
                break;
            }
            lines.push(line);
        }
        Ok(lines)
    }
}

impl Iterator for Rows {
    type Item = Result<Row, StoreError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ahead.is_empty()
            && let Err(error) = self.read_ahead()
        {
            return Some(Err(error));
        }
        let (row, end) = self.ahead.pop_front()?;
        let run = self.runs.next()?;
        if row.run != run {
            return Some(Err(self.contents(format!("flight {} stands where {run} should", row.run))));
        }
        self.end = end;
        Some(Ok(row))
    }
}

/// Puts the tables of all shards of one campaign together in the folder `into`, row by row.
///
/// # Errors
/// [`StoreError`] if they are not the shards of one campaign, all there, once, and complete, or a
/// file cannot be read or written. It names every folder that is not complete, and every shard that
/// is missing.
pub fn merge(folders: &[PathBuf], into: &Path) -> Result<Identity, StoreError> {
    let wrong = |folder: &Path, message: String| StoreError::Contents { path: folder.to_owned(), message };
    let merged = |message: String| wrong(Path::new("merge"), message);
    let mut whole: Option<Identity> = None;
    let mut shards: BTreeMap<u64, (&Path, Rows)> = BTreeMap::new();
    let mut incomplete = Vec::new();
    for folder in folders {
        let identity =
            read_identity(folder)?.ok_or_else(|| wrong(folder, "there are no results of a campaign".to_owned()))?;
        let Shard { index, of } = identity.shard;
        let found = Rows::of(folder, &identity).try_fold(0, |found, row| row.map(|_| found + 1))?;
        let expected = identity.shard.runs(identity.runs).count();
        if found != expected {
            incomplete.push(format!("{} has {found} of its {expected} flights", folder.display()));
        }
        let rows = Rows::of(folder, &identity);
        // All but which part of it.
        let identity = Identity { shard: Shard { index: 0, of }, ..identity };
        if let Some(why) = whole.get_or_insert_with(|| identity.clone()).differs(&identity) {
            return Err(wrong(folder, format!("not of the same campaign: {why}")));
        }
        if let Some((other, _)) = shards.insert(index, (folder, rows)) {
            return Err(wrong(
                folder,
                format!("shard {}/{of} again, which {} holds, too", index + 1, other.display()),
            ));
        }
    }
    let identity = whole.ok_or_else(|| merged("no folders".to_owned()))?;
    let of = identity.shard.of;
    let missing = (0..of)
        .filter(|index| !shards.contains_key(index))
        .map(|index| format!("shard {}/{of} is missing", index + 1));
    incomplete.extend(missing);
    if !incomplete.is_empty() {
        return Err(merged(format!("{}: the same `campaign` command flies what is left", incomplete.join("; "))));
    }
    let identity = Identity { shard: Shard::WHOLE, ..identity };
    let (mut store, done) = Store::open(into, &identity)?;
    let mut shards: Vec<(&Path, Rows)> = shards.into_values().collect();
    for run in 0..identity.runs {
        let (folder, rows) = &mut shards[(run % of) as usize];
        let row = rows.next().ok_or_else(|| wrong(folder, format!("flight {run} is not there any more")))??;
        if run >= done as u64 {
            store.append(&row)?;
        }
    }
    store.flush()?;
    Ok(identity)
}

/// The line of the columns' names.
fn header() -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.serialize(Row::nothing()).expect("plain fields into memory");
    let mut text = writer.into_inner().expect("a vector can be flushed");
    text.truncate(text.iter().position(|&byte| byte == b'\n').map_or(0, |end| end + 1));
    text
}
