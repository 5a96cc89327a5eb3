//! The numbers of a route: control points, and the runs that they belong to.

use model::{OutOfRange, Real};

use crate::path::spline::POINTS;

/// A control point of a route's splines. Plain data: a table of them can stand in a `const`, in
/// flash.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Knot<T> {
    /// Of the curve, N, m.
    pub point: [T; 3],
    /// From `point` to that of the next knot, m, with a rounding of its own size: it makes the
    /// curve's derivatives, far from the origin too.
    pub step: [T; 3],
    /// Of the two fields that h1 and h2 are counted along, unit vectors in N, across the curve and
    /// across each other.
    pub normals: [[T; 3]; 2],
    /// Of v_d on the way forwards and on the way back, m/s, both positive along their ways.
    pub speed: [T; 2],
    /// Of ψ_d, rad, without jumps of 2π from knot to knot.
    pub yaw: T,
}

impl<T: Real> Knot<T> {
    /// The same knot with each number rounded to another scalar.
    pub fn cast<U: Real>(&self) -> Knot<U> {
        let number = |x: T| U::lit(x.to_f64());
        Knot {
            point: self.point.map(number),
            step: self.step.map(number),
            normals: self.normals.map(|normal| normal.map(number)),
            speed: self.speed.map(number),
            yaw: number(self.yaw),
        }
    }

    pub(super) fn check(&self) -> Result<(), OutOfRange<T>> {
        let numbers = |field, numbers: &[T], bound: f64| {
            numbers.iter().try_for_each(|&number| OutOfRange::check(field, number, -bound, bound))
        };
        numbers("point", &self.point, 1e5)?;
        numbers("step", &self.step, 1e3)?;
        numbers("normal", self.normals.as_flattened(), 1.1)?;
        numbers("speed", &self.speed, 100.0)?;
        numbers("yaw", &[self.yaw], 1e4)
    }
}

/// A part of a route between two stops, or all of a closed one.
///
/// Its curve belongs to the parameters from 0 to `knots` − 7. A closed run repeats its first seven
/// knots at its end; an open one goes on straight at either end, at the speed it has there: its
/// waypoints are six spans from its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run<T> {
    /// Where its knots begin in the table.
    pub first: usize,
    /// How many they are, at least 8.
    pub knots: usize,
    /// Its end is its beginning.
    pub is_closed: bool,
    /// How long the payload rests at either end before it goes on by itself, s, at least 0;
    /// infinite: until it is told.
    pub dwell: T,
}

impl<T: Real> Run<T> {
    /// The parameters from its first waypoint to its last; of a closed one, once round.
    pub fn flown(&self) -> core::ops::Range<usize> {
        let spans = self.knots.saturating_sub(POINTS - 1);
        if self.is_closed { 0..spans } else { BEYOND..spans.saturating_sub(BEYOND) }
    }

    /// The same run with its number rounded to another scalar.
    pub fn cast<U: Real>(&self) -> Run<U> {
        let Self { first, knots, is_closed, dwell } = *self;
        Run { first, knots, is_closed, dwell: U::lit(dwell.to_f64()) }
    }
}

/// Spans of an open run before its first waypoint and behind its last.
pub const BEYOND: usize = 6;

/// What is flown after the last run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// Nothing: the payload stays at the last stop.
    #[default]
    Stay,
    /// The way back, so many times; and at its end the way forwards, and so on.
    Back(u32),
    /// The first run, so many times, for a route that ends where it begins.
    Again(u32),
}

/// Where a route's numbers are: in flash, in an array, or shared on the heap.
pub trait Table<T> {
    /// All runs' control points.
    fn knots(&self) -> &[Knot<T>];
    /// The runs, in the order in which they are flown.
    fn runs(&self) -> &[Run<T>];
}

/// A table of any two things that hold slices.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RouteTable<K, R> {
    /// All runs' control points.
    pub knots: K,
    /// The runs, in the order in which they are flown.
    pub runs: R,
}

impl<T, K: AsRef<[Knot<T>]>, R: AsRef<[Run<T>]>> Table<T> for RouteTable<K, R> {
    #[inline]
    fn knots(&self) -> &[Knot<T>] {
        self.knots.as_ref()
    }
    #[inline]
    fn runs(&self) -> &[Run<T>] {
        self.runs.as_ref()
    }
}

impl<T, S: Table<T>> Table<T> for &S {
    #[inline]
    fn knots(&self) -> &[Knot<T>] {
        (**self).knots()
    }
    #[inline]
    fn runs(&self) -> &[Run<T>] {
        (**self).runs()
    }
}
