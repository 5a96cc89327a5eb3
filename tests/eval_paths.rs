//! `hil-sim eval` with paths other than the circle: the golden ellipse and bent curve, built in and
//! by formula.

use hil_sim::study::eval::evaluate;
use serde_json::{Value, json};
use tests::golden::{self, Follow, relative_error};

fn built_in(kind: &str, path: &[f64]) -> Value {
    match kind {
        "ellipse" => {
            json!({ "kind": kind, "a": path[0], "b": path[1], "c0": path[2], "c1": path[3], "speed": path[4] })
        }
        _ => json!({ "kind": kind, "a": path[0], "b": path[1], "c0": path[2], "v0": path[3], "v1": path[4] }),
    }
}

fn formula(kind: &str, path: &[f64]) -> Value {
    let (h1, h2, speed, yaw, names) = match kind {
        "ellipse" => ("(x/a)^2 + (y/b)^2 - 1", "z - c0 - c1*x", "vd", "tangent", ["a", "b", "c0", "c1", "vd"]),
        _ => ("(x/a)^4 + (y/b)^4 - 1", "z - c0 - 0.5*sin(x/2)", "v0 + v1*x/a", "0.2*x", ["a", "b", "c0", "v0", "v1"]),
    };
    let constants: serde_json::Map<String, Value> =
        names.into_iter().zip(path).map(|(name, value)| (name.to_owned(), json!(value))).collect();
    json!({ "kind": "implicit", "h1": h1, "h2": h2, "speed": speed, "yaw": yaw, "constants": constants })
}

/// ‖Δū‖/‖ū‖ of one evaluation.
fn error(arithmetic: &str, path: &Value, vector: &Follow, gains: &golden::Gains, k_integral: [f64; 3]) -> f64 {
    let par = &vector.par;
    let request = json!({
        "law": "follow", "arithmetic": arithmetic, "path": path,
        "vehicle": {
            "payload_mass": par.payload_mass(), "uav_mass": par.uav_mass(), "rod_length": par.rod_length(),
            "inertia": par.inertia(), "gravity": par.gravity(),
        },
        "x": vector.x, "zeta": vector.zeta, "integral": vector.integral,
        "gains": { "k": gains, "k_integral": k_integral },
    });
    let answer = evaluate(request.to_string().as_bytes()).unwrap_or_else(|error| panic!("{request}: {error}"));
    let [t1, t2, t3] = answer.torque;
    relative_error(&[answer.u_zeta, t1, t2, t3], &vector.ubar_fig56_int)
}

#[test]
fn golden_curves_by_name_and_by_formula() {
    for kind in ["ellipse", "bent"] {
        let file = golden::follow(kind);
        for description in [built_in, formula] {
            for (arithmetic, worst_allowed, median_allowed) in
                [("f64", 1e-11, 1e-12), ("f32", 1e-4, 5e-7), ("witness", 1e-9, 1e-10)]
            {
                let mut errors: Vec<f64> = file
                    .vectors
                    .iter()
                    .map(|vector| {
                        let path = description(kind, &vector.path);
                        error(arithmetic, &path, vector, &file.meta.gains_fig56, file.meta.integral_gains)
                    })
                    .collect();
                errors.sort_by(f64::total_cmp);
                let (worst, median) = (errors[errors.len() - 1], errors[errors.len() / 2]);
                let what = if description(kind, &[1.0; 5])["kind"] == "implicit" { "by formula" } else { "built in" };
                println!("{kind} {what}, {arithmetic}: worst {worst:.1e}, median {median:.1e}");
                assert!(worst <= worst_allowed, "{kind} {what}, {arithmetic}: {worst:e}");
                assert!(median <= median_allowed, "{kind} {what}, {arithmetic}: {median:e}");
            }
        }
    }
}
