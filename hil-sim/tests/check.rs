//! Which curves are refused and where, and what the others ask of a vehicle.

use controller::{Vector3, Vehicle, VehicleParams};
use hil_sim::describe::course::{PathSpec, parse_path};
use hil_sim::study::check::{Limits, Reason, Refusal, Report};
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

fn path(value: Value) -> PathSpec {
    parse_path("path", value).unwrap_or_else(|error| panic!("{error}"))
}

fn implicit(h1: &str, h2: &str) -> PathSpec {
    path(json!({ "kind": "implicit", "h1": h1, "h2": h2, "speed": 1.0 }))
}

fn vehicle() -> Vehicle<f64> {
    Vehicle::new(VehicleParams::paper()).unwrap()
}

fn check(path: &PathSpec) -> Result<Report, Refusal> {
    path.check(&vehicle(), &Limits::of(&vehicle()))
}

/// The paper's circle at 2 m/s, against the turn's elementary mechanics.
#[test]
fn a_circle_asks_for_what_a_steady_turn_needs() {
    let (radius, speed, g) = (5.0, 2.0, 9.81);
    let report = check(&path(json!({ "kind": "circle", "radius": radius, "p3": -10.0, "speed": speed }))).unwrap();
    let near = |value: f64, wanted: f64, bound: f64| {
        assert!((value - wanted).abs() <= bound * wanted.abs().max(1e-3), "{value} against {wanted}");
    };
    // The walk's chords with their fourth-order correction.
    near(report.lap.length(), TAU * radius, 1e-9);
    near(report.lap_time, TAU * radius / speed, 1e-9);
    near(report.lap.sharpest().curvature(), 1.0 / radius, 1e-12);
    assert!(report.branches.is_none());

    // Centripetal force through the rod: tan(rod angle) = v²/(r g); the UAV turns on a circle wider
    // by L sin(angle).
    let centripetal = speed * speed / radius;
    let force = centripetal.hypot(g);
    let VehicleParams { payload_mass, uav_mass, rod_length, .. } = *vehicle().params();
    near(report.demand.rod_angle.max, (centripetal / g).atan(), 1e-12);
    near(report.demand.tension.min, force / g, 1e-12);
    let rate = speed / radius;
    let uav_radius = radius - rod_length * centripetal / force;
    let horizontal = uav_mass * rate * rate * uav_radius + payload_mass * centripetal;
    let vertical = (uav_mass + payload_mass) * g;
    near(report.demand.thrust.max, horizontal.hypot(vertical), 1e-11);
    near(report.demand.thrust.min, report.demand.thrust.max, 1e-11);
    near(report.demand.tilt.max, (horizontal / vertical).atan(), 1e-11);
    assert!(report.excesses.is_empty());

    // The highest speed is where the first limit of the turn is met.
    let fastest = report.fastest.unwrap();
    let excess = fastest.then.unwrap();
    assert!(fastest.speed > 2.0, "{}", fastest.speed);
    assert!(excess.value > excess.limit && excess.value < 1.001 * excess.limit, "{excess}");
}

/// A formula's curve and the same curve built in ask for the same.
#[test]
fn built_in_curves_and_their_formulas_agree() {
    let pairs = [
        (
            json!({ "kind": "ellipse", "a": 6.0, "b": 4.0, "c0": -10.0, "c1": 0.3, "speed": 1.5 }),
            json!({ "kind": "implicit", "h1": "(x/6)^2 + (y/4)^2 - 1", "h2": "z + 10 - 0.3*x", "speed": 1.5,
                    "yaw": "tangent" }),
        ),
        (
            json!({ "kind": "bent", "a": 5.0, "b": 4.0, "c0": -10.0, "v0": 1.5, "v1": 0.5 }),
            json!({ "kind": "implicit", "h1": "(x/a)^4 + (y/b)^4 - 1", "h2": "z + 10 - 0.5*sin(x/2)",
                    "speed": "1.5 + 0.5*x/a", "yaw": "0.2*x", "constants": { "a": 5.0, "b": 4.0 } }),
        ),
    ];
    for (built_in, formula) in pairs {
        let (a, b) = (check(&path(built_in)).unwrap(), check(&path(formula)).unwrap());
        let pairs = [
            (a.lap.length(), b.lap.length()),
            (a.lap_time, b.lap_time),
            (a.demand.thrust.max, b.demand.thrust.max),
            (a.demand.torque.max, b.demand.torque.max),
            (a.demand.body_rate.max, b.demand.body_rate.max),
        ];
        for (left, right) in pairs {
            // The walks start at different points, so their samples differ.
            assert!((left - right).abs() <= 1e-3 * right.abs(), "{left} against {right}");
        }
    }
}

