//! What is left of flights: a table, CSV files, figures, one HTML page, and a summary for programs.

mod figures;
mod legs;
pub mod live;
pub mod log;
mod map;
pub(crate) mod page;
pub(crate) mod plot;
mod summary;
mod table;

pub use map::map;
pub use table::table;

use std::io;
use std::path::{Path, PathBuf};

use crate::describe::reference::Reference;
use crate::fly::batch::Outcome;
use page::Page;

/// A drawn figure.
pub struct Figure {
    /// File name without ending.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The drawing.
    pub svg: String,
    /// One of the paper's, which its page shows; the flights of the others are there to be played.
    pub is_of_the_paper: bool,
}

/// A report that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file could not be written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A figure could not be drawn.
    #[error("figure {name}: {message}")]
    Figure {
        /// The figure.
        name: String,
        /// Why.
        message: String,
    },
    /// A log could not be encoded.
    #[error("log of {name}: {message}")]
    Log {
        /// The scenario.
        name: String,
        /// Why.
        message: String,
    },
}

/// Writes all files of a report into `folder`, logs in these formats, each complete or not at all,
/// and returns the page's path.
///
/// # Errors
/// [`ReportError`] names the file or figure.
pub fn write(
    folder: &Path,
    outcomes: &[Outcome],
    reference: &Reference,
    formats: &[log::Format],
) -> Result<PathBuf, ReportError> {
    std::fs::create_dir_all(folder).map_err(|error| ReportError::File { path: folder.to_owned(), error })?;
    let mut flights = Vec::with_capacity(outcomes.len());
    for outcome in outcomes {
        let scenario = &outcome.scenario;
        let table = log::Table::new(&scenario.name, &scenario.title, &log::Record::of_flight(outcome));
        log::write(folder, &table, formats)?;
        flights.push((outcome, table));
    }
    let figures = figures::draw(outcomes)?;
    for figure in &figures {
        write_file(&folder.join(format!("{}.svg", figure.name)), figure.svg.as_bytes())?;
    }
    write_file(&folder.join("summary.json"), summary::json(outcomes, reference).as_bytes())?;
    let shown = flights.iter().map(|(outcome, table)| (*outcome, table));
    let (curves, others): (Vec<_>, Vec<_>) = shown.partition(|(outcome, _)| figures::is_curve(outcome));
    let figures = figures.iter().filter(|figure| figure.is_of_the_paper).collect();
    let title = "Path following with a slung load";
    let curve_title = "Curves of every kind";
    let page = folder.join("report.html");
    let mut report = Page { heading: title, flights: others, figures, link: None };
    if report.flights.is_empty() {
        report = Page { heading: curve_title, flights: curves, figures: Vec::new(), link: None };
    } else if !curves.is_empty() {
        let link = Some(("report.html", title));
        let second = Page { heading: curve_title, flights: curves, figures: Vec::new(), link };
        write_file(&folder.join("curves.html"), page::page(&second, reference).as_bytes())?;
        report.link = Some(("curves.html", curve_title));
    }
    write_file(&page, page::page(&report, reference).as_bytes())?;
    Ok(page)
}

/// Writes beside the file first and then renames, so that whatever happens no half-written file has
/// its name.
///
/// # Errors
/// [`ReportError`] names the file.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), ReportError> {
    let partial = partial(path);
    std::fs::write(&partial, content)
        .and_then(|()| std::fs::rename(&partial, path))
        .map_err(|error| ReportError::File { path: path.to_owned(), error })
}

/// What a file is called while it is written.
fn partial(path: &Path) -> PathBuf {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    partial.into()
}

/// Finds out whether a file can be written, before the work that it is for.
///
/// # Errors
/// [`ReportError`] names the file.
pub fn try_file(path: &Path) -> Result<(), ReportError> {
    let partial = partial(path);
    std::fs::write(&partial, [])
        .and_then(|()| std::fs::remove_file(&partial))
        .map_err(|error| ReportError::File { path: path.to_owned(), error })
}

/// Makes a folder for reports, and finds out whether files can be written there, before the work
/// that they are for.
///
/// # Errors
/// [`ReportError`] names the folder.
pub fn try_folder(folder: &Path) -> Result<(), ReportError> {
    std::fs::create_dir_all(folder).map_err(|error| ReportError::File { path: folder.to_owned(), error })?;
    try_file(&folder.join("report"))
}
