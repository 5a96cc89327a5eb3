//! Every curve and profile: its series against itself at other times, its gradients, its geometry
//! in closed form, and the Fourier path's nearest point against a search in double precision.

use controller::{
    AlongTangent, Bent, CurvatureLimited, Curve, Curved, Ellipse, FixedYaw, Formula, FourierPath, Harmonics,
    Implicit, Linear, PointingAt, Profiled, ScalarField, Superellipse, Tilted,
};
use controller::{Analytic, Circle, Path, Real, Series, Vector3};
use proptest::prelude::*;

/// |v|: nalgebra has it with `std` only.
fn length(v: &Vector3<f64>) -> f64 {
    v.dot(v).sqrt()
}

fn unit(v: &Vector3<f64>) -> Vector3<f64> {
    v / length(v)
}

/// p(t) by its Taylor coefficients, orders 0 to 5.
type Motion = [Vector3<f64>; 6];

/// A motion about a point near the flat curves of half-axes 5 m and 4 m, 10 m up: metres, metres a
/// second, and so on.
const MOTION: Motion = [
    Vector3::new(3.1, 2.9, -9.6),
    Vector3::new(-1.1, 0.8, 0.3),
    Vector3::new(0.4, 0.5, -0.3),
    Vector3::new(-0.2, 0.3, 0.2),
    Vector3::new(0.15, -0.1, 0.1),
    Vector3::new(0.05, 0.1, -0.08),
];

/// How far series are followed, s.
const TIME: f64 = 0.08;

fn series<T: Real>(motion: &Motion) -> [Series<T, 7>; 3] {
    let mut coordinates = [Series([T::zero(); 7]); 3];
    for (axis, coordinate) in coordinates.iter_mut().enumerate() {
        for (c, vector) in coordinate.0.iter_mut().zip(motion) {
            *c = T::lit(vector[axis]);
        }
    }
    coordinates
}

/// The same motion about a later time.
fn later(motion: &Motion, t: f64) -> Motion {
    let shifted = series::<f64>(motion).map(|coordinate| coordinate.shift(t));
    std::array::from_fn(|k| Vector3::new(shifted[0].0[k], shifted[1].0[k], shifted[2].0[k]))
}

