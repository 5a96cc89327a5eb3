//! Campaign files.
//!
//! ```toml
//! title = "…"
//! runs = 10000                       # unless the command line says otherwise
//! ground_p3 = 0.0                    # where a body has crashed; left out: there is no ground
//!
//! [scenario]                         # common to all flights: the keys of a scenario file
//! duration_s = 40.0
//! …
//! [start]                            # drawn for every flight, each uniform up to this
//! distance_m = 5.0
//! …
//! [variables]                        # numbers that formulas below may use, drawn first
//! size = { uniform = [0.5, 2.0] }
//!
//! [draw]                             # any key of the scenario, by its path
//! "vehicle.uav_mass" = { formula = "2.5*size^3" }
//! "vehicle.payload_mass" = { uniform = [0.25, 0.75] }
//! "environment.air.wind" = { disc = 5.0 }
//! path = { choice = [{ kind = "circle", … }, { kind = "ellipse", … }] }
//!
//! [approach]                         # limits within which the path is joined
//! speed = 3.0
//! …
//! ```

use controller::State;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use toml::{Table, Value};

use super::draw::{Distribution, set};
use super::start::{Deviation, Start, StartFields};
use crate::describe::formula::Constants;
use crate::describe::input::{Invalid, read, within};
use crate::describe::path::PathSpec;
use crate::describe::scenario::{Law, Scenario};
use crate::world::Seed;
use crate::world::random::Purpose;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CampaignFields {
    #[serde(default)]
    title: String,
    #[serde(default = "thousand")]
    runs: u64,
    ground_p3: Option<f64>,
    scenario: Table,
    #[serde(default)]
    start: StartFields,
    #[serde(default)]
    variables: BTreeMap<String, Distribution>,
    #[serde(default)]
    draw: BTreeMap<String, Distribution>,
    #[serde(default)]
    approach: ApproachFields,
}

fn thousand() -> u64 {
    1000
}

/// Limits of the approach; as the controller's gentle ones where left out.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct ApproachFields {
    /// m/s.
    pub speed: Option<f64>,
    /// m/s².
    pub acceleration: Option<f64>,
    /// Degrees.
    pub tilt_deg: Option<f64>,
    /// Degrees.
    pub rod_deg: Option<f64>,
}

/// A campaign, validated.
#[derive(Debug)]
pub struct Campaign {
    /// A caption.
    pub title: String,
    /// Flights, unless told otherwise.
    pub runs: u64,
    /// Where a body has crashed, m.
    pub ground_p3: Option<f64>,
    /// Limits of the approach.
    pub approach: ApproachFields,
    scenario: Table,
    start: StartFields,
    variables: BTreeMap<String, Distribution>,
    draw: BTreeMap<String, Distribution>,
    /// Paths that have been walked round, which costs more than a flight: most campaigns draw the
    /// same few again and again.
    walked: Mutex<Vec<PathSpec>>,
}

/// Paths remembered.
const WALKED: usize = 64;

/// The built-in campaigns: name and text.
pub const BUILTIN: &[(&str, &str)] = &[
    ("campaign", include_str!("../../../scenarios/campaign.toml")),
    ("ground-to-ground", include_str!("../../../scenarios/ground-to-ground.toml")),
    (
        "ground-to-ground-rtk",
        concat!(
            include_str!("../../../scenarios/ground-to-ground.toml"),
            include_str!("../../../scenarios/on-rtk.toml")
        ),
    ),
];

/// The text of the built-in campaign of this name, if there is one.
#[must_use]
pub fn builtin(name: &str) -> Option<&'static str> {
    BUILTIN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// One flight of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// What is flown.
    pub scenario: Scenario,
    /// Where it starts.
    pub start: Start,
}

/// What is drawn for one flight.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draws {
    /// Of [`Campaign::distributions`]; none where a formula computes it.
    pub values: Vec<Option<Value>>,
    /// Where on the path it starts, as a share of its length.
    pub place: f64,
    /// How far off it.
    pub start: Deviation,
}

impl Campaign {
    /// Reads a campaign from the text of a file.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is unknown, missing or out of range.
    pub fn parse(text: &str) -> Result<Self, Invalid> {
        let table: Table = toml::from_str(text).map_err(|error| Invalid::new("file", error.message()))?;
        let CampaignFields { title, runs, ground_p3, scenario, start, variables, draw, approach } = read("", table)?;
        start.check()?;
        within("runs", runs, 1..=100_000_000)?;
        ground_p3.map(|p3| within("ground_p3", p3, -1e5..=1e5)).transpose()?;
        let walked = Mutex::default();
        let campaign = Self { title, runs, ground_p3, approach, scenario, start, variables, draw, walked };
        // Most mistakes show in the first flights; the others end the campaign with their flight's
        // number.
        for run in 0..8 {
            campaign.draw(Seed { batch: 0, run })?;
        }
        Ok(campaign)
    }

    /// The flight that `seed` stands for.
    ///
    /// # Errors
    /// [`Invalid`] if the drawn scenario is not valid.
    pub fn draw(&self, seed: Seed) -> Result<Drawn, Invalid> {
        let draws = self.draws(seed)?;
        self.flight(self.table(&draws)?, &draws)
    }

