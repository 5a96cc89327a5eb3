//! Many flights at once, each on one thread.

use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

use crate::describe::scenario::Scenario;
use crate::fly::run::{Arithmetic, End, Flight, Options, fly};

/// A scenario with its flight.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was flown.
    pub scenario: Scenario,
    /// The flight of the f32 controller with its f64 twin.
    pub flight: Flight,
    /// Time flown over CPU time of one core, with the f32 law only: the flight without its twin.
    pub times_real_time: f64,
}

/// A scenario that could not be set up.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("scenario {scenario}: {message}")]
pub struct BatchError {
    /// Its name.
    pub scenario: String,
    /// Why.
    pub message: String,
}

/// Seconds that [`fly_all`] simulates for these scenarios: each is flown twice, with and without its twin.
#[must_use]
pub fn work_s(scenarios: &[Scenario]) -> f64 {
    scenarios.iter().map(|scenario| 2.0 * scenario.duration_s).sum()
}

/// Flies all scenarios, in their order; once `stop` is true, those that are complete are returned.
///
/// # Errors
/// [`BatchError`] for the first scenario that cannot be set up in f32.
pub fn fly_all(
    scenarios: Vec<Scenario>,
    arithmetic: Arithmetic,
    stop: &AtomicBool,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Outcome>, BatchError> {
    let outcomes: Vec<Option<Outcome>> = scenarios
        .into_par_iter()
        .map(|scenario| {
            let fly = |twin| {
                fly(&scenario, Options { arithmetic, twin, stop, progress })
                    .map_err(|error| BatchError { scenario: scenario.name.clone(), message: error.to_string() })
            };
            let (flight, alone) = (fly(true)?, fly(false)?);
            let interrupted = flight.end == End::Interrupted || alone.end == End::Interrupted;
            let times_real_time = alone.times_real_time;
            Ok((!interrupted).then_some(Outcome { scenario, flight, times_real_time }))
        })
        .collect::<Result<_, _>>()?;
    Ok(outcomes.into_iter().flatten().collect())
}
