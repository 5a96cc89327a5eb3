//! A campaign's page: success over where flights started, d_C over time, margins.

use maud::{DOCTYPE, Markup, html};
use plotters::prelude::*;
use std::path::{Path, PathBuf};

use super::fly::INSTANTS;
use super::summary::Summary;
use super::tally::Tally;
use crate::report::page::{figure, head};
use crate::report::plot::{Area, COLOURS, Curve, Drawn, FINE, drawing, time_log};
use crate::report::{ReportError, write_file};

/// Writes `summary.json` and `campaign.html` into `folder` and returns the page's path.
///
/// # Errors
/// [`ReportError`] names the file or figure.
pub fn write(
    folder: &Path,
    title: &str,
    duration_s: f64,
    summary: &Summary,
    tally: &Tally,
) -> Result<PathBuf, ReportError> {
    let mut json = serde_json::to_string_pretty(summary).expect("plain numbers and strings");
    json.push('\n');
    write_file(&folder.join("summary.json"), json.as_bytes())?;
    let page = folder.join("campaign.html");
    write_file(&page, html(title, duration_s, summary, tally)?.as_bytes())?;
    Ok(page)
}

fn html(title: &str, duration_s: f64, summary: &Summary, tally: &Tally) -> Result<String, ReportError> {
    let start = "Share of good flights over where they started; bars from 0 to 1, the number of flights above.";
    let success = drawing("success", start, (1000, 330), |area| {
        let parts = area.split_evenly((1, 2));
        share(&parts[0], "distance at the start, m", tally, &tally.start_distance_m)?;
        share(&parts[1], "speed at the start, m/s", tally, &tally.start_speed)
    })?;
    let drawn = "The same over payload and wind.";
    let success_2 = drawing("success-drawn", drawn, (1000, 330), |area| {
        let parts = area.split_evenly((1, 2));
        share(&parts[0], "payload, kg", tally, &tally.payload_mass)?;
        share(&parts[1], "mean wind, m/s", tally, &tally.wind)
    })?;
    let percentile = "Percentiles of the distance from the path over the flights; one that ended early counts 100 m.";
    let over_time = drawing("distance", percentile, (1000, 380), |area| {
        time_log(area, "d_C, m", 1e-4, &percentiles(duration_s, tally), &[])
    })?;
    let least = "Least margins of each flight: flights by how near they came to a singularity, which is at zero.";
    let margins = drawing("margins", least, (1000, 330), |area| {
        let parts = area.split_evenly((1, 3));
        histogram(&parts[0], "least q·e3", tally, &tally.least_q3)?;
        histogram(&parts[1], "least q·b3", tally, &tally.least_q_b3)?;
        histogram(&parts[2], "least tension, N", tally, &tally.least_tension)
    })?;
    let heading = if title.is_empty() { "Campaign" } else { title };
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            (head(heading))
            body {
                main {
                    h1 { (heading) }
                    pre tabindex="0" { (summary.text()) }
                    (figure("success", &success, start))
                    (figure("success-drawn", &success_2, drawn))
                    (figure("distance", &over_time, percentile))
                    (figure("margins", &margins, least))
                    h2 { "Flights that failed" }
                    @if summary.failures.is_empty() { p { "None of " (summary.runs) "." } } @else { (failures(summary)) }
                }
            }
        }
    }
    .into_string())
}

fn failures(summary: &Summary) -> Markup {
    html! {
        div.wide role="region" aria-label="Flights that failed" tabindex="0" {
            table.results {
                caption { "Each can be flown again: " code { "hil-sim campaign … --replay FLIGHT" } }
                thead {
                    tr {
                        th scope="col" { "flight" }
                        @for name in ["verdict", "mode", "first fault", "last fault"] { th.words scope="col" { (name) } }
                        th scope="col" { "largest d_C, m" }
                    }
                }
                tbody {
                    @for failure in &summary.failures {
                        tr {
                            th scope="row" { (failure.run) }
                            td.words { (format!("{:?}", failure.verdict)) } td.words { (failure.mode) }
                            td.words { (failure.faults[0]) } td.words { (failure.faults[1]) }
                            td { (format!("{:.3}", failure.dc_max_m)) }
                        }
                    }
                }
            }
        }
    }
}

