//! What tells navigation where it is: fixes, height, heading, motion capture. Each is compared with
//! the nominal state when it comes, at the age it has, and waits as innovations for its turn, a
//! scalar a period. An innovation ages while it waits.
//!
//! With the point measured at r in body axes from the IMU and an age τ, (10) gives
//!
//! ```text
//! position:  δx − τ δv + ½ τ² (−[f]× δθ − R δb_a) − [R r]× δθ                                  (12)
//! velocity:  δv − τ (−[f]× δθ − R δb_a) − [R (ω × r)]× δθ                                      (13)
//! height:    −δx₃
//! heading:   δθ₃ − b1₃ (b1₁ δθ₁ + b1₂ δθ₂)/(b1₁² + b1₂²)                                       (14)
//! attitude:  δθ
//! ```

use model::{Matrix3, Real, Vector3};

use super::strapdown::{ERRORS, Moved, Strapdown, index};
use crate::covariance::Scalar;
use crate::lever::axes;

/// What an aid measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Position,
    Velocity,
    Height,
    Heading,
    Attitude,
}

/// Counts periods. What waits does so for less than the two minutes in which it comes round.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock<T> {
    periods: u16,
    period: T,
}

impl<T: Real> Clock<T> {
    pub(crate) fn every(period: T) -> Self {
        Self { periods: 0, period }
    }

    pub(crate) fn pass(&mut self) {
        self.periods = self.periods.wrapping_add(1);
    }

    /// Since a moment, s.
    fn passed(&self, since: u16) -> T {
        self.period * T::lit(f64::from(self.periods.wrapping_sub(since)))
    }
}

/// Innovations of one kind that wait: sums, since a source may be faster than the filter's cycle.
/// The mean of n has a variance of R/n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Waiting<T> {
    sum: Vector3<T>,
    /// Horizontal and down.
    variance: [T; 2],
    /// Sum of the ages, s, that the measurements had at `since`, by the filter's clock.
    age: T,
    since: u16,
    /// The lever in body axes, m, or the velocity that it brings, m/s; the last one's stands for
    /// all.
    lever: Vector3<T>,
    count: T,
}

impl<T: Real> Waiting<T> {
    pub(crate) fn none() -> Self {
        Self {
            sum: Vector3::zeros(),
            variance: [T::zero(); 2],
            age: T::zero(),
            since: 0,
            lever: Vector3::zeros(),
            count: T::zero(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.count < T::lit(0.5)
    }

    pub(crate) fn add(
        &mut self,
        innovation: &Vector3<T>,
        deviations: [T; 2],
        age: T,
        lever: &Vector3<T>,
        clock: &Clock<T>,
    ) {
        if self.is_empty() {
            self.since = clock.periods;
        }
        self.sum += innovation;
        for (variance, deviation) in self.variance.iter_mut().zip(deviations) {
            *variance += deviation * deviation;
        }
        self.age += age - clock.passed(self.since);
        self.lever = *lever;
        self.count += T::one();
    }

    /// The state has moved: so have the innovations against it.
    pub(crate) fn shift(&mut self, kind: Kind, moved: &Moved<T>, attitude: &Matrix3<T>, clock: &Clock<T>) {
        if self.is_empty() {
            return;
        }
        let Moved { position, velocity, acceleration, turn } = moved;
        let age = self.age / self.count + clock.passed(self.since);
        let only = |along: T| Vector3::new(along, T::zero(), T::zero());
        let by = match kind {
            Kind::Position => {
                let lever = turn.cross(&(attitude * self.lever));
                position - (velocity - acceleration * (age * T::lit(0.5))) * age + lever
            }
            Kind::Velocity => velocity - acceleration * age + turn.cross(&(attitude * self.lever)),
            Kind::Attitude => *turn,
            Kind::Height => only(-position.z),
            Kind::Heading => only(turn.dot(&heading(attitude))),
        };
        self.sum -= by * self.count;
    }

    /// Row `axis` of the mean.
    pub(crate) fn scalar(
        &self,
        kind: Kind,
        axis: usize,
        state: &Strapdown<T>,
        clock: &Clock<T>,
    ) -> Scalar<T, ERRORS> {
        let per_count = T::one() / self.count.max(T::one());
        let [across, down] = self.variance;
        let variance = if axis == 2 { down } else { across } * per_count * per_count;
        let innovation = self.sum.get(axis).copied().unwrap_or_else(T::zero) * per_count;
        let mut scalar = Scalar::of(innovation, variance);
        let age = self.age * per_count + clock.passed(self.since);
        let mut set = |at: usize, value: T| {
            if let Some(entry) = scalar.h.get_mut(at) {
                *entry = value;
            }
        };
        // How δv̇ turns with δθ and δb_a: row `axis` of −[f]× and of −R.
        let by_force = cross_row(&(state.attitude * state.force), axis);
        let [b1, b2, b3] = axes(&state.attitude).map(|b| b.get(axis).copied().unwrap_or_else(T::zero));
        let late = match kind {
            Kind::Position => {
                set(index::POSITION + axis, T::one());
                set(index::VELOCITY + axis, -age);
                age * age * T::lit(0.5)
            }
            Kind::Velocity => {
                set(index::VELOCITY + axis, T::one());
                -age
            }
            Kind::Height => {
                set(index::POSITION + 2, -T::one());
                return scalar;
            }
            Kind::Heading => {
                let along = heading(&state.attitude);
                set(index::ATTITUDE, along.x);
                set(index::ATTITUDE + 1, along.y);
                set(index::ATTITUDE + 2, along.z);
                return scalar;
            }
            Kind::Attitude => {
                set(index::ATTITUDE + axis, T::one());
                return scalar;
            }
        };
        let by_lever = cross_row(&(state.attitude * self.lever), axis);
        let turn = by_force * late + by_lever;
        set(index::ATTITUDE, turn.x);
        set(index::ATTITUDE + 1, turn.y);
        set(index::ATTITUDE + 2, turn.z);
        set(index::ACCELEROMETER, -(b1 * late));
        set(index::ACCELEROMETER + 1, -(b2 * late));
        set(index::ACCELEROMETER + 2, -(b3 * late));
        scalar
    }
}

impl Kind {
    /// All, in the order in which they take turns.
    pub(crate) const ALL: [Self; 5] = [Self::Position, Self::Velocity, Self::Attitude, Self::Heading, Self::Height];

    pub(crate) const fn scalars(self) -> usize {
        match self {
            Self::Height | Self::Heading => 1,
            Self::Position | Self::Velocity | Self::Attitude => 3,
        }
    }
}

/// (14), per δθ.
fn heading<T: Real>(attitude: &Matrix3<T>) -> Vector3<T> {
    let [b1, ..] = axes(attitude);
    let tilt = -b1.z / (b1.x * b1.x + b1.y * b1.y).max(T::lit(0.01));
    Vector3::new(tilt * b1.x, tilt * b1.y, T::one())
}

/// Row `axis` of −[v]×.
fn cross_row<T: Real>(v: &Vector3<T>, axis: usize) -> Vector3<T> {
    match axis {
        0 => Vector3::new(T::zero(), v.z, -v.y),
        1 => Vector3::new(-v.z, T::zero(), v.x),
        _ => Vector3::new(v.y, -v.x, T::zero()),
    }
}
