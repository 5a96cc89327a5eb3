//! The same paths for the witness, by formulas that it differentiates itself.

use super::{CurveSpec, ProfiledSpec, SpeedSpec, YawSpec};
use controller::{Harmonics, Vector3};
use rig::{Parameters, Shape, parameter, run};
use witness::jet::{Dual, Scalar, cross, dot, scale};
use witness::law::WitnessPath;

/// Newton steps for the nearest point in jets: each doubles the orders that are exact, and seven of
/// time, one of space and one along the inputs are fewer than sixteen.
const DOUBLINGS: usize = 4;

impl WitnessPath for ProfiledSpec {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        match &self.curve {
            CurveSpec::Numbers(parameters) => shaped(parameters, p),
            CurveSpec::Implicit(surfaces) => [surfaces.h1.evaluate(p), surfaces.h2.evaluate(p)],
            CurveSpec::Fourier(harmonics) => normal_coordinates(harmonics, p),
        }
    }

    fn speed<S: Scalar>(&self, p: [S; 3]) -> S {
        match &self.speed {
            SpeedSpec::Constant(speed) => S::constant(*speed),
            SpeedSpec::Formula(formula) => formula.evaluate(p),
            SpeedSpec::CurvatureLimited { max, acceleration } => {
                let excess = self.curvature_squared(p) * (max * max / acceleration).powi(2);
                S::constant(*max) / (excess + 1.0).sqrt().sqrt()
            }
        }
    }

    fn yaw<S: Scalar>(&self, p: [S; 3], tangent: [S; 3]) -> S {
        match &self.yaw {
            YawSpec::Fixed(yaw) => S::constant(*yaw),
            YawSpec::Tangent => tangent[1].atan2(tangent[0]),
            YawSpec::Formula(formula) => formula.evaluate(p),
            YawSpec::PointingAt { target: [x, y] } => (-p[1] + *y).atan2(-p[0] + *x),
        }
    }

    fn direction(&self) -> f64 {
        // (15.7) runs against (3.2).
        if matches!(self.curve.shape(), Some((Shape::Circle, _))) { -1.0 } else { 1.0 }
    }

    fn tangent<S: Scalar>(&self, p: [S; 3]) -> [S; 3] {
        if let CurveSpec::Fourier(harmonics) = &self.curve {
            // ρ is the tangent at the nearest point; ∇h1 × ∇h2 turns from it where the normals
            // twist.
            let [_, first, _] = curve(harmonics, foot(harmonics, p));
            return unit(first);
        }
        let [h1, h2] = self.surfaces(std::array::from_fn(|axis| Dual::<S, 3>::variable(p[axis], axis)));
        scale(unit(cross(h1.parts, h2.parts)), S::constant(self.direction()))
    }
}

/// h1 and h2 of the controller's curves, as their documentation states them.
fn shaped<S: Scalar>(parameters: &Parameters<f64>, p: [S; 3]) -> [S; 2] {
    let [x, y, z] = p;
    let [a, b, c0, c1] = parameters.run(run!("PATH_A" to "PATH_C1"));
    match Shape::of(parameters) {
        Shape::Circle => {
            let [radius, p3] = parameters.run(run!("PATH_RADIUS" to "PATH_P3"));
            [x * x + y * y - radius * radius, z - p3]
        }
        Shape::Ellipse => [(x / a).powi(2) + (y / b).powi(2) - 1.0, z - c0 - x * c1],
        Shape::Bent => [(x / a).powi(4) + (y / b).powi(4) - 1.0, z - c0 - (x * 0.5).sin() * 0.5],
        Shape::Superellipse => {
            let n = 2 * i32::from(parameters.whole(parameter!("PATH_EXP2")));
            [(x / a).powi(n) + (y / b).powi(n) - 1.0, z - c0 - x * c1]
        }
        Shape::Tilted => {
            let Plane { center, e1, e2, n } = Plane::of(parameters);
            let offset: [S; 3] = std::array::from_fn(|axis| p[axis] - center[axis]);
            let along = |e: [f64; 3]| offset[0] * e[0] + offset[1] * e[1] + offset[2] * e[2];
            [(along(e1) / a).powi(2) + (along(e2) / b).powi(2) - 1.0, -along(n)]
        }
        Shape::Fourier => unreachable!("a Fourier series is a curve of its own here"),
    }
}

/// A point on or near the curve, in N, m.
fn hint(parameters: &Parameters<f64>) -> [f64; 3] {
    let [a, _, c0, _] = parameters.run(run!("PATH_A" to "PATH_C1"));
    match Shape::of(parameters) {
        Shape::Circle => [parameters.get(parameter!("PATH_RADIUS")), 0.0, parameters.get(parameter!("PATH_P3"))],
        Shape::Ellipse | Shape::Bent | Shape::Superellipse => [a, 0.0, c0],
        Shape::Tilted => {
            let Plane { center, e1, .. } = Plane::of(parameters);
            std::array::from_fn(|axis| center[axis] + a * e1[axis])
        }
        Shape::Fourier => unreachable!("a Fourier series is a curve of its own here"),
    }
}

