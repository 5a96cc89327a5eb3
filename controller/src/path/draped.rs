//! Curves draped over a surface that is graded along n1: h1 = F(p1, p2) is their outline seen from
//! above, h2 = p3 − H(p1) their height. Much of (3.2) is constant there, (15.1):
//!
//! ```text
//! ∇h1 = (F1, F2, 0),   ∇h2 = (−H′, 0, 1),   ∇h1 × ∇h2 = (F2, −F1, H′ F2)
//! ```

use model::{Analytic, Real, Series};
use nalgebra::Vector3;

use crate::path::Located;
use crate::path::PositionSeries;
use crate::path::curve::{norm_squared, velocity};

/// Locates the payload from h1 and h2, the outline's gradient (F1, F2), the product with H′ (which
/// may be a number or a series), and H′ now.
#[inline]
pub(super) fn locate<T: Real>(
    surfaces: [Series<T, 7>; 2],
    [f1, f2]: [Series<T, 6>; 2],
    times_slope: impl Fn(Series<T, 6>) -> Series<T, 6>,
    slope: T,
    position: &PositionSeries<T>,
) -> Located<T> {
    let (zero, one) = (T::zero(), T::one());
    let along = [f2, -f1, times_slope(f2)];
    let length = norm_squared(&along).sqrt();
    let [v1, v2, v3] = velocity(position);
    Located {
        surfaces,
        gradients: [Vector3::new(f1.value(), f2.value(), zero), Vector3::new(-slope, zero, one)],
        along,
        length,
        speed: (f2 * (v1 + times_slope(v3)) - f1 * v2) / length,
        reach_margin: one,
    }
}