fn evaluate<const N: usize>(series: &Series<f64, N>, t: f64) -> f64 {
    series.0.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// A Taylor polynomial of N coefficients misses the function at t by O(tᴺ), so a halved t by 2⁻ᴺ
/// of that: a wrong coefficient of order k < N shows as 2⁻ᵏ.
fn assert_order<const N: usize>(what: &str, polynomial: &Series<f64, N>, exact: impl Fn(f64) -> f64) {
    // Rounding of some hundred operations on numbers up to the values' size.
    let noise = 3e-14 * polynomial.0.iter().fold(1.0, |sum: f64, c| sum.max(c.abs()));
    // On both sides, for on one of them the next two terms may cancel.
    let remainder =
        |t: f64| [t, -t].map(|t| (evaluate(polynomial, t) - exact(t)).abs()).into_iter().fold(0.0, f64::max);
    let (whole, half) = (remainder(TIME), remainder(0.5 * TIME));
    // Three quarters of an order for the next term's part.
    let expected = whole * 0.5_f64.powf(N as f64 - 0.75) + noise;
    assert!(half <= expected, "{what}: remainder {whole:e}, {half:e} at half the time");
    assert!(whole < 1e-2, "{what}: remainder {whole:e}");
}

/// All outputs of a path, as series, against their values at other times; and the gradients against
/// the surfaces.
fn check_series(name: &str, path: &mut dyn Path<f64>) {
    let [start, ..] = MOTION;
    path.search(&start);
    let outputs = path.outputs(&series(&MOTION));
    let mut at = |t: f64| {
        let motion = later(&MOTION, t);
        path.search(&motion[0]);
        path.outputs(&series(&motion))
    };
    let times = [TIME, 0.5 * TIME, -TIME, -0.5 * TIME];
    let exact = times.map(|t| (t, at(t)));
    let at_time = |t: f64| exact.iter().find(|(time, _)| *time == t).expect("one of the times").1;
    for i in 0..2 {
        assert_order(&format!("{name} h{}", i + 1), &outputs.surfaces[i], |t| at_time(t).surfaces[i].value());
    }
    assert_order(&format!("{name} speed"), &outputs.speed_error, |t| at_time(t).speed_error.value());
    let turn = |yaw: f64| yaw + std::f64::consts::TAU * ((outputs.yaw.value() - yaw) / std::f64::consts::TAU).round();
    assert_order(&format!("{name} yaw"), &outputs.yaw, |t| turn(at_time(t).yaw.value()));

    for axis in 0..3 {
        let mut line: Motion =
            [start, Vector3::zeros(), Vector3::zeros(), Vector3::zeros(), Vector3::zeros(), Vector3::zeros()];
        line[1][axis] = 1.0;
        path.search(&start);
        let along_axis = path.outputs(&series(&line));
        for i in 0..2 {
            let (gradient, slope) = (outputs.gradients[i][axis], along_axis.surfaces[i].derivative(1));
            assert!((gradient - slope).abs() < 1e-12, "{name}: ∇h{} along {axis} is {gradient}, not {slope}", i + 1);
        }
    }
    assert!((length(&outputs.tangent) - 1.0).abs() < 1e-14, "{name}: |ρ|");
}

fn superellipse() -> Superellipse<f64> {
    Superellipse::new(5.0, 4.0, 3, -10.0, 0.2).unwrap()
}

fn tilted() -> Tilted<f64> {
    Tilted::new(Vector3::new(0.5, -0.2, -10.0), Vector3::new(0.3, -0.4, 1.0), Vector3::new(1.0, 0.5, 0.1), 5.0, 4.0)
        .unwrap()
}

/// A loop with every harmonic in every direction, in the neighbourhood of [`MOTION`].
fn knot() -> FourierPath<f64, 3> {
    FourierPath::new(Harmonics {
        center: [0.1, -0.2, -10.0],
        cos: [[4.5, 0.3, 0.2], [0.2, 0.3, 0.4], [-0.1, 0.2, 0.15]],
        sin: [[0.2, 4.0, -0.1], [0.3, -0.2, 0.5], [0.05, 0.1, -0.2]],
        reference: [0.1, -0.1, 0.9],
    })
    .unwrap()
}

/// Every function at once.
struct Everything;

impl Implicit<f64> for Everything {
    fn surfaces<A: Analytic<f64>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        let outline = (x / 5.0).square() + (y / 4.0).powi(4) - 1.0;
        let height = (x * 0.3).sin() * (y * 0.2).exp() + (x * y * 0.1).tanh() + (x.square() + 2.0).ln();
        [outline, z + 10.0 + height + (y + 9.0).sqrt() - (x + 9.0).powf(0.3) + y.atan2(x + 9.0)]
    }
}

impl ScalarField<f64> for Everything {
    fn at<A: Analytic<f64>>(&self, p: [A; 3]) -> A {
        let [h1, h2] = self.surfaces(p);
        h1.cos() + h2.tanh()
    }
}

#[test]
fn curves_have_consistent_series_and_gradients() {
    let linear = || Formula(Linear::new(0.2, Vector3::new(0.1, -0.2, 0.3)).unwrap());
    let limited = CurvatureLimited::new(3.0, 1.0).unwrap();
    let circle = Circle::new(4.5, -10.0).unwrap();
    let ellipse = Ellipse::new(5.0, 4.0, -10.0, 0.2).unwrap();
    let bent = Bent::new(5.0, 4.0, -10.0).unwrap();
    check_series("circle", &mut circle.at_speed(1.0).unwrap());
    check_series("ellipse", &mut Profiled { curve: ellipse, speed: linear(), yaw: AlongTangent });
    check_series("superellipse", &mut Profiled { curve: superellipse(), speed: linear(), yaw: linear() });
    let pointing = Formula(PointingAt::new(1.0, -1.0).unwrap());
    check_series("bent", &mut bent.at_speed(1.0).unwrap().with_yaw(pointing));
    check_series("tilted", &mut tilted().at_speed(-2.0).unwrap().with_yaw(AlongTangent));
    let formula = Formula(Everything);
    check_series("formula", &mut Profiled { curve: formula, speed: Formula(Everything), yaw: Formula(Everything) });
    check_series("Fourier", &mut Profiled { curve: knot(), speed: linear(), yaw: AlongTangent });

    let yaw = FixedYaw::new(0.3).unwrap();
    check_series("limited on a circle", &mut Profiled { curve: circle, speed: limited, yaw });
    check_series("limited on an ellipse", &mut Profiled { curve: ellipse, speed: limited, yaw });
    check_series("limited on a superellipse", &mut Profiled { curve: superellipse(), speed: limited, yaw });
    check_series("limited on a bent curve", &mut Profiled { curve: bent, speed: limited, yaw });
    check_series("limited on a tilted ellipse", &mut Profiled { curve: tilted(), speed: limited, yaw });
    check_series("limited on a formula", &mut Profiled { curve: Formula(Everything), speed: limited, yaw });
    check_series("limited on a Fourier path", &mut Profiled { curve: knot(), speed: limited, yaw });
}

