//! A flown log through estimator and law again: what would they have said?
//!
//! The UAV moves as the log has it, whatever the law now says: the loop is open. The log's rows are
//! taken between by cubics (positions), great arcs (attitude) and lines, so that the controller
//! steps at its own rate. What is applied is what was logged: the law's memory goes on from that,
//! and its command is what it would have said at that instant. A law with fast poles says much of
//! little: torque is far apart where the state that it is given is centimetres from the one that
//! flew.

mod agreement;
mod filter;
mod flown;
mod logged;
mod pass;
mod series;

pub use agreement::{Difference, Replayed};

use cpu_time::ThreadTime;

use crate::describe::input::Invalid;
use crate::describe::scenario::Scenario;
use crate::fly::batch::Outcome;
use crate::fly::run::Flight;
use crate::report::log::ReadError;
use logged::Logged;
use pass::Pass;

/// The longest flight, s.
const LONGEST_S: f64 = 1e5;

/// A log that can't be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// It can't be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It does not say how the UAV moves.
    #[error("the log lacks {0}: nothing can be said without the UAV's motion")]
    Motion(String),
    /// It neither has the load nor what finds it.
    #[error(
        "the log lacks p1 … p3, v1 … v3 of the load, and f1 … f3 (PX4: vehicle_acceleration or sensor_combined), \
         from which it could be estimated: nothing can be said of the load"
    )]
    Load,
    /// The window has nothing of the log.
    #[error("--from {from} --to {to}: the log has {least:.3} to {most:.3} s")]
    Window {
        /// Asked for, s.
        from: f64,
        /// Asked for, s.
        to: f64,
        /// There, s.
        least: f64,
        /// There, s.
        most: f64,
    },
    /// More than a flight lasts.
    #[error("--from {from} --to {to} are {:.0} s, at most {LONGEST_S}: has the log's clock jumped?", to - from)]
    Long {
        /// s.
        from: f64,
        /// s.
        to: f64,
    },
    /// The scenario's numbers do not make a controller or a filter.
    #[error(transparent)]
    Scenario(#[from] Invalid),
}

/// What of a log is replayed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Part {
    /// From so many seconds of the log on; from its start if left out.
    pub from_s: Option<f64>,
    /// Up to so many; to its end if left out.
    pub to_s: Option<f64>,
    /// What all rotors give together at most, N, for logs that have shares of it.
    pub full_thrust: Option<f64>,
}

/// Replays the log in `bytes` with the estimator and the law of `scenario`: the law flies on the
/// estimate where the scenario has an `[estimator]` or the log no load, and on the logged load
/// elsewhere.
///
/// # Errors
/// [`ReplayError`] names what is missing or out of range.
pub fn replay(mut scenario: Scenario, bytes: &[u8], part: &Part) -> Result<Outcome, ReplayError> {
    let rotors = scenario.actuators.rotors.map(|rotors| 4.0 * rotors.max_thrust);
    let logged = Logged::read(bytes, part.full_thrust.or(rotors))?;
    let [least, most] = logged.span();
    let (from, to) = (part.from_s.unwrap_or(least).max(least), part.to_s.unwrap_or(most).min(most));
    let period = 1.0 / scenario.controller.rate_hz;
    if to - from < period {
        let (from, to) = (part.from_s.unwrap_or(least), part.to_s.unwrap_or(most));
        return Err(ReplayError::Window { from, to, least, most });
    }
    if to - from > LONGEST_S {
        return Err(ReplayError::Long { from, to });
    }
    scenario.duration_s = to - from;
    let begun = ThreadTime::now();
    let flown = Pass::new(&scenario, &logged, from)?.fly();
    let times_real_time = scenario.duration_s / begun.elapsed().as_secs_f64();
    let flight = Flight { times_real_time, times_real_time_with_twin: times_real_time, ..flown };
    Ok(Outcome { scenario, flight })
}
