//! A campaign's page: success over where flights started, d_C over time, margins.

use maud::{DOCTYPE, PreEscaped, html};
use plotters::prelude::*;
use std::path::{Path, PathBuf};

use super::fly::{INSTANTS, Row, Verdict};
use super::summary::Summary;
use crate::report::plot::{Area, COLOURS, Curve, Drawn, time_log};
use crate::report::{ReportError, STYLE, write_file};
use crate::study::compare::percentile;

/// Writes `summary.json` and `campaign.html` into `folder` and returns the page's path.
///
/// # Errors
/// [`ReportError`] names the file or figure.
pub fn write(
    folder: &Path,
    title: &str,
    duration_s: f64,
    summary: &Summary,
    rows: &[Row],
) -> Result<PathBuf, ReportError> {
    let mut json = serde_json::to_string_pretty(summary).expect("plain numbers and strings");
    json.push('\n');
    write_file(&folder.join("summary.json"), json.as_bytes())?;
    let page = folder.join("campaign.html");
    write_file(&page, html(title, duration_s, summary, rows)?.as_bytes())?;
    Ok(page)
}

fn html(title: &str, duration_s: f64, summary: &Summary, rows: &[Row]) -> Result<String, ReportError> {
    let figure = |name: &str, size, draw: &dyn Fn(&Area<'_>) -> Drawn| {
        svg(size, draw).map_err(|error| ReportError::Figure { name: name.to_owned(), message: error.to_string() })
    };
    let success = figure("success", (1000, 330), &|area| {
        let parts = area.split_evenly((1, 2));
        share(&parts[0], "distance at the start, m", rows, |row| row.start_distance_m)?;
        share(&parts[1], "speed at the start, m/s", rows, |row| row.start_speed)
    })?;
    let success_2 = figure("success over the vehicle's and the world's", (1000, 330), &|area| {
        let parts = area.split_evenly((1, 2));
        share(&parts[0], "payload, kg", rows, |row| row.payload_mass)?;
        share(&parts[1], "mean wind, m/s", rows, |row| row.wind)
    })?;
    let over_time = figure("d_C over time", (1000, 380), &|area| {
        time_log(area, "d_C, m", 1e-4, &percentiles(duration_s, rows), &[])
    })?;
    let margins = figure("margins", (1000, 330), &|area| {
        let parts = area.split_evenly((1, 3));
        histogram(&parts[0], "least q·e3", rows, |row| row.least_q3)?;
        histogram(&parts[1], "least q·b3", rows, |row| row.least_q_b3)?;
        histogram(&parts[2], "least tension, N", rows, |row| row.least_tension)
    })?;
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Campaign: " (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                pre { (summary.text(rows)) }
                (shown(&success, "Share of good flights over where they started; bars from 0 to 1, the number of flights above."))
                (shown(&success_2, "The same over payload and wind."))
                (shown(&over_time, "Percentiles of the distance from the path over the flights; one that ended early counts 100 m."))
                (shown(&margins, "Least margins of each flight: flights by how near they came to a singularity, which is at zero."))
                h2 { "Flights that failed" }
                div.wide {
                    table {
                        thead { tr { th { "flight" } th { "verdict" } th { "mode" } th { "first fault" } th { "last fault" } th { "largest d_C, m" } } }
                        tbody {
                            @for failure in &summary.failures {
                                tr {
                                    td { (failure.run) } td { (format!("{:?}", failure.verdict)) } td { (failure.mode) }
                                    td { (failure.faults[0]) } td { (failure.faults[1]) } td { (format!("{:.3}", failure.dc_max_m)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    .into_string())
}

fn shown(svg: &str, caption: &str) -> maud::Markup {
    html! { figure { (PreEscaped(svg)) figcaption { (caption) } } }
}

fn svg(size: (u32, u32), draw: &dyn Fn(&Area<'_>) -> Drawn) -> Result<String, Box<dyn std::error::Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    Ok(svg.replacen("<svg ", "<svg stroke-linejoin=\"round\" ", 1))
}

/// d_C's percentiles at the instants that rows have.
fn percentiles(duration_s: f64, rows: &[Row]) -> Vec<Curve> {
    let mut at: Vec<Vec<f64>> = vec![Vec::new(); INSTANTS];
    for row in rows {
        for (slot, text) in at.iter_mut().zip(row.dc_over_time_m.split(';')) {
            slot.extend(text.parse::<f64>());
        }
    }
    let shares = [("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("99.9 %", 0.999)];
    shares
        .into_iter()
        .zip(COLOURS)
        .map(|((label, share), colour)| Curve {
            label: label.to_owned(),
            points: (0..)
                .zip(&mut at)
                .map(|(i, values)| (duration_s * f64::from(i) / INSTANTS as f64, percentile(values, share)))
                .collect(),
            colour,
        })
        .collect()
}

/// Bars of a histogram or of shares.
const BINS: usize = 10;

/// The bins of `value` over its range: edges and rows.
fn bins(rows: &[Row], value: fn(&Row) -> f64) -> (f64, f64, Vec<Vec<&Row>>) {
    let finite = || rows.iter().map(value).filter(|value| value.is_finite());
    let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let (low, width) =
        if high > low { (low, (high - low) / BINS as f64) } else { (finite().next().unwrap_or(0.0), 1.0) };
    let mut bins = vec![Vec::new(); BINS];
    for row in rows.iter().filter(|row| value(row).is_finite()) {
        let bin = ((value(row) - low) / width) as usize;
        bins[bin.min(BINS - 1)].push(row);
    }
    (low, width, bins)
}

fn share(area: &Area<'_>, quantity: &str, rows: &[Row], value: fn(&Row) -> f64) -> Drawn {
    let (low, width, bins) = bins(rows, value);
    let bars = bins
        .iter()
        .map(|bin| {
            let good = bin.iter().filter(|row| row.verdict == Verdict::Good).count();
            (good as f64 / bin.len().max(1) as f64, bin.len())
        })
        .collect::<Vec<_>>();
    columns(area, quantity, "share of good flights", low, width, 1.15, &bars)
}

fn histogram(area: &Area<'_>, quantity: &str, rows: &[Row], value: fn(&Row) -> f64) -> Drawn {
    let (low, width, bins) = bins(rows, value);
    let bars: Vec<(f64, usize)> = bins.iter().map(|bin| (bin.len() as f64, bin.len())).collect();
    let top = bars.iter().fold(1.0_f64, |top, bar| top.max(bar.0));
    columns(area, quantity, "flights", low, width, 1.15 * top, &bars)
}

fn columns(area: &Area<'_>, x: &str, y: &str, low: f64, width: f64, top: f64, bars: &[(f64, usize)]) -> Drawn {
    let mut builder = ChartBuilder::on(area);
    builder.margin(10).x_label_area_size(38).y_label_area_size(56);
    let mut chart = builder.build_cartesian_2d(low..low + width * bars.len() as f64, 0.0..top)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc(x)
        .y_desc(y)
        .label_style(("sans-serif", 13))
        .axis_desc_style(("sans-serif", 14))
        .draw()?;
    let at = |index: usize| low + width * index as f64;
    chart.draw_series(bars.iter().enumerate().filter(|(_, bar)| bar.1 > 0).map(|(index, &(height, _))| {
        Rectangle::new([(at(index) + 0.06 * width, 0.0), (at(index + 1) - 0.06 * width, height)], COLOURS[0].filled())
    }))?;
    chart.draw_series(bars.iter().enumerate().filter(|(_, bar)| bar.1 > 0).map(|(index, &(height, count))| {
        Text::new(count.to_string(), (at(index) + 0.1 * width, height + 0.07 * top), ("sans-serif", 11))
    }))?;
    Ok(())
}
