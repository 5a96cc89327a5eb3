//! A route's flight leg by leg: how fast it was to be flown, could be, and was; how far the payload
//! was off, and how it stopped.

use controller::{Mode, State, Vector3, Vehicle};
use maud::{Markup, html};

use crate::describe::scenario::Law;
use crate::fly::batch::Outcome;
use crate::fly::sample::Sample;
use crate::fly::stops::Stops;
use crate::study::check::{Node, Report};

/// A leg's flight, all passes of it together.
struct Leg {
    /// Waypoints.
    from: usize,
    to: usize,
    /// m.
    length: f64,
    /// As planned, and as flown, s.
    time: [f64; 2],
    /// Highest speed as set, and as flown, m/s.
    speed: [f64; 2],
    /// How many times its speed it could be flown at within the limits, at most 4.
    factor: f64,
    /// Largest d_C, and the sum of its squares, over this many samples.
    distance: f64,
    squares: f64,
    samples: usize,
    /// How far from its last waypoint the payload came to rest, m.
    stop_error: Option<f64>,
}

/// A route's flight leg by leg.
pub struct Legs {
    legs: Vec<Leg>,
    /// At each sample of the log the speed that the route sets at the payload's nearest point, and
    /// the one that the vehicle's limits allow there, m/s. The limits are tried up to 4 times the
    /// route's own.
    pub speeds: Vec<[f64; 2]>,
}

/// How far along the route the nearest point is looked for from one sample to the next, m.
const WINDOW: f64 = 2.0;
/// A branch of the route that is flown the other way is taken for so much farther away, m.
const AGAINST: f64 = 0.3;
/// A payload slower than this has no direction, m/s.
const SLOW: f64 = 0.02;

impl Legs {
    /// Of a flight of a route that can be walked, from its log; `None` for other flights.
    #[must_use]
    pub fn of(Outcome { scenario, flight }: &Outcome) -> Option<Self> {
        let Law::Follow { path, .. } = &scenario.controller.law else { return None };
        path.route()?;
        let vehicle = Vehicle::new(scenario.controller.vehicle).ok()?;
        let report = path.check(&vehicle, &scenario.limits).ok()?;
        let planned = report.legs.as_ref()?;
        let mut legs: Vec<Leg> = planned.legs.iter().map(Leg::planned).collect();
        let mut stops = Stops::of(&scenario.controller.law);
        let mut walker = Walker { report: &report, at: None };
        let mut speeds = Vec::with_capacity(flight.log.len());
        for (index, sample) in flight.log.iter().enumerate() {
            let State { position, velocity, .. } = State::<f64>::from_paper(&sample.x);
            let (node, along) = walker.go(&position, &velocity);
            let between = |values: &[f64]| {
                let next = (node + 1).min(values.len() - 1);
                values[node] + along * (values[next] - values[node])
            };
            let set = between(&planned.speeds);
            speeds.push([set, set * between(&planned.factors)]);
            stops.push(&position, &velocity);
            let leg = report.lap.nodes()[node].leg;
            if let Some(leg) = legs.iter_mut().find(|other| Some(other.from) == leg).filter(|_| follows(sample)) {
                let next = flight.log.get(index + 1).map_or(sample.t_s, |next| next.t_s);
                leg.take(next - sample.t_s, velocity.dot(&velocity).sqrt(), sample.distance_m);
            }
        }
        for (waypoint, error) in stops.errors() {
            for leg in legs.iter_mut().filter(|leg| leg.to == waypoint) {
                leg.stop_error = Some(error);
            }
        }
        Some(Self { legs, speeds })
    }

