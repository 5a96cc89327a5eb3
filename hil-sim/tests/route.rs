//! Routes as described by a user: flown, checked, evaluated, and refused.

use hil_sim::describe::course::{PathSpec, parse_path};
use hil_sim::describe::scenario::{Law, ROUTES, Scenario, builtin};
use hil_sim::fly::metrics::Results;
use hil_sim::fly::run::{Arithmetic, fly_simply};
use hil_sim::study::check::{Limits, Report, way_breaches};
use hil_sim::study::eval;
use serde_json::{Value, json};

fn path(value: Value) -> PathSpec {
    parse_path("path", value).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario(name: &str) -> Scenario {
    builtin(name).expect("it is built in").unwrap_or_else(|error| panic!("{error}"))
}

fn check(name: &str) -> Report {
    let scenario = scenario(name);
    let Law::Follow { path, .. } = &scenario.controller.law else { panic!("{name} follows") };
    let vehicle = controller::Vehicle::new(scenario.controller.vehicle).unwrap();
    path.check(&vehicle, &Limits::of(&vehicle)).unwrap_or_else(|refusal| panic!("{name}: {refusal}"))
}

/// Within a millimetre of the route from joining on, without a step of thrust, and to rest within a
/// millimetre of each stop.
#[test]
fn built_in_routes_are_flown_to_the_millimetre() {
    for (name, _) in ROUTES {
        let flight = fly_simply(&scenario(name), Arithmetic::F32).unwrap();
        assert_eq!(flight.end.failure(), None, "{name}");
        let Results { dc_max_m, stop_error_m, thrust_step_max, .. } = flight.results;
        println!("{name}: d_C {dc_max_m:?}, off its stops {stop_error_m:?}, thrust {thrust_step_max:?}");
        assert!(dc_max_m.unwrap() <= 1e-3, "{name}: {dc_max_m:?}");
        assert!(thrust_step_max.unwrap() <= 0.01, "{name}: {thrust_step_max:?}");
        match *name {
            "figure-eight" => assert_eq!(stop_error_m, None),
            _ => assert!(stop_error_m.unwrap() <= 1e-3, "{name}: {stop_error_m:?}"),
        }
    }
}

/// What `check` says of the time is what is flown, to the tenth that a start's smoothness leaves
/// open; and each leg has its share.
#[test]
fn legs_make_up_the_route() {
    for (name, legs) in
        [("figure-eight", 32), ("survey-rows", 15), ("helix", 39), ("a-to-b", 2), ("two-kilometres", 39)]
    {
        let report = check(name);
        assert!(report.excesses.is_empty(), "{name}");
        let found = report.legs.unwrap();
        assert_eq!(found.legs.len(), legs, "{name}");
        let length: f64 = found.legs.iter().map(|leg| leg.length).sum();
        // The lap's own sum, in another order.
        assert!((length - report.lap.length()).abs() < 1e-9 * length, "{name}");
        let time: f64 = found.legs.iter().map(|leg| leg.time).sum();
        assert!((time + found.dwell - report.lap_time).abs() < 1e-9 * time, "{name}");
    }
}

/// Ten kilometres with 200 wide corners, and one that is too tight for what its pace allows.
#[test]
fn a_long_route_names_the_leg_that_is_not_flyable() {
    let points: Vec<[f64; 3]> = (0..200).map(|i| [50.0 * f64::from(i), 10.0 * f64::from(i % 2), -100.0]).collect();
    let mut corner_m = vec![20.0; 200];
    let route = |corner_m: &[f64]| {
        path(json!({ "kind": "route", "points": points, "speed": 5.0, "corner_m": corner_m, "acceleration": 12.0 }))
    };
    let vehicle = controller::Vehicle::new(controller::VehicleParams::paper()).unwrap();
    let check = |corner_m: &[f64]| route(corner_m).check(&vehicle, &Limits::of(&vehicle)).unwrap();
    let legs = |report: &Report| -> Vec<_> { report.excesses.iter().map(|excess| excess.place.leg).collect() };
    let wide = check(&corner_m);
    // A hard start and stop are what such a pace asks for besides.
    assert!(wide.lap.length() > 1e4 && legs(&wide).iter().all(|leg| [Some(0), Some(198)].contains(leg)));
    corner_m[120] = 0.5;
    let tight = check(&corner_m);
    let new: Vec<_> = legs(&tight).into_iter().filter(|leg| ![Some(0), Some(198)].contains(leg)).collect();
    assert!(!new.is_empty() && new.iter().all(|leg| [Some(119), Some(120)].contains(leg)), "{new:?}");
    let named = tight.excesses.iter().any(|excess| excess.to_string().contains("at leg 120, ("));
    assert!(named && tight.legs.unwrap().legs[120].factor < 1.0);
}

/// The law in f64 and by the witness's own splines, on a route that crosses itself.
#[test]
fn eval_agrees_with_the_witness() {
    let points: Vec<[f64; 3]> = (0..24)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 24.0).sin_cos();
            [6.0 * cos, 6.0 * sin * cos, -10.0 + 0.5 * sin]
        })
        .collect();
    let ask = |arithmetic: &str| {
        let line = json!({
            "law": "follow", "arithmetic": arithmetic,
            "path": { "kind": "route", "points": points, "closed": true, "corner_m": "smooth", "speed": 1.0, "yaw": "tangent" },
            "vehicle": { "payload_mass": 0.5, "uav_mass": 2.5, "inertia": [0.03, 0.03, 0.05], "rod_length": 2.0, "gravity": 9.81 },
            "x": [4.9, 2.2, -10.2, 0.1, -0.05, 0.08, 0.02, 2.5, -0.6, 0.4, 0.1, 0.05, -0.1, 0.1, 0.02, -0.05],
            "zeta": [0.1, -0.2, 0.05, 0.02],
            "gains": { "k": [[720, 1764, 1624, 735, 175, 21], [720, 1764, 1624, 735, 175, 21], [120, 274, 225, 85, 15], [6, 5]] }
        });
        eval::evaluate(line.to_string().as_bytes()).unwrap_or_else(|error| panic!("{error}"))
    };
    let (wanted, double, single) = (ask("witness"), ask("f64"), ask("f32"));
    let numbers = |answer: &eval::Answer| {
        let mut numbers = answer.xi.clone();
        numbers.extend(answer.torque);
        numbers.extend([answer.u_zeta, answer.thrust]);
        numbers
    };
    let error = |answer: &eval::Answer| {
        let pairs = || numbers(answer).into_iter().zip(numbers(&wanted));
        let size = pairs().map(|(_, b)| b * b).sum::<f64>().sqrt();
        pairs().map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / size
    };
    // As the tests of the law on routes have it.
    assert!(error(&double) < 1e-9, "{:e}", error(&double));
    assert!(error(&single) < 2e-4, "{:e}", error(&single));
    let det = |answer: &eval::Answer| answer.margins.path_det;
    assert!((det(&double) - det(&wanted)).abs() < 1e-9, "{} {}", det(&double), det(&wanted));
}

