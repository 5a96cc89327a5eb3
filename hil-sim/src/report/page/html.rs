//! The report: flights to play and to compare, what was measured, the paper's figures, and how to
//! read it all.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::data::{Shown, failure, json};
use super::{figure, head};
use crate::describe::reference::Reference;
use crate::fly::batch::Outcome;
use crate::report::Figure;
use crate::report::legs::Legs;
use crate::report::log::Table;
use crate::report::table::{filled, name_and_end};

/// Plots and their scales, by uPlot.
const PLOTTER: [&str; 2] = [include_str!("uplot/uPlot.iife.min.js"), include_str!("uplot/uPlot.min.css")];

/// What the page does, in the order in which it is read.
const SCRIPTS: [&str; 4] =
    [include_str!("flight.js"), include_str!("scene.js"), include_str!("plots.js"), include_str!("main.js")];

/// What a page shows.
pub struct Page<'a> {
    /// Its heading.
    pub heading: &'a str,
    /// Flights with their logs.
    pub flights: Vec<(&'a Outcome, &'a Table)>,
    /// Its figures.
    pub figures: Vec<&'a Figure>,
    /// Another page's file and heading.
    pub link: Option<(&'a str, &'a str)>,
}

/// A page with flights to play, their table, figures, and how to read them.
pub fn page(page: &Page<'_>, reference: &Reference) -> String {
    let Page { heading, flights, figures, link } = page;
    let outcomes: Vec<&Outcome> = flights.iter().map(|(outcome, _)| *outcome).collect();
    let shown: Vec<Shown<'_>> = flights
        .iter()
        .map(|(outcome, table)| Shown {
            legs: Legs::of(outcome),
            ..Shown::of(&outcome.scenario, table, outcome.flight.end)
        })
        .collect();
    let below = html! {
        @for outcome in &outcomes {
            @if let Some(replayed) = &outcome.flight.replayed {
                h2 { (outcome.scenario.name) " beside its log" }
                ul { @for sentence in replayed.sentences() { li { (sentence) } } }
            }
        }
        @for Shown { table, legs, .. } in &shown {
            @if let Some(legs) = legs { (legs.table(&table.name)) }
        }
        h2 { "Measured, and what the reference says" }
        (table(&outcomes, reference))
        p.note {
            "Effort is ∫‖u − u" sub { "hover" } "‖dt with u = (T, τ). Steady errors are means over the last lap; positive p3 is lower. "
            "f32 − f64: of thrust, torque, ζ and ξ, the largest difference from an f64 controller of the same source at the "
            "same states, over the largest value of the flight (or over hover thrust, J1 g/L, g, and one unit of the output, where these are "
            "larger), with time counted in √(L/g); the largest of the four. "
            "Times real time: one core, with the f32 law only. "
            "The reference is the closed loop in continuous time, integrated with a relative tolerance of 1e-9."
        }
        @for drawn in figures { (figure(&drawn.name, &drawn.svg, &drawn.caption)) }
    };
    flights_page(heading, *link, &shown, &below)
}

