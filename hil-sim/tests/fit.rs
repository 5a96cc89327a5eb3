//! Waypoints to curves: known curves come back, wiggles do not, and bad files are refused with
//! their place.

use controller::Vector3;
use hil_sim::describe::course::parse_path;
use hil_sim::study::check::probe::length;
use hil_sim::study::fit::{self, FitError, LEAST_ANGLE, fit, read};
use std::f64::consts::TAU;

fn loop_of(count: usize, curve: impl Fn(f64) -> [f64; 3]) -> Vec<Vector3<f64>> {
    (0..count).map(|i| Vector3::from(curve(TAU * i as f64 / count as f64))).collect()
}

#[test]
fn a_circle_comes_back_as_one_harmonic() {
    let found = fit(&loop_of(12, |s| [3.0 + 5.0 * s.cos(), 5.0 * s.sin(), -10.0]), 1e-6).unwrap();
    assert_eq!(found.count, 1);
    assert!(found.worst.0 < 1e-12 && found.rms < 1e-12, "{found}");
    assert!((found.lap.length() - TAU * 5.0).abs() < 1e-8, "{found}");
    assert!((found.lap.sharpest().curvature() - 0.2).abs() < 1e-10, "{found}");
    // All tangents are level: the vertical stands across every one.
    assert!(found.harmonics.reference[2].abs() > 0.999_999, "{found}");
}

/// A knot in space, from points at uneven parameters.
#[test]
fn a_trigonometric_knot_comes_back_from_uneven_points() {
    let knot = |s: f64| {
        let r = 5.0 + 1.5 * (3.0 * s).cos();
        [r * (2.0 * s).cos(), r * (2.0 * s).sin(), -15.0 + 1.5 * (3.0 * s).sin()]
    };
    let found = fit(&loop_of(80, |s| knot(s + 0.1 * s.sin())), 1e-3).unwrap();
    // The products of the second and third harmonics reach the fifth.
    assert_eq!(found.count, 5, "{found}");
    assert!(found.worst.0 < 1e-7, "{found}");
    let off = loop_of(500, knot).into_iter().map(|p| found.lap.nearest(p).distance).fold(0.0, f64::max);
    assert!(off < 1e-6, "{off}");
    assert!(found.lap.closest_branches().is_some());
}

/// A rounded rectangle is no trigonometric polynomial: more harmonics, until the tolerance is kept.
#[test]
fn a_finer_tolerance_takes_more_harmonics_and_is_kept() {
    let rectangle = |s: f64| {
        let p = |x: f64| x.signum() * x.abs().powf(0.5);
        [10.0 * p(s.cos()), 6.0 * p(s.sin()), -12.0]
    };
    let points = loop_of(60, |s| rectangle(s + 0.01));
    let mut before = 0;
    for tolerance in [1.0, 0.1, 0.03, 0.01] {
        let found = fit(&points, tolerance).unwrap();
        assert!(found.worst.0 <= tolerance, "{found}");
        assert!(found.count >= before, "{tolerance}: {found}");
        before = found.count;
        let by_lap = points.iter().map(|p| found.lap.nearest(*p).distance).fold(0.0, f64::max);
        // The fit's own feet are local; the lap's is the nearest point of all.
        assert!(by_lap <= found.worst.0 + 1e-6, "{by_lap} {found}");
        assert!(found.rms <= found.worst.0);
    }
    assert!(before > fit(&points, 1.0).unwrap().count);
    // A zigzag of 20 periods is above the highest harmonic.
    let zigzag: Vec<Vector3<f64>> = points
        .iter()
        .take(40)
        .enumerate()
        .map(|(i, point)| point + Vector3::new(0.0, 0.0, if i % 2 == 0 { 0.5 } else { -0.5 }))
        .collect();
    let error = fit(&zigzag, 0.1).map(|found| found.to_string()).unwrap_err();
    assert!(matches!(error, FitError::Tolerance { points: 40, .. }), "{error}");
}

#[test]
fn the_reference_direction_is_across_a_vertical_loop() {
    let found = fit(&loop_of(16, |s| [6.0 * s.cos(), 0.5, -20.0 + 4.0 * s.sin()]), 1e-3).unwrap();
    assert!(found.harmonics.reference[1].abs() > 0.999_999, "{found}");
    assert!(found.reference_angle > 1.57, "{found}");
}

