//! Paths as the witness takes them: two functions of the position, and a speed and a yaw along
//! them.

use crate::jet::{Dual, Scalar, cross, dot, scale};

/// A path C = {h1 = 0, h2 = 0}, given by formulas over any scalar; derivatives and the tangent
/// (3.2) follow from them.
pub trait WitnessPath {
    /// h1 and h2 at a position in N (m).
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2];

    /// v_d, the wanted speed along the path, m/s.
    fn speed<S: Scalar>(&self, p: [S; 3]) -> S;

    /// ψ_d, the wanted yaw, rad; `tangent` is the unit tangent at `p`.
    fn yaw<S: Scalar>(&self, p: [S; 3], tangent: [S; 3]) -> S;

    /// 1 if the path is flown along the tangent of (3.2), −1 if against it.
    fn direction(&self) -> f64 {
        1.0
    }

    /// The unit tangent at `p`: that of (3.2), unless the path states another off the curve.
    fn tangent<S: Scalar>(&self, p: [S; 3]) -> [S; 3] {
        let [h1, h2] = self.surfaces(std::array::from_fn(|axis| Dual::<S, 3>::variable(p[axis], axis)));
        let normal = cross(h1.parts, h2.parts);
        let length = dot(normal, normal).sqrt();
        scale(normal, S::constant(self.direction()) / length)
    }
}

/// The outputs (3.3): h1, h2, ρ·v − v_d, ψ − ψ_d, the last not wrapped.
pub fn outputs<S: Scalar, P: WitnessPath>(path: &P, p: [S; 3], v: [S; 3], psi: S) -> [S; 4] {
    let [h1, h2] = path.surfaces(p);
    let tangent = path.tangent(p);
    [h1, h2, dot(tangent, v) - path.speed(p), psi - path.yaw(p, tangent)]
}

/// The horizontal circle (15.7), flown along the tangent printed there, (−p2, p1, 0)/r, with
/// ψ_d = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// d1, m.
    pub radius: f64,
    /// d2, the height in N, m.
    pub p3: f64,
    /// v_d, m/s.
    pub speed: f64,
}

impl WitnessPath for Circle {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        [p[0] * p[0] + p[1] * p[1] - self.radius * self.radius, p[2] - self.p3]
    }

    fn speed<S: Scalar>(&self, _: [S; 3]) -> S {
        S::constant(self.speed)
    }

    fn yaw<S: Scalar>(&self, _: [S; 3], _: [S; 3]) -> S {
        S::constant(0.0)
    }

    fn direction(&self) -> f64 {
        -1.0
    }
}

/// An elliptic cylinder cut by a sloping plane, h1 = (p1/a)² + (p2/b)² − 1 and h2 = p3 − c0 −
/// c1 p1, with the nose along the tangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Half axis along n1, m.
    pub a: f64,
    /// Half axis along n2, m.
    pub b: f64,
    /// Height at p1 = 0 in N, m.
    pub c0: f64,
    /// Slope along n1.
    pub c1: f64,
    /// v_d, m/s.
    pub speed: f64,
}

impl WitnessPath for Ellipse {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        [(p[0] / self.a).powi(2) + (p[1] / self.b).powi(2) - 1.0, p[2] - self.c0 - p[0] * self.c1]
    }

    fn speed<S: Scalar>(&self, _: [S; 3]) -> S {
        S::constant(self.speed)
    }

    fn yaw<S: Scalar>(&self, _: [S; 3], tangent: [S; 3]) -> S {
        tangent[1].atan2(tangent[0])
    }
}

/// A superellipse on a bent sheet, h1 = (p1/a)⁴ + (p2/b)⁴ − 1 and h2 = p3 − c0 − ½
/// sin(p1/2), with v_d = v0 + v1 p1/a and ψ_d = 0.2 p1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent {
    /// Half width along n1, m.
    pub a: f64,
    /// Half width along n2, m.
    pub b: f64,
    /// Mean height in N, m.
    pub c0: f64,
    /// Mean speed, m/s.
    pub v0: f64,
    /// Change of speed from p1 = 0 to p1 = a, m/s.
    pub v1: f64,
}

impl WitnessPath for Bent {
    fn surfaces<S: Scalar>(&self, p: [S; 3]) -> [S; 2] {
        [(p[0] / self.a).powi(4) + (p[1] / self.b).powi(4) - 1.0, p[2] - self.c0 - (p[0] * 0.5).sin() * 0.5]
    }

    fn speed<S: Scalar>(&self, p: [S; 3]) -> S {
        p[0] * (self.v1 / self.a) + self.v0
    }

    fn yaw<S: Scalar>(&self, p: [S; 3], _: [S; 3]) -> S {
        p[0] * 0.2
    }
}
