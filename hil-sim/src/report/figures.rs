//! The figures, drawn from the logs: the paper's from runs that say which panel they are, a sheet
//! for any other run.

use plotters::prelude::*;

use super::plot::{Area, COLOURS, Curve, Drawn, FINE, Track, drawing, elevation, plan, space, time, time_log};
use super::{Figure, ReportError};
use crate::fly::batch::Outcome;
use crate::fly::sample::Sample;
use controller::{Command, Vector3};
use witness::plant::index;

/// Most points drawn of a curve: as many as a figure has pixels across.
const POINTS: usize = 1000;

/// A figure yet to be drawn.
struct Plan<'a> {
    name: String,
    caption: String,
    runs: Vec<&'a Outcome>,
    size: (u32, u32),
    panels: fn(&Area<'_>, &[&Outcome]) -> Drawn,
    is_of_the_paper: bool,
}

/// Whether a flight belongs to a family of curves, a figure with a name, rather than to a numbered
/// figure or to none.
pub fn is_curve(outcome: &Outcome) -> bool {
    outcome.scenario.figure.as_deref().is_some_and(|figure| !figure.starts_with(|c: char| c.is_ascii_digit()))
}

/// Draws every figure that these flights belong to.
pub fn draw(outcomes: &[Outcome]) -> Result<Vec<Figure>, ReportError> {
    let drawn = plans(outcomes).into_iter().map(|Plan { name, caption, runs, size, panels, is_of_the_paper }| {
        let svg = drawing(&name, &caption, size, |area| panels(area, &runs))?;
        Ok(Figure { name, caption, svg, is_of_the_paper })
    });
    drawn.collect()
}

fn plans(outcomes: &[Outcome]) -> Vec<Plan<'_>> {
    let of =
        |number: &str| -> Vec<&Outcome> {
            outcomes
                .iter()
                .filter(|outcome| {
                    outcome.scenario.figure.as_deref().is_some_and(|figure| {
                        figure == number || figure.trim_end_matches(char::is_alphabetic) == number
                    })
                })
                .collect()
        };
    let figure = |number, caption: &str, size, panels, runs| Plan {
        name: format!("fig{number}"),
        caption: format!("Fig. {number}. {caption}"),
        runs,
        size,
        panels,
        is_of_the_paper: true,
    };
    let mut plans = vec![
        figure(
            2,
            "An obstacle stops the vehicle at 5 s (dashed line) and releases it at once. Path following stays on its path; \
             trajectory tracking leaves it to catch up with a reference that ran on.",
            (1000, 780),
            obstacle as fn(&Area<'_>, &[&Outcome]) -> Drawn,
            of("2"),
        ),
        figure(
            3,
            "From rest 4 m outside the circle: the payload's way in space, n3 down.",
            (1000, 520),
            ways,
            of("3"),
        ),
        figure(
            4,
            "The flights of Fig. 3 over time: distance from the circle, thrust and torque.",
            (1000, 860),
            inputs,
            of("3"),
        ),
        figure(
            5,
            "The law is told 0.25 kg, the payload has 0.5 kg: without integral action the payload flies a larger circle, \
             lower and slower; with it all three errors go to zero.",
            (1000, 1100),
            wrong_mass,
            of("5"),
        ),
        figure(
            6,
            "The law is told 0.75 kg, the payload has 0.5 kg: smaller circle, higher and faster; with integral action all \
             three errors go to zero.",
            (1000, 1100),
            wrong_mass,
            of("6"),
        ),
    ];
    plans.retain(|plan| !plan.runs.is_empty());
    let mut curves: Vec<&str> = outcomes
        .iter()
        .filter(|outcome| is_curve(outcome))
        .filter_map(|outcome| outcome.scenario.figure.as_deref())
        .collect();
    curves.dedup();
    plans.extend(curves.into_iter().map(|curve| {
        let runs = of(curve);
        Plan {
            name: format!("curve-{curve}"),
            caption: format!("{curve}. {}", runs.first().map_or("", |run| &run.scenario.title)),
            runs,
            size: (1000, 1240),
            panels: curve_sheet,
            is_of_the_paper: false,
        }
    }));
    plans.extend(outcomes.iter().filter(|outcome| outcome.scenario.figure.is_none()).map(|outcome| Plan {
        name: outcome.scenario.name.clone(),
        caption: format!("{}. {}", outcome.scenario.name, outcome.scenario.title),
        runs: vec![outcome],
        size: (1000, 1160),
        panels: sheet,
        is_of_the_paper: false,
    }));
    plans
}

fn obstacle(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let (above, below) = area.split_vertically(500 * FINE);
    for (part, run) in above.split_evenly((1, runs.len())).iter().zip(runs) {
        plan(part, &panel_title(run), &circle(run), &tracks(&[run], runs))?;
    }
    time_log(&below, "d_C, m", 1e-7, &curves(runs, distance), &marks(runs))
}

fn ways(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let mut panels: Vec<String> = runs.iter().map(|run| panel(run)).collect();
    panels.dedup();
    for (part, letter) in area.split_evenly((1, panels.len())).iter().zip(&panels) {
        let shown: Vec<&Outcome> = runs.iter().copied().filter(|run| panel(run) == *letter).collect();
        space(part, &panel_title(shown[0]), &circle(shown[0]), &tracks(&shown, runs))?;
    }
    Ok(())
}

fn inputs(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let parts = area.split_evenly((3, 1));
    time_log(&parts[0], "d_C, m", 1e-4, &curves(runs, distance), &[])?;
    time(&parts[1], "T, N", &curves(runs, |_, sample| command(sample).map(|input| input.thrust)), &[])?;
    time(&parts[2], "torque, N m", &curves(runs, |_, sample| command(sample).map(torque)), &[])
}

