//! A route of B-splines for the witness: by de Boor's algorithm, differentiated by machine.

use super::WitnessPath;
use crate::jet::{Dual, Scalar, cross, dot, scale};

/// Newton steps for the nearest point in jets: each doubles the orders that are exact, and seven of
/// time and one along the inputs are fewer than sixteen.
const DOUBLINGS: usize = 4;

/// Degree of the curve, its normals and its speed; and of its yaw.
const DEGREE: usize = 7;
const YAW_DEGREE: usize = 3;

/// An open route over the whole numbers as knots, by its control points: h1 = r·n1 and h2 = r·n2
/// with r the way from the curve's nearest point to the payload.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Of the curve, N, m.
    pub points: Vec<[f64; 3]>,
    /// Of the two fields of normals.
    pub normals: [Vec<[f64; 3]>; 2],
    /// Of v_d, m/s.
    pub speed: Vec<f64>,
    /// Of ψ_d, rad.
    pub yaw: Vec<f64>,
}

/// The spline of `degree` over `points` at `u`, 0 to the number of its spans of degree 7, whose
/// points stand symmetrically about it: by repeated interpolation (de Boor).
fn spline<S: Scalar>(points: &[f64], degree: usize, u: S) -> S {
    let spans = points.len() - DEGREE;
    let span = (u.value().floor().max(0.0) as usize).min(spans - 1);
    let first = span + (DEGREE - degree) / 2;
    let mut triangle: Vec<S> = (0..=degree).map(|i| S::constant(points[first + i])).collect();
    // Point i of the span has the knots from i − degree on; u − span lies between knots 0 and 1.
    let u = u - span as f64;
    for level in 1..=degree {
        for i in (level..=degree).rev() {
            let knot = i as f64 - degree as f64;
            let alpha = (u - knot) / (degree + 1 - level) as f64;
            triangle[i] = (-alpha + 1.0) * triangle[i - 1] + alpha * triangle[i];
        }
    }
    triangle[degree]
}

fn vector_spline<S: Scalar>(points: &[[f64; 3]], u: S) -> [S; 3] {
    std::array::from_fn(|axis| {
        let coordinates: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        spline(&coordinates, DEGREE, u)
    })
}

impl Route {
    fn spans(&self) -> usize {
        self.points.len() - DEGREE
    }

    /// c, c′ and c″ at `u`.
    fn curve<S: Scalar>(&self, u: S) -> [[S; 3]; 3] {
        let inner = Dual::<S, 1>::variable(u, 0);
        let c = vector_spline(&self.points, Dual::<Dual<S, 1>, 1>::variable(inner, 0));
        [
            c.map(|x| x.value.value),
            c.map(|x| {
                let [first] = x.parts;
                first.value
            }),
            c.map(|x| {
                let [first] = x.parts;
                let [second] = first.parts;
                second
            }),
        ]
    }

    /// The point of the curve at parameter `u`, from 0 to the number of spans.
    #[must_use]
    pub fn point(&self, u: f64) -> [f64; 3] {
        vector_spline(&self.points, u)
    }

    /// The parameter of the curve's nearest point, by looking everywhere between `from` and `to`
    /// and then by bisection of the distance's slope.
    #[must_use]
    pub fn nearest(&self, p: [f64; 3], from: f64, to: f64) -> f64 {
        let samples = 32 * self.spans();
        let step = (to - from) / samples as f64;
        let away = |u: f64| {
            let c = self.point(u);
            let r: [f64; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
            dot(r, r)
        };
        let slope = |u: f64| {
            let [c, first, _] = self.curve(u);
            let r: [f64; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
            dot(r, first)
        };
        let best = (0..=samples)
            .map(|index| from + step * index as f64)
            .min_by(|left, right| away(*left).total_cmp(&away(*right)))
            .unwrap_or(from);
        let (mut low, mut high) = ((best - step).max(0.0), (best + step).min(self.spans() as f64));
        // Halved down to the spacing of f64.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if slope(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// n1 × n2 · c′/|c′| at parameter `u`.
    #[must_use]
    pub fn determinant(&self, u: f64) -> f64 {
        let [_, first, _] = self.curve(u);
        let [n1, n2] = self.normals.each_ref().map(|normal| vector_spline(normal, u));
        dot(cross(n1, n2), first) / dot(first, first).sqrt()
    }

    /// σ of the nearest point, with all its derivatives.
    fn foot<S: Scalar>(&self, p: [S; 3]) -> S {
        let mut sigma = S::constant(self.nearest(p.map(|x| x.value()), 0.0, self.spans() as f64));
        for _ in 0..DOUBLINGS {
            let [c, first, second] = self.curve(sigma);
            let r: [S; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
            sigma = sigma + dot(r, first) / (dot(first, first) - dot(r, second));
        }
        sigma
    }
}

impl WitnessPath for Route {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        let sigma = self.foot(p);
        let c = vector_spline(&self.points, sigma);
        let r: [S; 3] = std::array::from_fn(|axis| p[axis] - c[axis]);
        self.normals.each_ref().map(|normal| dot(r, vector_spline(normal, sigma)))
    }

    fn speed<S: Scalar>(&self, p: [S; 3]) -> S {
        spline(&self.speed, DEGREE, self.foot(p))
    }

    fn yaw<S: Scalar>(&self, p: [S; 3], _: [S; 3]) -> S {
        spline(&self.yaw, YAW_DEGREE, self.foot(p))
    }

    fn tangent<S: Scalar>(&self, p: [S; 3]) -> [S; 3] {
        let [_, first, _] = self.curve(self.foot(p));
        scale(first, S::constant(1.0) / dot(first, first).sqrt())
    }
}
