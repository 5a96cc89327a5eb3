//! The closed-form law against reference vectors that were computed in binary128 by differentiating
//! the paper's equations.

use controller::{
    AlongTangent, Analytic, Bent, Circle, Curve, Disturbance, Ellipse, Formula, Gains, Implicit, Linear, OutOfRange,
    Path, Profiled, Real, Reference, State, TrackGains, Vector3, Vehicle, VehicleParams, follow, track,
};
use tests::golden::{self, Follow, LawMeta, relative_error};

/// Relative errors of every vector, quantity by quantity.
#[derive(Default)]
struct Errors {
    inputs: Vec<f64>,
    torque: Vec<f64>,
    thrust: Vec<f64>,
    xi: Vec<f64>,
}

impl Errors {
    fn worst(errors: &[f64]) -> f64 {
        errors.iter().fold(0.0, |worst, &e| if e <= worst { worst } else { e })
    }

    fn median(errors: &[f64]) -> f64 {
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    }

    fn push(&mut self, inputs: ([f64; 4], [f64; 4]), thrust: (f64, f64), xi: (&[f64], &[f64])) {
        self.inputs.push(relative_error(&inputs.0, &inputs.1));
        self.torque.push(relative_error(&inputs.0[1..], &inputs.1[1..]));
        self.thrust.push(relative_error(&[thrust.0], &[thrust.1]));
        self.xi.push(relative_error(xi.0, xi.1));
    }

