//! How a target is spoken with.

use std::time::Duration;

/// Who sets the pace of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Each state is a control step of the target, as fast as both can.
    Lockstep,
    /// The target's own timer; states are sent as time goes by, and its latest command is used.
    RealTime,
}

/// How to speak with a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Who sets the pace.
    pub pace: Pace,
    /// Without an answer for this long the target is lost.
    pub patience: Duration,
    /// Without an answer for this long the question is sent again.
    pub retry: Duration,
    /// Ask for ξ, ν, margins and what the observers found with the samples that are logged.
    pub telemetry: bool,
}

impl Default for Options {
    /// Lockstep with telemetry, 5 s of patience.
    fn default() -> Self {
        Self {
            pace: Pace::Lockstep,
            patience: Duration::from_secs(5),
            retry: Duration::from_millis(50),
            telemetry: true,
        }
    }
}
