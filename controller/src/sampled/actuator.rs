//! The actuators as the law knows them: what they can apply, a known latency and a known
//! first-order lag.

use model::{Command, OutOfRange, Real};
use nalgebra::Vector3;

use crate::ranges::{MAX_THRUST, MAX_TORQUE, MIN_THRUST};
use crate::sampling::led;

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

/// Model steps over a latency are about this long, s, and no more than so many: rounding makes none.
const STEP: f64 = 0.02 * 1.001;
const STEPS: usize = 8;

/// A delay line of whole periods, then a first-order lag (11.6): the commands' way to thrust and
/// torque. A lag is led (11.9): what is sent goes beyond what is wanted, so that thrust and torque
/// come to it sooner.
// In this order: what every step needs comes before what is large.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Actuators<T> {
    /// What acts up to this sample, and by how much that stepped at the last one: nothing with a
    /// lag.
    applied: Command<T>,
    step: Command<T>,
    /// What the mean over the law's look ahead has over what will act when the coming command
    /// begins to: nothing without a lag.
    drift: Command<T>,
    delay: usize,
    /// In how many legs the commands in flight are gone through: one where there are none.
    legs: usize,
    /// A ring of the last commands; `newest` counts them, and the last one stands there.
    newest: usize,
    line: [Command<T>; SLOTS],
    lag: Option<Lag<T>>,
}

/// A lag and its lead.
#[derive(Clone, Copy, Debug)]
struct Lag<T> {
    /// e^(−h/τ): what a period leaves of the distance to a command.
    decay: T,
    /// Share of a command in the mean over its period.
    mean_share: T,
    /// τ over what the lead leaves of it, and the inverse.
    lead: T,
    per_lead: T,
    /// Share of what is wanted in the mean from when the coming command begins to act to when the
    /// law's answer is for.
    share: T,
    /// What will act when the coming command begins to.
    arriving: Command<T>,
    /// The mean of what acted in the last period.
    mean: Command<T>,
}

impl<T: Real> Lag<T> {
    fn new(period: T, lag: T, led: T, ahead: T, command: Command<T>) -> Self {
        let decay = (-period / lag).exp();
        let settled = |lag: T, time: T| T::one() - lag / time * (T::one() - (-time / lag).exp());
        Self {
            decay,
            mean_share: settled(lag, period),
            lead: lag / led,
            per_lead: led / lag,
            share: if ahead > T::zero() { settled(led, ahead) } else { T::zero() },
            arriving: command,
            mean: command,
        }
    }

    /// What acts a period after `from` under `command`, and the mean until then.
    fn pass(&self, from: &Command<T>, command: &Command<T>) -> (Command<T>, Command<T>) {
        let missing = command.minus(from);
        (command.minus(&missing.times(self.decay)), from.plus(&missing.times(self.mean_share)))
    }
}

impl<T: Real> Actuators<T> {
    /// With `latency` (rounded to whole periods) and `lag`, s; the law looks `horizon` s ahead.
    pub(crate) fn new(period: T, latency: T, lag: T, horizon: T, command: Command<T>) -> Result<Self, OutOfRange<T>> {
        // A thousandth of a period is left for rounding.
        OutOfRange::within("latency", latency, T::zero(), period * T::lit(MAX_DELAY as f64 + 1e-3))?;
        let periods = latency / period + T::lit(0.5);
        let delay = (0..MAX_DELAY).take_while(|&n| T::lit((n + 1) as f64) <= periods).count();
        let flown = |legs: usize| T::lit(legs as f64) * T::lit(STEP);
        let legs = (1..STEPS.min(delay)).take_while(|&legs| flown(legs) < T::lit(delay as f64) * period).count() + 1;
        let lag = (lag > T::zero()).then(|| Lag::new(period, lag, led(lag), horizon - latency, command));
        Ok(Self {
            line: [command; SLOTS],
            newest: 0,
            delay,
            legs,
            applied: command,
            step: Command::zero(),
            drift: Command::zero(),
            lag,
        })
    }

