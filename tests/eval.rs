//! `hil-sim eval`, line by line: golden vectors in all three arithmetics, and what it refuses.

use hil_sim::study::eval::{Answer, evaluate};
use serde_json::{Value, json};
use tests::golden::{self, Gains, Vehicle, relative_error};

fn vehicle(vehicle: &Vehicle) -> Value {
    json!({
        "payload_mass": vehicle.payload_mass(),
        "uav_mass": vehicle.uav_mass(),
        "rod_length": vehicle.rod_length(),
        "inertia": vehicle.inertia(),
        "gravity": vehicle.gravity(),
    })
}

fn ask(request: &Value) -> Answer {
    evaluate(request.to_string().as_bytes()).unwrap_or_else(|error| panic!("{request}: {error}"))
}

fn refusal(request: &Value) -> String {
    match evaluate(request.to_string().as_bytes()) {
        Ok(answer) => panic!("{request} was answered: {answer:?}"),
        Err(error) => error.to_string(),
    }
}

/// Allowed relative error of ū: the controller's bars against these vectors, and the witness's.
const BOUNDS: [(&str, f64); 3] = [("f64", 1e-12), ("f32", 4e-5), ("witness", 1e-9)];

fn agrees(answer: &Answer, u: &[f64; 4], thrust: f64, bound: f64) {
    let [t1, t2, t3] = answer.torque;
    let error = relative_error(&[answer.u_zeta, t1, t2, t3], u);
    assert!(error <= bound, "{error:e} above {bound:e}");
    assert!((answer.thrust / thrust - 1.0).abs() <= bound, "{} against {thrust}", answer.thrust);
}

fn follow(arithmetic: &str, vector: &golden::Follow, k: &Gains, k_integral: [f64; 3]) -> Value {
    json!({
        "law": "follow", "arithmetic": arithmetic, "vehicle": vehicle(&vector.par),
        "path": { "kind": "circle", "radius": vector.path[0], "p3": vector.path[1], "speed": vector.path[2] },
        "x": vector.x, "zeta": vector.zeta, "integral": vector.integral,
        "gains": { "k": k, "k_integral": k_integral },
    })
}

#[test]
fn following_agrees_with_the_golden_vectors() {
    let file = golden::follow("circle");
    for (arithmetic, bound) in BOUNDS {
        for vector in &file.vectors {
            let answer = ask(&follow(arithmetic, vector, &file.meta.gains_fig56, file.meta.integral_gains));
            agrees(&answer, &vector.ubar_fig56_int, vector.thrust, bound);
            assert_eq!(answer.xi.len(), 19);
            if let (Some(b), Some(a)) = (answer.b, answer.a) {
                assert!(relative_error(&b, &vector.b) <= bound);
                assert!(relative_error(a.as_flattened(), vector.a.as_flattened()) <= bound);
            }
            assert_eq!(answer.b.is_some(), arithmetic == "witness");
        }
    }
}

#[test]
fn tracking_agrees_with_the_golden_vectors() {
    let file = golden::track();
    for (arithmetic, bound) in BOUNDS {
        for vector in &file.vectors {
            let answer = ask(&json!({
                "law": "track", "arithmetic": arithmetic, "vehicle": vehicle(&vector.par),
                "reference": { "kind": "circle", "radius": 5.0, "p3": -10.0, "rate": 1.0 }, "time": vector.t,
                "x": vector.x, "zeta": vector.zeta, "gains": { "k": file.meta.gains_track },
            }));
            agrees(&answer, &vector.ubar, vector.thrust, bound);
            // ξ holds the outputs themselves: the reference is not subtracted.
            assert!(relative_error(&answer.xi, &vector.xi) <= bound);
        }
    }
}

#[test]
fn all_arithmetics_agree_on_the_margins() {
    let file = golden::follow("circle");
    for vector in &file.vectors {
        let [f64_, f32_, witness] = BOUNDS.map(|(arithmetic, _)| {
            let answer = ask(&follow(arithmetic, vector, &file.meta.gains_fig3, [0.0; 3]));
            let m = answer.margins;
            [m.q3, m.q_b3, m.lambda, m.kappa, m.path_det]
        });
        assert!(relative_error(&f64_, &witness) <= 1e-12, "{f64_:?} against {witness:?}");
        assert!(relative_error(&f32_, &witness) <= 1e-5, "{f32_:?} against {witness:?}");
    }
}

