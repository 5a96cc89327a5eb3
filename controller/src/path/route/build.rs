//! From waypoints to a route's table: legs, corners, stops.
//!
//! The curve's control points stand on the legs and, at a corner, on a circular arc that touches
//! both: eight of them in a row on one leg make the span straight, and the arc's ends are rounded
//! off by three knots either side, which the corner's size includes. They stand close at corners
//! and stops and farther apart between, so that a long leg takes few. Where the curve is to pass
//! smoothly through waypoints, each has one control point, put so that it does.

use model::{OutOfRange, Real};
use nalgebra::Vector3;

use super::fields;
use super::{Knot, Run};

/// A point of a route, with how it is flown from there on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint<T> {
    /// N, m, within ±10⁵. A stop is exactly there; a corner passes by it.
    pub point: [T; 3],
    /// How far from the point the corner's blend begins and ends, m, 0.02 to 1000; at most half of
    /// either leg is taken. `None`: no corner, but a point that the curve passes smoothly through,
    /// alone between corners or stops, or among evenly spaced others of its kind; where the spacing
    /// of those changes by more than a factor 2 it passes by.
    pub corner: Option<T>,
    /// Speed of the leg that begins here, m/s, 0.05 to 100.
    pub speed: T,
    /// ψ_d here, rad; between two waypoints it changes evenly. `None`: along the route's horizontal
    /// part, and unchanged where that is vertical.
    pub yaw: Option<T>,
    /// The payload comes to rest here for so long, s, at least 0; infinite: until it is told to go
    /// on. `None`: it passes, but for the ends of an open route.
    pub stop: Option<T>,
}

/// How a route is sped up and slowed down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoutePace<T> {
    /// Bound of the acceleration along the route and across it, m/s², 0.05 to 20; smoothed, so that
    /// it is kept to within some 10 %.
    pub acceleration: T,
    /// k of v_d = k (distance) near a stop, 1/s, 0.05 to 5: below the slowest pole of the speed's
    /// loop.
    pub stop_rate: T,
    /// Time in which the acceleration may rise to its bound a, s, 0.05 to 10: its second derivative
    /// is kept to a/rise² and its fourth to a/rise⁴. √(L/g) makes the UAV's acceleration of the
    /// payload's size.
    pub rise: T,
}

impl<T: Real> Default for RoutePace<T> {
    /// 1 m/s², 0.5/s, 0.4 s.
    fn default() -> Self {
        Self { acceleration: T::one(), stop_rate: T::lit(0.5), rise: T::lit(0.4) }
    }
}

/// Why waypoints make no route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RouteError<T> {
    /// A number of this waypoint, counted from 0, is out of range.
    Waypoint(usize, OutOfRange<T>),
    /// A number of the pace is out of range.
    Pace(OutOfRange<T>),
    /// Fewer than two waypoints, or three for a closed route.
    TooFew,
    /// The leg that begins at this waypoint is shorter than 0.05 m.
    ShortLeg(usize),
    /// The route turns by more than 150° (2.62 rad) at this waypoint, without a stop.
    SharpTurn(usize),
    /// The table is full: it needs more knots.
    Knots,
    /// The table needs more runs.
    Runs,
}

impl<T: Real> core::fmt::Display for RouteError<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Waypoint(index, error) => write!(f, "waypoint {index}: {error}"),
            Self::Pace(error) => error.fmt(f),
            Self::TooFew => f.write_str("an open route needs at least two waypoints, a closed one three"),
            Self::ShortLeg(index) => {
                write!(f, "waypoint {index}: the next one is nearer than {SHORTEST_LEG} m")
            }
            Self::SharpTurn(index) => {
                let degrees = LARGEST_TURN.to_degrees();
                write!(
                    f,
                    "waypoint {index}: the route turns by more than {degrees:.0} degrees; only a stop can do that"
                )
            }
            Self::Knots => f.write_str("the route needs more knots than the table holds"),
            Self::Runs => f.write_str("the route has more stops than the table holds"),
        }
    }
}

impl<T: Real> core::error::Error for RouteError<T> {}

/// m.
pub const SHORTEST_LEG: f64 = 0.05;
/// rad.
pub const LARGEST_TURN: f64 = 2.62;