    /// What `seed` draws.
    pub(super) fn draws(&self, seed: Seed) -> Result<Draws, Invalid> {
        let mut random = seed.stream(Purpose::Draw);
        let values = self
            .distributions()
            .map(|(field, distribution)| distribution.draw(&field, &mut random))
            .collect::<Result<_, _>>()?;
        // In this order, which is a seed's meaning.
        let place = random.unit();
        Ok(Draws { values, place, start: self.start.draw(&mut random) })
    }

    /// All that is drawn but for the start, with its field, in the order in which it is drawn.
    pub(super) fn distributions(&self) -> impl Iterator<Item = (String, &Distribution)> {
        let variables = self.variables.iter().map(|(name, distribution)| (format!("variables.{name}"), distribution));
        variables.chain(self.draw.iter().map(|(path, distribution)| (path.clone(), distribution)))
    }

    /// How large starts are drawn.
    pub(super) fn start(&self) -> &StartFields {
        &self.start
    }

    /// The scenario's keys with these draws.
    pub(super) fn table(&self, draws: &Draws) -> Result<Table, Invalid> {
        let mut table = self.scenario.clone();
        let mut variables = Constants::new();
        let mut values = draws.values.iter().map(Option::as_ref);
        for (name, distribution) in &self.variables {
            let field = format!("variables.{name}");
            let value = distribution.value(&field, values.next().flatten(), &variables)?;
            let number = value.as_float().ok_or_else(|| Invalid::new(field, "not a number"))?;
            variables.insert(name.clone(), number);
        }
        for (path, distribution) in &self.draw {
            let value = distribution.value(path, values.next().flatten(), &variables)?;
            set(&mut table, path, value)?;
        }
        Ok(table)
    }

    /// The flight of a scenario's keys, with the start of these draws where the scenario is not of
    /// a vehicle that stands.
    pub(super) fn flight(&self, table: Table, draws: &Draws) -> Result<Drawn, Invalid> {
        let scenario = self.scenario(table)?;
        let Law::Follow { path, .. } = &scenario.controller.law else {
            let message = "campaigns fly the supervised law \"follow\"";
            return Err(Invalid::new("scenario.controller.law", message));
        };
        let lap = path.lap().map_err(|refusal| Invalid::new("scenario.path", refusal))?;
        let start = if scenario.standing {
            Start { state: State::from_paper(&scenario.initial), tilt_deg: 0.0, rod_deg: 0.0 }
        } else {
            draws.start.about(&lap.at(lap.length() * draws.place).position)
        };
        Ok(Drawn { scenario, start })
    }

    /// A scenario from its keys, with a path that has been walked round.
    pub(super) fn scenario(&self, table: Table) -> Result<Scenario, Invalid> {
        let mut scenario = Scenario::from_table("campaign", table)?;
        if let Law::Follow { path, .. } = &mut scenario.controller.law {
            self.remember(path);
        }
        Ok(scenario)
    }

    /// Puts an equal path that has been walked round in the place of `path`, or walks it.
    fn remember(&self, path: &mut PathSpec) {
        // A thread that panicked left nothing half done.
        let mut walked = self.walked.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = walked.iter().find(|known| *known == path) {
            path.clone_from(known);
        } else if walked.len() < WALKED {
            // A refusal is kept as well, and told by the caller.
            let _ = path.lap();
            walked.push(path.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"
        [scenario]
        duration_s = 1.0
        path = { kind = "circle", radius = 5.0, p3 = -10.0, speed = 1.0 }
        controller = { law = "follow", rate_hz = 500.0 }
        [start]
        distance_m = 2.0
        speed = 1.0
        [draw]
        "vehicle.payload_mass" = { uniform = [0.25, 0.75] }
        "environment.air.wind" = { disc = 5.0 }
    "#;

    #[test]
    fn draws_stay_in_their_ranges_and_repeat() {
        let campaign = Campaign::parse(TEXT).unwrap();
        let mut masses = Vec::new();
        for run in 0..200 {
            let seed = Seed { batch: 3, run };
            let Drawn { scenario, start } = campaign.draw(seed).unwrap();
            assert_eq!(campaign.draw(seed).unwrap(), Drawn { scenario: scenario.clone(), start });
            let position: [f64; 3] = start.state.position.into();
            assert!(scenario.controller.law.distance(position) <= 2.0);
            let wind = scenario.environment.air.unwrap().wind;
            assert!(wind[0].hypot(wind[1]) <= 5.0 && wind[2] == 0.0);
            masses.push(scenario.vehicle.payload_mass);
        }
        assert!(masses.iter().all(|mass| (0.25..0.75).contains(mass)));
        let mean = masses.iter().sum::<f64>() / 200.0;
        // Five standard errors: 5 · 0.5/√12/√200.
        assert!((mean - 0.5).abs() < 0.051, "{mean}");
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_by_name() {
        let error = |text: String| Campaign::parse(&text).unwrap_err().to_string();
        assert!(error(format!("{TEXT}\n\"vehicle.colour\" = {{ uniform = [0.0, 1.0] }}")).contains("vehicle.colour"));
        assert!(error(format!("{TEXT}\n\"sensors.position.melt\" = {{ disc = 1.0 }}")).contains("melt"));
        assert!(error(TEXT.replace("[0.25, 0.75]", "[-2.0, -1.0]")).contains("payload_mass"));
        assert!(error(TEXT.replace("speed = 1.0\n        [draw]", "spin = 1.0\n        [draw]")).contains("spin"));
    }
}