/// The issue's own example, at hover on the circle.
fn example() -> Value {
    json!({
        "law": "follow", "arithmetic": "f64",
        "vehicle": { "payload_mass": 0.5, "uav_mass": 2.5, "inertia": [0.03, 0.03, 0.05], "rod_length": 2.0,
                     "gravity": 9.81 },
        "path": { "kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0 },
        "x": [0.0, 5.0, -10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        "zeta": [0.0, 0.0, 0.0, 0.0],
        "gains": { "k": [[64, 192, 240, 160, 60, 12], [64, 192, 240, 160, 60, 12], [1, 5, 10, 10, 5], [1, 2]] },
    })
}

#[test]
fn integrals_may_be_left_out() {
    let mut explicit = example();
    explicit["integral"] = json!([0.0, 0.0, 0.0]);
    explicit["gains"]["k_integral"] = json!([0.0, 0.0, 0.0]);
    assert_eq!(ask(&example()), ask(&explicit));
}

#[test]
fn nothing_else_may_be_left_out() {
    for field in ["law", "arithmetic", "vehicle", "path", "x", "zeta", "gains"] {
        let mut request = example();
        request.as_object_mut().unwrap().remove(field);
        let refusal = refusal(&request);
        assert!(refusal.contains(field), "without {field}: {refusal}");
    }
    for field in ["payload_mass", "uav_mass", "inertia", "rod_length", "gravity"] {
        let mut request = example();
        request["vehicle"].as_object_mut().unwrap().remove(field);
        let refusal = refusal(&request);
        assert!(refusal.contains("vehicle") && refusal.contains(field), "without {field}: {refusal}");
    }
}

#[test]
fn refusals_name_the_field() {
    let cases = [
        ("/x", json!([0.0; 15].as_slice()), "x: "),
        ("/x", json!([0.0; 17].as_slice()), "x: "),
        ("/x/3", json!("a"), "x[3]"),
        ("/x/3", json!(1e9), "x[3]"),
        ("/x/3", Value::Null, "x[3]"),
        ("/zeta", json!([0.0; 3].as_slice()), "zeta"),
        ("/law", json!("fly"), "law"),
        ("/arithmetic", json!("f16"), "arithmetic"),
        ("/vehicle/payload_mass", json!(-1.0), "vehicle.payload_mass"),
        ("/vehicle/inertia/1", json!(0.0), "vehicle.inertia[1]"),
        ("/vehicle", json!({ "mass": 1.0 }), "mass"),
        ("/path/kind", json!("square"), "path.kind"),
        ("/path/radius", json!(0.0), "path.radius"),
        ("/path/speed", json!(1e300), "path.speed"),
        ("/path", json!({ "kind": "circle", "radius": 5.0, "p3": 0.0, "speed": 1.0, "colour": 1 }), "colour"),
        ("/gains/k/2", json!([1.0, 2.0]), "gains.k[2]"),
        ("/gains/k", json!([[1.0]]), "gains.k"),
    ];
    for (pointer, value, name) in cases {
        let mut request = example();
        *request.pointer_mut(pointer).expect("the field is there") = value;
        let refusal = refusal(&request);
        assert!(refusal.contains(name), "{pointer}: {refusal}");
    }
    for (field, value) in [("time", json!(0.0)), ("reference", json!({})), ("typo", json!(1))] {
        let mut request = example();
        request[field] = value;
        let refusal = refusal(&request);
        assert!(refusal.contains(field), "{field}: {refusal}");
    }
}

#[test]
fn what_is_no_json_or_no_number_is_refused() {
    for line in ["", "{", "[]", "null", "{\"x\": NaN}", "\u{fffd}", &example().to_string().replace("9.81", "1e999")] {
        assert!(evaluate(line.as_bytes()).is_err(), "{line}");
    }
    assert!(evaluate(&[0xff, 0xfe]).is_err());
}

#[test]
fn a_singular_state_is_an_error_and_no_number() {
    for arithmetic in ["f32", "f64", "witness"] {
        let mut request = example();
        request["arithmetic"] = json!(arithmetic);
        // Free fall: ζ1 = g, no specific force along the rod.
        request["zeta"] = json!([9.81, 0.0, 0.0, 0.0]);
        assert!(refusal(&request).contains("singular"));
    }
}

#[test]
fn gains_need_not_be_stable() {
    let mut request = example();
    request["gains"]["k"] = json!([[0, 0, 0, 0, 0, 0], [-1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0], [0, 0]]);
    assert_eq!(ask(&request).nu[0], 0.0);
}
