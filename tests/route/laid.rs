//! Where the builder lays routes.

use crate::courses::Course;
use controller::{Table, Vector3};

/// The least distance of the laid curve from a waypoint, m.
fn missed(course: &Course, index: usize) -> f64 {
    let mut route = course.route::<f64>();
    let place = Vector3::from(course.waypoints[index].point);
    let spans: Vec<usize> = route.table().runs().iter().map(|run| run.flown().end).collect();
    let places = spans.iter().enumerate().flat_map(|(run, &spans)| (0..spans * 200).map(move |at| (run, at)));
    places.fold(f64::INFINITY, |least, (run, at)| {
        route.go_to(run, at as f64 / 200.0);
        least.min((route.point() - place).norm())
    })
}

/// One smooth waypoint between corners or stops is passed through, however long its legs are.
#[test]
fn a_smooth_waypoint_by_itself_is_passed_through() {
    for legs in [[12.0, 12.0], [3.0, 40.0], [60.0, 5.0]] {
        let [before, after] = legs;
        let points = [
            [0.0, 0.0, -10.0],
            [20.0, 0.0, -10.0],
            [20.0, before, -11.0],
            [20.0 + after, before + 2.0, -10.0],
            [90.0, 30.0, -10.0],
        ];
        let mut course = Course::new("one smooth", &points, 2.0, 2.0);
        course.waypoints[2].corner = None;
        let missed = missed(&course, 2);
        // Samples stand some centimetres apart, and the curve turns by little between two.
        assert!(missed < 0.02, "{legs:?}: {missed} m");
    }
}