/// Turns below this do not count, rad.
const LEAST_TURN: f64 = 0.01;
/// Knots on an arc.
const ARC: f64 = 6.0;
/// Knots that round off either end of an arc.
const ROUNDING: f64 = 3.0;
/// Spacing of knots about a stop, m; and as a share of the leg.
const STOP_SPACING: f64 = 0.5;
const STOP_SHARE: f64 = 1.0 / 24.0;
/// Even spacings next to a corner or stop; from there each metre away lets the spacing grow by
/// `GROWTH` up to `WIDEST`, m.
const EVEN: f64 = 4.0;
const GROWTH: f64 = 0.25;
const WIDEST: f64 = 10.0;

/// Knots before the first waypoint of an open run and behind its last.
pub(super) const BEYOND: usize = super::table::BEYOND + 3;

/// How many knots and runs were written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Built {
    /// Knots.
    pub knots: usize,
    /// Runs.
    pub runs: usize,
}

/// Where a waypoint is on a route: at the beginning of a span of a run, or where it is nearest to
/// the waypoint's corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passage {
    /// The run.
    pub run: usize,
    /// The span, as [`Route::parameter`](super::Route::parameter) counts them.
    pub span: usize,
}

/// Writes the route through `waypoints` into `knots` and `runs`. An open route has one run from
/// each stop to the next, its ends being stops; a closed one without stops is a single closed run,
/// and one with stops begins and ends at its first stop.
///
/// # Errors
/// The first thing that makes no route of the waypoints, or a slice that is too short.
pub fn build_route<T: Real>(
    waypoints: &[Waypoint<T>],
    is_closed: bool,
    pace: &RoutePace<T>,
    knots: &mut [Knot<T>],
    runs: &mut [Run<T>],
) -> Result<Built, RouteError<T>> {
    build_route_passing(waypoints, is_closed, pace, knots, runs, |_, _| {})
}

/// The same, telling where the route passes each waypoint, counted from 0, in the order flown. Of a
/// stop both are told: where the run before ends and where the next one begins.
///
/// # Errors
/// As [`build_route`].
pub fn build_route_passing<T: Real>(
    waypoints: &[Waypoint<T>],
    is_closed: bool,
    pace: &RoutePace<T>,
    knots: &mut [Knot<T>],
    runs: &mut [Run<T>],
    mut passes: impl FnMut(usize, Passage),
) -> Result<Built, RouteError<T>> {
    check(waypoints, is_closed, pace)?;
    let count = waypoints.len();
    let stop = waypoints.iter().position(|waypoint| waypoint.stop.is_some());
    let mut built = Built::default();
    let mut add = |course: Course<'_, T>, heading: &mut Option<T>| {
        let free = knots.get_mut(built.knots..).unwrap_or_default();
        let run = runs.get_mut(built.runs).ok_or(RouteError::Runs)?;
        let number = built.runs;
        // The weights at the beginning of a span are about the fourth of its knots.
        let used = course.lay(pace, heading, free, &mut |waypoint, knot| {
            passes(waypoint, Passage { run: number, span: knot.saturating_sub(3) });
        })?;
        let (_, last) = course.waypoint(course.last);
        let dwell = last.stop.unwrap_or_default();
        *run = Run { first: built.knots, knots: used, is_closed: course.is_closed, dwell };
        built = Built { knots: built.knots.saturating_add(used), runs: built.runs.saturating_add(1) };
        Ok(())
    };
    let mut heading = None;
    match (is_closed, stop) {
        (true, None) => add(Course { waypoints, first: 0, last: count, is_closed: true }, &mut heading)?,
        _ => {
            let (mut first, end) = match stop {
                Some(stop) if is_closed => (stop, stop.saturating_add(count)),
                _ => (0, count.saturating_sub(1)),
            };
            while first < end {
                let is_stop =
                    |at: &usize| waypoints.get(at.checked_rem(count).unwrap_or(0)).is_some_and(|w| w.stop.is_some());
                let last = (first.saturating_add(1)..end).find(is_stop).unwrap_or(end);
                add(Course { waypoints, first, last, is_closed: false }, &mut heading)?;
                first = last;
            }
        }
    }
    Ok(built)
}

