//! `summary.json`, for programs.

use serde::Serialize;

use crate::describe::reference::Reference;
use crate::fly::batch::Outcome;
use crate::fly::deviation::Deviation;
use crate::fly::flight::End;
use crate::fly::metrics::Results;
use crate::study::replay::Replayed;

#[derive(Serialize)]
struct Summary<'a> {
    runs: Vec<Run<'a>>,
}

#[derive(Serialize)]
struct Run<'a> {
    scenario: &'a str,
    law: &'static str,
    title: &'a str,
    duration_s: f64,
    rate_hz: f64,
    complete: bool,
    /// How it ended, if not at its duration.
    #[serde(skip_serializing_if = "Option::is_none")]
    failure: Option<String>,
    #[serde(flatten)]
    results: &'a Results,
    #[serde(skip_serializing_if = "Option::is_none")]
    f32_f64_max_relative: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    f32_f64_relative: Option<Deviation>,
    /// With the f32 law only.
    times_real_time: f64,
    times_real_time_with_twin: f64,
    /// How a replay compares with its log.
    #[serde(skip_serializing_if = "Option::is_none")]
    replayed: Option<&'a Replayed>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<&'a Results>,
}

/// The summary of these flights.
pub fn json(outcomes: &[Outcome], reference: &Reference) -> String {
    let runs = outcomes
        .iter()
        .map(|outcome| Run {
            scenario: &outcome.scenario.name,
            law: outcome.scenario.controller.law.name(),
            title: &outcome.scenario.title,
            duration_s: outcome.scenario.duration_s,
            rate_hz: outcome.scenario.controller.rate_hz,
            complete: matches!(outcome.flight.end, End::Complete | End::Landed(_)),
            failure: outcome.flight.end.failure(),
            results: &outcome.flight.results,
            f32_f64_max_relative: outcome.flight.deviation.map(|deviation| deviation.max()),
            f32_f64_relative: outcome.flight.deviation,
            times_real_time: outcome.flight.times_real_time,
            times_real_time_with_twin: outcome.flight.times_real_time_with_twin,
            replayed: outcome.flight.replayed.as_ref(),
            reference: reference.runs.get(&outcome.scenario.name),
        })
        .collect();
    let mut text = serde_json::to_string_pretty(&Summary { runs }).expect("plain numbers and strings");
    text.push('\n');
    text
}