fn wrong_mass(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let (above, below) = area.split_vertically(460 * FINE);
    let halves = above.split_evenly((1, 2));
    space(&halves[0], "In space", &circle(runs[0]), &tracks(runs, runs))?;
    plan(&halves[1], "From above", &circle(runs[0]), &tracks(runs, runs))?;
    let parts = below.split_evenly((3, 1));
    time(&parts[0], "radius error, m", &curves(runs, |run, s| against_circle(run, s).map(|e| e[0])), &[])?;
    time(&parts[1], "p3 error, m", &curves(runs, |run, s| against_circle(run, s).map(|e| e[1])), &[])?;
    time(&parts[2], "speed error, m/s", &curves(runs, |run, s| against_circle(run, s).map(|e| e[2])), &[])
}

fn sheet(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let (above, below) = area.split_vertically(460 * FINE);
    let halves = above.split_evenly((1, 2));
    space(&halves[0], "In space", &circle(runs[0]), &tracks(runs, runs))?;
    plan(&halves[1], "From above", &circle(runs[0]), &tracks(runs, runs))?;
    let parts = below.split_evenly((3, 1));
    let marks = marks(runs);
    time_log(&parts[0], "d_C, m", 1e-5, &curves(runs, distance), &marks)?;
    time(&parts[1], "T, N", &curves(runs, |_, sample| command(sample).map(|input| input.thrust)), &marks)?;
    time(&parts[2], "torque, N m", &curves(runs, |_, sample| command(sample).map(torque)), &marks)
}

fn curve_sheet(area: &Area<'_>, runs: &[&Outcome]) -> Drawn {
    let (above, below) = area.split_vertically(460 * FINE);
    let halves = above.split_evenly((1, 2));
    plan(&halves[0], "From above", &circle(runs[0]), &tracks(runs, runs))?;
    elevation(&halves[1], "From the side", &circle(runs[0]), &tracks(runs, runs))?;
    let parts = below.split_evenly((3, 1));
    time_log(&parts[0], "d_C, m", 1e-7, &curves(runs, distance), &[])?;
    // ξ holds h1 … h1⁽⁵⁾, h2 … h2⁽⁵⁾, h3 …, h4.
    time(&parts[1], "speed error, m/s", &curves(runs, |_, sample| xi(sample, 12)), &[])?;
    time(&parts[2], "yaw error, rad", &curves(runs, |_, sample| xi(sample, 17)), &[])
}

/// An element of the follower's ξ.
fn xi(sample: &Sample, index: usize) -> Option<f64> {
    sample.decision?.telemetry.map(|telemetry| telemetry.xi[index])
}

fn panel(run: &Outcome) -> String {
    run.scenario.figure.clone().unwrap_or_default()
}

fn panel_title(run: &Outcome) -> String {
    let law = match run.scenario.controller.law.name() {
        "track" => "trajectory tracking",
        _ => "path following",
    };
    format!("{} {law}", panel(run))
}

fn circle(run: &Outcome) -> Vec<[f64; 3]> {
    run.scenario.controller.law.outline(180)
}

/// The samples that are drawn.
fn drawn(run: &Outcome) -> impl Iterator<Item = &Sample> {
    let every = run.flight.log.len().div_ceil(POINTS).max(1);
    run.flight.log.iter().step_by(every)
}

/// Each run has the colour of its place among `all`.
fn colour(run: &Outcome, all: &[&Outcome]) -> RGBColor {
    let place = all.iter().position(|other| other.scenario.name == run.scenario.name).unwrap_or(0);
    COLOURS[place % COLOURS.len()]
}

fn tracks(runs: &[&Outcome], all: &[&Outcome]) -> Vec<Track> {
    runs.iter()
        .map(|run| Track {
            label: run.scenario.name.clone(),
            points: drawn(run).map(position).collect(),
            colour: colour(run, all),
        })
        .collect()
}

fn curves(runs: &[&Outcome], value: fn(&Outcome, &Sample) -> Option<f64>) -> Vec<Curve> {
    runs.iter()
        .map(|run| Curve {
            label: run.scenario.name.clone(),
            points: drawn(run).filter_map(|sample| Some((sample.t_s, value(run, sample)?))).collect(),
            colour: colour(run, runs),
        })
        .collect()
}

/// When obstacles stop and release.
fn marks(runs: &[&Outcome]) -> Vec<f64> {
    let mut marks: Vec<f64> = runs
        .iter()
        .filter_map(|run| run.scenario.obstacle)
        .flat_map(|obstacle| [obstacle.at_s, obstacle.at_s + obstacle.hold_s])
        .collect();
    marks.sort_by(f64::total_cmp);
    marks.dedup();
    marks
}

fn position(sample: &Sample) -> [f64; 3] {
    std::array::from_fn(|axis| sample.x[index::POSITION + axis])
}

fn distance(_: &Outcome, sample: &Sample) -> Option<f64> {
    Some(sample.distance_m)
}

fn command(sample: &Sample) -> Option<&Command<f64>> {
    sample.decision.as_ref().map(|decision| &decision.command)
}

fn torque(command: &Command<f64>) -> f64 {
    command.torque.iter().map(|axis| axis * axis).sum::<f64>().sqrt()
}

/// Errors of radius (m), p3 (m) and speed (m/s), where a horizontal circle is flown.
fn against_circle(run: &Outcome, sample: &Sample) -> Option<[f64; 3]> {
    let circle = run.scenario.controller.law.circle()?;
    let group = |first: usize| Vector3::from_fn(|axis, _| sample.x[first + axis]);
    Some(crate::fly::metrics::circle_errors(&group(index::POSITION), &group(index::VELOCITY), circle))
}
