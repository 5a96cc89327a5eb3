//! Can it be flown? A path is walked once round before anyone takes off.
//!
//! First the curve: is it closed, smooth, regular (∇h1 × ∇h2 ≠ 0), free of self-crossings,
//! without jumps of speed or yaw? Then the flight: with the outputs and all their derivatives zero
//! (the zero-dynamics manifold) the payload's motion to sixth order follows from the curve and v_d,
//! and the [law's own inverse](steady) gives what the vehicle must do for it all along the lap.

mod demand;
pub mod fence;
mod jumps;
pub mod lap;
mod limits;
pub mod probe;
mod profile;
pub mod refusal;
mod report;
pub mod route;
pub mod steady;
pub mod walk;
pub mod way;

pub use demand::{Demand, Range};
pub use fence::{Breach, Fence};
pub use lap::{Approach, Lap, Nearest, Node};
pub use limits::Limits;
pub use refusal::{Place, Reason, Refusal};
pub use route::{Leg, Legs};
pub use steady::Steady;
pub use way::way_breaches;

use controller::{Path, Vector3, Vehicle};
use probe::{Frame, Motion, at_speed, length, prescribed_speed, yaw};

/// A limit that the path at its speed does not keep to.
#[derive(Clone, Debug, PartialEq)]
pub struct Excess {
    /// The quantity.
    pub quantity: &'static str,
    /// Its value, in SI units.
    pub value: f64,
    /// The limit.
    pub limit: f64,
    /// Where.
    pub place: Place,
}

/// The highest constant speed within the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Fastest {
    /// m/s.
    pub speed: f64,
    /// What is exceeded just above it, if anything is below [`SPEED_LIMIT`].
    pub then: Option<Excess>,
}

/// The answer for a curve that closes and is smooth, or for a route.
#[derive(Clone, Debug)]
pub struct Report {
    /// The curve.
    pub lap: Lap,
    /// Time of a lap at the path's speed, of a route to its end, s.
    pub lap_time: f64,
    /// |∇h1 × ∇h2| over the lap, in the surfaces' units.
    pub regularity: Range,
    /// Its branches at their closest, if it has branches.
    pub branches: Option<Approach>,
    /// What the path asks for.
    pub demand: Demand,
    /// Limits that are not kept.
    pub excesses: Vec<Excess>,
    /// The highest constant speed within the limits, if there is one above [`SLOWEST`]; of a curve.
    pub fastest: Option<Fastest>,
    /// Of a route.
    pub legs: Option<Legs>,
    /// Where the UAV is at each node of the lap, N, m.
    pub uavs: Vec<Vector3<f64>>,
}

/// Range of the search for the highest speed, m/s.
pub const SPEED_LIMIT: f64 = 100.0;
/// Its lower end, m/s.
pub const SLOWEST: f64 = 0.05;
/// Nodes above which not each is asked at each speed.
const MANY: usize = 20_000;

/// Says what a `lap` of `path` asks of `vehicle`.
///
/// # Errors
/// [`Refusal`] with the place, if the curve is not free of self-crossings, if the speed vanishes on
/// it, or if no thrust can give the motion.
pub fn check<P: Path<f64> + ?Sized>(
    path: &mut P,
    lap: Lap,
    vehicle: &Vehicle<f64>,
    limits: &Limits,
) -> Result<Report, Refusal> {
    let branches = lap.branches()?;

    let motions = motions(path, &lap)?;
    profile::continuous(path, &lap)?;
    let mut lap_time = 0.0;
    let mut regularity = Range::new(lap.nodes()[0].regularity, lap.nodes()[0].place());
    let mut demand: Option<Demand> = None;
    let mut uavs = Vec::new();
    for (node, (motion, yaw)) in lap.nodes().iter().zip(&motions) {
        let steady = Steady::of(vehicle, motion, yaw).ok_or_else(|| Reason::FreeFall.at(node.place()))?;
        uavs.push(steady.uav_position(vehicle));
        regularity.take(node.regularity, node.place());
        match &mut demand {
            Some(demand) => demand.take(vehicle, &steady, node.place()),
            None => demand = Some(Demand::of(vehicle, &steady, node.place())),
        }
    }
    for ([from, to], [(first, _), (second, _)]) in lap.nodes().array_windows().zip(motions.array_windows()) {
        lap_time += (to.arc - from.arc) / (0.5 * (length(&first[1]) + length(&second[1])));
    }
    let demand = demand.ok_or_else(|| Reason::NoCurve.at(lap.nodes()[0].place()))?;
    let excesses = demand.excesses(limits);
    let forwards = motions[0].0[1].dot(&lap.nodes()[0].tangent()) > 0.0;
    let fastest = fastest(path, &lap, vehicle, limits, if forwards { 1.0 } else { -1.0 });
    Ok(Report { lap, lap_time, regularity, branches, demand, excesses, fastest, legs: None, uavs })
}

