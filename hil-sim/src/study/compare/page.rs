//! The comparison's files: `compare.json` for programs, one page of plots for people.

use maud::{DOCTYPE, PreEscaped, html};
use plotters::prelude::*;
use std::path::{Path, PathBuf};

use super::table::length;
use super::{CASES, Case, Comparison, Contender, Row, worse};
use crate::report::plot::{COLOURS, Curve, Drawn, time_log};
use crate::report::{ReportError, STYLE, write_file};

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
            draw(rows).map_err(|error| ReportError::Figure { name: case.name.to_owned(), message: error.to_string() })
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Four laws against the world" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "Four laws against the world" }
                p {
                    "The paper's vehicle on a circle of 5 m at 1 m/s, 500 Hz, law in binary32: " (comparison.runs)
                    " random starts a case, the same for every law, seed " (comparison.seed)
                    ". Equal poles for all: −1…−6, −1…−5, −2, −3. Thrust is limited to 3…60 N, torque to ±3 N·m. Known lag and latency are "
                    "compensated by every law alike. A flight of 40 s is good when its distance d" sub { "C" }
                    " from the circle stays below 25 cm in the last 10 s."
                }
                div.wide {
                    table {
                        thead { tr { th { "case" } th { "what is wrong" } @for law in Contender::ALL { th { (law.name()) } } } }
                        tbody {
                            @for (case, rows) in &flown {
                                tr {
                                    td { a href={ "#" (case.name) } { (case.name) } } td { (case.title) }
                                    @for row in rows {
                                        td { (row.good) " good\n" (length(row.median_dc_m)) "\n(" (length(row.max_dc_m)) ")" }
                                    }
                                }
                            }
                        }
                    }
                }
                p { "Good flights; median and, in brackets, largest of the flights' largest d" sub { "C" } " in the last quarter." }
                pre { (worse(comparison)) }
                @for ((case, _), svg) in flown.iter().zip(&figures) {
                    figure id=(case.name) {
                        (PreEscaped(svg))
                        figcaption { (case.name) ": " (case.title) ". Median (thick) and 95th percentile (thin) of d" sub { "C" } " over the flights." }
                    }
                }
            }
        }
    }
    .into_string())
}

fn draw(rows: &[&Row]) -> Result<String, Box<dyn std::error::Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (1000, 340)).into_drawing_area();
        area.fill(&WHITE)?;
        panel(&area, rows)?;
        area.present()?;
    }
    Ok(svg.replacen("<svg ", "<svg stroke-linejoin=\"round\" ", 1))
}

fn panel(area: &crate::report::plot::Area<'_>, rows: &[&Row]) -> Drawn {
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