/// A built-in curve's equations once more, as a formula.
struct Written<F>(F);

impl<F: Fn(f64, f64, f64) -> [f64; 2]> Written<F> {
    fn assert_values(&self, name: &str, curve: &mut impl Curve<f64>) {
        let located = curve.locate(&series(&MOTION));
        let [p, ..] = MOTION;
        for (got, expected) in located.surfaces.iter().zip((self.0)(p.x, p.y, p.z)) {
            assert!((got.value() - expected).abs() < 1e-13, "{name}: {} for {expected}", got.value());
        }
    }
}

#[test]
fn curves_are_the_zeros_they_state() {
    let superellipse_written =
        |x: f64, y: f64, z: f64| [(x / 5.0).powi(6) + (y / 4.0).powi(6) - 1.0, z + 10.0 - 0.2 * x];
    Written(superellipse_written).assert_values("superellipse", &mut superellipse());
    // The plane's axes by Gram and Schmidt, where the curve takes cross products.
    let n = unit(&Vector3::new(0.3, -0.4, 1.0));
    let major = Vector3::new(1.0, 0.5, 0.1);
    let e1 = unit(&(major - n * n.dot(&major)));
    let e2 = n.cross(&e1);
    let written = |x, y, z| {
        let offset = Vector3::new(x, y, z) - Vector3::new(0.5, -0.2, -10.0);
        let (xi, eta) = (e1.dot(&offset) / 5.0, e2.dot(&offset) / 4.0);
        [xi * xi + eta * eta - 1.0, -n.dot(&offset)]
    };
    Written(written).assert_values("tilted", &mut tilted());
}

/// Curvature and direction of one ellipse at its vertices, κ = a/b² and b/a², however the ellipse
/// is given.
fn check_ellipse(name: &str, curve: &mut impl Curved<f64>, forward: bool) {
    let (a, b) = (5.0, 4.0);
    let at_vertex = [
        (Vector3::new(a, 0.0, -10.0), Vector3::new(0.0, 1.0, 0.0), a / (b * b)),
        (Vector3::new(0.0, -b, -10.0), Vector3::new(1.0, 0.0, 0.0), b / (a * a)),
    ];
    for (point, direction, curvature) in at_vertex {
        let mut motion = [Vector3::zeros(); 6];
        motion[0] = point;
        // 3 m/s along, and 1 across, which ρ·v does not see.
        motion[1] = direction * 3.0 + Vector3::new(0.0, 0.0, 1.0);
        curve.search(&point);
        let located = curve.locate(&series(&motion));
        let sign = if forward { 1.0 } else { -1.0 };
        assert!(length(&(located.tangent() - direction * sign)) < 1e-13, "{name}: ρ = {}", located.tangent());
        assert!((located.speed.value() - 3.0 * sign).abs() < 1e-13, "{name}: ρ·v = {}", located.speed.value());
        assert!(located.surfaces.iter().all(|h| h.value().abs() < 1e-13), "{name}: not on the curve");
        let squared = curve.curvature_squared(&series(&motion), &located).value();
        assert!((squared.sqrt() - curvature).abs() < 1e-13, "{name}: κ = {}, not {curvature}", squared.sqrt());
    }
}

