//! A path seen from the host: its surfaces at a point, points on it, and the motion that keeps to
//! it.
//!
//! Everything comes from the outputs (3.3) that the law itself evaluates, so what holds here holds
//! in flight.

use controller::Outputs;
use controller::{Path, Series, Vector3};

/// Coefficients of a payload's Taylor series, as the law takes them.
const ORDERS: usize = 7;
/// Newton's method on a smooth regular curve doubles its digits each time; from a walk's prediction
/// it needs four.
const CORRECTIONS: usize = 12;
/// Steps of a search from far away, and the longest of them along a curve, m.
const STRIDES: usize = 60;
const STRIDE: f64 = 10.0;
/// A correction below this part of the distance from the origin (at least 1 m) is rounding.
const CONVERGED: f64 = 1e-13;

/// Taylor coefficients p₀, p₁, … of a motion, m/sᵏ.
pub type Motion = [Vector3<f64>; ORDERS];

/// A path's outputs at one point, at rest.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The point, in N, m.
    pub position: Vector3<f64>,
    /// h1 and h2.
    pub surfaces: [f64; 2],
    /// ∇h1 and ∇h2.
    pub gradients: [Vector3<f64>; 2],
    /// ρ.
    pub tangent: Vector3<f64>,
}

impl Frame {
    /// The frame at a point, if everything in it is defined.
    pub fn at<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>) -> Option<Self> {
        let outputs = path.outputs(&[0, 1, 2].map(|axis| Series::constant(position[axis])));
        let [g1, g2] = outputs.gradients;
        let frame = Self {
            position,
            surfaces: [outputs.surfaces[0].value(), outputs.surfaces[1].value()],
            gradients: outputs.gradients,
            tangent: outputs.tangent,
        };
        let finite = position.iter().chain(&g1).chain(&g2).chain(&frame.tangent).chain(&frame.surfaces);
        finite.into_iter().all(|value| value.is_finite()).then_some(frame)
    }

    /// Whether h1 and h2 have a finite value and finite gradients at a point.
    pub fn is_defined<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>) -> bool {
        let outputs = path.outputs(&[0, 1, 2].map(|axis| Series::constant(position[axis])));
        let [g1, g2] = outputs.gradients;
        outputs.surfaces.iter().all(|h| h.value().is_finite()) && g1.iter().chain(&g2).all(|g| g.is_finite())
    }

    /// |∇h1 × ∇h2|, 0 where the two surfaces do not cut each other.
    pub fn regularity(&self) -> f64 {
        length(&self.gradients[0].cross(&self.gradients[1]))
    }

    /// Newton's correction towards both surfaces, normal to ρ.
    pub fn correction(&self) -> Vector3<f64> {
        let [g1, g2] = self.gradients;
        let (c1, c2) = (g2.cross(&self.tangent), self.tangent.cross(&g1));
        -(c1 * self.surfaces[0] + c2 * self.surfaces[1]) / g1.dot(&c1)
    }

    /// The point of the curve that Newton's method reaches from `position` by corrections of at
    /// most `reach` (m).
    pub fn on_curve<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>, reach: f64) -> Option<Self> {
        let mut frame = Self::at(path, position)?;
        for _ in 0..CORRECTIONS {
            let correction = frame.correction();
            let size = length(&correction);
            // A NaN fails the comparison.
            if size.is_nan() || size > reach {
                return None;
            }
            frame = Self::at(path, frame.position + correction)?;
            if size <= CONVERGED * length(&frame.position).max(1.0) {
                return Some(frame);
            }
        }
        None
    }

    /// The point of the curve found from a `position` anywhere, with steps of at most `stride` (m)
    /// on the way.
    pub fn sought<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>, stride: f64) -> Option<Self> {
        let mut position = position;
        for _ in 0..STRIDES {
            let correction = Self::at(path, position)?.correction();
            let size = length(&correction);
            if size <= stride {
                return Self::on_curve(path, position, stride);
            }
            // A NaN, where the surfaces are parallel, ends the search at the next frame.
            position += correction * (stride / size);
        }
        None
    }
}

/// Distance of `position` from the curve at the foot that is reached from there, m: for a curve
/// that is not walked round.
pub fn local_distance<P: Path<f64> + ?Sized>(path: &mut P, position: Vector3<f64>) -> Option<f64> {
    let mut frame = Frame::sought(path, position, STRIDE)?;
    let mut distance = length(&(position - frame.position));
    let mut part = 1.0;
    for _ in 0..STRIDES {
        let along = (position - frame.position).dot(&frame.tangent) * part;
        if along.abs() <= CONVERGED.sqrt() * distance.max(1.0) {
            break;
        }
        let ahead = frame.position + frame.tangent * along.clamp(-STRIDE, STRIDE);
        let next = Frame::on_curve(path, ahead, STRIDE);
        // On a bend the step along the tangent may be too long.
        match next.filter(|next| length(&(position - next.position)) < distance) {
            Some(next) => (frame, distance) = (next, length(&(position - next.position))),
            None => part *= 0.5,
        }
    }
    Some(distance)
}

