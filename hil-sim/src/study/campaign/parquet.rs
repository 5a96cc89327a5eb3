//! The campaign's table as Parquet, for tools that read columns. Units and meanings of the columns
//! stand in the file's metadata.

use parquet::basic::Compression;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::{Map, Value};
use std::io::Write;
use std::sync::Arc;

use super::fly::Row;
use super::store::StoreError;

/// What a column holds.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Integer,
    Number,
    Text,
    /// Numbers that CSV separates by semicolons.
    List,
}

/// A column of [`Row`]: name, kind, unit, meaning.
type Column = (&'static str, Kind, &'static str, &'static str);

const COLUMNS: [Column; 30] = [
    ("run", Kind::Integer, "1", "Number of the flight"),
    ("verdict", Kind::Text, "", "What became of it"),
    ("end_s", Kind::Number, "s", "When it ended"),
    ("mode", Kind::Text, "", "Mode at the end"),
    ("first_fault", Kind::Text, "", "First fault, empty if there was none"),
    ("last_fault", Kind::Text, "", "Last fault, empty if there was none"),
    ("falls", Kind::Integer, "1", "Times it fell back from engage or follow, asked to follow"),
    ("engage_s", Kind::Number, "s", "Time in engage"),
    ("follow_s", Kind::Number, "s", "Time in follow"),
    ("reached_s", Kind::Number, "s", "Time from which d_C stayed below 25 cm; null if it did not"),
    ("dc_max_m", Kind::Number, "m", "Largest d_C in the last quarter"),
    ("dc_rms_m", Kind::Number, "m", "Root mean square of d_C in the last quarter"),
    ("start_distance_m", Kind::Number, "m", "d_C at the start"),
    ("start_speed", Kind::Number, "m/s", "Speed at the start"),
    ("start_tilt_deg", Kind::Number, "deg", "Tilt at the start"),
    ("start_rod_deg", Kind::Number, "deg", "Angle of the rod at the start"),
    ("payload_mass", Kind::Number, "kg", "Payload"),
    ("wind", Kind::Number, "m/s", "Mean wind"),
    ("least_q3", Kind::Number, "1", "Least q·e3 while the law was asked"),
    ("least_q_b3", Kind::Number, "1", "Least q·b3 while the law was asked"),
    ("least_tension", Kind::Number, "N", "Least tension, by the payload's mass that the law takes"),
    ("least_thrust", Kind::Number, "N", "Least thrust commanded"),
    ("largest_thrust", Kind::Number, "N", "Largest thrust commanded"),
    ("largest_torque", Kind::Number, "N m", "Largest torque commanded about an axis"),
    ("non_finite", Kind::Integer, "1", "Commands that were not finite"),
    ("out_of_limits", Kind::Integer, "1", "Commands outside the limits"),
    ("uav_touchdown_m_s", Kind::Number, "m/s", "Fastest touch of the UAV on the ground; null if there was none"),
    ("load_touchdown_m_s", Kind::Number, "m/s", "Fastest touch of the payload on the ground; null if there was none"),
    ("load_place_m", Kind::Number, "m", "Level distance of the payload from its place; null if it was not to land"),
    ("dc_over_time_m", Kind::List, "m", "d_C at instants evenly over the flight"),
];

/// Rows held at once as columns.
const GROUP: usize = 65_536;

/// A table that can't be made.
#[derive(Debug, thiserror::Error)]
pub enum ParquetError {
    /// Its rows.
    #[error(transparent)]
    Rows(#[from] StoreError),
    /// Its file.
    #[error(transparent)]
    File(#[from] parquet::errors::ParquetError),
}

/// Writes rows as a Parquet file.
///
/// # Errors
/// Those of the rows, of the encoder and of the file.
pub fn write(
    file: impl Write + Send,
    rows: impl Iterator<Item = Result<Row, StoreError>>,
) -> Result<(), ParquetError> {
    let fields = COLUMNS.map(|(name, kind, ..)| match kind {
        Kind::Integer => format!("required int64 {name};"),
        Kind::Number => format!("optional double {name};"),
        Kind::Text => format!("required binary {name} (STRING);"),
        Kind::List => {
            format!("required group {name} (LIST) {{ repeated group list {{ required double element; }} }}")
        }
    });
    let schema = Arc::new(parse_message_type(&format!("message campaign {{ {} }}", fields.concat()))?);
    let described = |key: &str, text: fn(&Column) -> &'static str| {
        let map: Map<String, Value> =
            COLUMNS.iter().map(|column| (column.0.to_owned(), text(column).into())).collect();
        KeyValue::new(key.to_owned(), Value::from(map).to_string())
    };
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(concat!("hil-sim ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(vec![described("units", |c| c.2), described("descriptions", |c| c.3)]))
        .build();
    let mut file = SerializedFileWriter::new(file, schema, Arc::new(properties))?;
    let mut group = Group::new();
    for row in rows {
        group.add(&row?);
        if group.rows == GROUP {
            group.write(&mut file)?;
            group = Group::new();
        }
    }
    if group.rows > 0 {
        group.write(&mut file)?;
    }
    file.close()?;
    Ok(())
}

/// Rows held as columns until they are written.
struct Group {
    rows: usize,
    columns: [Cells; COLUMNS.len()],
}

/// A column's cells, with the levels by which Parquet knows which of them are there.
enum Cells {
    Integers(Vec<i64>),
    Numbers { values: Vec<f64>, there: Vec<i16> },
    Texts(Vec<ByteArray>),
    Lists { values: Vec<f64>, there: Vec<i16>, inside: Vec<i16> },
}

impl Group {
    fn new() -> Self {
        let columns = COLUMNS.map(|(_, kind, ..)| match kind {
            Kind::Integer => Cells::Integers(Vec::new()),
            Kind::Number => Cells::Numbers { values: Vec::new(), there: Vec::new() },
            Kind::Text => Cells::Texts(Vec::new()),
            Kind::List => Cells::Lists { values: Vec::new(), there: Vec::new(), inside: Vec::new() },
        });
        Self { rows: 0, columns }
    }

    fn add(&mut self, row: &Row) {
        let row = serde_json::to_value(row).unwrap_or_default();
        for (cells, (name, ..)) in self.columns.iter_mut().zip(COLUMNS) {
            cells.add(&row[name]);
        }
        self.rows += 1;
    }

    fn write<W: Write + Send>(&self, file: &mut SerializedFileWriter<W>) -> parquet::errors::Result<()> {
        let mut group = file.next_row_group()?;
        for cells in &self.columns {
            let Some(mut column) = group.next_column()? else { break };
            match cells {
                Cells::Integers(values) => column.typed::<Int64Type>().write_batch(values, None, None)?,
                Cells::Numbers { values, there } => {
                    column.typed::<DoubleType>().write_batch(values, Some(there), None)?
                }
                Cells::Texts(values) => column.typed::<ByteArrayType>().write_batch(values, None, None)?,
                Cells::Lists { values, there, inside } => {
                    column.typed::<DoubleType>().write_batch(values, Some(there), Some(inside))?
                }
            };
            column.close()?;
        }
        group.close()?;
        Ok(())
    }
}

impl Cells {
    fn add(&mut self, cell: &Value) {
        match self {
            Self::Integers(values) => values.push(cell.as_i64().unwrap_or_default()),
            // JSON has no NaN and no infinity: null here, too.
            Self::Numbers { values, there } => {
                there.push(i16::from(cell.is_number()));
                values.extend(cell.as_f64());
            }
            Self::Texts(values) => values.push(cell.as_str().unwrap_or_default().into()),
            Self::Lists { values, there, inside } => {
                let numbers =
                    cell.as_str().unwrap_or_default().split(';').filter_map(|text| text.parse::<f64>().ok());
                let before = values.len();
                values.extend(numbers);
                let count = values.len() - before;
                // An empty list is an entry without a value.
                there.extend(std::iter::repeat_n(i16::from(count > 0), count.max(1)));
                inside.extend((0..count.max(1)).map(|place| i16::from(place > 0)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_are_the_rows_fields() {
        let Value::Object(row) = serde_json::to_value(Row::nothing()).unwrap() else { panic!("not an object") };
        assert_eq!(row.len(), COLUMNS.len());
        assert!(COLUMNS.iter().all(|(name, ..)| row.contains_key(*name)));
    }
}