/// The motion at the prescribed speed and the yaw along it, at every node.
fn motions<P: Path<f64> + ?Sized>(path: &mut P, lap: &Lap) -> Result<Vec<(Motion, [f64; 3])>, Refusal> {
    path.search(&lap.nodes()[0].position());
    let mut direction = 0.0_f64;
    lap.nodes()
        .iter()
        .map(|node| {
            let (motion, yaw) = prescribed(path, node.position()).map_err(|reason| reason.at(node.place()))?;
            let speed = motion[1].dot(&node.tangent());
            // From the second node on the sign must stay.
            if speed == 0.0 || speed * direction < 0.0 {
                return Err(Reason::Stops.at(node.place()));
            }
            direction = speed;
            Ok((motion, yaw))
        })
        .collect()
}

/// The motion at the prescribed speed through a point of the curve, and the yaw along it.
fn prescribed<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>) -> Result<(Motion, [f64; 3]), Reason> {
    let frame = Frame::at(path, position).ok_or(Reason::Undefined)?;
    let motion = prescribed_speed(path, &frame).ok_or(Reason::Undefined)?;
    let yaw = yaw(path, &motion);
    if yaw.iter().all(|value| value.is_finite()) { Ok((motion, yaw)) } else { Err(Reason::Undefined) }
}

/// The vehicle's state and inputs at a point of the curve with all outputs and their derivatives
/// zero.
///
/// # Errors
/// [`Refusal`] if speed or yaw have no value there, or no thrust can give the motion.
pub fn steady_at<P: Path<f64> + ?Sized>(
    path: &mut P,
    vehicle: &Vehicle<f64>,
    place: Place,
) -> Result<Steady, Refusal> {
    let (motion, yaw) = prescribed(path, place.position).map_err(|reason| reason.at(place))?;
    if motion[1] == Vector3::zeros() {
        return Err(Reason::Stops.at(place));
    }
    Steady::of(vehicle, &motion, &yaw).ok_or_else(|| Reason::FreeFall.at(place))
}

/// The vehicle at rest at a point of the path, with its yaw.
///
/// # Errors
/// [`Refusal`] if the yaw has no value there.
pub fn rest_at<P: Path<f64> + ?Sized>(path: &mut P, vehicle: &Vehicle<f64>, place: Place) -> Result<Steady, Refusal> {
    let mut motion = [Vector3::zeros(); 7];
    motion[0] = place.position;
    let yaw = yaw(path, &motion);
    Steady::of(vehicle, &motion, &yaw).ok_or_else(|| Reason::Undefined.at(place))
}

/// The highest constant speed whose demand keeps to the limits all the way up to it.
fn fastest<P: Path<f64> + ?Sized>(
    path: &mut P,
    lap: &Lap,
    vehicle: &Vehicle<f64>,
    limits: &Limits,
    direction: f64,
) -> Option<Fastest> {
    path.search(&lap.nodes()[0].position());
    // Of very many nodes every few: between two of them the curve turns by less than a fifth of a
    // radian.
    let nodes: Vec<&Node> = lap.nodes().iter().step_by((lap.nodes().len() / MANY).max(1)).collect();
    let yaws: Vec<[f64; 3]> = nodes.iter().map(|node| yaw(path, &node.motion)).collect();
    let exceeds = |speed: f64| -> Option<Excess> {
        let factor = speed * direction;
        let mut demand: Option<Demand> = None;
        for (node, yaw) in nodes.iter().zip(&yaws) {
            let yaw = [yaw[0], yaw[1] * factor, yaw[2] * factor * factor];
            let Some(steady) = Steady::of(vehicle, &at_speed(&node.motion, factor), &yaw) else {
                let place = node.place();
                return Some(Excess { quantity: "tension", value: 0.0, limit: limits.tension, place });
            };
            match &mut demand {
                Some(demand) => demand.take(vehicle, &steady, node.place()),
                None => demand = Some(Demand::of(vehicle, &steady, node.place())),
            }
        }
        demand.and_then(|demand| demand.excesses(limits).into_iter().next())
    };

    if exceeds(SLOWEST).is_some() {
        return None;
    }
    let (mut good, mut bad) = (SLOWEST, None);
    // Up in steps of a fifth, so that no band of bad speeds wider than that is jumped, then
    // halving.
    while bad.is_none() && good < SPEED_LIMIT {
        let next = (1.2 * good).min(SPEED_LIMIT);
        match exceeds(next) {
            Some(excess) => bad = Some((next, excess)),
            None => good = next,
        }
    }
    let Some((mut high, mut then)) = bad else {
        return Some(Fastest { speed: good, then: None });
    };
    while high - good > 1e-4 * good {
        let middle = 0.5 * (good + high);
        match exceeds(middle) {
            Some(excess) => (high, then) = (middle, excess),
            None => good = middle,
        }
    }
    Some(Fastest { speed: good, then: Some(then) })
}
