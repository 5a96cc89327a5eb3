//! `[[request]]`: what a pilot asks for in the course of a flight.
//!
//! ```toml
//! initial = { position = [0.6, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true }
//! ground = {}
//! request = [
//!     { at_s = 0.0, do = "hold" },          # takes off, and waits in the air
//!     { at_s = 20.0, do = "follow" },
//!     { at_s = 40.0, speed_factor = 0.0 },  # stops on the path; 1.0 goes on
//!     { at_s = 50.0, do = "hold" },
//!     { at_s = 55.0, do = "land" },
//! ]
//! ```

use controller::Request;
use serde::Deserialize;

use super::Scenario;
use crate::describe::input::{Invalid, within};

/// Largest factor of the path's speed, either way.
const FACTOR: f64 = 2.0;

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AskedFields {
    at_s: f64,
    #[serde(rename = "do")]
    what: Option<Word>,
    speed_factor: Option<f64>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Word {
    Off,
    Idle,
    Hold,
    Follow,
    Land,
}

/// What is asked for from a time on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// When, s.
    pub at_s: f64,
    /// What the vehicle is to do; what it was to do before if left out.
    pub request: Option<Request>,
    /// Factor of the path's speed; as before if left out.
    pub speed_factor: Option<f64>,
}

/// Reads the requests of a flight of `duration_s`.
pub(super) fn requests(fields: Vec<AskedFields>, duration_s: f64) -> Result<Vec<Asked>, Invalid> {
    let mut last_s = 0.0;
    let read = fields.into_iter().enumerate().map(|(index, AskedFields { at_s, what, speed_factor })| {
        let field = |name: &str| format!("request[{index}].{name}");
        last_s = within(&field("at_s"), at_s, last_s..=duration_s)?;
        if what.is_none() && speed_factor.is_none() {
            return Err(Invalid::new(field("do"), "asks for nothing: give do or speed_factor"));
        }
        let speed_factor =
            speed_factor.map(|factor| within(&field("speed_factor"), factor, -FACTOR..=FACTOR)).transpose()?;
        let request = what.map(|word| match word {
            Word::Off => Request::Off,
            Word::Idle => Request::Idle,
            Word::Hold => Request::Hold,
            Word::Follow => Request::Follow,
            Word::Land => Request::Land,
        });
        Ok(Asked { at_s, request, speed_factor })
    });
    read.collect()
}

/// The requests of a flight as its control periods pass.
#[derive(Clone, Debug)]
pub struct Requests {
    /// With the period from which they hold.
    requests: Vec<(u64, Asked)>,
    passed: usize,
    request: Request,
}

impl Requests {
    /// Of `scenario`: until the first request a vehicle that stands keeps its rotors off, and one
    /// in flight follows.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        let requests = scenario.requests.iter().map(|asked| (scenario.periods(asked.at_s), *asked)).collect();
        Self { requests, passed: 0, request: if scenario.standing { Request::Off } else { Request::Follow } }
    }

    /// What is asked for in the period `step`, and a factor of the speed if one begins in it.
    /// Periods in their order.
    pub fn at(&mut self, step: u64) -> (Request, Option<f64>) {
        let mut factor = None;
        while let Some((_, asked)) = self.requests.get(self.passed).filter(|(from, _)| *from <= step) {
            self.request = asked.request.unwrap_or(self.request);
            factor = asked.speed_factor.or(factor);
            self.passed += 1;
        }
        (self.request, factor)
    }

    /// Whether nothing more will be asked for.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.passed == self.requests.len()
    }
}