/// An open route's way: d_C is the distance from the nearest leg, however long it is.
#[test]
fn distance_is_that_of_the_nearest_leg() {
    // Two rows, the second with a stop, which has its nodes close together.
    let route = path(json!({
        "kind": "route", "points": [[0, 0, -10], [200, 0, -10], [200, 2, -10], [100, 2, -10], [0, 2, -10]],
        "corner_m": 0.5, "speed": 2, "stops": [{ "index": 3, "dwell_s": 1 }]
    }));
    for (point, distance) in
        [([101.3, 0.8, -10.0], 0.8), ([99.9, 1.3, -10.0], 0.7), ([50.0, -3.0, -6.0], 5.0), ([-3.0, -4.0, -10.0], 5.0)]
    {
        let found = route.distance(point);
        // Straight legs, to rounding.
        assert!((found - distance).abs() < 1e-9, "{point:?}: {found} against {distance}");
    }
    let outline = route.outline(100);
    for (end, wanted) in [(outline[0], [0.0, 0.0, -10.0]), (outline[100], [0.0, 2.0, -10.0])] {
        assert!((controller::Vector3::from(end) - controller::Vector3::from(wanted)).amax() < 1e-9, "{end:?}");
    }
}

/// Load, UAV and cable, the last two 2 m above the first and beside it in bends, are kept from
/// every edge by the margin; who does not keep it is named with the leg.
#[test]
fn fences_hold_for_load_uav_and_cable() {
    let breaches = |fence: Value| {
        let text = toml::to_string(&json!({
            "path": { "kind": "route", "points": [[0, 0, -10], [40, 0, -10], [40, 30, -10]], "corner_m": 4, "speed": 3 },
            "fence": fence
        }));
        let scenario = Scenario::parse("fence.toml", &text.unwrap()).unwrap_or_else(|error| panic!("{error}"));
        let Law::Follow { path, .. } = &scenario.controller.law else { panic!("it follows") };
        let vehicle = controller::Vehicle::new(scenario.controller.vehicle).unwrap();
        scenario.fence.unwrap().breaches(&path.check(&vehicle, &scenario.limits).unwrap())
    };
    let within = json!([[-5, -5], [45, -5], [45, 35], [-5, 35]]);
    // Heights: the load at 10 m, the UAV at 12.
    let tall = json!({ "polygon": within, "up_m": [8.5, 13.5] });
    assert_eq!(breaches(json!({ "inside": [tall], "margin_m": 1.0 })), []);
    let low = breaches(json!({ "inside": [{ "polygon": within, "up_m": [8.5, 12.5] }], "margin_m": 1.0 }));
    assert!(!low.is_empty() && low.iter().all(|breach| breach.what != "the load" && breach.is_inside), "{low:?}");
    // A mast between the load and the UAV is only in the cable's way; beside the second leg.
    let mast = breaches(
        json!({ "outside": [{ "center": [40.3, 20], "radius": 0.2, "up_m": [10.5, 11.5] }], "margin_m": 0.3 }),
    );
    let [mast] = mast[..] else { panic!("{mast:?}") };
    assert_eq!((mast.what, mast.place.leg), ("the cable", Some(1)));
    // 0.1 m from the mast, where the rod hangs straight; looked at every 5 cm.
    assert!((mast.distance - 0.1).abs() < 2e-3, "{mast}");
    assert!(mast.to_string().contains("the cable enters a keep-out") && mast.to_string().contains("leg 1"), "{mast}");
    // A wall that a leg passes through between two nodes.
    let wall = json!([[20.0, -9], [20.01, -9], [20.01, 9], [20.0, 9]]);
    let wall = breaches(json!({ "outside": [{ "polygon": wall, "up_m": [9, 11] }], "margin_m": 0.0 }));
    assert!(wall.iter().all(|breach| breach.place.leg == Some(0)) && !wall.is_empty(), "{wall:?}");
    // The corner is cut by its blend: its keep-out is not entered.
    let corner = json!({ "outside": [{ "center": [40, 0], "radius": 0.3 }], "margin_m": 0.5 });
    assert_eq!(breaches(corner), []);
}

