//! The witness of the law against the reference vectors and closed loops, and the structure the
//! theory gives it.

use hil_sim::world::integrate::{Tolerance, adaptive};
use tests::golden::{self, Follow, padded, relative_error};
use witness::jet::Scalar;
use witness::law::{Bent, Circle, Ellipse, Evaluation, Operating, OutputGains, Reference, Singular, WitnessPath};
use witness::plant::{self, Input, VehicleParameters};

/// Required of b̄, Ā and ū, as ‖Δ‖/‖·‖. Most of it is for ū where −b̄ + ν nearly
/// cancels: in f64 the equations themselves, evaluated by any method, lose up to 5e-12 there.
const BOUND: f64 = 1e-9;

/// The largest error of each quantity over a file.
#[derive(Default)]
struct Worst {
    thrust: f64,
    xi: f64,
    b: f64,
    a: f64,
    u: f64,
}

impl std::fmt::Display for Worst {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { thrust, xi, b, a, u } = self;
        write!(f, "T {thrust:.1e}, xi {xi:.1e}, b {b:.1e}, A {a:.1e}, u {u:.1e}")
    }
}

/// The binary128 values one evaluation is held against.
struct Expected<'a> {
    thrust: f64,
    xi: &'a [f64],
    b: &'a [f64; 4],
    a: &'a [[f64; 4]; 4],
    nu: &'a [f64; 4],
    u: &'a [f64; 4],
}