/// The plane of a tilted curve: its centre and axes, n = e1 × e2.
struct Plane {
    center: [f64; 3],
    e1: [f64; 3],
    e2: [f64; 3],
    n: [f64; 3],
}

impl Plane {
    fn of(parameters: &Parameters<f64>) -> Self {
        let n = unit(parameters.run(run!("PATH_NRM_1" to "PATH_NRM_3")));
        let e2 = unit(cross(n, parameters.run(run!("PATH_MAJ_1" to "PATH_MAJ_3"))));
        let center = parameters.run(run!("PATH_CTR_1" to "PATH_CTR_3"));
        Self { center, e1: cross(e2, n), e2, n }
    }
}

/// v/|v|.
fn unit<S: Scalar>(v: [S; 3]) -> [S; 3] {
    scale(v, S::constant(1.0) / dot(v, v).sqrt())
}

impl ProfiledSpec {
    /// A point on or near the curve, in N, m.
    pub(super) fn hint(&self) -> Vector3<f64> {
        match &self.curve {
            CurveSpec::Numbers(parameters) => Vector3::from(hint(parameters)),
            CurveSpec::Implicit(_) => Vector3::zeros(),
            CurveSpec::Fourier(harmonics) => harmonics.point(0.0),
        }
    }

    /// The square of dρ/ds along ρ, of the curve of constant (h1, h2) through `p`; of a Fourier
    /// curve itself, at the point nearest to `p`.
    fn curvature_squared<S: Scalar>(&self, p: [S; 3]) -> S {
        if let CurveSpec::Fourier(harmonics) = &self.curve {
            let [_, first, second] = curve(harmonics, foot(harmonics, p));
            let (bend, square) = (cross(first, second), dot(first, first));
            return dot(bend, bend) / (square * square * square);
        }
        let tangent = self.tangent(p);
        // ρ carried along itself.
        let moving: [Dual<S, 1>; 3] = std::array::from_fn(|axis| Dual { value: p[axis], parts: [tangent[axis]] });
        let bend = self.tangent(moving).map(|component| component.parts[0]);
        dot(bend, bend)
    }
}

/// r·n1 and r·n2 with r = p − c(σ) from the nearest point, n1 the reference direction less its
/// part along the tangent, and n2 = t × n1.
fn normal_coordinates<S: Scalar, const K: usize>(harmonics: &Harmonics<f64, K>, p: [S; 3]) -> [S; 2] {
    let [c, first, _] = curve(harmonics, foot(harmonics, p));
    let r: [S; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
    let t = unit(first);
    let e = harmonics.reference.map(S::constant);
    let along = dot(e, t);
    let across: [S; 3] = std::array::from_fn(|axis| e[axis] - along * t[axis]);
    let n1 = unit(across);
    [dot(r, n1), dot(r, cross(t, n1))]
}

/// σ of the nearest point, with all its derivatives.
fn foot<S: Scalar, const K: usize>(harmonics: &Harmonics<f64, K>, p: [S; 3]) -> S {
    let mut sigma = S::constant(nearest(harmonics, p.map(|component| component.value())));
    for _ in 0..DOUBLINGS {
        let [c, first, second] = curve(harmonics, sigma);
        let r: [S; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
        sigma = sigma + dot(r, first) / (dot(first, first) - dot(r, second));
    }
    sigma
}

/// c(σ), c′(σ), c″(σ), term by term.
fn curve<S: Scalar, const K: usize>(harmonics: &Harmonics<f64, K>, sigma: S) -> [[S; 3]; 3] {
    let zero = S::constant(0.0);
    let mut sums = [harmonics.center.map(S::constant), [zero; 3], [zero; 3]];
    for (index, (a, b)) in harmonics.cos.iter().zip(&harmonics.sin).enumerate() {
        let k = (index + 1) as f64;
        let (sin, cos) = (sigma * k).sin_cos();
        for axis in 0..3 {
            let (value, slope) = (cos * a[axis] + sin * b[axis], cos * b[axis] - sin * a[axis]);
            sums[0][axis] = sums[0][axis] + value;
            sums[1][axis] = sums[1][axis] + slope * k;
            sums[2][axis] = sums[2][axis] - value * (k * k);
        }
    }
    sums
}

/// The parameter of the nearest point, by looking everywhere and then by bisection of the
/// distance's slope.
fn nearest<const K: usize>(harmonics: &Harmonics<f64, K>, p: [f64; 3]) -> f64 {
    let samples = 64 * K;
    let step = std::f64::consts::TAU / samples as f64;
    let away = |sigma: f64| {
        let [c, first, _] = curve(harmonics, sigma);
        let r: [f64; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
        (dot(r, r), dot(r, first))
    };
    let best = (0..samples)
        .map(|index| step * index as f64)
        .min_by(|left, right| away(*left).0.total_cmp(&away(*right).0))
        .unwrap_or(0.0);
    let (mut low, mut high) = (best - step, best + step);
    // Halved down to the spacing of f64.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if away(middle).1 > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