fn check<T: Real>(waypoints: &[Waypoint<T>], is_closed: bool, pace: &RoutePace<T>) -> Result<(), RouteError<T>> {
    OutOfRange::check("acceleration", pace.acceleration, 0.05, 20.0).map_err(RouteError::Pace)?;
    OutOfRange::check("stop_rate", pace.stop_rate, 0.05, 5.0).map_err(RouteError::Pace)?;
    OutOfRange::check("rise", pace.rise, 0.05, 10.0).map_err(RouteError::Pace)?;
    if waypoints.len() < if is_closed { 3 } else { 2 } {
        return Err(RouteError::TooFew);
    }
    for (index, waypoint) in waypoints.iter().enumerate() {
        let number = |field, value, least, most| {
            OutOfRange::check(field, value, least, most).map_err(|error| RouteError::Waypoint(index, error))
        };
        waypoint.point.iter().try_for_each(|&coordinate| number("point", coordinate, -1e5, 1e5))?;
        number("corner", waypoint.corner.unwrap_or(T::one()), 0.02, 1e3)?;
        number("speed", waypoint.speed, 0.05, 100.0)?;
        number("stop", waypoint.stop.filter(|dwell| dwell.is_finite()).unwrap_or_default(), 0.0, 1e5)?;
        number("yaw", waypoint.yaw.unwrap_or_default(), -1e3, 1e3)?;
    }
    Ok(())
}

/// The waypoints from one stop to the next, or all of a closed route; the numbers go on behind the
/// last waypoint with the first.
#[derive(Clone, Copy)]
struct Course<'a, T> {
    waypoints: &'a [Waypoint<T>],
    first: usize,
    last: usize,
    is_closed: bool,
}

/// A straight line from one waypoint to the next.
struct Leg<T> {
    from: Vector3<T>,
    along: Vector3<T>,
    length: T,
}

/// How a waypoint is passed: on an arc that leaves the leg `tangent` before it and turns by `turn`,
/// over knots `spacing` apart; or smoothly, with a single knot.
#[derive(Clone, Copy)]
struct Corner<T> {
    is_smooth: bool,
    tangent: T,
    spacing: T,
    turn: T,
    radius: T,
    /// From the arc's beginning to its centre, of unit length.
    inwards: Vector3<T>,
}

