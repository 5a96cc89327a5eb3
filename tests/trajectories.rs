//! Closed loops in continuous time: the f64 law on the plant, integrated adaptively, against the
//! reference trajectories.

use controller::{
    Command, Disturbance, Gains, Path, Reference, State, TrackGains, Vehicle, VehicleParams, follow, track,
};
use hil_sim::describe::course::parse_path;
use hil_sim::describe::input::Invalid;
use hil_sim::world::integrate::{Tolerance, adaptive};
use tests::golden::{self, Trajectory};
use witness::plant::{Input, VehicleParameters, derivative};

/// The plant's 16 coordinates, ζ, ξ̃.
type Loop = [f64; 23];

/// Allowed difference, of a coordinate of x relative to 1 or to its own size: the reference is
/// integrated to a relative tolerance of 1e-9 a step, and the swing's transient may add some of
/// them up.
const BOUND: f64 = 1e-8;

/// A thousand times below the bound.
const TOLERANCE: Tolerance = Tolerance { absolute: 1e-11, relative: 1e-11 };

fn controller_vehicle(vehicle: &golden::Vehicle) -> Vehicle<f64> {
    Vehicle::new(VehicleParams {
        payload_mass: vehicle.payload_mass(),
        uav_mass: vehicle.uav_mass(),
        rod_length: vehicle.rod_length(),
        inertia: vehicle.inertia(),
        gravity: vehicle.gravity(),
    })
    .expect("a vehicle in range")
}

fn plant_vehicle(vehicle: &golden::Vehicle) -> VehicleParameters {
    VehicleParameters {
        payload_mass: vehicle.payload_mass(),
        uav_mass: vehicle.uav_mass(),
        rod_length: vehicle.rod_length(),
        inertia: vehicle.inertia(),
        gravity: vehicle.gravity(),
    }
}

/// What the law answers in the loop: u, u_ζ and the rates of ξ̃.
struct Answer {
    input: Input,
    u_zeta: f64,
    integrand: [f64; 3],
}

/// Integrates the loop from sample to sample and compares each.
fn compare(name: &str, reference: &Trajectory, law: impl Fn(f64, &State<f64>, &[f64; 4], &[f64; 3]) -> Answer) {
    let vehicle = plant_vehicle(&reference.par_plant);
    let rate = |t: f64, y: &Loop| -> Loop {
        let (x, zeta, integral) = split(y);
        let answer = law(t, &State::from_paper(&x), &zeta, &integral);
        let mut rate = [0.0; 23];
        rate[..16].copy_from_slice(&derivative(&vehicle, &x, &answer.input));
        rate[16..20].copy_from_slice(&[zeta[1], zeta[2], zeta[3], answer.u_zeta]);
        rate[20..].copy_from_slice(&answer.integrand);
        rate
    };
    let sample = |i: usize| -> Loop {
        let mut y = [0.0; 23];
        y[..16].copy_from_slice(&reference.x[i]);
        y[16..20].copy_from_slice(&reference.zeta[i]);
        y[20..].copy_from_slice(&reference.integral[i]);
        y
    };
    let mut y = sample(0);
    let mut worst = 0.0_f64;
    for i in 1..reference.t.len() {
        y = adaptive(rate, [reference.t[i - 1], reference.t[i]], &y, TOLERANCE)
            .unwrap_or_else(|error| panic!("{name} at {}: {error}", reference.t[i]));
        let wanted = sample(i);
        for k in 0..16 {
            let difference = (y[k] - wanted[k]).abs() / wanted[k].abs().max(1.0);
            assert!(
                difference <= BOUND,
                "{name} at {} s, coordinate {k}: {} against {}",
                reference.t[i],
                y[k],
                wanted[k]
            );
            worst = worst.max(difference);
        }
        let (x, zeta, integral) = split(&y);
        let thrust = law(reference.t[i], &State::from_paper(&x), &zeta, &integral).input.thrust;
        assert!((thrust / reference.u[i][0] - 1.0).abs() <= BOUND, "{name}: thrust {thrust}");
    }
    println!("{name}: worst difference {worst:.1e}");
}

fn split(y: &Loop) -> ([f64; 16], [f64; 4], [f64; 3]) {
    (std::array::from_fn(|i| y[i]), std::array::from_fn(|i| y[16 + i]), std::array::from_fn(|i| y[20 + i]))
}

fn row<const N: usize>(gains: &[f64]) -> [f64; N] {
    gains.try_into().expect("a gain for each derivative")
}

fn follows(name: &str, path: &(impl Path<f64> + Clone)) {
    let reference = &golden::trajectories()[name];
    let vehicle = controller_vehicle(&reference.par_controller);
    let gains = Gains {
        k1: row(&reference.gains[0]),
        k2: row(&reference.gains[1]),
        k3: row(&reference.gains[2]),
        k4: row(&reference.gains[3]),
        integral: reference.integral_gains.unwrap_or_default(),
    };
    compare(name, reference, |_, state, zeta, integral| {
        let solution = follow(&vehicle, &mut path.clone(), &gains, state, zeta, integral, &Disturbance::none());
        let xi = &solution.xi;
        // The reference has no ξ̃ where it has no integral action.
        let integrand = if reference.integral_gains.is_some() { [xi.h1[0], xi.h2[0], xi.h3[0]] } else { [0.0; 3] };
        Answer { input: input(&solution.command), u_zeta: solution.u_zeta, integrand }
    });
}

/// A command as the witness' plant takes it.
fn input(command: &Command<f64>) -> Input {
    Input { thrust: command.thrust, torque: command.torque.into() }
}

/// The path of this trajectory, described as a user would: the file has the fields in this order.
fn path(name: &str, kind: &str, fields: &[&str]) -> impl Path<f64> + Clone {
    let mut description = serde_json::Map::from_iter([("kind".to_owned(), kind.into())]);
    let reference = &golden::trajectories()[name];
    assert_eq!(fields.len(), reference.path.len());
    description.extend(fields.iter().zip(&reference.path).map(|(field, &value)| ((*field).to_owned(), value.into())));
    parse_path("path", serde_json::Value::from(description))
        .and_then(|path| path.build().map_err(|error| Invalid::out_of_range("path", error)))
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn path_following_of_figure_3() {
    follows("fig3_pfc_vd-5", &path("fig3_pfc_vd-5", "circle", &["radius", "p3", "speed"]));
}

#[test]
fn integral_action_of_figure_5() {
    follows("fig5_int_vd1", &path("fig5_int_vd1", "circle", &["radius", "p3", "speed"]));
}

#[test]
fn path_following_of_an_ellipse() {
    follows("ellipse", &path("ellipse", "ellipse", &["a", "b", "c0", "c1", "speed"]));
}

#[test]
fn trajectory_tracking_of_figure_3() {
    let name = "fig3_track";
    let reference = &golden::trajectories()[name];
    let vehicle = controller_vehicle(&reference.par_controller);
    let gains = TrackGains {
        position: [row(&reference.gains[0]), row(&reference.gains[1]), row(&reference.gains[2])],
        yaw: row(&reference.gains[3]),
    };
    compare(name, reference, |t, state, zeta, _| {
        let wanted = Reference::circle(5.0, -10.0, 1.0, t);
        let solution = track(&vehicle, &gains, &wanted, state, zeta, &Disturbance::none());
        Answer { input: input(&solution.command), u_zeta: solution.u_zeta, integrand: [0.0; 3] }
    });
}