/// d_C's percentiles at the instants that rows have.
fn percentiles(duration_s: f64, tally: &Tally) -> Vec<Curve> {
    let shares = [("median", 0.5), ("90 %", 0.9), ("99 %", 0.99), ("99.9 %", 0.999)];
    shares
        .into_iter()
        .zip(COLOURS)
        .map(|((label, share), colour)| Curve {
            label: label.to_owned(),
            points: (0..)
                .zip(&tally.dc_over_time_m)
                .map(|(i, values)| (duration_s * f64::from(i) / INSTANTS as f64, values.percentile(share)))
                .collect(),
            colour,
        })
        .collect()
}

/// Bars of a histogram or of shares.
const BINS: usize = 10;

/// The bins of values over their range: its least, a bin's width, and in each the flights and the
/// good ones among them.
fn bins(values: &[f64], good: &[bool]) -> (f64, f64, [[usize; 2]; BINS]) {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let (low, width) =
        if high > low { (low, (high - low) / BINS as f64) } else { (finite().next().unwrap_or(0.0), 1.0) };
    let mut bins = [[0; 2]; BINS];
    for (value, good) in values.iter().zip(good).filter(|(value, _)| value.is_finite()) {
        let [all, among] = &mut bins[(((value - low) / width) as usize).min(BINS - 1)];
        *all += 1;
        *among += usize::from(*good);
    }
    (low, width, bins)
}

fn share(area: &Area<'_>, quantity: &str, tally: &Tally, values: &[f64]) -> Drawn {
    let (low, width, bins) = bins(values, &tally.good);
    let bars = bins.map(|[all, good]| (good as f64 / all.max(1) as f64, all));
    columns(area, quantity, "share of good flights", low, width, 1.15, &bars)
}

fn histogram(area: &Area<'_>, quantity: &str, tally: &Tally, values: &[f64]) -> Drawn {
    let (low, width, bins) = bins(values, &tally.good);
    let bars = bins.map(|[all, _]| (all as f64, all));
    let top = bars.iter().fold(1.0_f64, |top, bar| top.max(bar.0));
    columns(area, quantity, "flights", low, width, 1.15 * top, &bars)
}

fn columns(area: &Area<'_>, x: &str, y: &str, low: f64, width: f64, top: f64, bars: &[(f64, usize)]) -> Drawn {
    let mut builder = ChartBuilder::on(area);
    builder.margin(10 * FINE).x_label_area_size(38 * FINE).y_label_area_size(56 * FINE);
    let mut chart = builder.build_cartesian_2d(low..low + width * bars.len() as f64, 0.0..top)?;
    chart
        .configure_mesh()
        .set_all_tick_mark_size(5 * FINE)
        .disable_x_mesh()
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.12))
        .x_desc(x)
        .y_desc(y)
        .label_style(("sans-serif", 13 * FINE))
        .axis_desc_style(("sans-serif", 14 * FINE))
        .draw()?;
    let at = |index: usize| low + width * index as f64;
    chart.draw_series(bars.iter().enumerate().filter(|(_, bar)| bar.1 > 0).map(|(index, &(height, _))| {
        Rectangle::new([(at(index) + 0.06 * width, 0.0), (at(index + 1) - 0.06 * width, height)], COLOURS[0].filled())
    }))?;
    chart.draw_series(bars.iter().enumerate().filter(|(_, bar)| bar.1 > 0).map(|(index, &(height, count))| {
        Text::new(count.to_string(), (at(index) + 0.1 * width, height + 0.07 * top), ("sans-serif", 11 * FINE))
    }))?;
    Ok(())
}
