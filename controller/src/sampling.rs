//! The rate, the latency and the lag that a law is told.

use model::{OutOfRange, Real};

use crate::ranges::{LATENCY, PERIOD, ROTOR_LAG};

/// Shortest time constant that the lead leaves of the rotors' lag, s, and the most by which it
/// amplifies a command's step.
const LED_LAG: f64 = 0.01;
const MOST_LEAD: f64 = 5.0;

/// When the law is called and when its command acts.
///
/// ```
/// use controller::Sampling;
///
/// // 500 Hz, states 10 ms old when their command begins to act, motors of 30 ms.
/// let sampling = Sampling { latency: 0.01, rotor_lag: 0.03, ..Sampling::every(0.002_f32) };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling<T> {
    /// Control period h, s.
    pub period: T,
    /// Known time from the state's sample to its command's start, s, at most
    /// [`MAX_DELAY`](crate::MAX_DELAY) periods.
    pub latency: T,
    /// Known time constant of the rotors' first-order lag, s.
    pub rotor_lag: T,
    /// Evaluate the law for when its command acts: `latency` + `rotor_lag` + h/2 ahead. Off, it is
    /// evaluated at the sample.
    pub look_ahead: bool,
}

impl<T: Real> Sampling<T> {
    /// Every `period` s, no latency, no lag, looking ahead.
    pub fn every(period: T) -> Self {
        Self { period, latency: T::zero(), rotor_lag: T::zero(), look_ahead: true }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Sampling<U> {
        Sampling {
            period: self.period.cast(),
            latency: self.latency.cast(),
            rotor_lag: self.rotor_lag.cast(),
            look_ahead: self.look_ahead,
        }
    }

    pub(crate) fn check(&self) -> Result<(), OutOfRange<T>> {
        PERIOD.check(self.period)?;
        LATENCY.check(self.latency)?;
        ROTOR_LAG.check(self.rotor_lag)
    }

    /// Half a period where the law looks ahead.
    pub(crate) fn half_hold(&self) -> T {
        if self.look_ahead { self.period * T::lit(0.5) } else { T::zero() }
    }

    /// From the sample to when the law is evaluated for.
    pub(crate) fn horizon(&self) -> T {
        if self.look_ahead { self.latency + led(self.rotor_lag) + self.half_hold() } else { T::zero() }
    }
}

/// What the lead leaves of a `lag`, s.
pub(crate) fn led<T: Real>(lag: T) -> T {
    lag.min((lag * T::lit(1.0 / MOST_LEAD)).max(T::lit(LED_LAG)))
}