/// From 30 m beside its first leg the load goes straight to the route: what stands in that way, for
/// load, UAV or cable, is told with the leg that it leads to; what stands beside it is not.
#[test]
fn fences_hold_on_the_way_to_the_route() {
    let breaches = |outside: Value, standing: bool| {
        let start = if standing {
            json!({ "position": [20.5, 30, 0], "uav_position": [20, 30, 0], "standing": true })
        } else {
            json!({ "position": [20, 30, -10] })
        };
        let text = toml::to_string(&json!({
            "path": { "kind": "route", "points": [[0, 0, -10], [40, 0, -10], [40, -30, -10]], "corner_m": 4, "speed": 3 },
            "initial": start,
            "ground": {},
            "controller": { "rate_hz": 250.0, "observer": { "payload": 4.0, "rod": 4.0, "torque": 4.0 } },
            "request": [{ "at_s": 0.0, "do": "hold" }, { "at_s": if standing { 30.0 } else { 1.0 }, "do": "follow" }],
            "duration_s": 100.0,
            "fence": { "outside": [outside], "margin_m": 0.5 }
        }));
        let scenario = Scenario::parse("fence.toml", &text.unwrap()).unwrap_or_else(|error| panic!("{error}"));
        let Law::Follow { path, .. } = &scenario.controller.law else { panic!("it follows") };
        let vehicle = controller::Vehicle::new(scenario.controller.vehicle).unwrap();
        let report = path.check(&vehicle, &scenario.limits).unwrap();
        let fence = scenario.fence.as_ref().unwrap();
        assert_eq!(fence.breaches(&report), [], "the route itself keeps it");
        way_breaches(&scenario, fence, &report).unwrap()
    };
    let cylinder = |n1: f64, up: [f64; 2]| json!({ "center": [n1, 15], "radius": 0.2, "up_m": up });
    // The load at 10 m, the UAV 2 m above it.
    for (up, what) in [([9.0, 10.5], "the load"), ([11.9, 13.0], "the UAV"), ([10.8, 11.2], "the cable")] {
        let found = breaches(cylinder(20.0, up), false);
        let [way] = found[..] else { panic!("{found:?}") };
        let said = way.to_string();
        assert!(said.starts_with(&format!("{what} enters a keep-out")) && said.contains("way to leg 0"), "{said}");
    }
    // From the ground it rises on the way.
    for standing in [false, true] {
        assert!(!breaches(cylinder(20.0, [0.0, 20.0]), standing).is_empty());
        assert_eq!(breaches(cylinder(23.0, [0.0, 20.0]), standing), []);
    }
}

