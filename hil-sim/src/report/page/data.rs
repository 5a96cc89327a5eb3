//! What a page's script is given of each flight: its columns as single-precision numbers, and what
//! stands beside them.

use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Map, Value, json};

use crate::describe::path::RouteSpec;
use crate::describe::scenario::{Law, Scenario};
use crate::fly::flight::{End, LOST_M};
use crate::report::legs::Legs;
use crate::report::log::{Column, Table};

/// A flight to be shown.
pub struct Shown<'a> {
    /// What was flown.
    pub scenario: &'a Scenario,
    /// Its log.
    pub table: &'a Table,
    /// How it ended.
    pub end: End,
    /// Where the ground is, m.
    pub ground_p3: Option<f64>,
    /// Of a route's flight, its legs.
    pub legs: Option<Legs>,
}

impl<'a> Shown<'a> {
    /// A flight of `scenario` over its own ground.
    pub fn of(scenario: &'a Scenario, table: &'a Table, end: End) -> Self {
        let ground_p3 = scenario.ground.map(|ground| ground.p3).or(scenario.ground_p3);
        Self { scenario, table, end, ground_p3, legs: None }
    }
}

/// Bytes that the flights of one page may have between them; samples are left out evenly to keep to
/// it.
const BUDGET: usize = 1_600_000;

/// The fewest samples that a flight is shown by.
const FEWEST: usize = 300;

/// Points of the curve to be flown.
const OUTLINE: usize = 240;

/// Waypoints of a route that are shown, at most: more could not be told apart.
const MARKED: usize = 200;

/// What the script does not look at.
const UNSEEN: [&str; 7] = ["angles", "zeta", "nu", "integral", "kappa", "path_det", "implied_payload_mass"];

