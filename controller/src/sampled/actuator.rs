//! The actuators as the law knows them: what they can apply, a known latency and a known
//! first-order lag.

use model::{Command, OutOfRange, Real};
use nalgebra::Vector3;

use crate::ranges::{MAX_THRUST, MAX_TORQUE, MIN_THRUST};

/// What turns a command into thrust and torque. The law's memory goes on from what it says was
/// applied, so nothing winds up.
///
/// [`ActuatorLimits`] is a box; [`Rotors`](crate::sampled::allocation::Rotors) is a set of rotors.
pub trait Actuation<T: Real>: Clone {
    /// `Ok` if every parameter is in range.
    ///
    /// # Errors
    /// The first that is not.
    fn check(&self) -> Result<(), OutOfRange<T>>;

    /// What is applied when `command` is asked for: finite for every finite command.
    fn apply(&self, command: &Command<T>) -> Command<T>;

    /// The least thrust, N, not below zero: what an armed vehicle applies on the ground.
    fn least_thrust(&self) -> T;

    /// The largest thrust, N.
    fn largest_thrust(&self) -> T {
        self.apply(&Command::of_thrust(T::lit(MAX_THRUST.max))).thrust
    }
}

/// Thrust and each torque, limited on their own.
///
/// ```
/// use controller::{Actuation, ActuatorLimits, Command};
///
/// let max_torque = [3.0, 3.0, 0.5_f32];
/// let limits = ActuatorLimits { min_thrust: 3.0, max_thrust: 60.0, max_torque };
/// assert_eq!(limits.apply(&Command::of_thrust(80.0)).thrust, 60.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorLimits<T> {
    /// Least thrust, N.
    pub min_thrust: T,
    /// Largest thrust, N.
    pub max_thrust: T,
    /// Largest torque about each body axis, N·m, either way.
    pub max_torque: [T; 3],
}

impl<T: Real> ActuatorLimits<T> {
    /// Practically none: ±10⁶ N and N·m.
    #[must_use]
    pub fn none() -> Self {
        let far = T::lit(1e6);
        Self { min_thrust: -far, max_thrust: far, max_torque: [far; 3] }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> ActuatorLimits<U> {
        ActuatorLimits {
            min_thrust: self.min_thrust.cast(),
            max_thrust: self.max_thrust.cast(),
            max_torque: self.max_torque.map(T::cast),
        }
    }
}

impl<T: Real> Actuation<T> for ActuatorLimits<T> {
    fn check(&self) -> Result<(), OutOfRange<T>> {
        MIN_THRUST.check(self.min_thrust)?;
        OutOfRange::within("max_thrust", self.max_thrust, self.min_thrust, T::lit(MAX_THRUST.max))?;
        for (range, &torque) in MAX_TORQUE.iter().zip(&self.max_torque) {
            range.check(torque)?;
        }
        Ok(())
    }

    /// The nearest allowed command.
    #[inline(never)]
    fn apply(&self, command: &Command<T>) -> Command<T> {
        let [t1, t2, t3] = self.max_torque;
        let torque = &command.torque;
        Command {
            thrust: command.thrust.clamp(self.min_thrust, self.max_thrust),
            torque: Vector3::new(torque.x.clamp(-t1, t1), torque.y.clamp(-t2, t2), torque.z.clamp(-t3, t3)),
        }
    }

