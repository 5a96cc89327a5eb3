//! Measurements of the load itself, where there are some: they make the filter better, and it never
//! needs them.
//!
//! A camera gives the direction of the cable, motion capture the places of both bodies, a receiver
//! on the load its place, and either may give its velocity. Each is brought to the rod's horizontal
//! components, compared with the nominal rod at the time of the sample, τ ago,
//!
//! ```text
//! direction, position: ν = z_q − (q − τ q̇ + ½ τ² q̈)_h,    h·δx = η − τ ζ                       (8)
//! velocity:            ν = z_q̇ − (q̇ − τ q̈)_h,             h·δx = ζ                             (9)
//! ```
//!
//! and summed up, since a camera may be faster than the filter's cycle: the mean of n innovations
//! has a variance of R/n. They age while they wait to be taken in: `waited` is the time since the
//! sums were empty.

use model::{Real, Vector3};

use super::state::{ERRORS, index};
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
    /// Where load and UAV (its centre of mass) are, m, seen at one instant, as motion capture does,
    /// with the standard deviation per axis of each, m. What navigation makes of the UAV's place
    /// has the accelerometer's noise in common with the rod; what is seen has not.
    Pair([Vector3<T>; 2], T),
    /// How it moves, m/s, with its standard deviation per axis, m/s.
    Velocity(Vector3<T>, T),
}

/// The nominal rod, its rate and its acceleration, in N.
pub(super) struct Swing<T> {
    pub(super) rod: Vector3<T>,
    pub(super) rate: Vector3<T>,
    pub(super) acceleration: Vector3<T>,
}

/// Innovations of one kind, summed up over a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Innovations<T> {
    sum: [T; 2],
    variance: T,
    /// Of the ages that the measurements had when the sums were empty, s.
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

    fn add(&mut self, innovation: [T; 2], deviation: T, age: T, waited: T) {
        self.sum = [self.sum[0] + innovation[0], self.sum[1] + innovation[1]];
        self.variance += deviation * deviation;
        self.age += age - waited;
        self.count += T::one();
    }

    /// Adds a measured rod by (8).
    pub(super) fn add_rod(&mut self, rod: [T; 2], deviation: T, [age, waited]: [T; 2], now: &Swing<T>) {
        let then = now.rod - (now.rate - now.acceleration * (age * T::lit(0.5))) * age;
        self.add([rod[0] - then.x, rod[1] - then.y], deviation, age, waited);
    }

    /// Adds a measured rate by (9).
    pub(super) fn add_rate(&mut self, rate: [T; 2], deviation: T, [age, waited]: [T; 2], now: &Swing<T>) {
        let then = now.rate - now.acceleration * age;
        self.add([rate[0] - then.x, rate[1] - then.y], deviation, age, waited);
    }

    /// The nominal state has moved by `error`: so have the innovations against it.
    pub(super) fn shift(&mut self, error: &[T; ERRORS], is_rate: bool, waited: T) {
        let [q1, q2, w1, w2, ..] = *error;
        let age = self.age + waited * self.count;
        let moved = |rod: T, rate: T| if is_rate { rate * self.count } else { rod * self.count - rate * age };
        self.sum = [self.sum[0] - moved(q1, w1), self.sum[1] - moved(q2, w2)];
    }

    /// The mean innovation of axis 0 or 1 as a scalar: of the rod, or of its `rate`.
    pub(super) fn scalar(&self, axis: usize, is_rate: bool, waited: T) -> Scalar<T, ERRORS> {
        let per_count = T::one() / self.count.max(T::one());
        let innovation = if axis == 0 { self.sum[0] } else { self.sum[1] };
        let mut scalar = Scalar::of(innovation * per_count, self.variance * per_count * per_count);
        let (rod, rate) = if is_rate { (T::zero(), T::one()) } else { (T::one(), -(self.age * per_count + waited)) };
        if let Some(entry) = scalar.h.get_mut(index::ROD + axis) {
            *entry = rod;
        }
        if let Some(entry) = scalar.h.get_mut(index::RATE + axis) {
            *entry = rate;
        }
        scalar
    }
}