struct EllipseFormula;

impl Implicit<f64> for EllipseFormula {
    fn surfaces<A: Analytic<f64>>(&self, [x, y, z]: [A; 3]) -> [A; 2] {
        [(x / 5.0).powi(2) + (y / 4.0).powi(2) - 1.0, z + 10.0]
    }
}

#[test]
fn one_ellipse_in_five_forms() {
    let down = Vector3::new(0.0, 0.0, 2.0);
    let center = Vector3::new(0.0, 0.0, -10.0);
    let harmonics = Harmonics {
        center: [0.0, 0.0, -10.0],
        cos: [[5.0, 0.0, 0.0]],
        sin: [[0.0, 4.0, 0.0]],
        reference: [0.0, 0.0, -1.0],
    };
    check_ellipse("ellipse", &mut Ellipse::new(5.0, 4.0, -10.0, 0.0).unwrap(), false);
    check_ellipse("superellipse", &mut Superellipse::new(5.0, 4.0, 1, -10.0, 0.0).unwrap(), false);
    check_ellipse("formula", &mut Formula(EllipseFormula), false);
    check_ellipse("tilted", &mut Tilted::new(center, down, Vector3::x(), 5.0, 4.0).unwrap(), true);
    check_ellipse("Fourier", &mut FourierPath::new(harmonics).unwrap(), true);
}

#[test]
fn limited_speed_keeps_its_bound() {
    let (top, bound) = (6.0, 2.0);
    let speed = CurvatureLimited::new(top, bound).unwrap();
    for radius in [0.5, 5.0, 500.0] {
        let mut path = Circle::new(radius, -10.0).unwrap().with_speed(speed);
        let mut motion = [Vector3::zeros(); 6];
        motion[0] = Vector3::new(radius, 0.0, -10.0);
        let v = -path.outputs(&series(&motion)).speed_error.value();
        let expected = top / (1.0 + (top * top / radius / bound).powi(2)).powf(0.25);
        assert!((v - expected).abs() < 1e-13);
        assert!(v * v / radius < bound && v <= top, "{v} m/s at {radius} m");
    }
}

