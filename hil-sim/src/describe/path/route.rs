//! Routes as described by a user: waypoints, and what is done at them and between them.

use controller::{
    End, Knot, OutOfRange, Path, Real, Route, RouteError, RoutePace, RouteTable, Run, Vector3, Waypoint, build_route,
};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};
use std::sync::Arc;

use super::fields::LineFields;
use crate::describe::input::{Invalid, all_within, join, read, within};
use crate::study::check::Refusal;

/// A table that flights share.
pub type SharedTable<T> = RouteTable<Arc<[Knot<T>]>, Arc<[Run<T>]>>;

/// A table being made.
type OwnTable = RouteTable<Vec<Knot<f64>>, Vec<Run<f64>>>;

/// Most waypoints of a route.
const MOST_POINTS: usize = 100_000;
/// Most knots of its table: some 10 for each waypoint with a corner.
const MOST_KNOTS: usize = 4_000_000;
/// Where a corner's blend begins if nothing is said, m.
const CORNER: f64 = 2.0;

/// A route as described by a user, with its table.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteSpec {
    waypoints: Vec<Waypoint<f64>>,
    is_closed: bool,
    end: End,
    lands: bool,
    acceleration: f64,
    is_pointing: bool,
    table: SharedTable<f64>,
}

impl RouteSpec {
    /// Its waypoints.
    #[must_use]
    pub fn waypoints(&self) -> &[Waypoint<f64>] {
        &self.waypoints
    }

    /// Whether the last waypoint leads back to the first.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// What is flown after the last waypoint.
    #[must_use]
    pub fn end(&self) -> End {
        self.end
    }

    /// Whether the vehicle lands where the route ends.
    #[must_use]
    pub fn lands(&self) -> bool {
        self.lands
    }

    /// Bound of the acceleration along it and across it, m/s².
    #[must_use]
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Whether its yaw points to a line rather than changing from waypoint to waypoint.
    #[must_use]
    pub fn is_pointing(&self) -> bool {
        self.is_pointing
    }

    /// The table that is flown, before it is rounded.
    #[must_use]
    pub fn table(&self) -> &SharedTable<f64> {
        &self.table
    }

    /// The route as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if rounding to `T` takes a number out of range.
    pub fn build<T: Real>(&self) -> Result<Route<T, SharedTable<T>>, OutOfRange<T>> {
        let RouteTable { knots, runs } = &self.table;
        let (knots, runs) = (knots.iter().map(Knot::cast).collect(), runs.iter().map(Run::cast).collect());
        Ok(Route::new(RouteTable { knots, runs })?.with_end(self.end))
    }
}

impl RouteSpec {
    /// The route, for what looks along it.
    ///
    /// # Errors
    /// None of a route that was read.
    pub(super) fn built(&self) -> Result<Route<f64, SharedTable<f64>>, Refusal> {
        self.build().map_err(|_| super::undefined(Vector3::from(self.waypoints[0].point)))
    }

    /// Whether its first run leads to a stop, and so begins at one.
    pub(super) fn starts_at_rest(&self) -> bool {
        self.table.runs.first().is_some_and(|run| !run.is_closed)
    }

    /// The first run's splines for the witness, about the point nearest to `position`.
    pub(super) fn witness(&self, position: [f64; 3]) -> witness::law::Route {
        let about = self.built().map_or(0, |mut route| {
            while !route.search(&position.into()) {}
            route.parameter().max(0.0) as usize
        });
        let Run { first, knots, .. } = self.table.runs.first().copied().unwrap_or_default();
        let spans = knots.saturating_sub(7);
        // Each side of the nearest span as many as a payload can be from it and still be nearest.
        let begin = about.saturating_sub(SEEN).min(spans.saturating_sub(2 * SEEN + 1));
        let end = knots.min(begin + 2 * SEEN + 8);
        let knots = &self.table.knots[first + begin..first + end];
        witness::law::Route {
            points: knots.iter().map(|knot| knot.point).collect(),
            normals: [0, 1].map(|n| knots.iter().map(|knot| knot.normals[n]).collect()),
            speed: knots.iter().map(|knot| knot.speed[0]).collect(),
            yaw: knots.iter().map(|knot| knot.yaw).collect(),
        }
    }
}

