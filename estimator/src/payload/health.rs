//! What may be believed of the payload filter.

use model::{Real, Vector3};

/// Whether the cable carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cable {
    /// It pulls: the pendulum holds.
    Taut,
    /// It does not: the load stands, flies by itself, or is lost. Where it is, nobody can tell.
    Slack,
}

/// What the estimate of the rod is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Validity {
    /// As good as its standard deviation says.
    Valid,
    /// Not known to 0.15 rad, or not to 0.04 rad an axis for 3030 periods (6 s at 500 Hz), or to
    /// 0.15 rad for twice as many, yet.
    Converging,
    /// The thrust model and the rod have disagreed for some 500 periods, 1 s at 500 Hz, beyond what
    /// noise explains: something is not as told.
    Inconsistent,
    /// Inputs have been missing for more than 50 periods, 0.1 s at 500 Hz.
    Blind,
    /// The cable is slack: there is no rod.
    Slack,
}

/// The filter's word on itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Health<T> {
    /// Whether the rod can be trusted, and why not.
    pub validity: Validity,
    /// Standard deviation of the rod's direction, rad: of both axes together.
    pub rod_deviation: T,
    /// Of its rate, 1/s.
    pub rate_deviation: T,
    /// Mean over some 500 periods, 1 s at 500 Hz, of ν²/S of the thrust model's three scalars: 1
    /// where the noise is as told.
    pub surprise: [T; 3],
}

/// Pull as a share of the payload's weight: below the one the cable goes slack, above the other it
/// is taut again.
const SLACK: f64 = 0.2;
const TAUT: f64 = 0.4;
/// Windows in a row that say so.
const WINDOWS: u8 = 2;
/// Windows from a start in which thrust scale and mass are found to agree: no word on the cable
/// before.
const SETTLING: u8 = 10;

/// Looks at the cable's pull, window by window.
#[derive(Clone, Copy, Debug)]
pub(super) struct CableWatch<T> {
    pub(super) cable: Cable,
    /// Smoothed pull on the UAV in N (frame), N (newton).
    pub(super) pull: Vector3<T>,
    against: u8,
    settling: u8,
}

impl<T: Real> CableWatch<T> {
    pub(super) fn new(cable: Cable) -> Self {
        Self { cable, pull: Vector3::zeros(), against: 0, settling: SETTLING }
    }

    /// Thrust scale and mass are to be found anew.
    pub(super) fn settle(&mut self) {
        (self.against, self.settling) = (0, SETTLING);
    }

    /// Takes the `pull` of a window, N, with the payload's `weight`, N. Returns whether the cable
    /// has just changed.
    pub(super) fn look(&mut self, pull: &Vector3<T>, weight: T) -> bool {
        // Over some two windows.
        self.pull += (pull - self.pull) * T::lit(0.4);
        if self.settling > 0 {
            self.settling -= 1;
            return false;
        }
        // A cable can't push: a pull upward is an error of thrust.
        let size = if self.pull.z > T::zero() { self.pull.dot(&self.pull).sqrt() } else { T::zero() };
        let is_against = match self.cable {
            Cable::Taut => size < weight * T::lit(SLACK),
            Cable::Slack => size > weight * T::lit(TAUT),
        };
        self.against = if is_against { self.against.saturating_add(1) } else { 0 };
        let has_changed = self.against >= WINDOWS;
        if has_changed {
            self.against = 0;
            self.cable = if self.cable == Cable::Taut { Cable::Slack } else { Cable::Taut };
        }
        has_changed
    }
}