/// Along the tangent of a circle, yaw turns with the speed's rate whichever side of ±π it is on.
#[test]
fn yaw_has_no_seam() {
    let (radius, rate) = (5.0_f64, 0.3_f64);
    for step in 0..1000 {
        let angle = f64::from(step) * 0.01;
        let (sin, cos) = angle.sin_cos();
        let mut motion = [Vector3::zeros(); 6];
        motion[0] = Vector3::new(radius * cos, radius * sin, -10.0);
        motion[1] = Vector3::new(-sin, cos, 0.0) * (radius * rate);
        motion[2] = Vector3::new(-cos, -sin, 0.0) * (0.5 * radius * rate * rate);
        let curve = Circle::new(radius, -10.0).unwrap();
        let yaw = curve.at_speed(1.0).unwrap().with_yaw(AlongTangent).outputs(&series(&motion)).yaw;
        let error = angle + std::f64::consts::FRAC_PI_2 - yaw.value();
        assert!((error / std::f64::consts::TAU - (error / std::f64::consts::TAU).round()).abs() < 1e-14);
        assert!((yaw.derivative(1) - rate).abs() < 1e-14 && yaw.derivative(2).abs() < 1e-14);
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let harmonics =
        |reference| Harmonics { center: [0.0; 3], cos: [[5.0, 0.0, 0.0]], sin: [[0.0, 4.0, 0.0]], reference };
    assert!(FourierPath::new(harmonics([1.0, 0.0, 0.0])).is_err(), "a reference along the tangent");
    assert!(FourierPath::new(harmonics([0.0; 3])).is_err());
    assert!(FourierPath::new(harmonics([0.0, 0.0, f64::NAN])).is_err());
    let still = Harmonics { center: [0.0; 3], cos: [[5.0, 0.0, 0.0]], sin: [[0.0; 3]], reference: [0.0, 0.0, 1.0] };
    assert!(FourierPath::new(still).is_err(), "a curve that turns back has no tangent there");
    assert!(Tilted::circle(Vector3::zeros(), Vector3::zeros(), 5.0).is_err());
    assert!(Tilted::new(Vector3::zeros(), Vector3::z(), Vector3::z(), 5.0, 4.0).is_err());
    assert!(Superellipse::new(5.0, 4.0, 0, -10.0, 0.0).is_err());
    assert!(Superellipse::new(5.0, 4.0, 11, -10.0, 0.0).is_err());
    assert!(Ellipse::new(0.0, 4.0, -10.0, 0.0).is_err());
    assert!(Bent::new(5.0, f64::INFINITY, -10.0).is_err());
    assert!(CurvatureLimited::new(1.0, 0.0).is_err());
}

/// Harmonics of the curves below.
const K: usize = 8;

/// A closed curve as a plain sum, in double precision: shares nothing with the path under test but
/// its numbers.
struct Sum(Harmonics<f32, K>);

impl Sum {
    /// c, c′ and c″.
    fn at(&self, sigma: f64) -> [Vector3<f64>; 3] {
        let vector = |v: [f32; 3]| Vector3::from(v.map(f64::from));
        let mut sums = [vector(self.0.center), Vector3::zeros(), Vector3::zeros()];
        for (index, (a, b)) in self.0.cos.iter().zip(&self.0.sin).enumerate() {
            let k = (index + 1) as f64;
            let (sin, cos) = (k * sigma).sin_cos();
            let (a, b) = (vector(*a), vector(*b));
            sums[0] += a * cos + b * sin;
            sums[1] += (b * cos - a * sin) * k;
            sums[2] -= (a * cos + b * sin) * (k * k);
        }
        sums
    }

    /// Federer's formula for the reach, inf |y − x|²/(2 dist(y − x, T_x)), over all pairs of
    /// `count` points.
    fn reach(&self, count: usize) -> f64 {
        let points: Vec<_> = (0..count).map(|i| self.at(std::f64::consts::TAU * i as f64 / count as f64)).collect();
        let mut reach = f64::INFINITY;
        for [x, tangent, _] in &points {
            let tangent = unit(tangent);
            for [y, ..] in &points {
                let chord = y - x;
                let across = length(&(chord - tangent * tangent.dot(&chord)));
                if length(&chord) > 1e-9 && across > 0.0 {
                    reach = reach.min(chord.dot(&chord) / (2.0 * across));
                }
            }
        }
        reach
    }

    /// The nearest point to `p`, and how far it is: a fine search and Newton's iteration to its
    /// end.
    fn nearest(&self, p: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let samples = 1000;
        let distance = |sigma: f64| length(&(p - self.at(sigma)[0]));
        let mut sigma = (0..samples)
            .map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(samples))
            .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
            .expect("samples");
        for _ in 0..20 {
            let [c, first, second] = self.at(sigma);
            sigma += (p - c).dot(&first) / (first.dot(&first) - (p - c).dot(&second));
        }
        (self.at(sigma)[0], distance(sigma))
    }
}

/// Loops of some 5 m radius, with harmonics in all directions that fall off as 1/k².
fn harmonics() -> impl Strategy<Value = Harmonics<f32, K>> {
    let wobble = || prop::array::uniform8(prop::array::uniform3(-1.0_f32..1.0));
    (wobble(), wobble(), 0.0_f32..0.5, prop::array::uniform3(-50.0_f32..50.0)).prop_map(
        |(mut cos, mut sin, size, center)| {
            for (index, (a, b)) in cos.iter_mut().zip(&mut sin).enumerate() {
                let scale = size / ((index + 1) as f32).powi(2);
                *a = a.map(|x| x * scale);
                *b = b.map(|x| x * scale);
            }
            cos[0][0] += 5.0;
            sin[0][1] += 4.0;
            Harmonics { center, cos, sin, reference: [0.0, 0.0, 1.0] }
        },
    )
}