impl Worst {
    fn take<const N: usize>(&mut self, label: &str, got: &Evaluation<N>, expected: &Expected<'_>) {
        let u = [got.u_zeta, got.torque[0], got.torque[1], got.torque[2]];
        let mut nu = 0.0;
        for (name, worst, error) in [
            ("T", &mut self.thrust, relative_error(&[got.thrust], &[expected.thrust])),
            ("xi", &mut self.xi, relative_error(&got.xi, expected.xi)),
            ("b", &mut self.b, relative_error(&got.b, expected.b)),
            ("A", &mut self.a, relative_error(got.a.as_flattened(), expected.a.as_flattened())),
            ("nu", &mut nu, relative_error(&got.nu, expected.nu)),
            ("u", &mut self.u, relative_error(&u, expected.u)),
        ] {
            assert!(error <= BOUND, "{label}: {name} off by {error:e}");
            *worst = worst.max(error);
        }
    }
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

fn circle(p: &[f64]) -> Circle {
    Circle { radius: p[0], p3: p[1], speed: p[2] }
}

fn ellipse(p: &[f64]) -> Ellipse {
    Ellipse { a: p[0], b: p[1], c0: p[2], c1: p[3], speed: p[4] }
}

fn bent(p: &[f64]) -> Bent {
    Bent { a: p[0], b: p[1], c0: p[2], v0: p[3], v1: p[4] }
}

/// Evaluates every vector of a file with its three sets of gains.
fn check_follow<P: WitnessPath>(name: &str, path: impl Fn(&[f64]) -> P) {
    let file = golden::follow(name);
    assert_eq!(file.vectors.len(), 100);
    let (fig3, fig56) = (padded(&file.meta.gains_fig3), padded(&file.meta.gains_fig56));
    let none = [0.0; 3];
    let mut worst = Worst::default();
    for (number, vector) in file.vectors.iter().enumerate() {
        let laws: [(&OutputGains, &[f64; 3], _, _); 3] = [
            (&fig3, &none, &vector.nu_fig3, &vector.ubar_fig3),
            (&fig56, &none, &vector.nu_fig56, &vector.ubar_fig56),
            (&fig56, &file.meta.integral_gains, &vector.nu_fig56_int, &vector.ubar_fig56_int),
        ];
        for (gains, integral_gains, nu, u) in laws {
            let got = evaluate(vector, &path(&vector.path), gains, integral_gains)
                .unwrap_or_else(|error| panic!("{name} {number}: {error}"));
            let expected = Expected { thrust: vector.thrust, xi: &vector.xi, b: &vector.b, a: &vector.a, nu, u };
            worst.take(&format!("{name} {number}"), &got, &expected);
        }
    }
    println!("witness on {name}, worst relative errors: {worst}");
}

fn evaluate<P: WitnessPath>(
    vector: &Follow,
    path: &P,
    gains: &OutputGains,
    integral_gains: &[f64; 3],
) -> Result<Evaluation<19>, Singular> {
    let at = Operating { vehicle: &vehicle(&vector.par), x: &vector.x, zeta: &vector.zeta };
    witness::law::follow(at, path, gains, integral_gains, &vector.integral)
}

#[test]
fn circle_vectors() {
    check_follow("circle", circle);
}

#[test]
fn ellipse_vectors() {
    check_follow("ellipse", ellipse);
}

#[test]
fn bent_vectors() {
    check_follow("bent", bent);
}

#[test]
fn tracking_vectors() {
    let file = golden::track();
    assert_eq!(file.vectors.len(), 100);
    let gains = padded(&file.meta.gains_track);
    let mut worst = Worst::default();
    for (number, vector) in file.vectors.iter().enumerate() {
        let at = Operating { vehicle: &vehicle(&vector.par), x: &vector.x, zeta: &vector.zeta };
        let reference = Reference::circle(5.0, -10.0, 1.0, vector.t);
        let got =
            witness::law::track(at, &reference, &gains).unwrap_or_else(|error| panic!("track {number}: {error}"));
        let expected = Expected {
            thrust: vector.thrust,
            xi: &vector.xi,
            b: &vector.b,
            a: &vector.a,
            nu: &vector.nu,
            u: &vector.ubar,
        };
        worst.take(&format!("track {number}"), &got, &expected);
    }
    println!("witness on track, worst relative errors: {worst}");
}

/// det Ā in closed form, from THEORY.md's section on singularities: nothing in the witness knows
/// it.
#[test]
fn decoupling_matrix_has_the_determinant_of_the_theory() {
    let file = golden::follow("ellipse");
    let gains = padded(&file.meta.gains_fig3);
    for (number, vector) in file.vectors.iter().enumerate() {
        let vehicle = vehicle(&vector.par);
        let path = ellipse(&vector.path);
        let a = evaluate(vector, &path, &gains, &[0.0; 3]).expect("a regular point").a;
        let (x, zeta1) = (&vector.x, vector.zeta[0]);
        let f11 = plant::drift(&vehicle, x)[10];
        let (rod, b3) = (plant::rod(x), plant::attitude(x)[2]);
        let rod_b3: f64 = (0..3).map(|i| rod[i] * b3[i]).sum();
        // ∇h1 × ∇h2 of the ellipse, by hand.
        let (g1, g2) = (2.0 * x[0] / (path.a * path.a), 2.0 * x[1] / (path.b * path.b));
        let normal = [g2, -g1, g2 * path.c1];
        let path_det = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let [j1, j2, j3] = vehicle.inertia;
        let lever = vehicle.rod_length * vehicle.uav_mass;
        let expected = vehicle.total_mass().powi(2)
            * (zeta1 - f11).powi(2)
            * (zeta1 - vehicle.gravity).powi(2)
            * path_det
            // ψ's own input gain, W33/J3, is 1/J3.
            / (lever.powi(2) * j1 * j2 * j3 * rod[2].powi(5) * rod_b3.powi(3));
        let got = determinant(&a);
        // Ā's own error, 1e-14 relative, times its condition number, up to 5e4 here.
        let bound = 1e-9 * expected.abs();
        assert!((got.abs() - expected.abs()).abs() <= bound, "{number}: {got} {expected}");
        assert!((got - vector.det_a).abs() <= bound, "{number}: {got} {}", vector.det_a);
    }
}

fn determinant(m: &[[f64; 4]; 4]) -> f64 {
    let minor = |r: [usize; 3], c: [usize; 3]| {
        m[r[0]][c[0]] * (m[r[1]][c[1]] * m[r[2]][c[2]] - m[r[1]][c[2]] * m[r[2]][c[1]])
            - m[r[0]][c[1]] * (m[r[1]][c[0]] * m[r[2]][c[2]] - m[r[1]][c[2]] * m[r[2]][c[0]])
            + m[r[0]][c[2]] * (m[r[1]][c[0]] * m[r[2]][c[1]] - m[r[1]][c[1]] * m[r[2]][c[0]])
    };
    m[0][0] * minor([1, 2, 3], [1, 2, 3]) - m[0][1] * minor([1, 2, 3], [0, 2, 3])
        + m[0][2] * minor([1, 2, 3], [0, 1, 3])
        - m[0][3] * minor([1, 2, 3], [0, 1, 2])
}

/// Free fall, ζ1 = g, makes Ā singular (the theory's first singularity): no value may come out as
/// if it were sound.
#[test]
fn free_fall_is_singular() {
    let vehicle = VehicleParameters::default();
    let mut x = [0.0; 16];
    x[0] = 5.0;
    x[2] = -10.0;
    let at = Operating { vehicle: &vehicle, x: &x, zeta: &[vehicle.gravity, 0.0, 0.0, 0.0] };
    let path = Circle { radius: 5.0, p3: -10.0, speed: 1.0 };
    let gains = padded(&golden::follow("circle").meta.gains_fig3);
    assert_eq!(witness::law::follow(at, &path, &gains, &[0.0; 3], &[0.0; 3]), Err(Singular));
}

/// A path given by formulas through every function, with a zero set equal to the circle's.
struct Disguised(Circle);

impl WitnessPath for Disguised {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        let [h1, h2] = self.0.surfaces(p);
        // Monotone functions that vanish with their argument.
        [(h1 * 0.1).tanh(), (h2.exp() + 1.0).ln() - 2.0_f64.ln()]
    }
    fn speed<S: Scalar>(&self, p: [S; 3]) -> S {
        self.0.speed(p)
    }
    fn yaw<S: Scalar>(&self, p: [S; 3], tangent: [S; 3]) -> S {
        self.0.yaw(p, tangent)
    }
    fn direction(&self) -> f64 {
        self.0.direction()
    }
}

