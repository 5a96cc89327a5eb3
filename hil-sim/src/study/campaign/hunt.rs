//! The smallest fault that still fails, in the space that a campaign draws its flights from.

use controller::State;
use serde::Serialize;
use std::fmt::Write as _;
use toml::{Table, Value};

use super::draw::set;
use super::file::{ApproachFields, Campaign, Drawn, Draws};
use super::fly::{Row, Verdict, fly_drawn, pilot};
use super::search::{Along, Search};
use super::space::{Space, length};
use super::start::Start;
use crate::describe::input::Invalid;
use crate::fly::flight::Control;
use crate::world::Seed;
use crate::world::random::Purpose;

/// What a hunt has found.
#[derive(Clone, Debug, Serialize)]
pub struct Hunt {
    /// Flights flown.
    pub flights: usize,
    /// What fails, smallest first. Of a hunt from the nominal the first is the smallest of all, and
    /// the others are of one number alone.
    pub finds: Vec<Find>,
    /// Numbers that fail neither way by themselves, to the end of what is drawn.
    pub harmless: Vec<String>,
    /// What was seen along the ray of the first.
    pub along: Option<Along>,
}

/// A fault that fails.
#[derive(Clone, Debug, Serialize)]
pub struct Find {
    /// Length, where 1 is from the nominal to the end of one range.
    pub size: f64,
    /// What differs from the nominal: the keys of the campaign's file with their numbers in the
    /// keys' units.
    pub fault: Vec<(String, Vec<f64>)>,
    /// What became of the flight.
    pub verdict: Verdict,
    /// When it ended, s.
    pub end_s: f64,
    /// The mode at the end.
    pub mode: String,
    /// The first fault, empty if there was none.
    pub first_fault: String,
    /// Largest d_C in the last quarter, m.
    pub dc_max_m: f64,
    /// A scenario file that `run` flies to the same end.
    #[serde(skip)]
    pub scenario: String,
}

