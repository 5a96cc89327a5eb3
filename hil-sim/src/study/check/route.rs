//! Routes: walked by their parameter, whatever their length, and judged leg by leg.

use super::demand::{Demand, Range};
use super::lap::{Lap, Node};
use super::probe::{Frame, Motion, at_speed, length};
use super::refusal::{Place, Reason, Refusal};
use super::walk::{TURN, angle, arc_of};
use super::{Limits, Report, Steady, prescribed};
use controller::{Route, Table, Vector3, Vehicle, Waypoint};

/// Nodes of a span at least, where it bends: the speed changes within it, and cubics between them
/// are within a ten-thousandth of what the span turns aside.
const LEAST: usize = 4;
/// The speed at which a payload counts as resting, m/s: a stop is reached for ever slower.
const AT_REST: f64 = 0.01;
/// What six lags of 0.5 s in a row lose of a start, s.
const STARTING: f64 = 3.0;
/// Spans within which a closed run's first waypoint is from its end: three for the spline, one for
/// the knot itself, and half of a corner's knots.
const LAID: usize = 12;
/// Speeds are tried up to this many times the route's own.
const FASTEST: f64 = 4.0;
/// Halvings of that range: to 0.1 %.
const HALVINGS: usize = 12;

/// A leg, from one waypoint to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// The waypoint that it begins at, and its number.
    pub from: usize,
    /// The waypoint that it leads to.
    pub to: usize,
    /// m.
    pub length: f64,
    /// Without dwelling, s.
    pub time: f64,
    /// What it asks of the vehicle.
    pub demand: Demand,
    /// How many times its speed it could be flown at within the limits, at most 4.
    pub factor: f64,
}

/// What only a route has.
#[derive(Clone, Debug, PartialEq)]
pub struct Legs {
    /// In the order flown.
    pub legs: Vec<Leg>,
    /// How long the payload rests at stops on the way, but for those where it is to be told, s.
    pub dwell: f64,
    /// Stops where it is to be told.
    pub told: usize,
    /// The time for which hovering takes as much energy, s: power goes with T^1.5.
    pub hovering: f64,
    /// At each node of the lap the speed that is set, m/s.
    pub speeds: Vec<f64>,
    /// At each node of the lap how many times its speed could be flown within the limits, at most
    /// 4.
    pub factors: Vec<f64>,
}

/// A place of a route's table.
#[derive(Clone, Copy)]
struct Spot {
    run: usize,
    parameter: f64,
}

/// The nodes of a route from its first waypoint on, one run after the other, and where each stands.
fn nodes<S: Table<f64>>(route: &mut Route<f64, S>, first: &Waypoint<f64>) -> Result<(Vec<Node>, Vec<Spot>), Refusal> {
    let (mut nodes, mut spots) = (Vec::<Node>::new(), Vec::new());
    let mut arc = 0.0;
    for run in 0..route.table().runs().len() {
        let range = route.table().runs()[run].flown();
        let before = nodes.len();
        let mut push = |route: &mut Route<f64, S>, parameter: f64| {
            route.go_to(run, parameter);
            let position = route.point();
            let frame =
                Frame::at(route, position).ok_or_else(|| Reason::Undefined.at(Place::of_curve(position, arc)))?;
            if let Some(last) = nodes[before..].last() {
                arc += arc_of(length(&(position - last.position())), angle(&last.tangent(), &frame.tangent));
            }
            nodes.push(Node::at(route, &frame, arc)?);
            spots.push(Spot { run, parameter });
            Ok(())
        };
        let closes = route.table().runs()[run].is_closed;
        let begin = if closes { nearest(route, run, first) } else { range.start };
        for span in (begin..range.end).chain(range.start..begin) {
            let steps = steps(route, run, span);
            for step in 0..steps {
                push(route, span as f64 + step as f64 / steps as f64)?;
            }
        }
        push(route, if closes { begin } else { range.end } as f64)?;
    }
    Ok((nodes, spots))
}

