//! Measurements of the load itself, where there are some: they make the filter better, and it never
//! needs them.
//!
//! A camera gives the direction of the cable, motion capture or a receiver on the load its place,
//! either may give its velocity. Each is brought to the rod's horizontal components, compared with
//! the nominal rod at the time of the sample, τ ago,
//!
//! ```text
//! direction, position: ν = z_q − (q − τ q̇ + ½ τ² q̈)_h,    h·δx = η − τ ζ                       (8)
//! velocity:            ν = z_q̇ − (q̇ − τ q̈)_h,             h·δx = ζ                             (9)
//! ```
//!
//! and summed up, since a camera may be faster than the filter's cycle: the mean of n innovations
//! has a variance of R/n.

use model::{Real, Vector3};

use super::pendulum::Pull;
use super::state::{ERRORS, PayloadState, index};
use crate::covariance::Scalar;

/// A measurement of the load, in N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoadMeasurement<T> {
    /// From the hook to the load, of any length but zero, with the standard deviation of its
    /// direction, rad.
    Direction(Vector3<T>, T),
    /// Where the load is, m, in the frame of the navigation's position, with its standard deviation
    /// per axis, m.
    Position(Vector3<T>, T),
    /// How it moves, m/s, with its standard deviation per axis, m/s.
    Velocity(Vector3<T>, T),
}

/// Innovations of one kind, summed up over a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovations<T> {
    sum: [T; 2],
    variance: T,
    age: T,
    count: T,
}

impl<T: Real> Innovations<T> {
    pub(super) fn none() -> Self {
        Self { sum: [T::zero(); 2], variance: T::zero(), age: T::zero(), count: T::zero() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count < T::lit(0.5)
    }

    fn add(&mut self, innovation: [T; 2], variance: T, age: T) {
        self.sum = [self.sum[0] + innovation[0], self.sum[1] + innovation[1]];
        self.variance += variance;
        self.age += age;
        self.count += T::one();
    }

    /// Adds a measured rod by (8).
    pub(super) fn add_rod(&mut self, rod: [T; 2], deviation: T, age: T, state: &PayloadState<T>, pull: &Pull<T>) {
        let then = state.rod - (state.rod_rate - pull.acceleration * (age * T::lit(0.5))) * age;
        self.add([rod[0] - then.x, rod[1] - then.y], deviation * deviation, age);
    }

    /// Adds a measured rate by (9).
    pub(super) fn add_rate(&mut self, rate: [T; 2], deviation: T, age: T, state: &PayloadState<T>, pull: &Pull<T>) {
        let then = state.rod_rate - pull.acceleration * age;
        self.add([rate[0] - then.x, rate[1] - then.y], deviation * deviation, age);
    }

    /// The nominal state has moved by `error`: so have the innovations against it.
    pub(super) fn shift(&mut self, error: &[T; ERRORS], is_rate: bool) {
        let [q1, q2, w1, w2, ..] = *error;
        let moved = |rod: T, rate: T| if is_rate { rate * self.count } else { rod * self.count - rate * self.age };
        self.sum = [self.sum[0] - moved(q1, w1), self.sum[1] - moved(q2, w2)];
    }

    /// The mean innovation of axis 0 or 1 as a scalar: of the rod, or of its `rate`.
    pub(super) fn scalar(&self, axis: usize, is_rate: bool) -> Scalar<T, ERRORS> {
        let per_count = T::one() / self.count.max(T::one());
        let innovation = if axis == 0 { self.sum[0] } else { self.sum[1] };
        let mut scalar = Scalar::of(innovation * per_count, self.variance * per_count * per_count);
        let (rod, rate) = if is_rate { (T::zero(), T::one()) } else { (T::one(), -(self.age * per_count)) };
        if let Some(entry) = scalar.h.get_mut(index::ROD + axis) {
            *entry = rod;
        }
        if let Some(entry) = scalar.h.get_mut(index::RATE + axis) {
            *entry = rate;
        }
        scalar
    }
}
