//! Pause, go on, slower, faster, back: a factor of v_d that changes smoothly.
//!
//! r(t) v_d(p) in place of v_d(p), with r behind six equal lags a/(s + a) from what is wished: r
//! has five continuous derivatives, as many as reach the torque, at whatever moment the wish
//! changes, and goes from one value to another without overshoot.

// As in series.rs: indices run over compile-time bounds.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use model::{Real, Series};

use crate::path::Outputs;

/// Lags in a row.
const LAGS: usize = 6;

/// a, 1/s: from rest to v_d in some 5 s, with 0.36/s at most.
const RATE: f64 = 2.0;

/// What is left of a change that counts as none; and of a stop before the way is turned.
const SETTLED: f64 = 1e-6;
const STOPPED: f64 = 1e-3;

/// The most that can be wished, either way.
const MOST: f64 = 2.0;

/// e^(−a t) (a t)ᵏ/k!: what a time leaves of the lags' deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Decay<T>([T; LAGS]);

impl<T: Real> Decay<T> {
    fn over(time: T) -> Self {
        let x = time * T::lit(RATE);
        let mut decay = [(-x).exp(); LAGS];
        for k in 1..LAGS {
            decay[k] = decay[k - 1] * x * T::RECIPROCAL[k];
        }
        Self(decay)
    }

    #[inline(never)]
    fn of(&self, deviations: &[T; LAGS]) -> [T; LAGS] {
        let mut after = [T::zero(); LAGS];
        for lag in 0..LAGS {
            for k in 0..=lag {
                after[lag] += self.0[k] * deviations[lag - k];
            }
        }
        after
    }
}

/// The factor r of v_d, and how it changes. The way back is flown with a positive r and v_d turned
/// round, after a stop: a path may have another speed there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpeedFactor<T> {
    wished: T,
    /// What is wished once it has stopped.
    after: Option<T>,
    is_backward: bool,
    /// 1, or −1 on the way back of a path that has no speed of its own for it.
    sign: T,
    /// Of each lag's output from what is wished; r is the last one's.
    deviations: [T; LAGS],
    is_settled: bool,
    /// Settled where v_d itself is flown.
    is_one: bool,
    /// At 0 until the path is joined.
    is_waiting: bool,
    /// Over a control period, and as far as the law looks ahead.
    period: Decay<T>,
    horizon: Decay<T>,
}

impl<T: Real> SpeedFactor<T> {
    /// 1, asked for every `period` s about `horizon` s later.
    pub(crate) fn one(period: T, horizon: T) -> Self {
        Self {
            wished: T::one(),
            after: None,
            is_backward: false,
            sign: T::one(),
            deviations: [T::zero(); LAGS],
            is_settled: true,
            is_one: true,
            is_waiting: false,
            period: Decay::over(period),
            horizon: Decay::over(horizon),
        }
    }

    /// r now, negative on the way back.
    pub(crate) fn value(&self) -> T {
        let [.., last] = self.deviations;
        let value = self.wished + last;
        if self.is_backward { -value } else { value }
    }

    /// What v_d is multiplied by now.
    pub(crate) fn effective(&self) -> T {
        self.value().abs() * self.sign
    }

    /// Changes what is wished: 1 flies v_d, 0 stops, less goes back; at most [`MOST`] either way,
    /// and nothing changes for a NaN.
    pub(crate) fn wish(&mut self, factor: T) {
        if !factor.is_finite() {
            return;
        }
        let size = factor.abs().min(T::lit(MOST));
        let turns = size > T::zero() && (factor < T::zero()) != self.is_backward;
        self.after = turns.then_some(size);
        self.unsettle();
        self.change_to(if turns { T::zero() } else { size });
    }

    fn unsettle(&mut self) {
        (self.is_settled, self.is_one) = (false, false);
    }

    fn change_to(&mut self, wished: T) {
        let change = self.wished - wished;
        self.deviations = self.deviations.map(|deviation| deviation + change);
        self.wished = wished;
    }

    /// The way turns when it stands: returns which way it is then. [`turned`](Self::turned) tells
    /// how the path takes it.
    fn turning(&mut self) -> Option<bool> {
        let stands = self.deviations.iter().all(|deviation| deviation.abs() < T::lit(STOPPED));
        let after = self.after.filter(|_| stands)?;
        self.after = None;
        self.is_backward = !self.is_backward;
        self.change_to(after);
        Some(self.is_backward)
    }

    /// After a turn: whether the path has a speed for that way itself.
    pub(crate) fn turned(&mut self, has_own: bool) {
        self.sign = if self.is_backward && !has_own { -T::one() } else { T::one() };
    }

    /// Begins at 0, for a payload at rest.
    pub(crate) fn restart(&mut self) {
        self.deviations = [-self.wished; LAGS];
        self.is_waiting = false;
        self.unsettle();
    }

