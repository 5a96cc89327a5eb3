//! Logs read back: columns by their names, from CSV or ULog.

use std::collections::{BTreeMap, HashMap};

use super::ulog::{PX4, PX4_READ};

/// A log that can't be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReadError {
    /// It is no CSV.
    #[error("{0}")]
    Csv(String),
    /// It begins like ULog and is none.
    #[error("ULog: {0}")]
    Ulog(String),
    /// A column is missing.
    #[error("no column `{0}`: a log of `hil-sim run` with [estimator] has it, in SI units")]
    Missing(&'static str),
}

/// Rows of time (s) and the columns of these names, NaN where there is no number: of a CSV each
/// line; of ULog each message of the first column's topic, with what the others last said until
/// then, the same instant among it. In ULog a column is a field of its name, or the one of PX4's
/// topics that is the same.
///
/// # Errors
/// [`ReadError`] says what is wrong, or names the column that is missing.
pub fn read<const N: usize>(bytes: &[u8], names: [&'static str; N]) -> Result<Vec<(f64, [f64; N])>, ReadError> {
    if bytes.starts_with(&super::ulog::MAGIC) { from_ulog(bytes, names) } else { from_csv(bytes, names) }
}

fn from_csv<const N: usize>(bytes: &[u8], names: [&'static str; N]) -> Result<Vec<(f64, [f64; N])>, ReadError> {
    let wrong = |error: csv::Error| ReadError::Csv(error.to_string());
    let mut reader = csv::Reader::from_reader(bytes);
    let header = reader.headers().map_err(wrong)?.clone();
    let place = |name| header.iter().position(|column| column.trim() == name).ok_or(ReadError::Missing(name));
    let time = place("t_s")?;
    let mut places = [0; N];
    for (slot, name) in places.iter_mut().zip(names) {
        *slot = place(name)?;
    }
    let row = |line: Result<csv::StringRecord, csv::Error>| {
        let line = line.map_err(wrong)?;
        let number = |place| line.get(place).and_then(|cell: &str| cell.trim().parse().ok()).unwrap_or(f64::NAN);
        Ok((number(time), places.map(number)))
    };
    reader.records().map(row).collect()
}

/// One column of ULog's: where it stands in the messages of its topic.
#[derive(Clone, Copy)]
struct Place {
    topic: u16,
    offset: usize,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Single,
    Double,
}

fn from_ulog<const N: usize>(bytes: &[u8], names: [&'static str; N]) -> Result<Vec<(f64, [f64; N])>, ReadError> {
    let wrong = |what: &str| ReadError::Ulog(what.to_owned());
    let mut formats: HashMap<&str, &str> = HashMap::new();
    let mut topics: BTreeMap<u16, &str> = BTreeMap::new();
    let mut places: Option<[Place; N]> = None;
    let (mut last, mut rows) = ([f64::NAN; N], Vec::new());
    // A row's time, until a datum comes that is later.
    let mut pending: Option<u64> = None;
    let seconds = |time: u64| 1e-6 * time as f64;
    // Past the magic, the version, and the time of its start.
    let mut rest = bytes.get(16..).ok_or_else(|| wrong("it ends in its header"))?;
    while let [low, high, kind, more @ ..] = rest {
        // A log that was cut off by a loss of power ends in a part of a message.
        let Some((body, next)) = more.split_at_checked(usize::from(u16::from_le_bytes([*low, *high]))) else { break };
        rest = next;
        let text = |body| std::str::from_utf8(body).map_err(|_| wrong("a name is no text"));
        match (*kind, body) {
            (b'F', body) => {
                let (name, fields) = text(body)?.split_once(':').ok_or_else(|| wrong("a format without a name"))?;
                formats.insert(name, fields);
            }
            // The first of several sensors of a kind.
            (b'A', [0, low, high, name @ ..]) => {
                topics.insert(u16::from_le_bytes([*low, *high]), text(name)?);
            }
            (b'D', [low, high, data @ ..]) => {
                let topic = u16::from_le_bytes([*low, *high]);
                if !topics.contains_key(&topic) {
                    continue;
                }
                // All topics are declared before the first datum, but those that begin in flight.
                let places = match &places {
                    Some(places) => places,
                    None => places.insert(find(&formats, &topics, names)?),
                };
                let time = data.first_chunk().ok_or_else(|| wrong("a datum without a time"))?;
                let time = u64::from_le_bytes(*time);
                if let Some(earlier) = pending.take_if(|pending| *pending < time) {
                    rows.push((seconds(earlier), last));
                }
                for (value, place) in last.iter_mut().zip(places).filter(|(_, place)| place.topic == topic) {
                    *value = number(data, *place).unwrap_or(f64::NAN);
                }
                if places.first().is_some_and(|first| first.topic == topic) {
                    pending = Some(time);
                }
            }
            _ => {}
        }
    }
    rows.extend(pending.map(|time| (seconds(time), last)));
    if places.is_none() {
        find(&formats, &topics, names)?;
    }
    Ok(rows)
}

/// Where the columns stand: under their own names, or where PX4 has them.
fn find<const N: usize>(
    formats: &HashMap<&str, &str>,
    topics: &BTreeMap<u16, &str>,
    names: [&'static str; N],
) -> Result<[Place; N], ReadError> {
    let mut columns: HashMap<&str, Place> = HashMap::new();
    for (&topic, name) in topics {
        let px4 = PX4.iter().chain(&PX4_READ).find(|(known, _)| known == name).map(|(_, fields)| *fields);
        let mut offset = 0;
        for field in formats.get(name).into_iter().flat_map(|fields| fields.split(';')) {
            let Some((kind, field)) = field.split_once(' ') else { continue };
            let (kind, count) = counted(kind);
            let size = size(formats, kind, 0)?;
            let known = |kind| {
                let same = |declared: &&(&str, &'static [&'static str])| {
                    declared.0.split_once(' ').is_some_and(|(_, name)| name == field)
                };
                let own = std::slice::from_ref(&field);
                let listed = px4.map_or(own, |fields| fields.iter().find(same).map_or(&[], |(_, columns)| *columns));
                listed.iter().take(count).enumerate().map(move |(index, name)| {
                    (*name, Place { topic, offset: usize::saturating_add(offset, index.saturating_mul(size)), kind })
                })
            };
            // What the table's own topics have goes before what is PX4's: they are first.
            let kind = match kind {
                "float" => Some(Kind::Single),
                "double" => Some(Kind::Double),
                _ => None,
            };
            for (name, place) in kind.into_iter().flat_map(known) {
                columns.entry(name).or_insert(place);
            }
            offset = usize::saturating_add(offset, count.saturating_mul(size));
        }
    }
    let mut places = [Place { topic: 0, offset: 0, kind: Kind::Single }; N];
    for (place, name) in places.iter_mut().zip(names) {
        *place = *columns.get(name).ok_or(ReadError::Missing(name))?;
    }
    Ok(places)
}

/// A type without its brackets, and how many there are of it.
fn counted(kind: &str) -> (&str, usize) {
    let array = kind.strip_suffix(']').and_then(|kind| kind.split_once('['));
    array.and_then(|(kind, count)| Some((kind, usize::from(count.parse::<u16>().ok()?)))).unwrap_or((kind, 1))
}

/// Bytes of a type, which may be a topic's within another's.
fn size(formats: &HashMap<&str, &str>, kind: &str, depth: usize) -> Result<usize, ReadError> {
    Ok(match kind {
        "int8_t" | "uint8_t" | "bool" | "char" => 1,
        "int16_t" | "uint16_t" => 2,
        "int32_t" | "uint32_t" | "float" => 4,
        "int64_t" | "uint64_t" | "double" => 8,
        nested => {
            let fields = formats.get(nested).filter(|_| depth < 8);
            let fields = fields.ok_or_else(|| ReadError::Ulog(format!("the type {nested} is not declared")))?;
            let mut sum = 0_usize;
            for (kind, _) in fields.split(';').filter_map(|field| field.split_once(' ')) {
                let (kind, count) = counted(kind);
                sum = sum.saturating_add(count.saturating_mul(size(formats, kind, depth + 1)?));
            }
            sum
        }
    })
}

fn number(data: &[u8], Place { offset, kind, .. }: Place) -> Option<f64> {
    let data = data.get(offset..)?;
    match kind {
        Kind::Single => data.first_chunk().map(|bytes| f32::from_le_bytes(*bytes).into()),
        Kind::Double => data.first_chunk().map(|bytes| f64::from_le_bytes(*bytes)),
    }
}
