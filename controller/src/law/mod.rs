//! Laws in continuous time, and what they are made of.

pub(crate) mod approach;
pub(crate) mod compensator;
pub(crate) mod follow;
pub(crate) mod gains;
pub(crate) mod hold;
pub(crate) mod lift;
pub(crate) mod lower;
pub(crate) mod margins;
pub(crate) mod solution;
pub(crate) mod speed_factor;
pub(crate) mod track;

use model::{Disturbance, Real, State, Vehicle};

use crate::error::Refused;
use approach::{Approach, Pace};
use solution::{Answer, Solution};

/// Where a law is to be evaluated: at the instant its command acts.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<T> {
    /// The state predicted for then.
    pub state: State<T>,
    /// ζ then.
    pub zeta: [T; 4],
    /// How long after the sample that is, s.
    pub horizon: T,
}

/// A law in continuous time, with the memory that is its own: a path's nearest point, integrals, an
/// approach under way.
///
/// What every law shares, ζ, the observers and the commands on their way, is the
/// [`Sampler`](crate::Sampler)'s, which lends it to one law at a time. Every period it asks the law
/// for an [`answer`](Self::answer) with [`evaluate`](Self::evaluate), and where that flies, tells
/// it so with [`accept`](Self::accept). A law that is [restarted](Self::restart) or
/// [joins](Self::join) remembers nothing of before.
pub trait Law<T: Real> {
    /// The outputs with their derivatives, ξ.
    type Xi: Copy;

    /// Evaluates the law at `ahead` against `disturbance`.
    fn evaluate(&mut self, vehicle: &Vehicle<T>, ahead: &Ahead<T>, disturbance: &Disturbance<T>);

    /// The last answer, all zeros before the first; its command is what it was before the limits.
    fn answer(&self) -> &Answer<T>;

    /// The same with ξ, which is made when it is asked for.
    fn solution(&self) -> Solution<T, Self::Xi>;

    /// Tells the law that its last answer flies, limited or not as `is_saturated` says, and moves
    /// it on by a `period`, s.
    fn accept(&mut self, period: T, is_saturated: bool);

    /// Starts at `state`, on the path or reference without an approach.
    fn restart(&mut self, state: &State<T>);

    /// Starts at `state` with an approach that keeps `pace`.
    ///
    /// # Errors
    /// [`Refused`], and nothing has changed; if it is [`Refused::Searching`], the law is to be
    /// asked again in the next period.
    fn join(&mut self, state: &State<T>, pace: &Pace<T>) -> Result<(), Refused>;

    /// The approach under way, if any.
    fn approach(&self) -> &Approach<T>;
}