    /// The same, once the path [is joined](Self::advance).
    pub(crate) fn wait(&mut self) {
        self.restart();
        self.is_waiting = true;
    }

    /// A period on, at whose end the path is joined or not yet. Where the way turns in it, whether
    /// it is backward then, and [`turned`](Self::turned) is to be told.
    #[inline]
    pub(crate) fn advance(&mut self, is_joined: bool) -> Option<bool> {
        if self.is_settled { None } else { self.change(is_joined) }
    }

    #[cold]
    fn change(&mut self, is_joined: bool) -> Option<bool> {
        if self.is_waiting && !is_joined {
            return None;
        }
        self.is_waiting = false;
        self.deviations = self.period.of(&self.deviations);
        if self.after.is_some() {
            return self.turning();
        }
        if self.deviations.iter().all(|deviation| deviation.abs() < T::lit(SETTLED)) {
            self.deviations = [T::zero(); LAGS];
            (self.is_settled, self.is_one) = (true, self.wished * self.sign == T::one());
        }
        None
    }

    /// Brings the factor at the horizon into the outputs.
    #[inline(always)]
    pub(crate) fn apply(&self, outputs: &mut Outputs<T>) {
        if !self.is_one {
            self.scale(outputs);
        }
    }

    // Apart: flight at v_d does without it.
    #[inline(never)]
    fn scale(&self, outputs: &mut Outputs<T>) {
        // A wait has no rate, as if it were for ever.
        let ahead = if self.is_waiting { Series::constant(T::zero()) } else { self.ahead() };
        let missing = ahead * -self.sign + T::one();
        outputs.speed_error += outputs.prescribed * missing;
    }

    /// r(t) about the horizon.
    fn ahead(&self) -> Series<T, LAGS> {
        // Each derivative of a deviation is a times what the lag before has more.
        let mut deviations = self.horizon.of(&self.deviations);
        let mut derivatives = [T::zero(); LAGS];
        for order in 0..LAGS {
            derivatives[order] = deviations[LAGS - 1];
            for lag in (1..LAGS).rev() {
                deviations[lag] = (deviations[lag - 1] - deviations[lag]) * T::lit(RATE);
            }
            deviations[0] = -deviations[0] * T::lit(RATE);
        }
        Series::from_derivatives(derivatives) + self.wished
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factor_has_five_continuous_derivatives_and_does_not_overshoot() {
        let period = 0.002;
        let mut factor = SpeedFactor::<f64>::one(period, 0.0);
        let mut last = factor.ahead();
        for step in 0..20_000 {
            // Wishes at odd moments, some in the middle of a change.
            let wish = [(700, 0.0), (1500, 1.0), (2100, 0.5), (9000, 1.3), (9001, 0.2)];
            if let Some((_, wish)) = wish.into_iter().find(|(at, _)| *at == step) {
                factor.wish(wish);
            }
            // What is wished reaches the sixth derivative alone: the present series continues the
            // last one.
            let (now, expected) = (factor.ahead(), last.shift(period));
            for k in 0..LAGS {
                // The sixth derivative is at most a⁶ (1 + 1)⁶ = 4096 per unit of change: what it
                // adds within a period.
                let bound = 2.0 * 4096.0 * period.powi(6 - k as i32) + SETTLED * 64.0;
                let error = (now.derivative(k) - expected.derivative(k)).abs();
                assert!(error <= bound, "step {step}, order {k}: {error:e}");
            }
            assert!(factor.value() <= 1.3 + 1e-12 && factor.value() >= -1e-12, "step {step}");
            assert_eq!(factor.advance(true), None);
            last = now;
        }
        assert_eq!(factor.value(), 0.2);
    }

    #[test]
    fn the_way_turns_when_it_stands() {
        let mut factor = SpeedFactor::<f64>::one(0.002, 0.0);
        factor.wish(-0.5);
        let mut turns = 0;
        for _ in 0..20_000 {
            let before = factor.value();
            if let Some(is_backward) = factor.advance(true) {
                assert!(is_backward && before.abs() < 0.01, "{before}");
                factor.turned(false);
                turns += 1;
            }
        }
        assert_eq!((turns, factor.value(), factor.sign), (1, -0.5, -1.0));
    }

    #[test]
    fn factor_changes_as_fast_as_stated() {
        let mut factor = SpeedFactor::<f64>::one(0.002, 0.0);
        factor.wish(0.0);
        let mut fastest = 0.0_f64;
        for _ in 0..3000 {
            fastest = fastest.max(factor.ahead().derivative(1).abs());
            factor.advance(true);
        }
        // a 5⁵ e⁻⁵/5!.
        assert!((fastest - 0.351).abs() < 1e-3, "{fastest}");
        assert!(factor.value() < 0.05, "{}", factor.value());
    }
}
