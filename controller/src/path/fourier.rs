//! Any smooth closed curve, as a Fourier series with normal-plane coordinates about the nearest
//! point.

// Indices are axes and compile-time orders.
#![allow(clippy::indexing_slicing)]

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::path::PositionSeries;
use crate::path::curve::{Sum, now};
use crate::path::nearest::{Local, Nearest, track};
use crate::path::{Curve, Curved, Harmonics, Located};

/// Newton steps from the last sample's nearest point to the present one, always all of them.
///
/// The error falls quadratically from the distance flown since the last sample. Random loops of 8
/// harmonics and some 5 m radius, followed at 0.8 of their reach with 15 cm a sample, leave 3e-6 m
/// in f32.
pub const NEWTON_STEPS: usize = 3;

/// The curve c(σ) as a path. With σ(p) the nearest point, r = p − c(σ) and t = c′/|c′|, these
/// are (15.3) and (15.4):
///
/// ```text
/// n1 = (e − (e·t) t)/|…|,   n2 = t × n1,   h1 = r·n1,   h2 = r·n2,   ρ = t
/// r·c′ = 0:   h1 = (r·e) |c′|/|c′ × e|,   h2 = r·(c′ × e)/|c′ × e|
/// ```
///
/// **h1 and h2 are in m, and |(h1, h2)| is the distance to the curve.** These coordinates exist
/// within the curve's reach, the distance of its nearest centre of curvature or second branch. The
/// nearest point is followed from sample to sample by [`NEWTON_STEPS`](crate::path::NEWTON_STEPS)
/// Newton steps, so a crossing branch can't catch it; [`Curve::search`] searches the whole curve.
///
/// ```
/// use controller::{AlongTangent, Curve, CurvatureLimited, FourierPath, Harmonics};
///
/// let harmonics = Harmonics {
///     center: [0.0, 0.0, -10.0_f32],
///     cos: [[5.0, 0.0, 0.0], [0.0, 0.0, 0.5]],
///     sin: [[0.0, 3.0, 0.0], [0.0; 3]],
///     reference: [0.0, 0.0, 1.0],
/// };
/// // 2 m/s, slower in the bends.
/// let speed = CurvatureLimited::new(2.0, 0.5)?;
/// let path = FourierPath::new(harmonics)?.with_speed(speed).with_yaw(AlongTangent);
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourierPath<T, const K: usize> {
    harmonics: Harmonics<T, K>,
    /// The reference direction at unit length.
    reference: Vector3<T>,
    /// Of the nearest point at the last sample, rad.
    sigma: T,
    /// c less a0 about it.
    local: Local<T>,
    /// Of the last sample.
    nearest: Nearest<T>,
}

impl<T: Real, const K: usize> FourierPath<T, K> {
    /// The path of `harmonics` (|coefficients| ≤ 10⁵ m), if its tangent keeps 6° from the reference
    /// direction.
    ///
    /// # Errors
    /// It does not, or a coefficient is out of range.
    pub fn new(harmonics: Harmonics<T, K>) -> Result<Self, OutOfRange<T>> {
        harmonics.check()?;
        let reference = Vector3::from(harmonics.reference);
        let mut local = [Vector3::zeros(); 8];
        harmonics.local(T::zero(), &mut local);
        Ok(Self {
            harmonics,
            reference: reference * (T::one() / reference.dot(&reference).sqrt()),
            sigma: T::zero(),
            local,
            nearest: Nearest::none(),
        })
    }

    /// The curve.
    pub fn harmonics(&self) -> &Harmonics<T, K> {
        &self.harmonics
    }

    /// σ of the nearest point at the last sample, rad, in (−π, π].
    pub fn sigma(&self) -> T {
        self.sigma
    }

    /// p − a0, N, m.
    #[inline]
    fn offset(&self, position: &Vector3<T>) -> Vector3<T> {
        position - Vector3::from(self.harmonics.center)
    }
}

/// |c′|, and ρ·v with ρ = c′/|c′|.
// Apart, so that the numbers at work fit the registers.
#[inline(never)]
fn length_and_speed<T: Real>(
    first: &[Series<T, 7>; 3],
    position: &PositionSeries<T>,
) -> (Series<T, 7>, Series<T, 6>) {
    let (mut square, mut along) = (Sum::empty(), Sum::empty());
    for (d, p) in first.iter().zip(position) {
        square.add_square(d);
        along.add_product(&d.truncate(), &p.differentiate());
    }
    let length = square.0.sqrt();
    (length, along.0 / length.truncate())
}

