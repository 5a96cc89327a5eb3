//! The routes that the tests fly: waypoints, and the tables made from them.

use std::f64::consts::{PI, TAU};

use controller::{Knot, Real, Route, RoutePace, RouteTable, Run, Waypoint, build_route};

/// Waypoints, and whether the last leads back to the first.
pub struct Course {
    pub name: &'static str,
    pub waypoints: Vec<Waypoint<f64>>,
    pub is_closed: bool,
}

/// A route that owns its table.
pub type Owned<T> = Route<T, RouteTable<Vec<Knot<T>>, Vec<Run<T>>>>;

impl Course {
    pub fn new(name: &'static str, points: &[[f64; 3]], corner: f64, speed: f64) -> Self {
        let waypoints = points
            .iter()
            .map(|&point| Waypoint { point, corner: Some(corner), speed, yaw: None, stop: None })
            .collect();
        Self { name, waypoints, is_closed: false }
    }

    pub fn closed(self) -> Self {
        Self { is_closed: true, ..self }
    }

    /// Passes smoothly through the waypoints from `first` on.
    pub fn smooth(mut self, first: usize) -> Self {
        self.waypoints.iter_mut().skip(first).for_each(|waypoint| waypoint.corner = None);
        self
    }

    pub fn table(&self) -> RouteTable<Vec<Knot<f64>>, Vec<Run<f64>>> {
        let (mut knots, mut runs) = (vec![Knot::default(); 20_000], vec![Run::default(); 100]);
        let built = build_route(&self.waypoints, self.is_closed, &RoutePace::default(), &mut knots, &mut runs)
            .unwrap_or_else(|error| panic!("{}: {error}", self.name));
        knots.truncate(built.knots);
        runs.truncate(built.runs);
        RouteTable { knots, runs }
    }

    pub fn route<T: Real>(&self) -> Owned<T> {
        let RouteTable { knots, runs } = self.table();
        Route::new(RouteTable {
            knots: knots.iter().map(Knot::cast).collect(),
            runs: runs.iter().map(Run::cast).collect(),
        })
        .unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }
}

/// Gerono's lemniscate, 12 m by 6 m.
pub fn figure_eight() -> Course {
    let points: Vec<[f64; 3]> = (0..32)
        .map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / 32.0).sin_cos();
            [6.0 * cos, 6.0 * sin * cos, -10.0]
        })
        .collect();
    Course::new("figure eight", &points, 2.0, 1.5).closed().smooth(0)
}

/// A trefoil, some 8 m across and 3 m high.
pub fn knot() -> Course {
    let points: Vec<[f64; 3]> = (0..48)
        .map(|i| {
            let t = TAU * f64::from(i) / 48.0;
            let radius = 2.0 * (2.0 + (3.0 * t).cos());
            [radius * (2.0 * t).cos(), radius * (2.0 * t).sin(), -10.0 + 1.5 * (3.0 * t).sin()]
        })
        .collect();
    Course::new("knot", &points, 2.0, 1.5).closed().smooth(0)
}

/// Eight rows of 20 m, 2 m apart.
pub fn survey_rows() -> Course {
    let points: Vec<[f64; 3]> = (0..8)
        .flat_map(|row| {
            let (near, far) = if row % 2 == 0 { (0.0, 20.0) } else { (20.0, 0.0) };
            let y = 2.0 * f64::from(row);
            [[near, y, -10.0], [far, y, -10.0]]
        })
        .collect();
    Course::new("survey rows", &points, 2.0, 2.0)
}

/// Straight up for 8 m, over to a helix of 5 m radius, two turns of it and off along its tangent.
pub fn helix() -> Course {
    let mut points = vec![[5.0, -8.0, -2.0], [5.0, -8.0, -10.0]];
    points.extend((0..=36).map(|i| {
        let angle = PI / 9.0 * f64::from(i);
        [5.0 * angle.cos(), 5.0 * angle.sin(), -10.0 - 0.15 * f64::from(i)]
    }));
    points.push([5.0, 12.0, -15.8]);
    let mut course = Course::new("helix", &points, 3.0, 1.5).smooth(2);
    course.waypoints[39].corner = Some(3.0);
    course
}

/// 20 m there, a stop, and back.
pub fn there_and_back() -> Course {
    let mut course =
        Course::new("there and back", &[[0.0, 0.0, -10.0], [12.0, 16.0, -12.0], [0.0, 0.0, -10.0]], 2.0, 2.0);
    course.waypoints[1].stop = Some(3.0);
    course
}

/// Forty waypoints over 2 km.
pub fn two_kilometres() -> Course {
    let points: Vec<[f64; 3]> = (0..40)
        .map(|i| {
            let t = f64::from(i);
            [45.0 * t, 40.0 * (1.3 * t).sin(), -30.0 + 8.0 * (0.7 * t).cos()]
        })
        .collect();
    Course::new("two kilometres", &points, 8.0, 6.0)
}

pub fn all() -> [Course; 6] {
    [figure_eight(), knot(), survey_rows(), helix(), there_and_back(), two_kilometres()]
}
