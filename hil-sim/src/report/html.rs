//! The report: one page that holds everything it shows.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::Figure;
use super::table::COLUMNS;
use crate::describe::reference::Reference;
use crate::fly::batch::Outcome;

pub(crate) const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 1040px; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 2.5rem }
.wide { overflow-x: auto }
table { border-collapse: collapse; font-size: 0.8rem; font-variant-numeric: tabular-nums }
th, td { padding: 0.3rem 0.55rem; text-align: right; white-space: pre-line; vertical-align: top }
th:nth-child(-n+2), td:nth-child(-n+2) { text-align: left }
thead th { border-bottom: 2px solid #444 } tbody tr { border-bottom: 1px solid #ddd }
.reference { color: #777 }
figure { margin: 2rem 0 } figure svg { width: 100%; height: auto; border: 1px solid #ddd }
figcaption { color: #333; margin-top: 0.5rem }
";

/// What a page shows.
pub struct Page<'a> {
    /// Its heading.
    pub heading: &'a str,
    /// Flights of its table.
    pub outcomes: Vec<&'a Outcome>,
    /// Its figures.
    pub figures: Vec<&'a Figure>,
    /// Another page's file and heading.
    pub link: Option<(&'a str, &'a str)>,
}

/// A page with table, figures and how to read them.
pub fn page(page: &Page<'_>, reference: &Reference) -> String {
    let Page { heading, outcomes, figures, link } = page;
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (heading) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (heading) }
                @if let Some((file, other)) = link { p { a href=(file) { (other) } } }
                p {
                    "The controller flies in binary32, as on the target, in closed loop with a binary64 model of vehicle and load. "
                    "Inertial axes n1, n2, n3 with n3 pointing down; p is the payload's position, d"
                    sub { "C" } " its distance from the curve, u = (T, τ)."
                }
                h2 { "Measured, and what the reference says" }
                (table(outcomes, reference))
                p {
                    "Effort is ∫‖u − u" sub { "hover" } "‖dt. Steady errors are means over the last lap; positive p3 is lower. "
                    "f32 − f64: of thrust, torque, ζ and ξ, the largest difference from an f64 controller of the same source at the "
                    "same states, over the largest value of the flight (or over hover thrust, J1 g/L, g, and one unit of the output, where these are "
                    "larger), with time counted in √(L/g); the largest of the four. "
                    "Times real time: one core, with the f32 law only. "
                    "The reference is the closed loop in continuous time, integrated with a relative tolerance of 1e-9."
                }
                @for figure in figures {
                    figure id=(figure.name) {
                        (PreEscaped(&figure.svg))
                        figcaption { (figure.caption) }
                    }
                }
            }
        }
    }
    .into_string()
}

fn table(outcomes: &[&Outcome], reference: &Reference) -> Markup {
    html! {
        div.wide {
            table {
                thead {
                    tr {
                        th { "run" } th { "law" }
                        @for column in COLUMNS { th { (column.heading) } }
                        th { "f32 − f64,\nrelative" } th { "times\nreal time" }
                    }
                }
                tbody {
                    @for outcome in outcomes {
                        @let expected = reference.runs.get(&outcome.scenario.name).copied().unwrap_or_default();
                        tr title=(outcome.scenario.title) {
                            td {
                                (outcome.scenario.name)
                                @if let Some(failure) = outcome.flight.end.failure() { br; strong { (failure) } }
                            }
                            td { (outcome.scenario.controller.law.name()) }
                            @for column in COLUMNS {
                                td {
                                    (column.text(&outcome.flight.results).unwrap_or_default())
                                    @if let Some(text) = column.text(&expected) { br; span.reference { (text) } }
                                }
                            }
                            td { @if let Some(deviation) = outcome.flight.deviation { (format!("{:.1e}", deviation.max())) } }
                            td { (format!("{:.0}", outcome.flight.times_real_time)) }
                        }
                    }
                }
            }
        }
    }
}
