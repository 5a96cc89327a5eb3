//! The comparison's files: `compare.json` for programs, one page of plots for people.

use maud::{DOCTYPE, Markup, html};
use plotters::prelude::*;
use std::path::{Path, PathBuf};

use super::table::length;
use super::{CASES, Case, Comparison, Contender, Row, worse};
use crate::report::page::{figure, head};
use crate::report::plot::{Area, COLOURS, Curve, Drawn, drawing, time_log};
use crate::report::{ReportError, write_file};

/// Writes `compare.json` and `compare.html` into `folder` and returns the page's path.
///
/// # Errors
/// [`ReportError`] names the file or figure.
pub fn write(folder: &Path, comparison: &Comparison) -> Result<PathBuf, ReportError> {
    std::fs::create_dir_all(folder).map_err(|error| ReportError::File { path: folder.to_owned(), error })?;
    let mut json = serde_json::to_string_pretty(comparison).expect("plain numbers and strings");
    json.push('\n');
    write_file(&folder.join("compare.json"), json.as_bytes())?;
    let page = folder.join("compare.html");
    write_file(&page, html(comparison)?.as_bytes())?;
    Ok(page)
}

fn html(comparison: &Comparison) -> Result<String, ReportError> {
    let flown: Vec<(&Case, Vec<&Row>)> = CASES
        .iter()
        .map(|case| (case, comparison.of_case(case.name).collect::<Vec<_>>()))
        .filter(|(_, rows)| !rows.is_empty())
        .collect();
    let figures = flown
        .iter()
        .map(|(case, rows)| {
            let caption = format!(
                "{}: {}. Median (thick) and 95th percentile (thin) of d_C over the flights.",
                case.name, case.title
            );
            Ok(figure(case.name, &drawing(case.name, &caption, (1000, 340), |area| panel(area, rows))?, &caption))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let heading = "Four laws against the world";
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(heading))
            body {
                main {
                    h1 { (heading) }
                    p {
                        "The paper's vehicle on a circle of 5 m at 1 m/s, 500 Hz, law in binary32: " (comparison.runs)
                        " random starts a case, the same for every law, seed " (comparison.seed)
                        ". Equal poles for all: −1…−6, −1…−5, −2, −3. Thrust is limited to 3…60 N, torque to ±3 N·m. Known lag and latency are "
                        "compensated by every law alike. A flight of 40 s is good when its distance d" sub { "C" }
                        " from the circle stays below 25 cm in the last 10 s."
                    }
                    (cases(&flown))
                    pre tabindex="0" { (worse(comparison)) }
                    @for figure in figures { (figure) }
                }
            }
        }
    }
    .into_string())
}

fn cases(flown: &[(&Case, Vec<&Row>)]) -> Markup {
    html! {
        div.wide role="region" aria-label="Cases and laws" tabindex="0" {
            table.results {
                caption { "Good flights; median and, in brackets, largest of the flights' largest d" sub { "C" } " in the last quarter." }
                thead {
                    tr {
                        th.words scope="col" { "case" }
                        th.words scope="col" { "what is wrong" }
                        @for law in Contender::ALL { th scope="col" { (law.name()) } }
                    }
                }
                tbody {
                    @for (case, rows) in flown {
                        tr {
                            th scope="row" { a href={ "#" (case.name) } { (case.name) } }
                            td.words { (case.title) }
                            @for row in rows {
                                td { (row.good) " good\n" (length(row.median_dc_m)) "\n(" (length(row.max_dc_m)) ")" }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn panel(area: &Area<'_>, rows: &[&Row]) -> Drawn {
    let curve = |row: &Row, column: usize, label: String, colour| Curve {
        label,
        points: row.trace.iter().map(|point| (point[0], point[column])).collect(),
        colour,
    };
    let medians = rows.iter().zip(COLOURS).map(|(row, colour)| curve(row, 1, row.law.name().to_owned(), colour));
    let tails = rows.iter().zip(COLOURS).map(|(row, colour)| curve(row, 2, String::new(), colour.mix_white()));
    let curves: Vec<Curve> = tails.chain(medians).collect();
    time_log(area, "d_C, m", 1e-5, &curves, &[])
}

/// A paler shade, for what is beside the point.
trait Pale {
    fn mix_white(self) -> Self;
}

impl Pale for RGBColor {
    fn mix_white(self) -> Self {
        let pale = |part: u8| part / 2 + 127;
        Self(pale(self.0), pale(self.1), pale(self.2))
    }
}