/// d_C of a lap against the closed form of a circle, on both sides and off the plane.
#[test]
fn the_nearest_point_is_that_of_the_circle() {
    let circle = implicit("x^2 + y^2 - 25", "z + 10");
    let mut worst = 0.0_f64;
    for i in 0..500 {
        let t = f64::from(i);
        let (radius, angle, z) = (5.0 + 3.0 * (0.7 * t).sin(), 1.3 * t, -10.0 + 2.0 * (0.31 * t).cos());
        let p = [radius * angle.cos(), radius * angle.sin(), z];
        worst = worst.max((circle.distance(p) - (radius - 5.0).hypot(z + 10.0)).abs());
    }
    // R·0.02⁴/384 for the cubic between two nodes.
    assert!(worst <= 5.0 * 0.02_f64.powi(4) / 384.0 * 1.1, "{worst:e}");
}

fn refusal(path: &PathSpec) -> Refusal {
    let refusal = match check(path) {
        Err(refusal) => refusal,
        Ok(report) => panic!("accepted: {report}"),
    };
    assert!(refusal.place.position.iter().all(|value| value.is_finite()) && refusal.place.arc.is_finite());
    assert!(!refusal.to_string().contains("NaN"), "{refusal}");
    refusal
}

fn assert_near(refusal: &Refusal, p: [f64; 3], bound: f64) {
    let off = refusal.place.position - Vector3::from(p);
    assert!(off.dot(&off).sqrt() <= bound, "{refusal}, expected near {p:?}");
}

#[test]
fn a_crossing_is_refused_at_its_place() {
    // Bernoulli's lemniscate crosses itself in the origin.
    let lemniscate = refusal(&implicit("(x^2 + y^2)^2 - 25*(x^2 - y^2)", "z + 10"));
    assert_near(&lemniscate, [0.0, 0.0, -10.0], 1e-3);
    // A Fourier curve is regular where it crosses itself.
    let (sin, cos) = 1.0_f64.sin_cos();
    let (sin_2, cos_2) = 2.0_f64.sin_cos();
    let eight = path(
        json!({ "kind": "fourier", "center": [0.0, 0.0, -10.0], "reference": [0.0, 0.0, 1.0], "speed": 1.0,
        "cos": [[5.0 * sin, 0.0, 0.0], [0.0, 3.0 * sin_2, 0.0]], "sin": [[5.0 * cos, 0.0, 0.0], [0.0, 3.0 * cos_2, 0.0]] }),
    );
    let eight = refusal(&eight);
    assert!(matches!(eight.reason, Reason::Crossing { .. }), "{eight}");
    assert_near(&eight, [0.0, 0.0, -10.0], 1e-3);
}

#[test]
fn a_kink_is_refused_at_its_place() {
    // √(x²) is |x|: two arcs that meet at an angle on x = 0.
    let lens = refusal(&implicit("(sqrt(x^2) + 3)^2 + y^2 - 25", "z + 10"));
    assert!(lens.place.position.x.abs() < 1e-3, "{lens}");
    assert!((lens.place.position.y.abs() - 4.0).abs() < 1e-3, "{lens}");
    // Half a circle and half an ellipse: tangents agree, curvatures do not.
    let egg = refusal(&implicit("(x + sqrt(x^2))^2/16 + (x - sqrt(x^2))^2/36 + y^2/9 - 1", "z + 10"));
    assert_eq!(egg.reason, Reason::Jump { order: 2 }, "{egg}");
    assert!(egg.place.position.x.abs() < 1e-4, "{egg}");
}

#[test]
fn an_open_curve_is_refused() {
    let parabola = refusal(&implicit("y - x^2", "z + 10"));
    assert_eq!(parabola.reason, Reason::Open);
    let line = refusal(&implicit("y - sin(x)", "z + 10"));
    assert!(matches!(line.reason, Reason::Open | Reason::Endless), "{line}");
    let helix = refusal(&implicit("x - 3*cos(z)", "y - 3*sin(z)"));
    assert!(matches!(helix.reason, Reason::Open | Reason::Endless), "{helix}");
}