/// Tangents in all directions: within 15° of any of them.
#[test]
fn a_curve_whose_tangents_leave_no_direction_is_refused_with_the_place() {
    // A torus knot of many turns about its own core: its tangents fill the sphere.
    let coil = |s: f64| {
        let r = 10.0 + 3.0 * (11.0 * s).cos();
        [r * s.cos(), r * s.sin(), -20.0 + 3.0 * (11.0 * s).sin()]
    };
    match fit(&loop_of(400, coil), 0.5) {
        Err(FitError::NoReference { angle, position, arc }) => {
            assert!(angle < LEAST_ANGLE);
            let off = (position[0].hypot(position[1]) - 10.0).hypot(position[2] + 20.0);
            assert!((off - 3.0).abs() < 0.6 && arc >= 0.0, "{position:?}");
        }
        Err(error) => panic!("{error}"),
        Ok(found) => panic!("{found}"),
    }
}

#[test]
fn a_loop_that_crosses_itself_is_refused() {
    let eight = loop_of(40, |s| [8.0 * (s + 0.3).sin(), 4.0 * (2.0 * s + 0.6).sin(), -10.0]);
    let error = fit(&eight, 0.01).unwrap_err();
    assert!(matches!(error, FitError::Curve(_)) && error.to_string().contains("crosses itself"), "{error}");
}

/// What is written can be read as a path, and is the same curve.
#[test]
fn the_path_file_holds_the_curve() {
    let found = fit(&loop_of(40, |s| [8.0 * s.cos(), 5.0 * s.sin(), -10.0 + (2.0 * s).sin()]), 1e-3).unwrap();
    let mut table: toml::Table = toml::from_str(&fit::toml(&found, "points.csv")).unwrap();
    let path = parse_path("path", table.remove("path").unwrap()).unwrap();
    let lap = path.lap().unwrap();
    assert!((lap.length() - found.lap.length()).abs() < 1e-9);
    for node in found.lap.nodes() {
        assert!(path.distance(node.position().into()) < 1e-8);
    }
    let constant = fit::rust(&found, "points.csv");
    assert!(constant.contains(&format!("Harmonics<f32, {}>", found.count)), "{constant}");
    // A row each for the centre, the harmonics' two, and the reference.
    assert_eq!(constant.matches('[').count(), 2 * found.count + 4, "{constant}");
}

#[test]
fn files_are_read_as_documented() {
    let text = "x, y, z\n# corner\n1.5,0,-10\n 0 , 2.5e0 ,-10\n-1,0,-10\n0,-2,-11\n1.5,0,-10\n";
    let points = read("w.csv", text).unwrap().points;
    assert_eq!(points.len(), 4);
    assert!(length(&(points[1] - Vector3::new(0.0, 2.5, -10.0))) == 0.0);
}

#[test]
fn bad_files_are_refused_with_line_column_and_value() {
    let good = "1,0,-10\n0,2,-10\n-1,0,-10\n";
    let cases = [
        (format!("{good}0,two,-10\n"), 4, Some(2), "\"two\""),
        (format!("x,y,z\n{good}0,2,NaN\n"), 5, Some(3), "NaN"),
        (format!("{good}0,inf,-10\n"), 4, Some(2), "inf"),
        (format!("{good}0,1e9,-10\n"), 4, Some(2), "1000000000"),
        (format!("{good}0,1\n"), 4, None, "2 values"),
        (format!("{good}0,1,2,3\n"), 4, None, "4 values"),
        (format!("{good}-1,0,-10\n0,3,-10\n"), 4, None, "repeats"),
        (format!("{good}0,,-10\n"), 4, Some(2), "\"\""),
        (good.to_owned(), 0, None, "3 points"),
        (String::new(), 0, None, "0 points"),
    ];
    for (text, line, column, message) in cases {
        let error = read("w.csv", &text).expect_err(&text);
        assert_eq!((error.line, error.column), (line, column), "{error}");
        assert!(error.message.contains(message) && error.to_string().starts_with("w.csv"), "{error}");
    }
}