    /// Asserts the worst and the median error of ū and the worst of the torque alone, of T and of
    /// ξ.
    fn assert(&self, what: &str, worst: f64, median: f64, torque: f64, outputs: f64) {
        let found = [
            ("u worst", Self::worst(&self.inputs), worst),
            ("u median", Self::median(&self.inputs), median),
            ("torque worst", Self::worst(&self.torque), torque),
            ("T worst", Self::worst(&self.thrust), outputs),
            ("xi worst", Self::worst(&self.xi), outputs),
        ];
        for (quantity, error, bound) in found {
            println!("{what}: {quantity} {error:.2e} (bound {bound:.1e})");
        }
        for (quantity, error, bound) in found {
            assert!(error <= bound, "{what}: {quantity} {error:e} exceeds {bound:e}");
        }
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

fn state<T: Real>(x: &[f64; 16]) -> State<T> {
    State::<f64>::from_paper(x).cast()
}

fn row<T: Real, const N: usize>(k: &[f64]) -> [T; N] {
    std::array::from_fn(|j| T::lit(k[j]))
}

fn gains<T: Real>(k: &golden::Gains, integral: [f64; 3]) -> Gains<T> {
    Gains { k1: row(&k[0]), k2: row(&k[1]), k3: row(&k[2]), k4: row(&k[3]), integral: integral.map(T::lit) }
}

fn follow_errors<T: Real, P: Path<T>>(file: &str, path: impl Fn(&[T]) -> Result<P, OutOfRange<T>>) -> Errors {
    let file = golden::follow(file);
    let LawMeta { gains_fig3, gains_fig56, integral_gains, .. } = &file.meta;
    let mut errors = Errors::default();
    for vector in &file.vectors {
        let Follow { ubar_fig3, ubar_fig56, ubar_fig56_int, .. } = vector;
        let settings = [
            (gains(gains_fig3, [0.0; 3]), ubar_fig3),
            (gains(gains_fig56, [0.0; 3]), ubar_fig56),
            (gains(gains_fig56, *integral_gains), ubar_fig56_int),
        ];
        let parameters: Vec<T> = vector.path.iter().copied().map(T::lit).collect();
        for (gains, expected) in settings {
            let solution = follow(
                &vehicle(&vector.par),
                &mut path(&parameters).unwrap(),
                &gains,
                &state(&vector.x),
                &vector.zeta.map(T::lit),
                &vector.integral.map(T::lit),
                &Disturbance::none(),
            );
            let torque = solution.command.torque.map(T::to_f64);
            let xi = [&solution.xi.h1[..], &solution.xi.h2, &solution.xi.h3, &solution.xi.h4].concat();
            errors.push(
                ([solution.u_zeta.to_f64(), torque.x, torque.y, torque.z], *expected),
                (solution.command.thrust.to_f64(), vector.thrust),
                (&xi.iter().map(|x| x.to_f64()).collect::<Vec<_>>(), &vector.xi),
            );
        }
    }
    errors
}

fn track_errors<T: Real>() -> Errors {
    let file = golden::track();
    let [k1, k2, k3, k4] = &file.meta.gains_track[..] else { panic!("four rows of gains") };
    let gains = TrackGains { position: [row(k1), row(k2), row(k3)], yaw: row(k4) };
    let mut errors = Errors::default();
    for vector in &file.vectors {
        let reference = Reference::circle(T::lit(5.0), T::lit(-10.0), T::one(), T::lit(vector.t));
        let zeta = vector.zeta.map(T::lit);
        let solution =
            track(&vehicle(&vector.par), &gains, &reference, &state(&vector.x), &zeta, &Disturbance::none());
        let torque = solution.command.torque.map(T::to_f64);
        let [p1, p2, p3] = solution.xi.position;
        let xi = [&p1[..], &p2, &p3, &solution.xi.yaw].concat();
        errors.push(
            ([solution.u_zeta.to_f64(), torque.x, torque.y, torque.z], vector.ubar),
            (solution.command.thrust.to_f64(), vector.thrust),
            (&xi.iter().map(|x| x.to_f64()).collect::<Vec<_>>(), &vector.xi),
        );
    }
    errors
}

/// In f64 the vectors' own rounding, up to 2.6e-12 where ū nearly cancels, is not met: the closed
/// form loses less.
const F64: f64 = 1e-12;
/// In f32 the worst vectors are those in which ū nearly cancels; unit roundoff is 6e-8.
const F32_WORST: f64 = 4e-5;
const F32_MEDIAN: f64 = 3e-7;
const F32_TORQUE: f64 = 4e-6;
/// The curves whose tangent is normalized divide twice more, by formula with gradients of their own
/// rounding.
const F32_TORQUE_NORMALIZED: f64 = 6e-6;
/// T and ξ in f32: a few tens of roundings of numbers that do not cancel.
const F32_OUTPUTS: f64 = 2e-6;

fn circle<T: Real>(parameters: &[T]) -> Result<impl Path<T> + use<T>, OutOfRange<T>> {
    Circle::new(parameters[0], parameters[1])?.at_speed(parameters[2])
}

fn ellipse<T: Real>(parameters: &[T]) -> Result<impl Path<T> + use<T>, OutOfRange<T>> {
    let [a, b, c0, c1, speed] = *parameters else { panic!("five parameters") };
    Ok(Ellipse::new(a, b, c0, c1)?.at_speed(speed)?.with_yaw(AlongTangent))
}

/// The ellipse as a user would write it.
struct EllipseFormula<T> {
    a: T,
    b: T,
    c0: T,
    c1: T,
}

impl<T: Real> Implicit<T> for EllipseFormula<T> {
    fn surfaces<A: Analytic<T>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        [(x / self.a).powi(2) + (y / self.b).powi(2) - T::one(), z - self.c0 - x * self.c1]
    }
}

fn ellipse_formula<T: Real>(parameters: &[T]) -> Result<impl Path<T> + use<T>, OutOfRange<T>> {
    let [a, b, c0, c1, speed] = *parameters else { panic!("five parameters") };
    Ok(Formula(EllipseFormula { a, b, c0, c1 }).at_speed(speed)?.with_yaw(AlongTangent))
}

/// v_d = v0 + v1 p1/a.
fn bent_speed<T: Real>(a: T, v0: T, v1: T) -> Result<Formula<Linear<T>>, OutOfRange<T>> {
    Linear::new(v0, Vector3::new(v1 / a, T::zero(), T::zero())).map(Formula)
}

/// ψ_d = 0.2 p1.
fn bent_yaw<T: Real>() -> Result<Formula<Linear<T>>, OutOfRange<T>> {
    Linear::new(T::zero(), Vector3::new(T::lit(0.2), T::zero(), T::zero())).map(Formula)
}

fn bent<T: Real>(parameters: &[T]) -> Result<impl Path<T> + use<T>, OutOfRange<T>> {
    let [a, b, c0, v0, v1] = *parameters else { panic!("five parameters") };
    Ok(Profiled { curve: Bent::new(a, b, c0)?, speed: bent_speed(a, v0, v1)?, yaw: bent_yaw()? })
}

/// The bent curve as a user would write it.
struct BentFormula<T> {
    a: T,
    b: T,
    c0: T,
}

impl<T: Real> Implicit<T> for BentFormula<T> {
    fn surfaces<A: Analytic<T>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        let half = T::lit(0.5);
        [(x / self.a).powi(4) + (y / self.b).powi(4) - T::one(), z - self.c0 - (x * half).sin() * half]
    }
}