    /// As if `command` had been applied for long.
    pub(crate) fn reset(&mut self, command: Command<T>) {
        self.line = [command; SLOTS];
        self.applied = command;
        (self.step, self.drift) = (Command::zero(), Command::zero());
        if let Some(lag) = &mut self.lag {
            (lag.arriving, lag.mean) = (command, command);
        }
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

    /// What will act when the coming command begins to.
    #[inline]
    pub(crate) fn arriving(&self) -> Command<T> {
        self.lag.as_ref().map_or_else(|| self.sent(0), |lag| lag.arriving)
    }

    /// What the mean from then to when the law's answer is for has over
    /// [`arriving`](Self::arriving), as far as it is known before the coming command: nothing
    /// without a lag.
    #[inline]
    pub(crate) fn drift(&self) -> &Command<T> {
        &self.drift
    }

    /// The mean of what acted in the last period.
    pub(crate) fn mean(&self) -> Command<T> {
        self.lag.as_ref().map_or(self.applied, |lag| lag.mean)
    }

    /// The latency that is modelled, s.
    pub(crate) fn latency(&self, period: T) -> T {
        T::lit(self.delay as f64) * period
    }

    /// Whether there is a latency.
    #[inline]
    pub(crate) fn is_late(&self) -> bool {
        self.delay > 0
    }

    /// In how many [legs](Self::leg) the commands in flight are gone through.
    pub(crate) fn legs(&self) -> usize {
        self.legs
    }

    /// A leg's length in periods and the sum of what acts in each; `acting` at its beginning, and
    /// then at its end.
    pub(crate) fn leg(&self, index: usize, acting: &mut Command<T>) -> (T, Command<T>) {
        let passed = |index: usize| (self.delay * index).checked_div(self.legs).unwrap_or(0);
        let (begin, end) = (passed(index), passed(index + 1));
        let mut sum = Command::zero();
        for period in begin..end {
            sum = sum.plus(&self.pass(acting, self.delay - 1 - period));
        }
        (T::lit((end - begin) as f64), sum)
    }

    /// The mean over the period of the command sent `before` the last one; `acting` at its
    /// beginning, and then at its end.
    // Apart where code is scarce: in its loop it would stand several times.
    #[cfg_attr(target_arch = "arm", inline(never))]
    fn pass(&self, acting: &mut Command<T>, before: usize) -> Command<T> {
        let command = self.sent(before);
        let Some(lag) = &self.lag else { return command };
        let (then, mean) = lag.pass(acting, &command);
        *acting = then;
        mean
    }

    /// What is to be sent for `wanted` to act (11.9), if that is something else.
    #[inline]
    pub(crate) fn led(&self, wanted: &Command<T>) -> Option<Command<T>> {
        self.lag.as_ref().map(|lag| lag.arriving.plus(&wanted.minus(&lag.arriving).times(lag.lead)))
    }

    /// What will act of a command `sent`: the inverse of [`led`](Self::led).
    #[inline]
    pub(crate) fn unled(&self, sent: &Command<T>) -> Command<T> {
        let unlead = |lag: &Lag<T>| lag.arriving.plus(&sent.minus(&lag.arriving).times(lag.per_lead));
        self.lag.as_ref().map_or(*sent, unlead)
    }

    /// Sends the command for the coming hold.
    #[inline]
    pub(crate) fn push(&mut self, command: &Command<T>) {
        self.newest = self.newest.wrapping_add(1);
        if let Some(slot) = self.line.get_mut(self.newest % SLOTS) {
            *slot = *command;
        }
        let delayed = if self.delay == 0 { *command } else { self.sent(self.delay) };
        if self.lag.is_some() {
            self.lag_behind(command, &delayed);
        } else {
            self.step = delayed.minus(&self.applied);
            self.applied = delayed;
        }
    }

    #[cold]
    fn lag_behind(&mut self, command: &Command<T>, delayed: &Command<T>) {
        let wanted = self.unled(command);
        if let Some(lag) = &mut self.lag {
            (self.applied, lag.mean) = lag.pass(&self.applied, delayed);
            (lag.arriving, _) = lag.pass(&lag.arriving, command);
            self.drift = wanted.minus(&lag.arriving).times(lag.share);
        }
    }
}