    /// As a table.
    pub fn table(&self, name: &str) -> Markup {
        let millimetres = |distance: f64| {
            if distance < 0.1 { format!("{:.3} mm", 1e3 * distance) } else { format!("{distance:.2} m") }
        };
        html! {
            h2 { (name) " leg by leg" }
            div.wide role="region" aria-label={ (name) " leg by leg" } tabindex="0" {
                table.results {
                    caption {
                        "What was set and what was flown while following, all passes of a leg together, rests included. The limits are those of "
                        code { "[limits]" } " and are tried up to four times as fast."
                    }
                    thead {
                        tr {
                            @for heading in [
                                "leg", "length", "time planned,\nwithout stops", "time flown", "highest\nspeed set", "highest\nspeed flown",
                                "limits allow", "largest d_C", "RMS d_C", "rest off\nits stop",
                            ] {
                                th scope="col" { (heading) }
                            }
                        }
                    }
                    tbody {
                        @for leg in &self.legs {
                            tr {
                                th scope="row" { (leg.from) " to " (leg.to) }
                                td { (format!("{:.2} m", leg.length)) }
                                @for time in leg.time { td { (format!("{time:.1} s")) } }
                                @for speed in leg.speed { td { (format!("{speed:.2} m/s")) } }
                                td { @if leg.factor < 4.0 { (format!("{:.2} times", leg.factor)) } @else { "4 times" } }
                                @if leg.samples > 0 {
                                    td { (millimetres(leg.distance)) }
                                    td { (millimetres((leg.squares / leg.samples as f64).sqrt())) }
                                } @else {
                                    td { "not flown" } td {}
                                }
                                td { @if let Some(error) = leg.stop_error { (millimetres(error)) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn follows(sample: &Sample) -> bool {
    sample.decision.is_some_and(|decision| decision.mode == Mode::Follow)
}

impl Leg {
    fn planned(leg: &crate::study::check::Leg) -> Self {
        Self {
            from: leg.from,
            to: leg.to,
            length: leg.length,
            time: [leg.time, 0.0],
            speed: [leg.demand.speed.max, 0.0],
            factor: leg.factor,
            distance: 0.0,
            squares: 0.0,
            samples: 0,
            stop_error: None,
        }
    }

    fn take(&mut self, time: f64, speed: f64, distance: f64) {
        self.time[1] += time;
        self.speed[1] = self.speed[1].max(speed);
        if distance.is_finite() {
            self.distance = self.distance.max(distance);
            self.squares += distance * distance;
            self.samples += 1;
        }
    }
}

/// Where along a route a payload is, known from where it was: the route may cross itself, or come
/// back on itself.
struct Walker<'a> {
    report: &'a Report,
    at: Option<usize>,
}

impl Walker<'_> {
    /// The node before the nearest point, and the share of the way from it to the next.
    fn go(&mut self, position: &Vector3<f64>, velocity: &Vector3<f64>) -> (usize, f64) {
        let nodes = self.report.lap.nodes();
        let last = nodes.len() - 1;
        let away = |node: &Node| {
            let off = position - node.position();
            off.dot(&off)
        };
        let speed = velocity.dot(velocity).sqrt();
        let against = |node: &Node| {
            let along = if speed > SLOW { node.tangent().dot(velocity) / speed } else { 1.0 };
            AGAINST * AGAINST * 0.5 * (1.0 - along)
        };
        let nearest = |range: std::ops::RangeInclusive<usize>| {
            let cost = |index: &usize| away(&nodes[*index]) + against(&nodes[*index]);
            range.map(|index| (cost(&index), index)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, index)| index)
        };
        let found = match self.at {
            None => nearest(0..=last),
            Some(at) => {
                let arc = nodes[at].arc;
                let from = nodes.partition_point(|node| node.arc < arc - WINDOW).min(at.saturating_sub(2));
                let to = (nodes.partition_point(|node| node.arc <= arc + WINDOW)).max(at + 2).min(last);
                let found = nearest(from..=to);
                // Once more round, or from the beginning.
                let round = if found == last { nearest(0..=(2.min(last))) } else { found };
                if away(&nodes[round]) < away(&nodes[found]) + WINDOW * WINDOW * 1e-6 { round } else { found }
            }
        };
        self.at = Some(found);
        let share = |index: usize| {
            let way = nodes[index + 1].position() - nodes[index].position();
            let whole = way.dot(&way);
            if whole > 0.0 { (position - nodes[index].position()).dot(&way) / whole } else { 0.0 }
        };
        let before = if found == last || found > 0 && share(found) < 0.0 { found.saturating_sub(1) } else { found };
        (before, if last == 0 { 0.0 } else { share(before).clamp(0.0, 1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::scenario::builtin;
    use crate::fly::run::{Arithmetic, fly_simply};

    fn flown(name: &str) -> (Outcome, Legs) {
        let scenario = builtin(name).expect("it is built in").expect("it is valid");
        let flight = fly_simply(&scenario, Arithmetic::F32).expect("it can be set up");
        let outcome = Outcome { scenario, flight };
        let legs = Legs::of(&outcome).expect("it is a route");
        (outcome, legs)
    }

    /// Where the payload is on its path its speed is the one that is set at its place, to what d_C
    /// lets differ: so the place is the right one, at a crossing too.
    #[test]
    fn a_place_is_kept_where_a_route_crosses_itself() {
        let (outcome, legs) = flown("figure-eight");
        for (sample, [set, allowed]) in outcome.flight.log.iter().zip(&legs.speeds) {
            let State { velocity, .. } = State::<f64>::from_paper(&sample.x);
            let speed = velocity.dot(&velocity).sqrt();
            // Cubics between nodes, and a speed between two of them by a line: 1 cm/s of 1.5 m/s.
            assert!(sample.t_s < 15.0 || (speed - set).abs() < 0.01, "{} s: {speed}, {set}", sample.t_s);
            assert!(allowed > set);
        }
        assert!(legs.legs.iter().all(|leg| leg.samples > 0));
    }

    #[test]
    fn the_way_back_is_a_leg_of_its_own() {
        let (_, legs) = flown("a-to-b");
        let [there, back] = &legs.legs[..] else { panic!("{} legs", legs.legs.len()) };
        // It begins 1.1 m from the route; afterwards within the 0.1 mm that the README states.
        assert!(there.distance > 0.5 && back.distance < 1e-4, "{} {}", there.distance, back.distance);
        for leg in [there, back] {
            assert!((leg.speed[1] - leg.speed[0]).abs() < 0.01 && leg.stop_error.is_some_and(|error| error < 1e-4));
        }
        assert!(there.time[1] > there.time[0] + 20.0, "the rest of 20 s at B is the first leg's");
    }
}
