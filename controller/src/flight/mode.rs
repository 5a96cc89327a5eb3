//! The supervisor's words: modes, requests, faults, the policy, what it is told and what it
//! answers.

use model::{Channel, Command, OutOfRange, Real, State, Uav};
use nalgebra::Vector3;

use crate::law::margins::Margin;
use crate::ranges::{ASIDE, CALM, CLEAR, COAST, DESCENT, PAYLOAD_LOST, RISE, SINK};

/// What the vehicle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Mode {
    /// Rotors off.
    Off,
    /// Armed, at least thrust.
    Idle,
    /// Rising from the ground until the load has left it too; by the UAV's own navigation.
    TakeOff,
    /// On the way to the path.
    Join,
    /// On the path.
    Follow,
    /// At rest, or coming to it.
    Hold,
    /// Sinking at [`Policy::descent`].
    Land,
    /// No state to fly on.
    Fault,
}

/// What the pilot wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Request {
    /// Rotors off, at once.
    Off,
    /// Armed on the ground; in flight the same as [`Hold`](Self::Hold).
    Idle,
    /// Along the path.
    Follow,
    /// Stop where it is.
    Hold,
    /// Sink, and switch off on the ground.
    Land,
}

/// Why the vehicle is not doing what was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Fault {
    /// There was no state.
    NoState,
    /// This part of the state is not a number, or out of any range.
    State(Channel),
    /// This margin is beyond its limit.
    Margin(Margin),
    /// The law's answer was not finite.
    NotFinite,
    /// No point of the path was found from here.
    NoPath,
    /// The cable does not pull, or the load is nearer than the cable was told to be long.
    Slack,
    /// The payload is gone.
    PayloadLost,
    /// Load, rod and UAV are measured where no cable of this length could have them together, or
    /// the load where its velocity does not lead.
    Contradiction,
    /// A landing UAV was carried by what it does not stand on: by its cable, with the load caught
    /// on the way down.
    Caught,
}

/// What to do without a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lost<T> {
    /// Cut the rotors; only [`Request::Off`] leaves the fault.
    Cut,
    /// Sink with this share of the hover thrust, 0 to 1, and no torque; a good state again leads to
    /// hold.
    Sink(T),
}

/// What is done when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Policy<T> {
    /// How long the last command goes on without a good state, s.
    pub coast: T,
    /// What comes after that.
    pub lost: Lost<T>,
    /// Whether hold goes back to the path by itself when [`Request::Follow`] still stands, and the
    /// vehicle has been calm.
    pub resume: bool,
    /// How long the vehicle must have been calm before it rejoins, s.
    pub calm: T,
    /// Speed of a take-off, m/s.
    pub rise: T,
    /// How much higher than the cable is long a take-off rises, m.
    pub clear: T,
    /// Speed of a landing, m/s.
    pub descent: T,
    /// How far from the load the UAV lands, m; no further than the cable lets it.
    pub aside: T,
    /// Share of the payload's mass below which it counts as lost.
    pub payload_lost: T,
}

impl<T: Real> Default for Policy<T> {
    /// 0.1 s, then sinking at 90 % of the hover thrust; back to the path after a calm second;
    /// take-off at 0.4 m/s to a metre above the cable's length; landing at 0.4 m/s, 0.6 m beside
    /// the load; lost below 30 %.
    fn default() -> Self {
        Self {
            coast: COAST.default(),
            lost: Lost::Sink(SINK.default()),
            resume: true,
            calm: CALM.default(),
            rise: RISE.default(),
            clear: CLEAR.default(),
            descent: DESCENT.default(),
            aside: ASIDE.default(),
            payload_lost: PAYLOAD_LOST.default(),
        }
    }
}

impl<T: Real> Policy<T> {
    pub(crate) fn check(&self) -> Result<(), OutOfRange<T>> {
        COAST.check(self.coast)?;
        CALM.check(self.calm)?;
        RISE.check(self.rise)?;
        CLEAR.check(self.clear)?;
        DESCENT.check(self.descent)?;
        ASIDE.check(self.aside)?;
        PAYLOAD_LOST.check(self.payload_lost)?;
        match self.lost {
            Lost::Cut => Ok(()),
            Lost::Sink(share) => SINK.check(share),
        }
    }
}

/// What a step answers; what the law had to say to it is in
/// [`Supervisor::solution`](crate::Supervisor::solution).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output<T> {
    /// Finite and within the limits; nothing at all in [`Mode::Off`].
    pub command: Command<T>,
    /// The mode it was made in.
    pub mode: Mode,
    /// The last fault since a request changed.
    pub fault: Option<Fault>,
    /// A margin past its warning.
    pub warning: Option<Margin>,
}

/// What is known at a sample.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a, T> {
    /// Load, rod and UAV, where all of it is known.
    pub state: Option<&'a State<T>>,
    /// The UAV as its own navigation has it; it is taken from the state and a taut cable where this
    /// is missing. What hold and landing fly, and what a slack cable is told by.
    pub uav: Option<&'a Uav<T>>,
    /// The accelerometer's specific force in body axes, m/s²: the cable's pull, without waiting for
    /// the velocity to show it.
    pub specific_force: Option<Vector3<T>>,
}

impl<T: Real> Measured<'_, T> {
    /// ω in body axes, rad/s, of the state, or else of the UAV; none where neither is to be
    /// trusted.
    #[must_use]
    pub fn body_rate(&self) -> Option<Vector3<T>> {
        let state = self.state.filter(|state| state.check().is_ok()).map(|state| state.body_rate);
        state.or_else(|| self.uav.filter(|uav| uav.check().is_ok()).map(|uav| uav.body_rate))
    }
}

impl<'a, T> From<Option<&'a State<T>>> for Measured<'a, T> {
    /// The state, where there is one, and nothing else.
    fn from(state: Option<&'a State<T>>) -> Self {
        Self { state, uav: None, specific_force: None }
    }
}

impl<'a, T> From<&'a State<T>> for Measured<'a, T> {
    /// The state and nothing else.
    fn from(state: &'a State<T>) -> Self {
        Some(state).into()
    }
}