/// Which of a closed run's last spans begins nearest to its first waypoint: the builder puts it
/// there.
fn nearest<S: Table<f64>>(route: &mut Route<f64, S>, run: usize, first: &Waypoint<f64>) -> usize {
    let end = route.table().runs()[run].flown().end;
    let mut away = |span: &usize| {
        route.go_to(run, *span as f64);
        length(&(route.point() - Vector3::from(first.point)))
    };
    let last = end.saturating_sub(LAID)..end;
    last.map(|span| (away(&span), span)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, span)| span)
}

/// How many steps a span takes so that its tangent turns by [`TURN`] at most in each.
fn steps<S: Table<f64>>(route: &mut Route<f64, S>, run: usize, span: usize) -> usize {
    let turn = [0.0, 0.25, 0.5, 0.75, 1.0].map(|along| {
        route.go_to(run, span as f64 + along);
        route.turn()
    });
    let turn = turn.into_iter().fold(0.0, f64::max);
    ((turn / TURN).ceil() as usize).max(LEAST)
}

/// Waypoints in the order flown, with which number each has; of a closed route the first once more.
fn order(waypoints: &[Waypoint<f64>], is_closed: bool) -> Vec<usize> {
    let count = waypoints.len();
    if !is_closed {
        return (0..count).collect();
    }
    // With stops it begins at the first of them.
    let first = waypoints.iter().position(|waypoint| waypoint.stop.is_some()).unwrap_or(0);
    (0..=count).map(|index| (first + index) % count).collect()
}

/// Tells each node its leg: a waypoint's place is the node nearest to it, about a leg's length
/// behind the last one's.
fn tell_legs(nodes: &mut [Node], waypoints: &[Waypoint<f64>], order: &[usize]) {
    let point = |at: usize| Vector3::from(waypoints[order[at]].point);
    let mut begin = 0;
    for leg in 0..order.len() - 1 {
        let chord = length(&(point(leg + 1) - point(leg)));
        let arc = nodes[begin].arc;
        // Corners shorten a leg to a third of it at the most, and a smooth curve goes round by less
        // than half.
        let window = begin..nodes.partition_point(|node| node.arc <= arc + 1.75 * chord);
        let near = |&index: &usize| nodes[index].arc >= arc + 0.25 * chord;
        let away = |index: &usize| length(&(nodes[*index].position() - point(leg + 1)));
        let end = match leg + 2 == order.len() {
            true => nodes.len(),
            false => window.filter(near).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(begin),
        };
        for node in &mut nodes[begin..end] {
            node.leg = Some(order[leg]);
        }
        begin = end;
    }
}

/// Walks a route through `waypoints` from its beginning to its end.
///
/// # Errors
/// [`Refusal`] where it has no derivatives.
pub fn walk<S: Table<f64>>(
    route: &mut Route<f64, S>,
    waypoints: &[Waypoint<f64>],
    is_closed: bool,
) -> Result<Lap, Refusal> {
    let order = order(waypoints, is_closed);
    let (mut nodes, _) = nodes(route, &waypoints[order[0]])?;
    tell_legs(&mut nodes, waypoints, &order);
    Ok(Lap::new(nodes, is_closed))
}

