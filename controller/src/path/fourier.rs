//! Any smooth closed curve, as a Fourier series with normal-plane coordinates about the nearest point.

// As in series.rs: indices run over compile-time orders.
#![allow(clippy::indexing_slicing, clippy::needless_range_loop)]

use core::array::from_fn;

use model::{Analytic, OutOfRange, Real, Series};
use nalgebra::Vector3;

use crate::law::lift::PositionSeries;
use crate::path::curve::{dot, norm_squared, now, velocity};
use crate::path::{Curve, Curved, Harmonics, Located};

/// Orders of p(t), hence of σ(t).
const N: usize = 7;

/// The curve c(σ) as a path. With σ(p) the nearest point, r = p − c(σ) and t = c′/|c′|,
///
/// ```text
/// n1 = (e − (e·t) t)/|…|,   n2 = t × n1,   h1 = r·n1,   h2 = r·n2,   ρ = t
/// r·c′ = 0:   h1 = (r·e) |c′|/|c′ × e|,   h2 = r·(c′ × e)/|c′ × e|
/// ```
///
/// **h1 and h2 are in m, and |(h1, h2)| is the distance to the curve.** These coordinates exist within the curve's reach, the
/// distance of its nearest centre of curvature or second branch. The nearest point is followed from sample to sample by
/// [`NEWTON_STEPS`](crate::path::NEWTON_STEPS) Newton steps, so a crossing branch can't catch it; [`Curve::search`] searches the
/// whole curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourierPath<T, const K: usize> {
    harmonics: Harmonics<T, K>,
    /// The reference direction at unit length.
    reference: Vector3<T>,
    /// Of the nearest point at the last sample, rad.
    sigma: T,
    /// c about it, by its derivatives in σ.
    local: [Vector3<T>; N + 1],
    /// (σ(t) − σ(0))/t, orders 0 to 5.
    advance: [T; N - 1],
}