/// The scenarios round the building fly the curve that their waypoints give.
#[test]
fn the_building_scenarios_hold_the_fit_of_their_waypoints() {
    let points = read("building.csv", include_str!("../scenarios/building.csv")).unwrap().points;
    let found = fit(&points, 0.05).unwrap();
    for name in ["building", "building-light", "building-heavy"] {
        let scenario = hil_sim::describe::scenario::builtin(name).unwrap().unwrap();
        let hil_sim::describe::scenario::Law::Follow { path, .. } = scenario.controller.law else { panic!("{name}") };
        let off = found.lap.nodes().iter().map(|node| path.distance(node.position().into())).fold(0.0, f64::max);
        // The file's coefficients are rounded to nanometres.
        assert!(off < 1e-7, "{name}: {off:e}");
    }
}

/// The same loop in other words.
#[test]
fn names_and_units_of_columns_are_obeyed() {
    let plain = read("w.csv", "10,0,-12\n0,8,-12\n-10,0,-11\n0,-8,-12\n").unwrap().points;
    let cases = [
        "z,y,x\n-12,0,10\n-12,8,0\n-11,0,-10\n-12,-8,0\n",
        "north,east,up\n10,0,12\n0,8,12\n-10,0,11\n0,-8,12\n",
        "East (m), North (m), Altitude (m)\n0,10,12\n8,0,12\n0,-10,11\n-8,0,12\n",
        "x_cm,y_cm,z_up_cm\n1000,0,1200\n0,800,1200\n-1000,0,1100\n0,-800,1200\n",
        "e,n,d\n0,10,-12\n8,0,-12\n0,-10,-11\n-8,0,-12\n",
        "west,south,down [m]\n0,-10,-12\n-8,0,-12\n0,10,-11\n8,0,-12\n",
    ];
    for text in cases {
        let points = read("w.csv", text).unwrap_or_else(|error| panic!("{text}: {error}")).points;
        let off = points.iter().zip(&plain).map(|(one, other)| length(&(one - other))).fold(0.0, f64::max);
        assert!(off < 1e-12, "{text}: {points:?}");
    }
    let feet = read("w.csv", "x ft,y ft,z ft\n10,0,-12\n0,8,-12\n-10,0,-11\n0,-8,-12\n").unwrap().points;
    assert!(feet.iter().zip(&plain).all(|(one, other)| length(&(one - other * 0.3048)) < 1e-12));
    for (names, column, message) in [
        ("lat,lon,alt", Some(1), "an angle"),
        ("x,y,z (deg)", Some(3), "an angle"),
        ("x,y,colour", Some(3), "colour"),
        ("x,y,z_parsec", Some(3), "parsec"),
        ("x,y,x", None, "n3"),
        ("x,y,z,t", Some(4), "\"t\""),
        ("x,y", None, "2 names"),
    ] {
        let error = read("w.csv", &format!("{names}\n1,2,3\n")).expect_err(names);
        assert_eq!((error.line, error.column), (1, column), "{error}");
        assert!(error.message.contains(message), "{error}");
    }
}

#[test]
fn sizes_that_make_no_sense_are_doubted() {
    let doubts = |scale: f64, z: f64| {
        let point = |x: f64, y: f64| format!("{},{},{z}\n", scale * x, scale * y);
        let text = point(10.0, 0.0) + &point(0.0, 8.0) + &point(-10.0, 0.0) + &point(0.0, -8.0);
        read("w.csv", &text).unwrap().doubts()
    };
    assert_eq!(doubts(1.0, -12.0), Vec::<String>::new());
    for (scale, z, doubt) in [(1e-5, -12.0, "2.00e-4 m"), (1e3, -12.0, "20.0 km"), (1.0, 12.0, "below the origin")] {
        assert!(doubts(scale, z)[0].contains(doubt), "{:?}", doubts(scale, z));
    }
}

#[test]
fn more_waypoints_than_a_loop_needs_are_refused() {
    let line = |i: usize| format!("{},{},-10\n", 10.0 * (1e-4 * i as f64).cos(), 10.0 * (1e-4 * i as f64).sin());
    let error = read("w.csv", &(0..30_000).map(line).collect::<String>()).unwrap_err();
    assert!(error.message.contains("more than 20000"), "{error}");
}

/// A loop as thin as a hair, whose tangents are all but one: the search for a reference direction
/// ends all the same.
#[test]
fn a_hair_of_a_loop_is_answered() {
    let answer = fit(&loop_of(16, |s| [47.0 + 9e-5 * s.cos(), 8.0 + 8e-5 * s.sin(), 12.0 + s.sin()]), 0.05);
    assert!(answer.is_err() || answer.is_ok_and(|found| found.reference_angle > LEAST_ANGLE));
}
