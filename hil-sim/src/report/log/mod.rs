//! Logs of flights in the formats of the field, each written from one [`Table`].

mod csv;
mod mcap;
mod quantities;
mod read;
mod record;
mod table;
mod ulog;

pub use read::{ReadError, read};
pub use record::Record;
pub use table::{Column, Table, Values};
pub use ulog::{MOTORS, OUTPUTS};

use std::path::Path;

use super::{ReportError, write_file};

/// A format of logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// NAME.csv, with units and meanings in NAME.csv-metadata.json.
    Csv,
    /// NAME.ulg, for Flight Review, PlotJuggler and pyulog.
    Ulog,
    /// NAME.mcap, for Foxglove and PlotJuggler.
    Mcap,
}

/// Writes the log into `folder`, once a format.
///
/// # Errors
/// [`ReportError`] names the file.
pub fn write(folder: &Path, table: &Table, formats: &[Format]) -> Result<(), ReportError> {
    let name = &table.name;
    for format in formats {
        match format {
            Format::Csv => {
                write_file(&folder.join(format!("{name}.csv")), &csv::encode(table))?;
                write_file(&folder.join(format!("{name}.csv-metadata.json")), &csv::metadata(table))?;
            }
            Format::Ulog => write_file(&folder.join(format!("{name}.ulg")), &ulog::encode(table))?,
            Format::Mcap => {
                let bytes = mcap::encode(table)
                    .map_err(|error| ReportError::Log { name: name.clone(), message: error.to_string() })?;
                write_file(&folder.join(format!("{name}.mcap")), &bytes)?;
            }
        }
    }
    Ok(())
}
