//! The plant against the reference vectors of the model (2.8).

use tests::golden::{self, relative_error};
use witness::plant::{self, Input, VehicleParameters};

/// Required of each of f, G and ẋ, as ‖Δ‖/‖·‖. The vectors are exact to half an ulp and
/// f64 evaluation of (2.8) loses a few.
const BOUND: f64 = 1e-13;

#[test]
fn drift_input_matrix_and_derivative() {
    let vectors = golden::plant();
    assert_eq!(vectors.len(), 25);
    let mut worst = [0.0_f64; 3];
    for (number, vector) in vectors.iter().enumerate() {
        let vehicle = vehicle(&vector.par);
        let input = Input { thrust: vector.u[0], torque: [vector.u[1], vector.u[2], vector.u[3]] };
        let errors = [
            relative_error(&plant::drift(&vehicle, &vector.x), &vector.f),
            relative_error(plant::input_matrix(&vehicle, &vector.x).as_flattened(), vector.g.as_flattened()),
            relative_error(&plant::derivative(&vehicle, &vector.x, &input), &vector.xdot),
        ];
        for ((name, error), worst) in ["f", "G", "xdot"].into_iter().zip(errors).zip(&mut worst) {
            assert!(error <= BOUND, "vector {number}: {name} off by {error:e}");
            *worst = worst.max(error);
        }
    }
    let [f, g, xdot] = worst;
    println!("plant, worst relative errors: f {f:.1e}, G {g:.1e}, xdot {xdot:.1e}");
}

fn vehicle(par: &golden::Vehicle) -> VehicleParameters {
    VehicleParameters {
        payload_mass: par.payload_mass(),
        uav_mass: par.uav_mass(),
        rod_length: par.rod_length(),
        inertia: par.inertia(),
        gravity: par.gravity(),
    }
}
