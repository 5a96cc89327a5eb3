//! Paths as described by a user: the law against the witness on random formulas, and the errors of
//! a description.

use controller::Disturbance;
use controller::{Gains, Path, State, Vector3, Vehicle, VehicleParams, follow};
use hil_sim::describe::course::{PathSpec, parse_path};
use proptest::prelude::*;
use serde_json::{Value, json};
use witness::law::Operating;
use witness::plant::VehicleParameters;

/// ‖Δū‖/‖ū‖ between the f64 law and the witness on the same path; `None` where the witness
/// finds the law singular.
fn difference(path: &PathSpec, x: &[f64; 16], zeta: &[f64; 4]) -> Option<f64> {
    let gains = Gains {
        k1: [64.0, 192.0, 240.0, 160.0, 60.0, 12.0],
        k2: [64.0, 192.0, 240.0, 160.0, 60.0, 12.0],
        k3: [1.0, 5.0, 10.0, 10.0, 5.0],
        k4: [1.0, 2.0],
        integral: [0.0; 3],
    };
    let vehicle = VehicleParameters::default();
    let rows = [gains.k1, gains.k2, [1.0, 5.0, 10.0, 10.0, 5.0, 0.0], [1.0, 2.0, 0.0, 0.0, 0.0, 0.0]];
    let wanted = path.witness(Operating { vehicle: &vehicle, x, zeta }, &rows, &[0.0; 3], &[0.0; 3]).ok()?;
    let mut flown = path.build::<f64>().unwrap();
    let state = State::from_paper(x);
    flown.search(&state.position);
    let found = follow(
        &Vehicle::new(VehicleParams::paper()).unwrap(),
        &mut flown,
        &gains,
        &state,
        zeta,
        &[0.0; 3],
        &Disturbance::none(),
    );
    let [t1, t2, t3] = wanted.torque;
    let (a, b) = ([wanted.u_zeta, t1, t2, t3], &found.command.torque);
    let norm = a.iter().map(|value| value * value).sum::<f64>().sqrt();
    let off = (found.u_zeta - a[0]).powi(2) + (Vector3::new(t1, t2, t3) - b).dot(&(Vector3::new(t1, t2, t3) - b));
    Some(off.sqrt() / norm)
}

prop_compose! {
    /// States as wide as those of the golden vectors, about a position.
    fn state_near(p: [f64; 3])(
        offset in prop::array::uniform3(-0.5..0.5_f64),
        angles in prop::array::uniform5(-0.4..0.4_f64),
        rates in prop::array::uniform8(-0.8..0.8_f64),
        zeta in prop::array::uniform4(-1.5..1.5_f64),
    ) -> ([f64; 16], [f64; 4]) {
        let mut x = [0.0; 16];
        for axis in 0..3 {
            x[axis] = p[axis] + offset[axis];
        }
        x[3..8].copy_from_slice(&angles);
        x[8..16].copy_from_slice(&rates);
        (x, zeta)
    }
}