#[test]
fn a_formula_that_is_not_defined_is_refused_at_its_place() {
    // The circle ends where the logarithm does, at x = −3.
    let cut = refusal(&implicit("x^2 + y^2 - 25", "z + 10 + 0.1*ln(x + 3)"));
    assert!(cut.place.position.x < 0.0, "{cut}");
    let root = refusal(&implicit("x^2 + y^2 - 25", "z + 10 + 0.1*(x + 3)^1.5"));
    assert_eq!(root.reason, Reason::Undefined, "{root}");
    assert!((root.place.position.x + 3.0).abs() < 1e-3, "{root}");
    let nowhere = refusal(&implicit("ln(-1 - x^2)", "z"));
    assert_eq!(nowhere.reason, Reason::Undefined);
    let speed = path(json!({ "kind": "implicit", "h1": "x^2 + y^2 - 25", "h2": "z + 10", "speed": "sqrt(x)" }));
    assert_eq!(refusal(&speed).reason, Reason::Undefined);
    let yaw = path(json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0, "yaw": "ln(y)" }));
    assert_eq!(refusal(&yaw).reason, Reason::Undefined);
}

/// The circle with this speed and this yaw.
fn profiled(speed: &str, yaw: &str) -> PathSpec {
    path(json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": speed, "yaw": yaw }))
}

#[test]
fn a_speed_or_yaw_that_jumps_is_refused_at_its_place() {
    let branch = [-5.0, 0.0, -10.0];
    let jumps = [
        (profiled("2 + 0.1*atan2(y, x)", "0"), Reason::SpeedJumps { order: 0 }, branch),
        // Half an angle is half a turn off after a lap; a whole multiple is not, since the law
        // takes whole turns for none.
        (profiled("1", "0.5*atan2(y, x)"), Reason::YawJumps { order: 0 }, branch),
        (profiled("1", "-2.5*atan2(y, x)"), Reason::YawJumps { order: 0 }, branch),
    ];
    for (path, reason, place) in jumps {
        let refusal = refusal(&path);
        assert_eq!(refusal.reason, reason, "{refusal}");
        assert_near(&refusal, place, 1e-3);
    }
    let kinks = [
        (profiled("1 + 0.1*sqrt((y - 1)^2)", "0"), Reason::SpeedJumps { order: 1 }),
        (profiled("1", "0.1*sqrt((y - 1)^2)"), Reason::YawJumps { order: 1 }),
    ];
    for (path, reason) in kinks {
        let refusal = refusal(&path);
        assert_eq!(refusal.reason, reason, "{refusal}");
        assert!((refusal.place.position.y - 1.0).abs() < 1e-3, "{refusal}");
    }
}

#[test]
fn a_speed_or_yaw_that_only_changes_fast_is_accepted() {
    for (speed, yaw) in [
        ("1", "atan2(y, x)"),
        ("1", "3*atan2(y, x) + 40"),
        ("2 + tanh(100*x)", "0.001*y"),
        ("1e-3*x + 1", "tanh(100*y)"),
    ] {
        check(&profiled(speed, yaw)).unwrap_or_else(|refusal| panic!("{speed}, {yaw}: {refusal}"));
    }
}

#[test]
fn surfaces_that_do_not_cut_each_other_are_refused() {
    assert_eq!(refusal(&implicit("x^2 + y^2 + 1", "z")).reason, Reason::NoCurve);
    // A double root: the gradient vanishes all along.
    refusal(&implicit("(x^2 + y^2 - 25)^2", "z + 10"));
    // Two cylinders that touch along nothing but two points: their curves cross there.
    let vivianis = refusal(&implicit("x^2 + y^2 + z^2 - 16", "(x - 2)^2 + y^2 - 4"));
    assert_near(&vivianis, [4.0, 0.0, 0.0], 1e-3);
}

#[test]
fn a_speed_that_vanishes_is_refused() {
    let stops = path(json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": "x/5" }));
    let stops = refusal(&stops);
    assert_eq!(stops.reason, Reason::Stops);
    // Within a step of where the sign changes.
    assert!(stops.place.position.x.abs() < 0.2, "{stops}");
    assert_eq!(
        refusal(&path(json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 0.0 }))).reason,
        Reason::Stops
    );
}