/// The steady motion along the circle (15.7) at `speed` against the printed tangent, as it passes
/// (0, r, p3) with ψ = 0: everything turns about n3 at Ω = −speed/r, which gives v̇, then q, then
/// b3, from THEORY.md's two lines.
fn steady(vehicle: &VehicleParameters, radius: f64, p3: f64, speed: f64) -> [f64; 16] {
    let turn = speed / radius;
    let pull = [-speed * turn, -vehicle.gravity]; // λ q, along n2 and n3
    let lambda = -pull[0].hypot(pull[1]);
    let rod = [pull[0] / lambda, pull[1] / lambda];
    let c = vehicle.total_mass() / (vehicle.uav_mass * vehicle.rod_length);
    // κ b3 = q̈ − c λ q, and only the horizontal part of q turns.
    let thrust = [-turn * turn * rod[0] - c * pull[0], -c * pull[1]];
    let phi = (-thrust[0]).atan2(thrust[1]);
    let mut x = [0.0; 16];
    x[1] = radius;
    x[2] = p3;
    x[3] = (-rod[0]).atan2(rod[1]);
    x[5] = phi;
    x[8] = speed;
    x[12] = turn * rod[0];
    x[14] = -turn * phi.sin();
    x[15] = turn * phi.sin() * phi.tan();
    x
}