fn bent_formula<T: Real>(parameters: &[T]) -> Result<impl Path<T> + use<T>, OutOfRange<T>> {
    let [a, b, c0, v0, v1] = *parameters else { panic!("five parameters") };
    let curve = Formula(BentFormula { a, b, c0 });
    Ok(Profiled { curve, speed: bent_speed(a, v0, v1)?, yaw: bent_yaw()? })
}

#[test]
fn circle_f64() {
    follow_errors::<f64, _>("circle", circle).assert("circle f64", F64, F64, F64, F64);
}

#[test]
fn circle_f32() {
    let errors = follow_errors::<f32, _>("circle", circle);
    errors.assert("circle f32", F32_WORST, F32_MEDIAN, F32_TORQUE, F32_OUTPUTS);
}

#[test]
fn track_f64() {
    track_errors::<f64>().assert("track f64", F64, F64, F64, F64);
}

#[test]
fn track_f32() {
    track_errors::<f32>().assert("track f32", F32_WORST, F32_MEDIAN, F32_TORQUE, F32_OUTPUTS);
}

#[test]
fn ellipse_f64() {
    follow_errors::<f64, _>("ellipse", ellipse).assert("ellipse f64", F64, F64, F64, F64);
}

#[test]
fn ellipse_f32() {
    let errors = follow_errors::<f32, _>("ellipse", ellipse);
    errors.assert("ellipse f32", F32_WORST, F32_MEDIAN, F32_TORQUE_NORMALIZED, F32_OUTPUTS);
}

#[test]
fn ellipse_formula_f64() {
    follow_errors::<f64, _>("ellipse", ellipse_formula).assert("ellipse by formula f64", F64, F64, F64, F64);
}

#[test]
fn ellipse_formula_f32() {
    let errors = follow_errors::<f32, _>("ellipse", ellipse_formula);
    errors.assert("ellipse by formula f32", F32_WORST, F32_MEDIAN, F32_TORQUE_NORMALIZED, F32_OUTPUTS);
}

#[test]
fn bent_f64() {
    follow_errors::<f64, _>("bent", bent).assert("bent f64", F64, F64, F64, F64);
}

#[test]
fn bent_f32() {
    let errors = follow_errors::<f32, _>("bent", bent);
    errors.assert("bent f32", F32_WORST, F32_MEDIAN, F32_TORQUE_NORMALIZED, F32_OUTPUTS);
}

#[test]
fn bent_formula_f64() {
    follow_errors::<f64, _>("bent", bent_formula).assert("bent by formula f64", F64, F64, F64, F64);
}

#[test]
fn bent_formula_f32() {
    let errors = follow_errors::<f32, _>("bent", bent_formula);
    errors.assert("bent by formula f32", F32_WORST, F32_MEDIAN, F32_TORQUE_NORMALIZED, F32_OUTPUTS);
}