#[test]
fn what_is_no_route_is_refused_by_its_field() {
    let route = |key: &str, value: Value| {
        let mut fields = json!({ "kind": "route", "points": [[0, 0, -10], [30, 0, -10], [30, 20, -10]], "speed": 2 });
        fields[key] = value;
        fields
    };
    for (fields, field, message) in [
        (route("points", json!([[0, 0, -10]])), "path.points.len", "2 to"),
        (route("points", json!([[0, 0, -10], [30, 0, -10], [0, 0.1, -10]])), "path.points[1]", "turns"),
        (route("points", json!([[0, 0, -10], [30, 0, -10], [30, 0.01, -10]])), "path.points[1]", "nearer"),
        (route("points", json!([[0, 0, -10], [2e5, 0, -10]])), "path.points[1]", "100000"),
        (route("speed", json!(0)), "path.speed", "0.05 to 100"),
        (route("speed", json!([1, 2])), "path.speed", "2 values where there are 3 points"),
        (route("corner_m", json!("round")), "path.corner_m", "smooth"),
        (route("corner_m", json!(0)), "path.corner_m", "0.02"),
        (route("yaw", json!([0, 1])), "path.yaw", "2 values"),
        (route("stops", json!([{ "index": 3 }])), "path.stops[0].index", "0 to 2"),
        (route("stops", json!([{ "index": 1, "dwell_s": -1 }])), "path.stops[0].dwell_s", "0 to"),
        (route("acceleration", json!(0)), "path.acceleration", "0.05"),
        (route("end", json!({ "again": 2 })), "path.end", "last point is its first"),
        (route("radius", json!(2)), "path", "unknown field `radius`"),
    ] {
        let error = parse_path("path", fields.clone()).expect_err(&fields.to_string());
        assert!(error.field.starts_with(field), "{fields}: {error}");
        assert!(error.to_string().contains(message), "{fields}: {error}");
    }
}
