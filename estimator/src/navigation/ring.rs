//! Where the IMU was: what a late fix is compared with.
//!
//! A ring of (x, v) every half cycle, newest first. A correction of the state moves the whole ring
//! by what it means for then,
//!
//! ```text
//! x_i ← x_i + Δx − τ_i Δv + ½ τ_i² Δa,   v_i ← v_i + Δv − τ_i Δa,   Δa = Δθ × f − R Δb_a             (11)
//! ```
//!
//! so there is no replay, no output predictor and no buffer of the IMU's samples.

use model::{Real, Vector3};

use super::strapdown::Moved;

/// Entries, half cycles apart: 150 periods, 0.3 s at 500 Hz.
const ENTRIES: usize = 11;

#[derive(Clone, Debug)]
pub(crate) struct Ring<T> {
    entries: [(Vector3<T>, Vector3<T>); ENTRIES],
    /// From the newest entry to now, and between two entries, s.
    since: T,
    spacing: T,
}

impl<T: Real> Ring<T> {
    /// At rest at a place for long.
    pub(crate) fn new(position: &Vector3<T>, velocity: &Vector3<T>, spacing: T) -> Self {
        let mut ring = Self { entries: [(*position, *velocity); ENTRIES], since: T::zero(), spacing };
        ring.restart(position, velocity);
        ring
    }

    /// Straight on at `velocity` before now.
    pub(crate) fn restart(&mut self, position: &Vector3<T>, velocity: &Vector3<T>) {
        self.since = T::zero();
        let mut age = T::zero();
        for entry in &mut self.entries {
            *entry = (position - velocity * age, *velocity);
            age += self.spacing;
        }
    }

    /// The oldest age that it reaches back to, s.
    pub(crate) fn span(&self) -> T {
        self.since + self.spacing * T::lit((ENTRIES - 1) as f64)
    }

    pub(crate) fn pass(&mut self, period: T) {
        self.since += period;
    }

    pub(crate) fn push(&mut self, position: &Vector3<T>, velocity: &Vector3<T>) {
        self.entries.copy_within(0..ENTRIES - 1, 1);
        if let Some(newest) = self.entries.first_mut() {
            *newest = (*position, *velocity);
        }
        self.since = T::zero();
    }

    /// (x, v) of `age` s ago, between two entries; `now` where that is later than the newest.
    pub(crate) fn at(&self, age: T, now: (Vector3<T>, Vector3<T>)) -> (Vector3<T>, Vector3<T>) {
        let mut newer_age = self.since;
        if age < newer_age {
            let newest = self.entry(0);
            let share = age / newer_age;
            return (now.0 + (newest.0 - now.0) * share, now.1 + (newest.1 - now.1) * share);
        }
        let mut place = 0;
        for _ in 0..ENTRIES - 2 {
            if age >= newer_age + self.spacing {
                newer_age += self.spacing;
                place += 1;
            }
        }
        let (newer, older) = (self.entry(place), self.entry(place + 1));
        let share = ((age - newer_age) / self.spacing).min(T::one());
        (newer.0 + (older.0 - newer.0) * share, newer.1 + (older.1 - newer.1) * share)
    }

    fn entry(&self, place: usize) -> (Vector3<T>, Vector3<T>) {
        self.entries.get(place).copied().unwrap_or_else(|| (Vector3::zeros(), Vector3::zeros()))
    }

    /// (11).
    pub(crate) fn shift(&mut self, Moved { position, velocity, acceleration, .. }: &Moved<T>) {
        let mut age = self.since;
        for (x, v) in &mut self.entries {
            *x += position - (velocity - acceleration * (age * T::lit(0.5))) * age;
            *v += velocity - acceleration * age;
            age += self.spacing;
        }
    }
}
