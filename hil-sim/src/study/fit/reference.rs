//! The constant direction that a curve's normals are counted from.

use controller::Vector3;
use std::f64::consts::PI;

/// The direction must stay this far from every tangent.
pub const LEAST_ANGLE: f64 = 15.0 * PI / 180.0;
/// Directions tried first: 3° apart.
const DIRECTIONS: usize = 2500;
/// An improvement of the cosine by less does not count.
const SETTLED: f64 = 1e-9;

/// The direction whose least angle to all `tangents` (unit vectors, either sign) is largest, with
/// that angle (rad) and the index of the tangent it is measured to.
pub fn farthest(tangents: &[Vector3<f64>]) -> (Vector3<f64>, f64, usize) {
    let cosine = |direction: &Vector3<f64>| {
        let mut worst = (0.0_f64, 0);
        for (index, tangent) in tangents.iter().enumerate() {
            let cosine = direction.dot(tangent).abs();
            if cosine > worst.0 {
                worst = (cosine, index);
            }
        }
        worst
    };

    // Half a sphere in equal areas, by the golden angle.
    let turn = PI * (3.0 - 5.0_f64.sqrt());
    let spread = (0..DIRECTIONS).map(|i| {
        let z = 1.0 - (i as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = (turn * i as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        Vector3::new(radius * cos, radius * sin, z)
    });
    let mut best = Vector3::new(0.0, 0.0, 1.0);
    let mut least = cosine(&best);
    for direction in spread {
        let found = cosine(&direction);
        if found.0 < least.0 {
            (best, least) = (direction, found);
        }
    }

    // Then downhill by ever smaller turns about the axes.
    let mut angle = 0.05;
    while angle > 1e-6 {
        let mut improved = false;
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let mut about = Vector3::zeros();
                about[axis] = sign * angle;
                let direction = best + about.cross(&best);
                let direction = direction / direction.dot(&direction).sqrt();
                let found = cosine(&direction);
                if found.0 < least.0 - SETTLED {
                    (best, least, improved) = (direction, found, true);
                }
            }
        }
        if !improved {
            angle *= 0.5;
        }
    }
    (best, least.0.min(1.0).acos(), least.1)
}