impl<T: Real> Course<'_, T> {
    fn waypoint(&self, index: usize) -> (usize, Waypoint<T>) {
        let index = index.checked_rem(self.waypoints.len()).unwrap_or(0);
        let nowhere = Waypoint { point: [T::zero(); 3], corner: None, speed: T::one(), yaw: None, stop: None };
        (index, self.waypoints.get(index).copied().unwrap_or(nowhere))
    }

    fn leg(&self, index: usize) -> Result<Leg<T>, RouteError<T>> {
        let (number, waypoint) = self.waypoint(index);
        let from = Vector3::from(waypoint.point);
        let way = Vector3::from(self.waypoint(index.saturating_add(1)).1.point) - from;
        let length = way.dot(&way).sqrt();
        if length < T::lit(SHORTEST_LEG) {
            return Err(RouteError::ShortLeg(number));
        }
        Ok(Leg { from, along: way * (T::one() / length), length })
    }

    /// The corner between leg `index` − 1 and leg `index`, or the stop that is there.
    fn corner(&self, index: usize) -> Result<Corner<T>, RouteError<T>> {
        let straight = |spacing| Corner {
            is_smooth: false,
            tangent: T::zero(),
            spacing,
            turn: T::zero(),
            radius: T::zero(),
            inwards: Vector3::zeros(),
        };
        let at_stop = |leg: &Leg<T>| straight((leg.length * T::lit(STOP_SHARE)).min(T::lit(STOP_SPACING)));
        if !self.is_closed && index == self.first {
            return Ok(at_stop(&self.leg(index)?));
        }
        let before = if index > 0 { index.saturating_sub(1) } else { self.waypoints.len().saturating_sub(1) };
        if !self.is_closed && index == self.last {
            return Ok(at_stop(&self.leg(before)?));
        }
        let (number, waypoint) = self.waypoint(index);
        let (before, after) = (self.leg(before)?, self.leg(index)?);
        let half = T::lit(0.5);
        let Some(corner) = waypoint.corner else {
            return Ok(Corner { is_smooth: true, ..straight(before.length.min(after.length)) });
        };
        let size = corner.min(before.length * half).min(after.length * half);
        let across = before.along.cross(&after.along);
        let (sin, cos) = (across.dot(&across).sqrt(), before.along.dot(&after.along));
        let turn = sin.atan2(cos);
        if turn > T::lit(LARGEST_TURN) {
            return Err(RouteError::SharpTurn(number));
        }
        if turn < T::lit(LEAST_TURN) {
            return Ok(straight(size * T::lit(1.0 / (ARC + ROUNDING))));
        }
        // size = tangent + ROUNDING spacing, where ARC spacing = turn tangent/tan(turn/2).
        let half_tangent = sin / (T::one() + cos);
        let spacing_per_tangent = turn / (half_tangent * T::lit(ARC));
        let tangent = size / (T::one() + spacing_per_tangent * T::lit(ROUNDING));
        let inwards = (after.along - before.along * cos) * (T::one() / sin);
        let (spacing, radius) = (tangent * spacing_per_tangent, tangent / half_tangent);
        Ok(Corner { is_smooth: false, tangent, spacing, turn, radius, inwards })
    }

    /// Writes the run's knots, and says how many.
    fn lay(
        &self,
        pace: &RoutePace<T>,
        heading: &mut Option<T>,
        knots: &mut [Knot<T>],
        passes: &mut dyn FnMut(usize, usize),
    ) -> Result<usize, RouteError<T>> {
        let mut laying = Laying { knots, used: 0 };
        let mut from = self.corner(self.first)?;
        for index in self.first..self.last {
            let (leg, to) = (self.leg(index)?, self.corner(index.saturating_add(1))?);
            let (_, waypoint) = self.waypoint(index);
            let (next_number, next) = self.waypoint(index.saturating_add(1));
            let straight = leg.length - from.tangent - to.tangent;
            let grading = Grading::of(straight, from.spacing, to.spacing);
            let knot = |arc: T| {
                let share = (arc / leg.length).clamp(T::zero(), T::one());
                let yaw = waypoint
                    .yaw
                    .zip(next.yaw)
                    .map(|(yaw, next)| yaw + (next - yaw).wrap_angle() * share)
                    .or(waypoint.yaw);
                (leg.from + leg.along * arc, waypoint.speed, yaw)
            };
            if !self.is_closed && index == self.first {
                let spacing = grading.first();
                for beyond in (0..=BEYOND).rev() {
                    laying.push(knot(-spacing * T::lit(beyond as f64)))?;
                }
                passes(self.waypoint(index).0, BEYOND);
            }
            if !(from.is_smooth && to.is_smooth) {
                grading.each(|arc| laying.push(knot(from.tangent + arc)))?;
            }
            if !self.is_closed && index.saturating_add(1) == self.last {
                let spacing = grading.last();
                passes(next_number, laying.used);
                for beyond in 0..=BEYOND {
                    laying.push(knot(leg.length + spacing * T::lit(beyond as f64)))?;
                }
            } else if to.turn > T::zero() {
                let start = leg.from + leg.along * (leg.length - to.tangent);
                let (_, _, yaw) = knot(leg.length);
                let step = to.turn * T::lit(1.0 / ARC);
                let points = ARC as usize;
                // Where the leg has no straight piece, the last arc ended where this one begins.
                let touches = straight < from.spacing.min(to.spacing) * T::lit(0.3) && from.turn > T::zero();
                for point in usize::from(touches)..=points {
                    let (sin, cos) = (step * T::lit(point as f64)).sin_cos();
                    let offset = leg.along * (sin * to.radius) + to.inwards * ((T::one() - cos) * to.radius);
                    laying.push((start + offset, waypoint.speed.min(next.speed), yaw))?;
                }
                passes(next_number, laying.used.saturating_sub(points / 2 + 1));
            } else {
                passes(next_number, laying.used);
                laying.push(knot(leg.length))?;
                if to.is_smooth {
                    laying.pass_through();
                }
            }
            from = to;
        }
        laying.finish(self.is_closed, pace, heading)
    }
}