/// Formulas of closed curves about (0, 0, −10) with every function of the language, by random
/// constants.
fn formula_path() -> impl Strategy<Value = Value> {
    let surface = prop::sample::select(vec![
        "(x/a)^2 + (y/b)^2 - 1",
        "(x/a)^4 + (y/b)^4 - 1 + c*tanh(x*y/10)",
        "exp((x/a)^2 + (y/b)^2) - exp(1) + c*sin(x)",
        "ln(1 + (x/a)^2 + (y/b)^2) - ln(2) + c*cos(y/2)/5",
        "sqrt(1 + x^2/a^2 + y^2/b^2) - sqrt(2) + c*sin(x + y)/9",
        "((x/a)^2 + 0.3)^1.5 + ((y/b)^2 + 0.2)^1.7 - 1.5",
        "2^(x^2/a^2 + y^2/b^2) - 2 + c*atan2(z + 13, 5 + x)/9",
    ]);
    let sheet = prop::sample::select(vec![
        "z + 10 - c*sin(x/2)",
        "z + 10 - c*tanh(y/3) - 0.1*x",
        "z + 10 + c*exp(-(x^2 + y^2)/50)",
        "(z + 10)*(2 + cos(y/4)) - c*x",
        "atan2(z + 10, 10 + c*y) + c/20*x",
        "z + 10 - c*ln(20 + x*y/5) + 3*c",
        "(z + 15)^2 - 25 - c*x",
    ]);
    let speed = prop::sample::select(vec!["1.5", "1 + 0.3*x/a", "-2 + 0.1*sin(y)", "sqrt(4 + y^2/20)"]);
    let yaw = prop::sample::select(vec!["tangent", "0.2*x", "atan2(-y, -x)", "0.3", "tanh(z + y/5)"]);
    (surface, sheet, speed, yaw, 4.0..7.0_f64, 3.0..6.0_f64, -0.5..0.5_f64).prop_map(
        |(h1, h2, speed, yaw, a, b, c)| {
            json!({ "kind": "implicit", "h1": h1, "h2": h2, "speed": speed, "yaw": yaw,
                    "constants": { "a": a, "b": b, "c": c } })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, max_shrink_iters: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_law_agrees_with_the_witness_on_any_formula(
        (path, (x, zeta)) in formula_path().prop_flat_map(|path| {
            // Somewhere on the curve's outer side along n1.
            let a = path["constants"]["a"].as_f64().unwrap_or(5.0);
            (Just(path), state_near([a, 1.0, -10.0]))
        })
    ) {
        let spec = parse_path("path", path.clone()).unwrap();
        if let Some(difference) = difference(&spec, &x, &zeta) {
            prop_assert!(difference <= 1e-8, "{difference:e} on {path}");
        }
    }

    #[test]
    fn the_law_agrees_with_the_witness_on_fourier_curves(
        wave in prop::array::uniform3(-0.6..0.6_f64),
        (x, zeta) in state_near([6.0, 0.5, -10.0]),
    ) {
        let path = json!({ "kind": "fourier", "center": [0.0, 0.0, -10.0], "reference": [0.1, 0.0, 1.0], "speed": 1.5,
            "cos": [[6.0, 0.0, 0.0], [wave[0], 0.0, wave[1]]], "sin": [[0.0, 5.0, 0.0], [0.0, wave[2], wave[0]]],
            "yaw": "tangent" });
        let spec = parse_path("path", path.clone()).unwrap();
        if let Some(difference) = difference(&spec, &x, &zeta) {
            prop_assert!(difference <= 1e-8, "{difference:e} on {path}");
        }
    }
}

/// Every built-in curve, and the speed that is bound by curvature.
#[test]
fn the_law_agrees_with_the_witness_on_the_built_in_kinds() {
    let paths = [
        json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0, "yaw": "tangent" }),
        json!({ "kind": "ellipse", "a": 5.0, "b": 4.0, "c0": -10.0, "c1": 0.2, "speed": 1.0 }),
        json!({ "kind": "bent", "a": 5.0, "b": 4.0, "c0": -10.0, "v0": 1.5, "v1": 0.5 }),
        json!({ "kind": "superellipse", "a": 5.0, "b": 4.0, "half_exponent": 3, "c0": -10.0, "speed": 1.0 }),
        json!({ "kind": "tilted", "center": [0.0, 0.0, -10.0], "normal": [0.3, 0.2, 1.0], "major": [1.0, 0.1, 0.0],
                "a": 5.0, "b": 4.0, "speed": 1.2, "yaw": { "x": 0.3, "y": -0.2 } }),
        json!({ "kind": "ellipse", "a": 5.0, "b": 3.0, "c0": -10.0, "c1": 0.2,
                "speed": { "max": 3.0, "acceleration": 1.0 } }),
        json!({ "kind": "fourier", "center": [0.0, 0.0, -10.0], "reference": [0.0, 0.0, 1.0],
                "speed": { "max": 3.0, "acceleration": 1.0 }, "cos": [[5.0, 0.0, 0.5]], "sin": [[0.0, 4.0, 0.2]] }),
    ];
    let x = [5.2, 0.7, -10.3, 0.1, -0.2, 0.15, -0.1, 0.3, 0.2, 1.0, 0.3, 0.2, -0.1, 0.3, 0.1, -0.2];
    for path in paths {
        let spec = parse_path("path", path.clone()).unwrap();
        let difference = difference(&spec, &x, &[0.3, -0.2, 0.4, 0.1]).unwrap();
        assert!(difference <= 1e-10, "{difference:e} on {path}");
    }
}