impl<T: Real, const K: usize> FourierPath<T, K> {
    /// The path of `harmonics` (|coefficients| ≤ 10⁵ m), if its tangent keeps 6° from the reference direction.
    ///
    /// # Errors
    /// It does not, or a coefficient is out of range.
    pub fn new(harmonics: Harmonics<T, K>) -> Result<Self, OutOfRange<T>> {
        harmonics.check()?;
        let reference = Vector3::from(harmonics.reference);
        Ok(Self {
            harmonics,
            reference: reference * (T::one() / reference.dot(&reference).sqrt()),
            sigma: T::zero(),
            local: [Vector3::zeros(); N + 1],
            advance: [T::zero(); N - 1],
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

/// r = p − c(σ), c′(σ) and (σ − σ(0))/t along the payload's motion.
struct Nearest<T> {
    error: [Series<T, N>; 3],
    first: [Series<T, N>; 3],
    advance: [T; N - 1],
}

/// Solves r·c′ = 0 order by order, given c's derivatives about the nearest point and `divisor` |c′|² − r·c″ there.
///
/// With s = σ − σ(0) and powers sʲ, both r and c′ are Σⱼ (…) sʲ, in which the newest coefficient of s stands in the first power
/// alone: order m of r·c′ is linear in it.
#[inline]
fn solve<T: Real>(
    position: &PositionSeries<T>,
    offset: &Vector3<T>,
    local: &[Vector3<T>; N + 1],
    divisor: T,
) -> Nearest<T> {
    // Taylor coefficients of c and c′ in s.
    let point: [_; N] = from_fn(|j| local[j] * T::PER_FACTORIAL[j]);
    let first: [_; N] = from_fn(|j| local[j + 1] * T::PER_FACTORIAL[j]);

    let per_divisor = T::one() / divisor;
    // s/t, and the same of s², …, s⁶: entry n of row j is coefficient j + n of sʲ, and the ones before it vanish.
    let mut advance = [T::zero(); N - 1];
    let mut powers = [[T::zero(); N - 1]; N - 2];
    let mut r = [Vector3::zeros(); N];
    let mut d = [Vector3::zeros(); N];
    r[0] = offset - point[0];
    d[0] = first[0];
    let [x, y, z] = position;
    for m in 1..N {
        r[m] = Vector3::new(x.0[m], y.0[m], z.0[m]);
        let mut lower = &advance;
        let coefficients = point.iter().zip(&first).skip(2).take(m - 1);
        for ((j, (c, c_1)), row) in (2..).zip(coefficients).zip(&mut powers) {
            let reversed = lower.iter().take(m + 1 - j).rev();
            let power = advance.iter().zip(reversed).fold(T::zero(), |sum, (&a, &b)| sum + a * b);
            if let Some(entry) = row.get_mut(m - j) {
                *entry = power;
            }
            r[m] -= c * power;
            d[m] += c_1 * power;
            lower = row;
        }
        let product = r.iter().zip(d.iter().take(m + 1).rev()).fold(T::zero(), |sum, (r, d)| sum + r.dot(d));
        let newest = product * per_divisor;
        advance[m - 1] = newest;
        r[m] -= point[1] * newest;
        d[m] += first[1] * newest;
    }
    let transposed = |v: &[Vector3<T>; N]| [Series(v.map(|v| v.x)), Series(v.map(|v| v.y)), Series(v.map(|v| v.z))];
    Nearest { error: transposed(&r), first: transposed(&d), advance }
}

impl<T: Real, const K: usize> Curve<T> for FourierPath<T, K> {
    #[inline]
    fn locate(&mut self, position: &PositionSeries<T>) -> Located<T> {
        let offset = self.offset(&now(position));
        self.sigma = self.harmonics.track(&offset, self.sigma);
        self.local = self.harmonics.derivatives(self.sigma);
        let [point, c_1, c_2, ..] = self.local;
        let speed_squared = c_1.dot(&c_1);
        let r = offset - point;
        let divisor = speed_squared - r.dot(&c_2);
        let Nearest { error, first, advance } = solve(position, &offset, &self.local, divisor);
        self.advance = advance;

        // h1 = (r·e) g and h2 = (r·w)/|w| with w = c′ × e and g = |c′|/|w|.
        let e = &self.reference;
        let [d1, d2, d3] = first;
        let w = [d2 * e.z - d3 * e.y, d3 * e.x - d1 * e.z, d1 * e.y - d2 * e.x];
        let per_w = norm_squared(&w).rsqrt();
        let length = norm_squared(&first).sqrt();
        let g = length * per_w;
        let [r1, r2, r3] = error;
        let height = r1 * e.x + r2 * e.y + r3 * e.z;

        // Gradients: r moves by dp − c′ dσ, c′ by c″ dσ, with ∇σ = c′/divisor.
        let grad_sigma = c_1 * (T::one() / divisor);
        let (w_0, per_w_0, g_0) = (now(&w), per_w.value(), g.value());
        let w_1 = c_2.cross(e);
        let w_rate = w_0.dot(&w_1) * per_w_0 * per_w_0;
        let g_1 = g_0 * (c_1.dot(&c_2) / speed_squared - w_rate);
        let n2 = w_0 * per_w_0;
        let h1_sigma = height.value() * g_1 - e.dot(&c_1) * g_0;
        let h2_sigma = (r.dot(&w_1) - r.dot(&w_0) * w_rate) * per_w_0;

        let along = first.map(|c| c.truncate());
        let length = length.truncate();
        Located {
            surfaces: [height * g, dot(&error, &w) * per_w],
            gradients: [e * g_0 + grad_sigma * h1_sigma, n2 + grad_sigma * h2_sigma],
            along,
            length,
            speed: dot(&along, &velocity(position)) / length,
            reach_margin: divisor / speed_squared,
        }
    }

    fn search(&mut self, position: &Vector3<T>) {
        self.sigma = self.harmonics.search(&self.offset(position));
    }
}

impl<T: Real, const K: usize> Curved<T> for FourierPath<T, K> {
    /// c″(σ(t)): its Taylor polynomial in s, by Horner's rule.
    #[inline]
    fn turning(&self, _: &PositionSeries<T>, _: &Located<T>) -> [Series<T, 6>; 3] {
        let [a1, a2, a3, a4, a5, _] = self.advance;
        let advance = Series([T::zero(), a1, a2, a3, a4, a5]);
        let second: [_; 6] = from_fn(|j| self.local[j + 2] * T::PER_FACTORIAL[j]);
        let compose = |component: fn(&Vector3<T>) -> T| {
            let last = Series::constant(component(&second[5]));
            second[..5].iter().rev().fold(last, |sum, c| sum * advance + component(c))
        };
        [compose(|c| c.x), compose(|c| c.y), compose(|c| c.z)]
    }
}