/// The bar on the nearest point, m.
const NEAREST: f64 = 1e-5;

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// Flown round the loop at the edge of 0.8 of the reach in f32, winding about it, the nearest
    /// point found by the bounded iteration is the f64 search's, and h is the distance to it.
    #[test]
    fn nearest_point_within_the_reach(harmonics in harmonics(), winding in 1_i32..6, phase in 0.0..6.0_f64) {
        let sum = Sum(harmonics);
        let distance = 0.8 * sum.reach(400);
        let Ok(mut path) = FourierPath::new(harmonics) else { return Err(TestCaseError::reject("steep")) };
        // 0.03 rad a sample is some 15 cm: 75 m/s at 500 Hz.
        let samples = 210;
        for i in 0..samples {
            let sigma = 0.03 * f64::from(i);
            let [c, tangent, _] = sum.at(sigma);
            let tangent = unit(&tangent);
            let n1 = unit(&(Vector3::z() - tangent * tangent.z));
            let (sin, cos) = (phase + f64::from(winding) * sigma).sin_cos();
            let p = (c + (n1 * cos + tangent.cross(&n1) * sin) * distance).map(|x| f64::from(x as f32));
            let mut motion = [Vector3::zeros(); 6];
            motion[0] = p;
            if i == 0 {
                path.search(&p.map(|x| x as f32));
            }
            let located = path.locate(&series::<f32>(&motion));
            let (expected, expected_distance) = sum.nearest(&p);
            let error = length(&(sum.at(f64::from(path.sigma()))[0] - expected));
            prop_assert!(error <= NEAREST, "sample {}: {:e} m from the nearest point", i, error);
            let [h1, h2] = located.surfaces.map(|h| f64::from(h.value()));
            prop_assert!((h1.hypot(h2) - expected_distance).abs() <= NEAREST, "d_C = {} for {}", h1.hypot(h2), expected_distance);
            prop_assert!(located.reach_margin > 0.15, "margin {}", located.reach_margin);
        }
    }

    /// A position that is not a number does not stay with the path.
    #[test]
    fn a_lost_sample_is_forgotten(harmonics in harmonics(), sigma in -3.0..3.0_f64) {
        let sum = Sum(harmonics);
        let Ok(mut path) = FourierPath::new(harmonics) else { return Err(TestCaseError::reject("steep")) };
        let [c, ..] = sum.at(sigma);
        path.search(&c.map(|x| x as f32));
        let mut motion = [Vector3::zeros(); 6];
        motion[0] = Vector3::repeat(f64::NAN);
        let _ = path.locate(&series::<f32>(&motion));
        motion[0] = c;
        for _ in 0..3 {
            let _ = path.locate(&series::<f32>(&motion));
        }
        let error = length(&(sum.at(f64::from(path.sigma()))[0] - sum.nearest(&c).0));
        prop_assert!(error <= NEAREST, "{:e} m off", error);
    }
}

#[test]
fn a_yaw_more_by_whole_turns_is_the_same_yaw() {
    use controller::Disturbance;
    use controller::follow;
    use controller::{Gains, State, Vehicle, VehicleParams};

    let vehicle = Vehicle::new(VehicleParams::<f64>::paper()).unwrap();
    let gains = Gains { k1: [1.0; 6], k2: [1.0; 6], k3: [1.0; 5], k4: [2.0, 3.0], integral: [0.0; 3] };
    let state = State::at_rest(Vector3::new(5.0, 0.0, -10.0));
    let answer = |yaw: f64| {
        let curve = Circle::new(5.0, -10.0).unwrap();
        let mut path = curve.at_speed(0.0).unwrap().with_yaw(FixedYaw::new(yaw).unwrap());
        follow(&vehicle, &mut path, &gains, &state, &[0.0; 4], &[0.0; 3], &Disturbance::none())
    };
    for yaw in [-3.0, -0.3, 0.0, 1.0, 3.1] {
        for turns in [-15.0, -2.0, -1.0, 1.0, 2.0, 15.0] {
            let (once, more) = (answer(yaw), answer(yaw + turns * std::f64::consts::TAU));
            // The rounding of a hundred radians.
            assert!((once.xi.h4[0] - more.xi.h4[0]).abs() < 3e-14, "{yaw} and {turns} turns: {:?}", more.xi.h4);
            assert!((once.command.torque.z - more.command.torque.z).abs() < 3e-14, "{yaw} and {turns} turns");
        }
    }
}