/// Walks a route and says what its legs ask of `vehicle`.
///
/// # Errors
/// [`Refusal`] with the leg and the place where no thrust can give the motion.
pub fn check<S: Table<f64>>(
    route: &mut Route<f64, S>,
    waypoints: &[Waypoint<f64>],
    is_closed: bool,
    vehicle: &Vehicle<f64>,
    limits: &Limits,
) -> Result<Report, Refusal> {
    let order = order(waypoints, is_closed);
    let (mut nodes, spots) = nodes(route, &waypoints[order[0]])?;
    tell_legs(&mut nodes, waypoints, &order);

    let mut regularity = Range::new(nodes[0].regularity, nodes[0].place());
    let (mut steadies, mut factors) = (Vec::new(), Vec::new());
    for (node, Spot { run, parameter }) in nodes.iter().zip(&spots) {
        route.go_to(*run, *parameter);
        let (motion, yaw) = prescribed(route, node.position()).map_err(|reason| reason.at(node.place()))?;
        let steady = Steady::of(vehicle, &motion, &yaw).ok_or_else(|| Reason::FreeFall.at(node.place()))?;
        regularity.take(node.regularity, node.place());
        steadies.push(steady);
        factors.push(factor(vehicle, limits, node.place(), &motion, &yaw));
    }

    let mut legs: Vec<Leg> = Vec::new();
    let hover = vehicle.hover_thrust();
    let power = |steady: &Steady| (steady.command.thrust / hover).powf(1.5);
    let mut hovering = 0.0;
    for (index, node) in nodes.iter().enumerate() {
        let (steady, place) = (&steadies[index], node.place());
        // A leg that no node is on is as short as one.
        let from = node.leg.unwrap_or(order[0]);
        match legs.last_mut().filter(|leg| leg.from == from) {
            Some(leg) => {
                leg.demand.take(vehicle, steady, place);
                leg.factor = leg.factor.min(factors[index]);
            }
            None => {
                let to = order[order.iter().position(|&at| at == from).unwrap_or(0) + 1];
                let demand = Demand::of(vehicle, steady, place);
                legs.push(Leg { from, to, length: 0.0, time: 0.0, demand, factor: factors[index] });
            }
        }
        let (Some(next), Some(leg)) = (nodes.get(index + 1), legs.last_mut()) else { continue };
        let way = next.arc - node.arc;
        let time = passing(way, length(&steady.state.velocity), length(&steadies[index + 1].state.velocity));
        leg.length += way;
        leg.time += time;
        hovering += time * 0.5 * (power(steady) + power(&steadies[index + 1]));
    }
    let runs = route.table().runs();
    let starts = runs.iter().filter(|run| !run.is_closed).count() as f64 * STARTING;
    if let Some(first) = legs.first_mut() {
        first.time += starts;
    }
    let dwells = runs.iter().take(runs.len() - 1).map(|run| run.dwell);
    let dwell = dwells.clone().filter(|dwell| dwell.is_finite()).sum();
    let told = dwells.filter(|dwell| dwell.is_infinite()).count();
    hovering += starts + dwell;

    let time = legs.iter().map(|leg| leg.time).sum::<f64>() + dwell;
    let excesses = legs.iter().flat_map(|leg| leg.demand.excesses(limits)).collect();
    let demand = legs.iter().map(|leg| leg.demand).reduce(Demand::joined).expect("a route has a leg");
    let uavs = steadies.iter().map(|steady| steady.uav_position(vehicle)).collect();
    let lap = Lap::new(nodes, is_closed);
    let speeds = steadies.iter().map(|steady| length(&steady.state.velocity)).collect();
    let legs = Some(Legs { legs, dwell, told, hovering, speeds, factors });
    Ok(Report { lap, lap_time: time, regularity, branches: None, demand, excesses, fastest: None, legs, uavs })
}

/// The time for `way` (m) at a speed that changes evenly with it, down to rest, s.
fn passing(way: f64, from: f64, to: f64) -> f64 {
    let (from, to) = (from.max(AT_REST), to.max(AT_REST));
    let ratio = to / from;
    // ln(to/from)/(to − from), without the difference of near numbers.
    if (ratio - 1.0).abs() < 1e-6 { way / from } else { way * ratio.ln() / (to - from) }
}

/// How many times the motion could be as fast within the limits.
fn factor(vehicle: &Vehicle<f64>, limits: &Limits, place: Place, motion: &Motion, yaw: &[f64; 3]) -> f64 {
    let fits = |factor: f64| {
        let yaw = [yaw[0], yaw[1] * factor, yaw[2] * factor * factor];
        Steady::of(vehicle, &at_speed(motion, factor), &yaw)
            .is_some_and(|steady| Demand::of(vehicle, &steady, place).excesses(limits).is_empty())
    };
    if fits(FASTEST) {
        return FASTEST;
    }
    let (mut low, mut high) = (0.0, FASTEST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}