/// Spans either side of the nearest one that the witness looks at.
const SEEN: usize = 6;

/// A route's fields.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RouteFields {
    #[serde(rename = "kind")]
    _kind: IgnoredAny,
    points: Vec<[f64; 3]>,
    #[serde(default)]
    closed: bool,
    #[serde(default = "usual_corners")]
    corner_m: CornerField,
    speed: EachField,
    #[serde(default = "no_yaw")]
    yaw: YawField,
    #[serde(default)]
    stops: Vec<StopFields>,
    acceleration: Option<f64>,
    #[serde(default)]
    end: EndField,
}

/// One number for all waypoints, or one each.
#[derive(Deserialize)]
#[serde(untagged, expecting = "neither a number nor a list of them")]
enum EachField {
    All(f64),
    Each(Vec<f64>),
}

/// How a waypoint is passed.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "neither a number nor \"smooth\"")]
enum Corner {
    Blend(f64),
    Smooth(Smooth),
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Smooth {
    Smooth,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "neither a number, nor \"smooth\", nor a list of them")]
enum CornerField {
    All(Corner),
    Each(Vec<Corner>),
}

fn usual_corners() -> CornerField {
    CornerField::All(Corner::Blend(CORNER))
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "neither a number, nor a list of them, nor \"tangent\", nor { x, y }")]
enum YawField {
    All(Yaw),
    Each(Vec<Yaw>),
    PointingAt(LineFields),
}