#[test]
fn errors_name_the_field_and_the_column() {
    let cases = [
        (json!({ "kind": "helix", "speed": 1.0 }), "path.kind", "helix"),
        (json!({ "kind": "circle", "radius": -5.0, "p3": -10.0, "speed": 1.0 }), "path.radius", "outside"),
        (json!({ "kind": "circle", "radius": 5.0, "p3": -10.0 }), "path.speed", "missing"),
        (json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0, "tilt": 1 }), "path.tilt", "unknown"),
        (json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": [1.0] }), "path.speed", "neither"),
        (json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": "2*w" }), "path.speed", "column 3"),
        (
            json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1, "yaw": "0.2*x)" }),
            "path.yaw",
            "column 6",
        ),
        (json!({ "kind": "implicit", "h1": "x^2 + + y", "h2": "z", "speed": 1 }), "path.h1", "column 7"),
        (json!({ "kind": "implicit", "h1": "x^2 + y^2 - 1", "speed": 1 }), "path", "h2"),
        (json!({ "kind": "bent", "a": 5.0, "b": 4.0, "c0": -10.0, "v0": 1.0 }), "path.speed", "v0 and v1"),
        (
            json!({ "kind": "superellipse", "a": 5.0, "b": 4.0, "half_exponent": 11, "c0": 0, "speed": 1 }),
            "path.half_exponent",
            "outside",
        ),
        (
            json!({ "kind": "fourier", "center": [0, 0, 0], "reference": [0, 0, 1], "speed": 1, "cos": [[1, 0, 0]],
            "sin": [] }),
            "path.sin",
            "0 rows",
        ),
        // The tangent runs along the reference direction.
        (
            json!({ "kind": "fourier", "center": [0, 0, 0], "reference": [1, 0, 0], "speed": 1, "cos": [[1, 0, 0]],
            "sin": [[0, 1, 0]] }),
            "path",
            "reference",
        ),
        (
            json!({ "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": "c", "constants": { "c": "d" } }),
            "path.constants.c",
            "invalid type",
        ),
    ];
    for (path, field, message) in cases {
        let error = parse_path("path", path.clone()).expect_err(&path.to_string());
        assert!(error.field.starts_with(field), "{path}: {error}");
        assert!(error.to_string().contains(message), "{path}: {error}");
    }
}

/// Of a curve that does not close the distance is that of the foot nearby: against the least over
/// points of the curve.
#[test]
fn an_open_curve_has_a_distance() {
    let open = parse_path("path", json!({ "kind": "implicit", "h1": "y - 2*sin(x/3)", "h2": "z + 10", "speed": 1 }));
    let open = open.unwrap();
    assert!(open.lap().is_err());
    for point in [[0.0, 0.5, -10.0], [4.0, 3.0, -9.0], [-20.0, -2.5, -10.5], [7.0, 0.0, -10.0]] {
        let away = |x: f64| {
            let along = Vector3::new(x, 2.0 * (x / 3.0).sin(), -10.0) - Vector3::from(point);
            along.dot(&along).sqrt()
        };
        let least = (-40_000..40_000).map(|i| away(1e-3 * f64::from(i))).fold(f64::INFINITY, f64::min);
        let found = open.distance(point);
        assert!((found - least).abs() < 1e-6, "{point:?}: {found} against {least}");
    }
}