/// A page of flights to play, with more below them.
pub fn flights_page(heading: &str, link: Option<(&str, &str)>, shown: &[Shown<'_>], below: &Markup) -> String {
    let above = html! {
        @if let Some((file, other)) = link { p { a href=(file) { (other) } } }
        @for Shown { table, end, .. } in shown {
            @if let Some(failure) = failure(*end, table) {
                p.lost { (failure) span { (table.name) @if !table.title.is_empty() { ": " (table.title) } } }
            }
        }
    };
    whole(heading, false, &above, &json(shown), below)
}

/// The page of flights that are being flown, `flights` as its script takes them.
pub fn live_page(flights: &str) -> String {
    let above = html! { p #live role="status" { "Waiting for the first sample" } };
    whole("Flying now", true, &above, flights, &html! {})
}

fn whole(heading: &str, is_live: bool, above: &Markup, flights: &str, below: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" data-live[is_live] {
            (head(heading))
            style { (PreEscaped(PLOTTER[1])) }
            body {
                main {
                    h1 { (heading) }
                    (above)
                    (controls())
                    section #scenes .scenes aria-label="Flights in space" {}
                    div.scale {
                        span { "The trail is coloured by d" sub { "C" } ", the distance from the dashed curve: 1 mm" }
                        i {}
                        span { "10 m" }
                    }
                    section #strips aria-label="Modes and faults over time" {}
                    section #plots .plots aria-label="Plots over time" {}
                    p.note.keys {
                        kbd { "Space" } " plays, " kbd { "←" } " " kbd { "→" } " move by 0.1 s, " kbd { "Page Up" } " " kbd { "Page Down" }
                        " by a twentieth, " kbd { "Home" } " " kbd { "End" } " to the ends; " kbd { "+" } " " kbd { "−" } " zoom the plots, " kbd { "0" }
                        " shows all; " kbd { "A" } " " kbd { "D" } " " kbd { "W" } " " kbd { "S" } " turn the view, " kbd { "Q" } " " kbd { "E" }
                        " move it, " kbd { "F" } " follows the vehicle. Drag in a plot to zoom, click to go there; drag in a scene to turn it."
                    }
                    noscript { p { "Playing flights and plots needs scripts; the tables and figures below do not." } }
                    h2 { "Events" }
                    ol #events .events {}
                    (below)
                    p.note {
                        "The controller flies in binary32, as on the target, in closed loop with a binary64 model of vehicle and load. "
                        "Inertial axes n1, n2, n3 with n3 pointing down; p is the payload's position. Arrows on the rotors are their thrusts; the front is in blue."
                    }
                }
                script type="application/json" id="flights" { (PreEscaped(flights)) }
                script { (PreEscaped(PLOTTER[0])) }
                script { @for script in SCRIPTS { (PreEscaped(script)) } }
            }
        }
    }
    .into_string()
}

fn controls() -> Markup {
    html! {
        div.bar.sticky role="toolbar" aria-label="Time and view" {
            button #play .play type="button" aria-pressed="false" { "Play" }
            input #time type="range" min="0" max="1" step="0.01" value="0" aria-label="Time";
            output #clock for="time" {}
            label {
                "speed "
                select #speed {
                    @for speed in ["0.1", "0.5", "1", "2", "5", "20"] {
                        option value=(speed) selected[speed == "1"] { (speed) "×" }
                    }
                }
            }
            label { "flight " select #first {} }
            label #compare { "beside it " select #second { option value="" { "none" } } }
            label {
                "view "
                select #view {
                    @for (value, name) in [("space", "in space"), ("above", "from above"), ("north", "to the north"), ("east", "to the east")] {
                        option value=(value) { (name) }
                    }
                }
            }
            button #follow type="button" aria-pressed="false" { "Follow" }
            button #unzoom type="button" { "Show all" }
        }
    }
}

fn table(outcomes: &[&Outcome], reference: &Reference) -> Markup {
    let columns = filled(outcomes, reference);
    html! {
        div.wide role="region" aria-label="Results" tabindex="0" {
            table.results {
                caption { "A row a flight; what the reference says is in grey below what was measured." }
                thead {
                    tr {
                        th.words scope="col" { "flight" }
                        th.words scope="col" { "law" }
                        @for column in &columns { th scope="col" { (column.heading) } }
                        th scope="col" { "f32 − f64,\nrelative" }
                        th scope="col" { "times\nreal time" }
                    }
                }
                tbody {
                    @for outcome in outcomes {
                        @let expected = reference.runs.get(&outcome.scenario.name).copied().unwrap_or_default();
                        tr title=(outcome.scenario.title) {
                            th scope="row" {
                                @let (name, end) = name_and_end(outcome);
                                (name)
                                @if let Some(end) = end { br; span.bad { (end) } }
                            }
                            td.words { (outcome.scenario.controller.law.name()) }
                            @for column in &columns {
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
