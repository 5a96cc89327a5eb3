//! The law on a route against the witness, which has a spline of its own and differentiates it by
//! machine.

use crate::courses;
use crate::courses::Course;
use controller::{
    Disturbance, Gains, Path, Real, Solution, State, Table, Vector3, Vehicle, VehicleParams, Xi, follow,
};
use tests::golden::{self, relative_error};
use witness::law::{Evaluation, Operating};
use witness::plant::VehicleParameters;

/// The witness's route of a run's first `spans` spans from `first` on.
fn witness_route(course: &Course, run: usize, first: usize, spans: usize) -> witness::law::Route {
    let table = course.table();
    let begin = table.runs()[run].first + first;
    let knots = &table.knots()[begin..begin + spans + 7];
    witness::law::Route {
        points: knots.iter().map(|knot| knot.point).collect(),
        normals: std::array::from_fn(|n| knots.iter().map(|knot| knot.normals[n]).collect()),
        speed: knots.iter().map(|knot| knot.speed[0]).collect(),
        yaw: knots.iter().map(|knot| knot.yaw).collect(),
    }
}

fn vehicle<T: Real>(par: &golden::Vehicle) -> Vehicle<T> {
    Vehicle::new(VehicleParams {
        payload_mass: T::lit(par.payload_mass()),
        uav_mass: T::lit(par.uav_mass()),
        rod_length: T::lit(par.rod_length()),
        inertia: par.inertia().map(T::lit),
        gravity: T::lit(par.gravity()),
    })
    .unwrap()
}

fn row<T: Real, const N: usize>(k: &[f64]) -> [T; N] {
    std::array::from_fn(|j| T::lit(k.get(j).copied().unwrap_or(0.0)))
}

fn gains<T: Real>(k: &golden::Gains) -> Gains<T> {
    Gains { k1: row(&k[0]), k2: row(&k[1]), k3: row(&k[2]), k4: row(&k[3]), integral: [T::zero(); 3] }
}

fn evaluate<T: Real>(
    course: &Course,
    run: usize,
    par: &golden::Vehicle,
    k: &golden::Gains,
    x: &[f64; 16],
    zeta: &[f64; 4],
) -> Solution<T, Xi<T>> {
    let mut route = course.route::<T>();
    route.begin_run(run);
    let state: State<T> = State::<f64>::from_paper(x).cast();
    while !route.search(&state.position) {}
    follow(&vehicle(par), &mut route, &gains(k), &state, &zeta.map(T::lit), &[T::zero(); 3], &Disturbance::none())
}

fn numbers<T: Real>(solution: &Solution<T, Xi<T>>) -> ([f64; 4], Vec<f64>) {
    let torque = solution.command.torque.map(T::to_f64);
    let xi = &solution.xi;
    let xi = [&xi.h1[..], &xi.h2, &xi.h3, &xi.h4].concat().iter().map(|x| x.to_f64()).collect();
    ([solution.u_zeta.to_f64(), torque.x, torque.y, torque.z], xi)
}

/// The states of the reference vectors for the circle, moved to places all along each route's first
/// and last runs.
#[test]
fn law_on_routes_agrees_with_the_witness() {
    let file = golden::follow("circle");
    let k = &file.meta.gains_fig56;
    let padded = std::array::from_fn(|output| row(&k[output]));
    for course in courses::all() {
        let (mut double, mut outputs, mut single) = (vec![], vec![], vec![]);
        let table = course.table();
        let run = table.runs().len() - 1;
        let spans = table.runs()[run].knots - 7;
        for (number, vector) in file.vectors.iter().take(60).enumerate() {
            // 13 spans about the place: its neighbours, for the nearest point is searched there
            // alone.
            let about = (number * spans / 60).min(spans - 13);
            let witness = witness_route(&course, run, about, 13);
            let place = witness.point(6.0 + 0.9 * (number as f64 * 0.37).fract());
            let circle = Vector3::new(vector.x[0], vector.x[1], 0.0);
            let on_circle = circle * (vector.path[0] / circle.dot(&circle).sqrt());
            let mut x = vector.x;
            // A quarter of the vectors' distances, within the curves' reach.
            for (axis, on) in [on_circle.x, on_circle.y, vector.path[1]].into_iter().enumerate() {
                x[axis] = place[axis] + 0.25 * (vector.x[axis] - on).clamp(-1.0, 1.0);
            }
            let par = &vector.par;
            let plant = VehicleParameters {
                payload_mass: par.payload_mass(),
                uav_mass: par.uav_mass(),
                rod_length: par.rod_length(),
                inertia: par.inertia(),
                gravity: par.gravity(),
            };
            let at = Operating { vehicle: &plant, x: &x, zeta: &vector.zeta };
            let Evaluation { u_zeta, torque: [t1, t2, t3], xi, nu, .. } =
                witness::law::follow(at, &witness, &padded, &[0.0; 3], &[0.0; 3]).unwrap();
            let expected = [u_zeta, t1, t2, t3];
            let (u, found) = numbers(&evaluate::<f64>(&course, run, par, k, &x, &vector.zeta));
            // u_ζ is one coordinate of p⁽⁶⁾: where it happens to be far smaller than the others, it
            // has the rounding of theirs.
            let size = |numbers: &[f64]| numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
            let share = (size(&expected) / (0.01 * size(&nu[..3]))).min(1.0);
            double.push(relative_error(&u, &expected) * share);
            outputs.push(relative_error(&found, &xi));
            single.push(
                share
                    * relative_error(&numbers(&evaluate::<f32>(&course, run, par, k, &x, &vector.zeta)).0, &expected),
            );
        }
        let mut bounds = vec![];
        for (what, errors, worst, median) in [
            ("u in f64", &mut double, 1e-9, 1e-11),
            ("outputs in f64", &mut outputs, 1e-9, 1e-11),
            ("u in f32", &mut single, 2e-4, 1e-6),
        ] {
            errors.sort_by(f64::total_cmp);
            let (found_worst, found_median) = (errors[errors.len() - 1], errors[errors.len() / 2]);
            println!("{}, {what}: worst {found_worst:.1e}, median {found_median:.1e}", course.name);
            bounds.push((what, found_worst <= worst && found_median <= median));
        }
        for (what, holds) in bounds {
            assert!(holds, "{}: {what}", course.name);
        }
    }
}