/// The flights as JSON that may stand inside a script element.
pub fn json(flights: &[Shown<'_>]) -> String {
    let columns: usize = flights.iter().map(|flight| seen(flight.table).count() + 1).sum();
    // Four bytes a number, and four characters for three of them.
    let rows = (BUDGET / (columns * 16 / 3).max(1)).max(FEWEST);
    let flights: Vec<Value> = flights.iter().map(|flight| one(flight, rows)).collect();
    Value::from(flights).to_string().replace('<', "\\u003c")
}

fn seen(table: &Table) -> impl Iterator<Item = &Column> {
    table
        .columns
        .iter()
        .filter(|column| !UNSEEN.iter().any(|unseen| column.name.starts_with(unseen) || column.topic == *unseen))
}

fn one(flight: &Shown<'_>, rows: usize) -> Value {
    let Shown { scenario, table, end, ground_p3, legs } = flight;
    let every = table.t_s.len().div_ceil(rows).max(1);
    let last = table.t_s.len().saturating_sub(1);
    // The last sample is how a flight ended.
    let rows: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
    let mut columns: Map<String, Value> = seen(table)
        .filter_map(|column| table.numbers(column.name).map(|numbers| (column.name, numbers)))
        .filter_map(|(name, numbers)| Some((name.to_owned(), packed(rows.iter().map(|&row| numbers[row]))?)))
        .collect();
    if let Some(Legs { speeds, .. }) = legs {
        for (name, which) in [("set_speed", 0), ("allowed_speed", 1)] {
            let speeds = rows.iter().map(|&row| speeds.get(row).map_or(f32::NAN, |speeds| speeds[which] as f32));
            columns.extend(packed(speeds).map(|packed| (name.to_owned(), packed)));
        }
    }
    let waypoints: Vec<([f64; 3], bool)> = route(scenario)
        .filter(|route| route.waypoints().len() <= MARKED)
        .map(|route| route.waypoints().iter().map(|waypoint| (waypoint.point, waypoint.stop.is_some())).collect())
        .unwrap_or_default();
    let outline: Vec<f32> =
        scenario.controller.law.outline(OUTLINE).into_iter().flatten().map(|part| part as f32).collect();
    let rotors = scenario.actuators.rotors;
    json!({
        "name": table.name,
        "title": table.title,
        "lost": failure(*end, table),
        "time": bytes(rows.iter().map(|&row| table.t_s[row] as f32)),
        "columns": columns,
        "modes": changes(table, "mode"),
        "faults": changes(table, "fault"),
        "cables": changes(table, "cable"),
        "grounds": changes(table, "ground"),
        "estimates": changes(table, "estimate"),
        "path": bytes(outline),
        "waypoints": waypoints,
        "rod_length": scenario.vehicle.rod_length,
        "payload_mass": scenario.controller.vehicle.payload_mass,
        "hover_n": scenario.vehicle.total_mass() * scenario.vehicle.gravity,
        "arm": rotors.map_or(0.3, |rotors| rotors.arm_m),
        "drag": rotors.map(|rotors| rotors.drag_m),
        "ground": ground_p3,
        "wind": scenario.environment.air.map_or([0.0; 3], |air| air.wind),
    })
}

/// What is flown, if it is a route.
fn route(scenario: &Scenario) -> Option<&RouteSpec> {
    match &scenario.controller.law {
        Law::Follow { path, .. } => path.route(),
        Law::Track { .. } => None,
    }
}

/// A column: one number if it does not change, and nothing if it is empty. A gap is filled with
/// what was there before it.
fn packed(numbers: impl Iterator<Item = f32> + Clone) -> Option<Value> {
    let first = numbers.clone().find(|number| number.is_finite())?;
    if numbers.clone().all(|number| number == first || number.is_nan()) {
        return Some(Value::from(first));
    }
    let mut before = f32::NAN;
    Some(bytes(numbers.map(|number| {
        if !number.is_nan() {
            before = number;
        }
        before
    })))
}

/// Little-endian single precision in base 64.
fn bytes(numbers: impl IntoIterator<Item = f32>) -> Value {
    let bytes: Vec<u8> = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
    BASE64_STANDARD.encode(bytes).into()
}

/// [from, word] wherever a column of words changes; where there is no word, the vehicle is held.
fn changes(table: &Table, name: &str) -> Vec<(f64, String)> {
    let Some(column) = table.columns.iter().find(|column| column.name == name) else { return Vec::new() };
    let mut list: Vec<(f64, String)> = Vec::new();
    // The last sample has no answer: nothing comes after it.
    for (row, &t_s) in table.t_s.iter().enumerate().take(table.t_s.len().saturating_sub(1)) {
        let word = column.word(row).unwrap_or_default();
        if list.last().is_none_or(|(_, last)| last != word) {
            list.push((t_s, word.to_owned()));
        }
    }
    list
}

/// Why a flight did not reach its duration, in a sentence.
pub fn failure(end: End, table: &Table) -> Option<String> {
    let (what, at_s, why) = match end {
        End::Complete | End::Landed(_) | End::Interrupted => return None,
        End::Crashed(at_s) => ("Crashed", at_s, "on the ground".to_owned()),
        End::Lost(at_s) => ("Lost", at_s, format!("{LOST_M:.0} m or more from the path")),
        End::NotFinite(at_s) => ("Lost", at_s, "the state or the command stopped being a number".to_owned()),
        End::Unanswered(at_s) => ("Unanswered", at_s, "no command came from the controller".to_owned()),
    };
    let nearest =
        nearest(table).map(|(name, value, t_s)| format!("; before that {name} fell to {value:.3} at {t_s:.1} s"));
    Some(format!("{what} at {at_s:.1} s: {why}{}", nearest.unwrap_or_default()))
}

/// Margins that end at zero, as people know them; the tension as a share of the weight.
const MARGINS: [(&str, &str, f32); 5] = [
    ("q3", "q·e3 (the cable's angle)", 1.0),
    ("q_b3", "q·b3 (thrust along the cable)", 1.0),
    ("lambda", "the cable's tension over the payload's weight", -1.0 / 9.81),
    ("cos_phi_squared", "cos²φ (the yaw's chart)", 1.0),
    ("reach", "the path's reach", 1.0),
];

/// The first margin to come within a tenth of its singularity, its least value, and when.
fn nearest(table: &Table) -> Option<(&'static str, f32, f64)> {
    MARGINS
        .into_iter()
        .filter_map(|(column, name, scale)| {
            let values = table.numbers(column)?;
            let row = values.iter().position(|value| value * scale < 0.1)?;
            Some((name, values[row] * scale, table.t_s[row]))
        })
        .min_by(|a, b| a.2.total_cmp(&b.2))
}