#[test]
fn limits_are_named_with_their_place() {
    // A vertical loop so fast that the rod would have to push.
    let loop_ = |speed: f64| {
        path(
            json!({ "kind": "tilted", "center": [0.0, 0.0, -20.0], "normal": [0.0, 1.0, 0.0], "major": [1.0, 0.0, 0.0],
            "a": 6.0, "b": 4.0, "speed": speed }),
        )
    };
    let slow = check(&loop_(1.0)).unwrap();
    assert!(slow.excesses.is_empty(), "{slow}");
    let fast = check(&loop_(5.0)).unwrap();
    // The payload's own acceleration at the side of the ellipse, κ v² = 25·6/16, is nearly level
    // there.
    let rod = fast.excesses.iter().find(|excess| excess.quantity == "rod angle").unwrap();
    assert!(rod.place.position.x.abs() > 5.0, "{fast}");
    let fastest = slow.fastest.unwrap();
    // Every speed up to the highest is good, and a little more is not.
    assert!(check(&loop_(0.999 * fastest.speed)).unwrap().excesses.is_empty());
    assert!(!check(&loop_(1.001 * fastest.speed)).unwrap().excesses.is_empty());
}

/// A wave on a circle with `n` periods: the walk follows bends of any size.
#[test]
fn closed_curves_of_many_shapes_are_accepted() {
    for n in [2, 5, 9] {
        let wavy = implicit(
            &format!("sqrt(x^2 + y^2) - 10 - 0.5*cos({n}*atan2(y, x))"),
            &format!("z + 10 - 0.7*sin({n}*atan2(y, x))"),
        );
        let report = check(&wavy).unwrap_or_else(|refusal| panic!("{n}: {refusal}"));
        assert!(report.lap.length() > 2.0 * PI * 10.0, "{n}");
    }
    for half_exponent in [1, 2, 5, 10] {
        let square = path(json!({ "kind": "superellipse", "a": 5.0, "b": 3.0, "half_exponent": half_exponent,
            "c0": -10.0, "speed": 0.5 }));
        let report = check(&square).unwrap_or_else(|refusal| panic!("{half_exponent}: {refusal}"));
        assert!(report.lap.length() < 32.0 && report.lap.length() > 25.0);
    }
}

/// Double normals of known curves: an ellipse's minor axis (a saddle of the distance), and a flat
/// bone's waist.
#[test]
fn branches_are_apart_by_the_shortest_double_normal() {
    let ellipse = check(&implicit("(x/7)^2 + (y/4)^2 - 1", "z + 10")).unwrap();
    let found = ellipse.branches.unwrap();
    // As good as the cubics between the nodes.
    assert!((found.distance - 8.0).abs() < 1e-7, "{ellipse}");
    // r = 4 + 2 cos 2φ is 2 at its waist, φ = 90°.
    let bone = check(&implicit("sqrt(x^2 + y^2) - 4 - 2*cos(2*atan2(y, x))", "z + 10")).unwrap();
    assert!((bone.branches.unwrap().distance - 4.0).abs() < 1e-7, "{bone}");
}

#[test]
fn functions_whose_gradients_are_parallel_everywhere_are_no_undefined_formula() {
    for (h1, h2) in [("25", "z + 10"), ("x - x", "z + 10"), ("x^2 + y^2 - 25", "x^2 + y^2 - 25")] {
        assert_eq!(check(&implicit(h1, h2)).unwrap_err().reason, Reason::Parallel, "{h1}, {h2}");
    }
    assert_eq!(check(&implicit("sqrt(x - 1e6)", "z + 10")).unwrap_err().reason, Reason::Undefined);
}

/// Ripples of 6 mm make ten thousands of nodes, of which not each is compared with each other. The
/// shortest double normal of an ellipse with half axes 7 m and 4 m is then found to within what
/// they move it: their height, and their slope over the distance.
#[test]
fn a_curve_with_very_many_bends_is_walked_and_its_branches_are_found() {
    let rippled = check(&implicit("(x/7)^2 + (y/4)^2 - 1 + 1e-5*sin(1000*x)", "z + 10")).unwrap();
    assert!(rippled.lap.nodes().len() > 30_000, "{}", rippled.lap.nodes().len());
    let (height, slope) = (2e-5, 2e-2_f64);
    let found = rippled.branches.unwrap().distance;
    assert!((found - 8.0).abs() < 2.0 * height + 8.0 * slope * slope, "{found}");
    let eight = implicit("(x^2 + y^2)^2 - 50*(x^2 - y^2) + 1e-3*(cos(2000*x) - 1)", "z + 10");
    assert!(check(&eight).is_err(), "it crosses itself");
}
