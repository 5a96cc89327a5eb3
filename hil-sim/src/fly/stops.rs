//! How well a payload stops.

use controller::Vector3;

use crate::describe::scenario::Law;

/// A stop is visited within this distance, m.
const NEAR: f64 = 1.0;
/// A payload slower than this rests, m/s.
const AT_REST: f64 = 0.01;

/// A stop of a route, and its last visit.
struct Stop {
    waypoint: usize,
    point: Vector3<f64>,
    is_near: bool,
    /// Least speed of the visit, m/s, and the distance then, m.
    slowest: [f64; 2],
}

/// Watches a payload at a route's stops.
pub struct Stops(Vec<Stop>);

impl Stops {
    /// Of what a law flies: where waypoints say so, and at the end of a route that does not close.
    pub fn of(law: &Law) -> Self {
        let Law::Follow { path, .. } = law else { return Self(Vec::new()) };
        let Some(route) = path.route() else { return Self(Vec::new()) };
        let last = route.waypoints().len() - 1;
        let is_stop = |index: usize| route.waypoints()[index].stop.is_some() || index == last && !route.is_closed();
        let stops = route.waypoints().iter().enumerate().filter(|(index, _)| is_stop(*index));
        // Where a flight begins is no visit.
        let stop = |waypoint: usize, point: [f64; 3]| Stop {
            waypoint,
            point: point.into(),
            is_near: true,
            slowest: [f64::NEG_INFINITY, f64::NAN],
        };
        Self(stops.map(|(index, waypoint)| stop(index, waypoint.point)).collect())
    }

    /// Takes in where the payload is, m, and how fast, m/s.
    pub fn push(&mut self, position: &Vector3<f64>, velocity: &Vector3<f64>) {
        for Stop { point, is_near, slowest, .. } in &mut self.0 {
            let length = |v: Vector3<f64>| v.dot(&v).sqrt();
            let [distance, speed] = [length(position - *point), length(*velocity)];
            let comes = distance < NEAR && !*is_near;
            *is_near = distance < NEAR;
            if comes || *is_near && speed < slowest[0] {
                *slowest = [speed, distance];
            }
        }
    }

    /// The stops at which the payload rested: waypoint, and the distance from it when the payload
    /// was slowest on its last visit, m.
    pub fn errors(&self) -> impl Iterator<Item = (usize, f64)> {
        let rested = self.0.iter().filter(|stop| (0.0..AT_REST).contains(&stop.slowest[0]));
        rested.map(|stop| (stop.waypoint, stop.slowest[1]))
    }

    /// The largest of them.
    pub fn error(&self) -> Option<f64> {
        self.errors().map(|(_, error)| error).reduce(f64::max)
    }
}