/// The motion through a point of the curve that keeps both surfaces at zero, order by order: the
/// k-th coefficient of each is linear in the k-th of the motion. `speed` gives the latter's
/// component along ρ.
fn motion<P: Path<f64> + ?Sized>(
    path: &mut P,
    frame: &Frame,
    speed: impl Fn(&Outputs<f64>, &Motion, usize) -> f64,
) -> Option<Motion> {
    let [g1, g2] = frame.gradients;
    // Inverse of the rows ∇h1, ∇h2, ρ by their cross products.
    let columns = [g2.cross(&frame.tangent), frame.tangent.cross(&g1), g1.cross(&g2)];
    let determinant = g1.dot(&columns[0]);
    let mut motion = [Vector3::zeros(); ORDERS];
    motion[0] = frame.position;
    for k in 1..ORDERS {
        let outputs = path.outputs(&series(&motion));
        let [h1, h2] = &outputs.surfaces;
        let third = speed(&outputs, &motion, k);
        motion[k] = (columns[2] * third - columns[0] * h1.0[k] - columns[1] * h2.0[k]) / determinant;
        if !motion[k].iter().all(|value| value.is_finite()) {
            return None;
        }
    }
    Some(motion)
}

/// The motion along the curve at 1 m/s: its coefficients are those of the curve by arc length.
pub fn unit_speed<P: Path<f64> + ?Sized>(path: &mut P, frame: &Frame) -> Option<Motion> {
    motion(path, frame, |_, motion, k| {
        if k == 1 {
            return 1.0;
        }
        // The (k−1)-th coefficient of |ṗ|² is 2k ρ·p_k + Σ (j+1)(k−j) p_{j+1}·p_{k−j}, and zero.
        let known: f64 = (1..k - 1).map(|j| ((j + 1) * (k - j)) as f64 * motion[j + 1].dot(&motion[k - j])).sum();
        -known / (2.0 * k as f64)
    })
}

/// The motion along the curve at the path's own speed v_d: all outputs and their derivatives are
/// zero on it.
pub fn prescribed_speed<P: Path<f64> + ?Sized>(path: &mut P, frame: &Frame) -> Option<Motion> {
    motion(path, frame, |outputs, _, k| -outputs.speed_error.0[k - 1] / k as f64)
}

/// ψ_d and its first two derivatives along a motion, rad/sᵏ.
pub fn yaw<P: Path<f64> + ?Sized>(path: &mut P, motion: &Motion) -> [f64; 3] {
    let yaw = path.outputs(&series(motion)).yaw;
    [0, 1, 2].map(|k| yaw.derivative(k))
}

/// Prescribed speed and yaw at a point, with their derivatives by arc length.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    /// v_d, m/s.
    pub speed: f64,
    /// 1/s.
    pub speed_slope: f64,
    /// ψ_d, rad.
    pub yaw: f64,
    /// rad/m.
    pub yaw_slope: f64,
}

/// Speed and yaw along a motion of unit speed.
pub fn profile<P: Path<f64> + ?Sized>(path: &mut P, motion: &Motion) -> Profile {
    let outputs = path.outputs(&series(motion));
    // h3 = 1 − v_d.
    let (error, yaw) = (outputs.speed_error, outputs.yaw);
    Profile {
        speed: 1.0 - error.value(),
        speed_slope: -error.derivative(1),
        yaw: yaw.value(),
        yaw_slope: yaw.derivative(1),
    }
}

/// A motion as the series that paths take.
fn series(motion: &Motion) -> [Series<f64, ORDERS>; 3] {
    [0, 1, 2].map(|axis| Series(motion.map(|coefficient| coefficient[axis])))
}

/// The same motion run at `factor` times the speed.
pub fn at_speed(motion: &Motion, factor: f64) -> Motion {
    let mut scaled = *motion;
    let mut power = 1.0;
    for coefficient in &mut scaled {
        *coefficient *= power;
        power *= factor;
    }
    scaled
}

/// |v|. (nalgebra's own norms need its `std`, which the controller does without.)
pub fn length(v: &Vector3<f64>) -> f64 {
    v.dot(v).sqrt()
}