/// The heading at a waypoint.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "neither a number nor \"tangent\"")]
enum Yaw {
    Fixed(f64),
    Tangent(Tangent),
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Tangent {
    Tangent,
}

fn no_yaw() -> YawField {
    YawField::All(Yaw::Fixed(0.0))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StopFields {
    index: usize,
    dwell_s: Option<f64>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum EndField {
    #[default]
    Hover,
    Land,
    Back(u32),
    Again(u32),
}

/// Reads the route described by `value`, the field `at` of the input.
///
/// # Errors
/// [`Invalid`] for an unknown or missing field, one out of range, or waypoints that make no route.
pub(super) fn parse<'de, V: Deserializer<'de>>(at: &str, value: V) -> Result<RouteSpec, Invalid> {
    let fields: RouteFields = read(at, value)?;
    let RouteFields { points, closed: is_closed, corner_m, speed, yaw, stops, acceleration, end, .. } = fields;
    let field = |name: &str| join(at, name);
    let count = points.len();
    within(&field("points.len"), count, if is_closed { 3 } else { 2 }..=MOST_POINTS)?;
    let fits = |name: &str, given: usize| {
        if given == count {
            return Ok(());
        }
        Err(Invalid::new(field(name), format_args!("{given} values where there are {count} points")))
    };
    match &corner_m {
        CornerField::Each(each) => fits("corner_m", each.len())?,
        CornerField::All(_) => {}
    }
    match &speed {
        EachField::Each(each) => fits("speed", each.len())?,
        EachField::All(_) => {}
    }
    match &yaw {
        YawField::Each(each) => fits("yaw", each.len())?,
        YawField::All(_) | YawField::PointingAt(_) => {}
    }
    let pointing = match &yaw {
        YawField::PointingAt(LineFields { x, y }) => Some(all_within(&field("yaw"), [*x, *y], 1e5)?),
        _ => None,
    };
    let mut waypoints: Vec<Waypoint<f64>> = points
        .into_iter()
        .enumerate()
        .map(|(index, point)| Waypoint {
            point,
            corner: match match &corner_m {
                CornerField::All(corner) => *corner,
                CornerField::Each(each) => each[index],
            } {
                Corner::Blend(size) => Some(size),
                Corner::Smooth(_) => None,
            },
            speed: match &speed {
                EachField::All(speed) => *speed,
                EachField::Each(each) => each[index],
            },
            yaw: match match &yaw {
                YawField::All(yaw) => *yaw,
                YawField::Each(each) => each[index],
                YawField::PointingAt(_) => Yaw::Tangent(Tangent::Tangent),
            } {
                Yaw::Fixed(yaw) => Some(yaw),
                Yaw::Tangent(_) => None,
            },
            stop: None,
        })
        .collect();
    for (number, StopFields { index, dwell_s }) in stops.into_iter().enumerate() {
        let index = within(&field(&format!("stops[{number}].index")), index, 0..=count - 1)?;
        let dwell = dwell_s.map(|dwell| within(&field(&format!("stops[{number}].dwell_s")), dwell, 0.0..=1e5));
        waypoints[index].stop = Some(dwell.transpose()?.unwrap_or(f64::INFINITY));
    }
    let lands = matches!(end, EndField::Land);
    if lands && is_closed {
        return Err(Invalid::new(field("end"), "\"land\" needs a route that does not close"));
    }
    let end = match end {
        EndField::Hover | EndField::Land => End::Stay,
        EndField::Back(times) => End::Back(times),
        EndField::Again(times) => End::Again(times),
    };
    let comes_back = waypoints[0].point == waypoints[count - 1].point || is_closed;
    if matches!(end, End::Again(_)) && !comes_back {
        return Err(Invalid::new(field("end"), "\"again\" needs a route whose last point is its first"));
    }
    let mut pace = RoutePace::default();
    if let Some(acceleration) = acceleration {
        pace.acceleration = acceleration;
    }
    let mut table = lay(&waypoints, is_closed, &pace).map_err(|error| refused(at, error))?;
    if let Some(target) = pointing {
        point_at(&mut table.knots, target);
    }
    let RouteTable { knots, runs } = table;
    let table = RouteTable { knots: knots.into(), runs: runs.into() };
    let (acceleration, is_pointing) = (pace.acceleration, pointing.is_some());
    Ok(RouteSpec { waypoints, is_closed, end, lands, acceleration, is_pointing, table })
}

/// The table through `waypoints`.
fn lay(waypoints: &[Waypoint<f64>], is_closed: bool, pace: &RoutePace<f64>) -> Result<OwnTable, RouteError<f64>> {
    let mut runs = vec![Run::default(); waypoints.len() + 1];
    let mut most = 32 * waypoints.len() + 256;
    loop {
        let mut knots = vec![Knot::default(); most];
        match build_route(waypoints, is_closed, pace, &mut knots, &mut runs) {
            Ok(built) => {
                knots.truncate(built.knots);
                runs.truncate(built.runs);
                return Ok(RouteTable { knots, runs });
            }
            Err(RouteError::Knots) if most < MOST_KNOTS => most *= 4,
            Err(error) => return Err(error),
        }
    }
}

/// What the builder refused, by the field that says it.
fn refused(at: &str, error: RouteError<f64>) -> Invalid {
    let field = match &error {
        RouteError::Waypoint(index, OutOfRange { field: "point", .. })
        | RouteError::ShortLeg(index)
        | RouteError::SharpTurn(index) => format!("points[{index}]"),
        RouteError::Waypoint(_, OutOfRange { field: "corner", .. }) => "corner_m".to_owned(),
        RouteError::Waypoint(_, OutOfRange { field, .. }) | RouteError::Pace(OutOfRange { field, .. }) => {
            (*field).to_owned()
        }
        RouteError::TooFew | RouteError::Knots | RouteError::Runs => "points".to_owned(),
    };
    Invalid::new(join(at, &field), error)
}

/// Turns the nose to the vertical line through `target`, p1 and p2 in m. Where a knot is on it the
/// yaw stays.
fn point_at(knots: &mut [Knot<f64>], [x, y]: [f64; 2]) {
    let mut last = 0.0;
    for knot in knots {
        let way = Vector3::new(x - knot.point[0], y - knot.point[1], 0.0);
        if way.dot(&way) > 0.0 {
            last += (way.y.atan2(way.x) - last).wrap_angle();
        }
        knot.yaw = last;
    }
}
