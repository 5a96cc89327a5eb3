//! What a board tells the control side, and what it hears back.

use link::dialect::{LOAD_COMMAND_DATA, LOAD_TELEMETRY_DATA, LoadFault};

use crate::estimate::Unseen;
use crate::failsafe::Loss;
use crate::store::NotKept;

/// What drives the control step, and whether the rotors do as they are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// The timer, with the latest state; rotors on.
    Flight,
    /// Each state frame; rotors off, since the vehicle is a simulated one.
    Lockstep,
    /// The timer, with the latest state; rotors off.
    RealTime,
}

/// What the board found out when it started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Boot {
    /// The watchdog caused the reset.
    pub by_watchdog: bool,
    /// Watchdog resets since power-on.
    pub watchdog_resets: u32,
    /// The crystal did not start.
    pub internal_clock: bool,
    /// Why parameters, mission and fence are not as they were before, if they are not.
    pub forgotten: Option<NotKept>,
    /// Core clock, Hz.
    pub core_hz: u32,
}

/// What happened since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Control steps on a good state.
    pub steps: u32,
    /// Control steps that ended after their period.
    pub overruns: u32,
    /// Control periods without a new state.
    pub missed: u32,
    /// States refused.
    pub refused: u32,
    /// Times a fault ended the law's flight.
    pub fallbacks: u32,
    /// Most counts of the core's timer that a control step took.
    pub worst_cycles: u32,
}

impl Counters {
    /// Counts a control period by what was wrong with its state. Returns what the link says of
    /// that.
    pub(super) fn take(&mut self, absence: Option<Absence>) -> LoadFault {
        let (counter, fault) = match absence {
            None => (&mut self.steps, LoadFault::empty()),
            Some(Absence::Bad) => (&mut self.refused, LoadFault::LOAD_FAULT_BAD_STATE),
            Some(_) => (&mut self.missed, LoadFault::LOAD_FAULT_NO_STATE),
        };
        *counter = counter.wrapping_add(1);
        fault
    }
}

/// Something that has happened and that the pilot must hear of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Nothing yet.
    Nothing,
    /// The pilot's switch, or the board's, has stopped the rotors.
    Killed,
    /// Too long without a state: the rotors have stopped.
    Blind,
    /// Load, UAV or cable came too near the fence, and the configured action is taken.
    Fence,
    /// No fix for so long that position drifts.
    Drifts,
    /// Fixes come again.
    Fixed,
    /// This is lost, and the configured action taken.
    Lost(Loss),
}

/// What was wrong with the last control period's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// None came.
    Missing,
    /// What came was from another time.
    Stale,
    /// What came was the last one again, to the last bit, which in flight no measurement is.
    Frozen,
    /// It was no state.
    Bad,
    /// None came, and the estimator does not know it.
    Unseen(Unseen),
}

/// The outcome of one control step.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the link. Its `rotor` is what the law wants, though the vehicle may be a simulated one.
    pub command: LOAD_COMMAND_DATA,
    /// For the link, when it is its turn.
    pub telemetry: Option<LOAD_TELEMETRY_DATA>,
    /// What the rotors get, from 0 to 1: zero when not armed, and when the vehicle is a simulated
    /// one.
    pub outputs: [f32; 4],
}