    fn least_thrust(&self) -> T {
        self.min_thrust.max(T::zero())
    }
}

/// Longest latency the actuators' model can hold, in control periods.
pub const MAX_DELAY: usize = 31;
/// A power of two, so that a count that wraps keeps its place.
const SLOTS: usize = MAX_DELAY + 1;

/// A delay line of whole periods, then a first-order lag (11.6): the commands' way to thrust and
/// torque.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Actuators<T> {
    /// A ring of the last commands; `newest` counts them, and the last one stands there.
    line: [Command<T>; SLOTS],
    newest: usize,
    delay: usize,
    /// Commands sent since the reset that do not act yet.
    waiting: usize,
    /// e^(−h/τ): what a period leaves of the distance to a command; 0 without lag.
    decay: T,
    /// Share of a command's step that acts at once: 1 without lag, 0 with one. A number, so that no
    /// period branches.
    at_once: T,
    /// Share of the newest command in the mean over the law's look ahead.
    share: T,
    /// What acts up to this sample, and by how much that stepped at the last one.
    applied: Command<T>,
    step: Command<T>,
    /// What the mean over the law's look ahead has over `applied`.
    drift: Command<T>,
}

impl<T: Real> Actuators<T> {
    /// With `latency` (rounded to whole periods) and `lag`, s; the law looks `horizon` s ahead.
    pub(crate) fn new(period: T, latency: T, lag: T, horizon: T, command: Command<T>) -> Result<Self, OutOfRange<T>> {
        // A thousandth of a period is left for rounding.
        OutOfRange::within("latency", latency, T::zero(), period * T::lit(MAX_DELAY as f64 + 1e-3))?;
        let periods = latency / period + T::lit(0.5);
        let delay = (0..MAX_DELAY).take_while(|&n| T::lit((n + 1) as f64) <= periods).count();
        let has_lag = lag > T::zero();
        let (decay, at_once) = if has_lag { ((-period / lag).exp(), T::zero()) } else { (T::zero(), T::one()) };
        // The newest command begins to act after the latency, and then as 1 − e^(−t/τ); until then
        // the line's commands pass from the applied to the newest.
        let acting = horizon - latency;
        let settled = if has_lag { lag * (T::one() - (-acting / lag).exp()) } else { T::zero() };
        let share =
            if delay > 0 || has_lag { (acting - settled + latency * T::lit(0.5)) / horizon } else { T::zero() };
        let share = if horizon > T::zero() { share } else { T::zero() };
        let line = [command; SLOTS];
        Ok(Self {
            line,
            newest: 0,
            delay,
            waiting: 0,
            decay,
            at_once,
            share,
            applied: command,
            step: Command::zero(),
            drift: Command::zero(),
        })
    }

    /// As if `command` had been applied for long.
    pub(crate) fn reset(&mut self, command: Command<T>) {
        if let Some(slot) = self.line.get_mut(self.newest % SLOTS) {
            *slot = command;
        }
        self.waiting = 0;
        self.applied = command;
        self.step = Command::zero();
        self.drift = Command::zero();
    }

    /// What acts up to this sample.
    #[inline]
    pub(crate) fn applied(&self) -> &Command<T> {
        &self.applied
    }

    /// By how much that stepped at the last sample: nothing where there is a lag.
    #[inline]
    pub(crate) fn step(&self) -> &Command<T> {
        &self.step
    }

    /// The command sent `before` the last one.
    #[inline]
    pub(crate) fn sent(&self, before: usize) -> Command<T> {
        self.line.get(self.newest.wrapping_sub(before) % SLOTS).copied().unwrap_or(self.applied)
    }

    /// What the mean over the law's look ahead has over [`applied`](Self::applied), as far as it is
    /// known before the coming command: nothing without latency and lag.
    #[inline]
    pub(crate) fn drift(&self) -> &Command<T> {
        &self.drift
    }

    /// Sends the command for the coming hold.
    #[inline]
    pub(crate) fn push(&mut self, command: Command<T>) {
        self.newest = self.newest.wrapping_add(1);
        if let Some(slot) = self.line.get_mut(self.newest % SLOTS) {
            *slot = command;
        }
        let delayed = if self.waiting < self.delay {
            self.waiting += 1;
            self.applied
        } else {
            self.sent(self.delay)
        };
        let step = delayed.minus(&self.applied);
        self.applied = delayed.minus(&step.times(self.decay));
        self.step = step.times(self.at_once);
        self.drift = command.minus(&self.applied).times(self.share);
    }
}