/// Why a hunt ended without finding.
#[derive(Debug, thiserror::Error)]
pub enum HuntError {
    /// At a user's wish.
    #[error("interrupted")]
    Interrupted,
    /// A flight could not be set up.
    #[error(transparent)]
    Flight(#[from] Invalid),
    /// There is nothing to search.
    #[error("{0}")]
    Nothing(String),
}

/// Hunts from the nominal, or from what the flight of `seed` met where `from_flight`. Noise, gusts,
/// choices and the place on the path are in each flight those of `seed`.
///
/// # Errors
/// [`HuntError`] if nothing is drawn, the nominal flight fails, or the flight to begin from does
/// not.
pub fn hunt(campaign: &Campaign, seed: Seed, from_flight: bool, control: Control<'_>) -> Result<Hunt, HuntError> {
    let base = campaign.draws(seed)?;
    let space = Space::new(campaign, base.clone());
    let nothing = |why: String| Err(HuntError::Nothing(why));
    if space.dimension() == 0 {
        return nothing("the campaign draws no numbers: nothing to search".to_owned());
    }
    let fly = |point: &[f64]| fly(campaign, &space.draws(point), seed, control);
    let fails = |point: &[f64]| Ok(fly(point)?.1.verdict != Verdict::Good);
    let mut search = Search::new(&space, &fails, seed.stream(Purpose::Hunt));

    if search.fails(&vec![0.0; space.dimension()])? {
        return nothing("the nominal flight fails: there is no smallest fault".to_owned());
    }
    let alone = if from_flight { Vec::new() } else { search.alone()? };
    let begun = if from_flight {
        let point = space.point(&base);
        if !search.fails(&point)? {
            return nothing(format!("flight {} does not fail: there is nothing to shrink", seed.run));
        }
        Some(point)
    } else {
        let shorter = |a: &&Vec<f64>, b: &&Vec<f64>| length(a).total_cmp(&length(b));
        let best = alone.iter().flatten().min_by(shorter).cloned();
        search.anywhere(best)?
    };
    let mut smallest = None;
    let mut next = begun;
    while let Some(point) = next {
        let shrunk = search.shrunk(point)?;
        let (least, along) = search.checked(shrunk.clone())?;
        // One that is smaller on the same ray is where it goes on.
        next = (along.smaller_failed > 0).then_some(least);
        smallest = Some((shrunk, along));
    }

    let find = |point: &Vec<f64>| -> Result<Find, HuntError> {
        let (scenario, row) = fly(point)?;
        let differs = |name: &str, numbers, range: &std::ops::Range<usize>| {
            (length(&point[range.clone()]) > 0.0).then(|| (name.to_owned(), numbers))
        };
        let numbers = space.numbers(point);
        let groups = space.groups.iter().zip(numbers);
        let fault = groups.filter_map(|(group, numbers)| differs(&group.name, numbers, &group.range)).collect();
        let Row { verdict, end_s, mode, first_fault, dc_max_m, .. } = row;
        let find =
            Find { size: length(point), fault, verdict, end_s, mode, first_fault, dc_max_m, scenario: String::new() };
        Ok(Find { scenario: file(&find, &scenario), ..find })
    };
    let mut others: Vec<Find> = alone.iter().flatten().map(&find).collect::<Result<_, _>>()?;
    others.sort_by(|a, b| a.size.total_cmp(&b.size));
    let first = smallest.as_ref().map(|(point, _)| find(point)).transpose()?;
    let flights = search.flights() + first.iter().len() + others.len();
    let mut harmless = Vec::new();
    for group in space.groups.iter().filter(|_| !from_flight) {
        for (place, index) in group.range.clone().enumerate() {
            if alone[2 * index].is_none() && alone[2 * index + 1].is_none() {
                let place = if group.range.len() > 1 { format!("[{place}]") } else { String::new() };
                harmless.push(format!("{}{place}", group.name));
            }
        }
    }
    let finds = first.into_iter().chain(others).collect();
    Ok(Hunt { flights, finds, harmless, along: smallest.map(|(_, along)| along) })
}

/// Flies draws as `run` flies the scenario that says the same, and returns that.
fn fly(campaign: &Campaign, draws: &Draws, seed: Seed, control: Control<'_>) -> Result<(Table, Row), HuntError> {
    let table = campaign.table(draws)?;
    let Drawn { scenario, start } = campaign.flight(table.clone(), draws)?;
    let table = written(campaign, table, &start, scenario.standing || scenario.bodies.is_some(), seed)?;
    let scenario = campaign.scenario(table.clone())?;
    // As the file says it, to the last bit.
    let start = Start { state: State::from_paper(&scenario.initial), ..start };
    let pilot = pilot(&scenario.controller, &ApproachFields::default())?.without_telemetry();
    let ground_p3 = scenario.ground_p3;
    let row = fly_drawn(&Drawn { scenario, start }, pilot, ground_p3, seed, control, &mut |_| {});
    row.map(|row| (table, row)).ok_or(HuntError::Interrupted)
}

/// A drawn scenario with all that a campaign adds to it.
fn written(
    campaign: &Campaign,
    mut table: Table,
    start: &Start,
    is_stated: bool,
    seed: Seed,
) -> Result<Table, Invalid> {
    let whole = |name: &str, number: u64| {
        let number = i64::try_from(number).map_err(|_| Invalid::new(name, "too large for a scenario file"))?;
        Ok::<Value, Invalid>(number.into())
    };
    table.insert("seed".to_owned(), whole("seed", seed.batch)?);
    table.insert("run".to_owned(), whole("run", seed.run)?);
    table.insert("take_over".to_owned(), true.into());
    if let Some(ground_p3) = campaign.ground_p3 {
        table.insert("ground_p3".to_owned(), ground_p3.into());
    }
    set(&mut table, "controller.supervised", true.into())?;
    let ApproachFields { speed, acceleration, tilt_deg, rod_deg } = campaign.approach;
    for (parameter, value) in [
        ("APP_SPEED", speed),
        ("APP_ACC", acceleration),
        ("APP_TILT", tilt_deg.map(f64::to_radians)),
        ("APP_ROD", rod_deg.map(f64::to_radians)),
    ] {
        if let Some(value) = value {
            set(&mut table, &format!("controller.parameters.{parameter}"), value.into())?;
        }
    }
    if !is_stated {
        let [p1, p2, p3, alpha, beta, phi, theta, psi, v1, v2, v3, alpha_dot, beta_dot, o1, o2, o3] =
            start.state.to_paper();
        let mut initial = Table::new();
        let list = |numbers: [f64; 3]| Value::Array(numbers.map(Value::Float).to_vec());
        for (name, numbers) in [("position", [p1, p2, p3]), ("velocity", [v1, v2, v3]), ("body_rate", [o1, o2, o3])] {
            initial.insert(name.to_owned(), list(numbers));
        }
        for (name, number) in [
            ("alpha", alpha),
            ("beta", beta),
            ("phi", phi),
            ("theta", theta),
            ("psi", psi),
            ("alpha_dot", alpha_dot),
            ("beta_dot", beta_dot),
        ] {
            initial.insert(name.to_owned(), number.into());
        }
        table.insert("initial".to_owned(), initial.into());
    }
    Ok(table)
}

/// The text of a find's scenario file.
fn file(find: &Find, table: &Table) -> String {
    let mut table = table.clone();
    table.insert("title".to_owned(), find.line().into());
    toml::to_string(&table).expect("tables of plain values")
}

impl Find {
    /// In a line.
    #[must_use]
    pub fn line(&self) -> String {
        let number = |number: &f64| format!("{number:.4}");
        let fault = self.fault.iter().map(|(name, numbers)| match numbers.as_slice() {
            [one] => format!("{name} {}", number(one)),
            numbers => format!("{name} [{}]", numbers.iter().map(number).collect::<Vec<_>>().join(", ")),
        });
        let mut line = format!("{:.3} of the range: {}; ", self.size, fault.collect::<Vec<_>>().join(", "));
        let _ = match self.verdict {
            Verdict::Good => write!(line, "good"),
            Verdict::Held | Verdict::Off => {
                write!(line, "d_C {} in {}", crate::study::compare::length(self.dc_max_m), self.mode)
            }
            Verdict::Crashed => write!(line, "on the ground at {:.2} s", self.end_s),
            Verdict::Lost | Verdict::NonFinite => write!(line, "lost at {:.2} s", self.end_s),
        };
        if !self.first_fault.is_empty() {
            let _ = write!(line, ", first fault {}", self.first_fault);
        }
        line
    }
}

impl Hunt {
    /// For a terminal; `name` gives each find's file.
    #[must_use]
    pub fn text(&self, name: impl Fn(usize) -> String) -> String {
        let mut text = String::new();
        let Some(first) = self.finds.first() else {
            return format!("{} flights, and none fails, to the ends of what is drawn\n", self.flights);
        };
        let _ = writeln!(
            text,
            "{} flights; the smallest fault that fails, {}:\n  {}",
            self.flights,
            name(0),
            first.line()
        );
        if let Some(Along { smaller, smaller_failed, larger, larger_failed }) = self.along {
            let _ = writeln!(
                text,
                "along its ray {smaller_failed} of {smaller} smaller and {larger_failed} of {larger} larger ones fail"
            );
        }
        if self.finds.len() > 1 {
            let _ = writeln!(text, "the least that fails of one number alone:");
        }
        for (index, find) in self.finds.iter().enumerate().skip(1) {
            let _ = writeln!(text, "  {}: {}", name(index), find.line());
        }
        if !self.harmless.is_empty() {
            let _ =
                writeln!(text, "alone, to the ends of their ranges, these fail none: {}", self.harmless.join(", "));
        }
        text
    }
}