/// Where knots stand on a straight piece: evenly at its ends, and farther apart between.
struct Grading<T> {
    length: T,
    spacings: [T; 2],
    /// What the marched spacings are stretched by to end at the piece's end.
    scale: T,
    count: usize,
    /// The last spacing, before it is stretched.
    last: T,
}

impl<T: Real> Grading<T> {
    fn of(length: T, from: T, to: T) -> Self {
        let mut grading = Self { length, spacings: [from, to], scale: T::one(), count: 0, last: T::zero() };
        let (mut at, mut count) = (T::zero(), 0_usize);
        // Each step is at least 0.1 mm, so of a leg's length at most a million or so; a table is
        // full long before.
        while count < MOST_ON_A_LEG {
            let next = at + grading.spacing(at);
            if next > length {
                // To the nearer of the two.
                if next - length < length - at {
                    grading.last = next - at;
                    (at, count) = (next, count.saturating_add(1));
                }
                break;
            }
            grading.last = next - at;
            (at, count) = (next, count.saturating_add(1));
        }
        if count > 0 {
            grading.scale = length / at;
            grading.count = count;
        }
        grading
    }

    /// The spacing behind `at`, by what is wanted in the middle of it.
    fn spacing(&self, at: T) -> T {
        let wanted = |at: T| {
            let [from, to] = self.spacings;
            let grown =
                |spacing: T, away: T| spacing + (away - spacing * T::lit(EVEN)).max(T::zero()) * T::lit(GROWTH);
            grown(from, at).min(grown(to, self.length - at)).min(T::lit(WIDEST)).max(T::lit(1e-4))
        };
        wanted(at + wanted(at) * T::lit(0.5))
    }

    /// Between the first two knots, and between the last two.
    fn first(&self) -> T {
        self.spacing(T::zero()) * self.scale
    }
    fn last(&self) -> T {
        self.last * self.scale
    }

    /// Shows the places between the piece's ends.
    fn each<E>(&self, mut show: impl FnMut(T) -> Result<(), E>) -> Result<(), E> {
        let mut at = T::zero();
        for _ in 1..self.count {
            at += self.spacing(at);
            show(at * self.scale)?;
        }
        Ok(())
    }
}

/// Knots of one leg, at most.
const MOST_ON_A_LEG: usize = 100_000;

/// Knots being written.
struct Laying<'a, T> {
    knots: &'a mut [Knot<T>],
    used: usize,
}

impl<T: Real> Laying<'_, T> {
    /// A control point with the speed wished there and a yaw, if one is given.
    fn push(&mut self, (point, speed, yaw): (Vector3<T>, T, Option<T>)) -> Result<(), RouteError<T>> {
        let knot = self.knots.get_mut(self.used).ok_or(RouteError::Knots)?;
        let yaw = yaw.unwrap_or(T::lit(f64::NAN));
        *knot = Knot { point: point.into(), speed: [speed; 2], yaw, ..Knot::default() };
        self.used = self.used.saturating_add(1);
        Ok(())
    }

    /// Has the curve pass through the last point.
    fn pass_through(&mut self) {
        if let Some(knot) = self.used.checked_sub(1).and_then(|last| self.knots.get_mut(last)) {
            fields::mark(knot);
        }
    }

    /// Makes all else from points, wished speeds and given yaws.
    fn finish(self, is_closed: bool, pace: &RoutePace<T>, heading: &mut Option<T>) -> Result<usize, RouteError<T>> {
        let Self { knots, used } = self;
        let count = if is_closed { used.saturating_add(7) } else { used };
        let knots = knots.get_mut(..count).ok_or(RouteError::Knots)?;
        fields::interpolate(knots, used, is_closed);
        if is_closed {
            for index in 0..7 {
                let from = knots.get(index).copied().unwrap_or_default();
                if let Some(knot) = knots.get_mut(used.saturating_add(index)) {
                    *knot = from;
                }
            }
        }
        fields::steps(knots);
        fields::normals(knots, used, is_closed);
        fields::speeds(knots, used, is_closed, pace);
        fields::yaws(knots, used, is_closed, heading);
        Ok(count)
    }
}
