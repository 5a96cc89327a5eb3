//! The load's own velocity, where its place is measured finely.
//!
//! Hook and rod are corrected apart, each for the accelerometer's noise that has moved it, and the
//! sum of their velocities has what both leave. The load itself that noise does not move but along
//! the cable. Where its place is measured, an observer on its own motion knows it better,
//!
//! ```text
//! p̂˙ = v̂ + 2 o e,   v̂˙ = g e3 − s q + f + 2 o² e,   f˙ = o³ e,   e = p − p̂                   (16)
//! o² = N_a/(σ √Δ)
//! ```
//!
//! with f what air and a wrong rod add, and o where white noise of the acceleration and of places
//! of deviation σ every Δ seconds weigh the same.

use model::{Real, Vector3, is_within};

/// Slowest observer, rad/s: behind a coarser measurement hook and rod know better.
const LEAST: f64 = 7.0;
/// Of the rate of places, the most that the observer is fast by: its gains are those of (16) in
/// continuous time.
const MOST: f64 = 0.1;
/// Time without a place after which there is nothing to go on from, and oldest place, s.
const PAUSE: f64 = 0.05;
/// A place so far from where the observer is, m, is where it begins anew.
const FAR: f64 = 0.3;

/// The observer of the load's motion.
#[derive(Clone, Debug)]
pub(super) struct Track<T> {
    position: Vector3<T>,
    velocity: Vector3<T>,
    force: Vector3<T>,
    /// Since the last place, s, no more than [`PAUSE`].
    since: T,
}

impl<T: Real> Track<T> {
    pub(super) fn none() -> Self {
        Self { position: Vector3::zeros(), velocity: Vector3::zeros(), force: Vector3::zeros(), since: T::lit(PAUSE) }
    }

    fn is_off(&self) -> bool {
        self.since >= T::lit(PAUSE)
    }

    /// A `period` (s) with g e3 − s q.
    #[inline]
    pub(super) fn pass(&mut self, acceleration: &Vector3<T>, period: T) {
        if self.is_off() {
            return;
        }
        let gained = (acceleration + self.force) * period;
        self.position += (self.velocity + gained * T::lit(0.5)) * period;
        self.velocity += gained;
        self.since = (self.since + period).min(T::lit(PAUSE));
    }

    /// Takes a `place` of this `deviation`, m, and `age`, s, under an accelerometer's `noise`,
    /// m/s²/√Hz; without a place before it, from the load's `motion` by hook and rod.
    #[cold]
    pub(super) fn take(&mut self, place: &Vector3<T>, [deviation, age, noise]: [T; 3], motion: &[Vector3<T>; 2]) {
        // A second place in a period tells nothing of velocity.
        if self.since <= T::zero() {
            return;
        }
        let error = place - (self.position - self.velocity * age);
        if self.is_off() || !is_within(&error, T::lit(FAR * FAR)) {
            [self.position, self.velocity] = *motion;
            self.force = Vector3::zeros();
        } else {
            let fastest = T::lit(MOST) / self.since;
            let rate = (noise / (deviation * self.since.sqrt())).sqrt().min(fastest);
            if rate < T::lit(LEAST) {
                *self = Self::none();
                return;
            }
            let gain = error * (rate * self.since);
            self.position += gain * T::lit(2.0);
            self.velocity += gain * (rate * T::lit(2.0));
            self.force += gain * (rate * rate);
        }
        self.since = if age < T::lit(PAUSE) { T::zero() } else { T::lit(PAUSE) };
    }

    /// The load's velocity, where it is tracked.
    #[inline]
    pub(super) fn velocity(&self) -> Option<&Vector3<T>> {
        (!self.is_off()).then_some(&self.velocity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 0.002;
    /// Motion capture's: 1 mm, 10 ms, behind 0.015 m/s²/√Hz.
    const SEEN: [f64; 3] = [0.001, 0.01, 0.015];

    /// Flies a second of a load that the air pushes with 0.3 m/s², seen every other period.
    fn flown(deviation: f64) -> (Track<f64>, f64) {
        let mut track = Track::none();
        let (air, age) = (0.3, SEEN[1]);
        let at = |t: f64| Vector3::new(0.5 * air * t * t, 0.0, 0.0);
        for step in 1..=500 {
            track.pass(&Vector3::zeros(), PERIOD);
            if step % 2 == 0 {
                let place = at(f64::from(step) * PERIOD - age);
                track.take(&place, [deviation, age, SEEN[2]], &[Vector3::zeros(); 2]);
            }
        }
        (track, air)
    }

    #[test]
    fn a_steady_push_leaves_no_error() {
        let (track, push) = flown(SEEN[0]);
        // What the start has left after 15 time constants, and the age's ½ τ² of 0.3 m/s².
        let off = track.velocity().unwrap() - Vector3::new(push, 0.0, 0.0);
        assert!(off.amax() < 1e-3, "{off}");
        assert!((track.force.x - push).abs() < 0.01, "{}", track.force);
    }

    #[test]
    fn a_coarse_measurement_is_left_to_the_filter() {
        assert!(flown(0.02).0.velocity().is_none());
    }

    #[test]
    fn it_ends_with_the_places() {
        let (mut track, _) = flown(SEEN[0]);
        for _ in 0..24 {
            track.pass(&Vector3::zeros(), PERIOD);
            assert!(track.velocity().is_some());
        }
        track.pass(&Vector3::zeros(), PERIOD * 2.0);
        assert!(track.velocity().is_none());
    }

    #[test]
    fn what_can_not_be_is_begun_anew_from() {
        let (mut track, _) = flown(SEEN[0]);
        let told = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 5.0, 6.0)];
        for place in [1e30, f64::NAN] {
            track.pass(&Vector3::zeros(), PERIOD);
            track.take(&Vector3::new(place, 0.0, 0.0), SEEN, &told);
            assert_eq!(track.velocity(), Some(&told[1]));
        }
        track.take(&Vector3::zeros(), SEEN, &told);
        assert_eq!(track.velocity(), Some(&told[1]));
    }
}