/// On the path, moving along it as wanted, ξ = 0, and ū is the same for any formulas with the same
/// zero set.
#[test]
fn input_on_the_path_does_not_depend_on_its_formulas() {
    let vehicle = VehicleParameters::default();
    let x = steady(&vehicle, 5.0, -10.0, 5.0);
    let at = Operating { vehicle: &vehicle, x: &x, zeta: &[0.0; 4] };
    let circle = Circle { radius: 5.0, p3: -10.0, speed: -5.0 };
    let gains = [[0.0; 6]; 4];
    let plain = witness::law::follow(at, &circle, &gains, &[0.0; 3], &[0.0; 3]).expect("regular");
    let other = witness::law::follow(at, &Disguised(circle), &gains, &[0.0; 3], &[0.0; 3]).expect("regular");
    // The rounding of fifth derivatives whose terms are some thousands.
    for value in plain.xi.iter().chain(&other.xi) {
        assert!(value.abs() < 1e-10, "{:?}", plain.xi);
    }
    assert!((plain.thrust - other.thrust).abs() < 1e-12);
    assert!((plain.u_zeta - other.u_zeta).abs() < 1e-9);
    for axis in 0..3 {
        let difference = plain.torque[axis] - other.torque[axis];
        assert!(difference.abs() < 1e-12, "torque {axis}: {difference}");
    }
}

/// The reference closed loops, flown again by the witness in continuous time: plant, compensator,
/// integral and law.
#[test]
fn closed_loops() {
    for (name, run) in golden::trajectories() {
        let (told, flown) = (vehicle(&run.par_controller), vehicle(&run.par_plant));
        let gains = padded(&run.gains);
        let integral_gains = run.integral_gains.unwrap_or_default();
        let rate = |t: f64, y: &[f64; 23]| -> [f64; 23] {
            let x: [f64; 16] = std::array::from_fn(|i| y[i]);
            let zeta = [y[16], y[17], y[18], y[19]];
            let integral = [y[20], y[21], y[22]];
            let at = Operating { vehicle: &told, x: &x, zeta: &zeta };
            let follow = |solution: Result<Evaluation<19>, Singular>| {
                solution.map(|s| (s.thrust, s.u_zeta, s.torque, [s.xi[0], s.xi[6], s.xi[12]]))
            };
            let p = &run.path;
            let solution = match run.kind.as_str() {
                "circle" => follow(witness::law::follow(at, &circle(p), &gains, &integral_gains, &integral)),
                "ellipse" => follow(witness::law::follow(at, &ellipse(p), &gains, &integral_gains, &integral)),
                "track" => witness::law::track(at, &Reference::circle(5.0, -10.0, 1.0, t), &gains)
                    .map(|s| (s.thrust, s.u_zeta, s.torque, [0.0; 3])),
                other => panic!("unknown kind {other}"),
            };
            // A point without a law ends the integration: it doesn't accept a NaN.
            let Ok((thrust, u_zeta, torque, errors)) = solution else {
                return [f64::NAN; 23];
            };
            let x_dot = plant::derivative(&flown, &x, &Input { thrust, torque });
            let mut rate = [0.0; 23];
            rate[..16].copy_from_slice(&x_dot);
            rate[16..20].copy_from_slice(&[zeta[1], zeta[2], zeta[3], u_zeta]);
            rate[20..].copy_from_slice(&errors);
            rate
        };
        let tolerance = Tolerance { absolute: 1e-11, relative: 1e-10 };
        let mut y = [0.0; 23];
        y[..16].copy_from_slice(&run.x[0]);
        y[16..20].copy_from_slice(&run.zeta[0]);
        let mut worst = 0.0_f64;
        for sample in 1..run.t.len() {
            y = adaptive(rate, [run.t[sample - 1], run.t[sample]], &y, tolerance)
                .unwrap_or_else(|error| panic!("{name} at {}: {error}", run.t[sample]));
            for (flown, expected) in y.iter().zip(&run.x[sample][..3]) {
                worst = worst.max((flown - expected).abs());
            }
        }
        println!("closed loop {name}: payload within {worst:.1e} m of the reference");
        // The relative tolerance of the reference runs, 1e-9, of coordinates of the order of 10 m.
        assert!(worst < 1e-8, "{name}: {worst}");
    }
}
