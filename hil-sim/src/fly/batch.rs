//! Many flights at once, each on one thread.

use rayon::prelude::*;

use crate::describe::scenario::Scenario;
use crate::fly::flight::{Control, End};
use crate::fly::run::{Arithmetic, Flight, fly};

/// A scenario with its flight.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was flown.
    pub scenario: Scenario,
    /// The flight of the f32 controller with its f64 twin.
    pub flight: Flight,
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

/// Flies all scenarios, in their order; once they are to stop, those that are complete are
/// returned.
///
/// # Errors
/// [`BatchError`] for the first scenario that cannot be set up in f32.
pub fn fly_all(
    scenarios: Vec<Scenario>,
    arithmetic: Arithmetic,
    control: Control<'_>,
) -> Result<Vec<Outcome>, BatchError> {
    let outcomes: Vec<Option<Outcome>> = scenarios
        .into_par_iter()
        .map(|scenario| {
            let flight = fly(&scenario, arithmetic, true, control)
                .map_err(|error| BatchError { scenario: scenario.name.clone(), message: error.to_string() })?;
            Ok((flight.end != End::Interrupted).then_some(Outcome { scenario, flight }))
        })
        .collect::<Result<_, _>>()?;
    Ok(outcomes.into_iter().flatten().collect())
}
