//! A log as a table: time, and columns that know their names, units and meanings. Every format is
//! written from it.

use super::quantities::{QUANTITIES, WORDS};
use super::record::Record;

/// A flight's log.
pub struct Table {
    /// The flight's name.
    pub name: String,
    /// What was flown.
    pub title: String,
    /// s.
    pub t_s: Vec<f64>,
    /// Those that at least one record has, in order; columns of a topic are neighbours.
    pub columns: Vec<Column>,
}

/// A column of a log.
pub struct Column {
    /// The topic of logs that have topics.
    pub topic: &'static str,
    /// Unique in the table.
    pub name: &'static str,
    /// "1" is the unit of a pure number; words have none.
    pub unit: &'static str,
    /// What it is, for people.
    pub about: &'static str,
    /// As many as the table has times.
    pub values: Values,
}

/// A column's values.
pub enum Values {
    /// Numbers, to single precision: that of the controller. NaN stands for an absent value.
    Numbers(Vec<f32>),
    /// Words, as indices into the list of those that occur.
    Words {
        /// In the order of their first occurrence.
        list: Vec<String>,
        /// One a time; an index that is not in the list is for no word.
        index: Vec<u8>,
    },
}

/// The index of no word.
pub const NO_WORD: u8 = u8::MAX;

impl Table {
    /// The table of these records.
    #[must_use]
    pub fn new(name: &str, title: &str, records: &[Record]) -> Self {
        let words = WORDS.iter().filter_map(|word| {
            let (mut list, mut index) = (Vec::<String>::new(), Vec::with_capacity(records.len()));
            for record in records {
                index.push((word.value)(record).map_or(NO_WORD, |value| {
                    let place = list.iter().position(|other| *other == value).unwrap_or_else(|| {
                        list.push(value);
                        list.len() - 1
                    });
                    u8::try_from(place).unwrap_or(NO_WORD)
                }));
            }
            let values = Values::Words { list, index };
            let column = Column { topic: word.topic, name: word.name, unit: "", about: word.about, values };
            column.index().is_some().then_some(column)
        });
        let mut columns: Vec<Column> = words.collect();
        for quantity in QUANTITIES {
            let taken: Vec<Option<[f64; 4]>> = records.iter().map(quantity.values).collect();
            if taken.iter().all(Option::is_none) {
                continue;
            }
            columns.extend(quantity.columns.iter().enumerate().map(|(place, &(name, unit))| Column {
                topic: quantity.topic,
                name,
                unit,
                about: quantity.about,
                values: Values::Numbers(
                    taken.iter().map(|numbers| numbers.map_or(f32::NAN, |numbers| numbers[place] as f32)).collect(),
                ),
            }));
        }
        Self {
            name: name.to_owned(),
            title: title.to_owned(),
            t_s: records.iter().map(|record| record.t_s).collect(),
            columns,
        }
    }

    /// The topics with their columns.
    pub fn topics(&self) -> impl Iterator<Item = (&'static str, &[Column])> {
        self.columns.chunk_by(|a, b| a.topic == b.topic).map(|columns| (columns[0].topic, columns))
    }

    /// The numbers of the column of this name.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<&[f32]> {
        self.columns.iter().find(|column| column.name == name).and_then(|column| match &column.values {
            Values::Numbers(numbers) => Some(&**numbers),
            Values::Words { .. } => None,
        })
    }

    /// Time of a row in whole microseconds, as logs with topics have it.
    #[must_use]
    pub fn microseconds(&self, row: usize) -> u64 {
        // Times are not negative.
        (1e6 * self.t_s[row]).round() as u64
    }
}

impl Column {
    /// Whether there is a value in this row.
    #[must_use]
    pub fn has(&self, row: usize) -> bool {
        match &self.values {
            Values::Numbers(numbers) => !numbers[row].is_nan(),
            Values::Words { index, .. } => index[row] != NO_WORD,
        }
    }

    /// The first row with a value.
    fn index(&self) -> Option<usize> {
        let rows = match &self.values {
            Values::Numbers(numbers) => numbers.len(),
            Values::Words { index, .. } => index.len(),
        };
        (0..rows).find(|&row| self.has(row))
    }

    /// The word in this row.
    #[must_use]
    pub fn word(&self, row: usize) -> Option<&str> {
        match &self.values {
            Values::Numbers(_) => None,
            Values::Words { list, index } => list.get(usize::from(index[row])).map(String::as_str),
        }
    }
}