impl<T: Real, const K: usize> Curve<T> for FourierPath<T, K> {
    #[inline]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let offset = self.offset(&now(position));
        let [last, ..] = &self.local;
        let advanced =
            self.sigma + track::<_, NEWTON_STEPS>(&self.local, &(offset - last), Harmonics::<T, K>::longest_step());
        self.sigma = advanced.wrap_angle();
        self.harmonics.local(self.sigma, &mut self.local);
        let [point, ..] = &self.local;
        let r = offset - point;
        self.nearest.solve(position, &r, &self.local);
        let Nearest { error, first, .. } = &self.nearest;

        // h1 = (r·e) |c′|/|w| and h2 = (r·w)/|w| with w = c′ × e.
        let e = &self.reference;
        let [d1, d2, d3] = first;
        let (mut across, mut square) = (Sum::empty(), Sum::empty());
        // c′ and e along the axis that follows, and along the last of the three.
        let mut next = (d2, e.y);
        for (r, last) in error.iter().zip([(d3, e.z), (d1, e.x), (d2, e.y)]) {
            let w = *next.0 * last.1 - *last.0 * next.1;
            across.add_product(r, &w);
            square.add_square(&w);
            next = last;
        }
        let w_length = square.0.sqrt();
        let h2 = across.0 / w_length;

        let (length, speed) = length_and_speed(first, position);
        let [r1, r2, r3] = *error;
        let h1 = (r1 * e.x + r2 * e.y + r3 * e.z) * length / w_length;

        // Gradients: r moves by dp − c′ dσ, c′ by c″ dσ, with ∇σ = c′/divisor.
        let Nearest { speed_squared, divisor, .. } = self.nearest;
        let [_, c_1, half_c_2, ..] = self.local;
        let c_2 = half_c_2 + half_c_2;
        let grad_sigma = c_1 * (T::one() / divisor);
        let (w_0, w_1) = (c_1.cross(e), c_2.cross(e));
        let per_w_0 = T::one() / w_length.value();
        let g_0 = length.value() * per_w_0;
        let w_rate = w_0.dot(&w_1) * per_w_0 * per_w_0;
        let g_1 = g_0 * (c_1.dot(&c_2) / speed_squared - w_rate);
        let n2 = w_0 * per_w_0;
        let h1_sigma = r.dot(e) * g_1 - e.dot(&c_1) * g_0;
        let h2_sigma = (r.dot(&w_1) - r.dot(&w_0) * w_rate) * per_w_0;

        Located {
            surfaces: [h1, h2],
            gradients: [e * g_0 + grad_sigma * h1_sigma, n2 + grad_sigma * h2_sigma],
            along: first.map(|c| c.truncate()),
            length: length.truncate(),
            speed,
            reach_margin: divisor / speed_squared,
        }
    }

    fn search(&mut self, position: &Vector3<T>) -> bool {
        self.sigma = self.harmonics.search(&self.offset(position));
        self.harmonics.local(self.sigma, &mut self.local);
        true
    }
}

impl<T: Real, const K: usize> Curved<T> for FourierPath<T, K> {
    /// c″(σ(t)).
    #[inline]
    fn turning(&self, _: &PositionSeries<T>, _: &Located<T>) -> [Series<T, 6>; 3] {
        let [_, _, c_2, c_3, c_4, c_5, c_6, c_7] = self.local;
        let [second, third, fourth] = [c_2 * T::lit(2.0), c_3 * T::lit(6.0), c_4 * T::lit(12.0)];
        let [fifth, sixth, seventh] = [c_5 * T::lit(20.0), c_6 * T::lit(30.0), c_7 * T::lit(42.0)];
        let compose = |component: fn(&Vector3<T>) -> T| {
            self.nearest.advance.compose(&[second, third, fourth, fifth, sixth, seventh].map(|c| component(&c)))
        };
        [compose(|c| c.x), compose(|c| c.y), compose(|c| c.z)]
    }
}
