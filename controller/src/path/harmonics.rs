//! A closed curve as a Fourier series, and a search of all of it.

// Orders are compile-time numbers.
#![allow(clippy::indexing_slicing)]

use model::{OutOfRange, Real};
use nalgebra::Vector3;

use crate::path::nearest::{Local, newton};

/// Newton steps after the search of the whole curve.
const SEARCH_STEPS: usize = 8;

/// Points of the search of the whole curve, per harmonic.
const SAMPLES_PER_HARMONIC: usize = 16;

/// Of the angle between the reference direction and the tangent, the least sine that a curve is
/// accepted with (6°).
const LEAST_SINE: f64 = 0.1;

/// The closed curve c(σ) = a0 + Σ_{k=1…K} (A_k cos kσ + B_k sin kσ), σ in rad, in N, m; and the
/// direction that its normals are counted from. Plain data: it can stand in a `const`.
///
/// ```
/// use controller::Harmonics;
///
/// // An ellipse of 5 m by 3 m that rises and falls by 0.5 m twice a lap.
/// const LOOP: Harmonics<f32, 2> = Harmonics {
///     center: [0.0, 0.0, -10.0],
///     cos: [[5.0, 0.0, 0.0], [0.0, 0.0, 0.5]],
///     sin: [[0.0, 3.0, 0.0], [0.0; 3]],
///     reference: [0.0, 0.0, 1.0],
/// };
/// assert_eq!(LOOP.point(0.0).z, -9.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonics<T, const K: usize> {
    /// a0.
    pub center: [T; 3],
    /// A_1 to A_K.
    pub cos: [[T; 3]; K],
    /// B_1 to B_K.
    pub sin: [[T; 3]; K],
    /// Direction e of any length, nowhere along the tangent.
    pub reference: [T; 3],
}

impl<T: Real, const K: usize> Harmonics<T, K> {
    /// c(σ) − a0, c′(σ), …, c⁽ᴹ⁻¹⁾(σ), in m.
    #[inline]
    pub fn derivatives<const M: usize>(&self, sigma: T) -> [Vector3<T>; M] {
        let turn = sigma.sin_cos();
        // The even derivatives are multiples ±k^m of the harmonic itself, the odd ones of its first
        // derivative: one after the other, for the sums of both don't fit the registers.
        let even = self.sum::<M>(turn, |a, b, sin, cos| a * cos + b * sin, |_| T::one());
        let odd = self.sum::<M>(turn, |a, b, sin, cos| b * cos - a * sin, |frequency| frequency);
        core::array::from_fn(|order| if order % 2 == 0 { even[order / 2] } else { odd[order / 2] })
    }

    /// Every second derivative, of M in all: for each harmonic multiples of `start`, the first by
    /// `factor` of its frequency.
    #[inline(always)]
    fn sum<const M: usize>(
        &self,
        (sin_1, cos_1): (T, T),
        start: impl Fn(Vector3<T>, Vector3<T>, T, T) -> Vector3<T>,
        factor: impl Fn(T) -> T,
    ) -> [Vector3<T>; 4] {
        const { assert!(M <= 8) };
        let (mut sin, mut cos) = (sin_1, cos_1);
        let mut frequency = T::one();
        let mut sums = [Vector3::zeros(); 4];
        for (a, b) in self.cos.iter().zip(&self.sin) {
            let derivative = start(Vector3::from(*a), Vector3::from(*b), sin, cos);
            let square = frequency * frequency;
            let mut factor = factor(frequency);
            for_each_order!(HALF in [0 1 2 3] {
                if 2 * HALF < M {
                    sums[HALF] += derivative * factor;
                    factor *= -square;
                }
            });
            (sin, cos) = (sin * cos_1 + cos * sin_1, cos * cos_1 - sin * sin_1);
            frequency += T::one();
        }
        sums
    }

    /// c(σ), N, m.
    pub fn point(&self, sigma: T) -> Vector3<T> {
        let [offset] = self.derivatives(sigma);
        offset + Vector3::from(self.center)
    }

    /// Parameters that sample the whole curve, 16 to the shortest harmonic's period.
    fn samples() -> impl Iterator<Item = T> {
        let count = SAMPLES_PER_HARMONIC * K;
        let step = T::lit(core::f64::consts::TAU / count as f64);
        (0..count).scan(T::lit(-core::f64::consts::PI), move |sigma, _| {
            *sigma += step;
            Some(*sigma)
        })
    }

    /// `Ok` if all numbers are within ±10⁵ and the tangent keeps 6° from the reference direction
    /// (so it has no zero either).
    pub(super) fn check(&self) -> Result<(), OutOfRange<T>> {
        let coefficients = self.cos.iter().chain(&self.sin).chain([&self.center, &self.reference]);
        for number in coefficients.flatten() {
            OutOfRange::check("coefficient", *number, -1e5, 1e5)?;
        }
        let reference = Vector3::from(self.reference);
        OutOfRange::check("length of reference", reference.dot(&reference).sqrt(), 1e-3, 1e6)?;
        for sigma in Self::samples() {
            let [_, tangent] = self.derivatives(sigma);
            let across = tangent.cross(&reference);
            let lengths = tangent.dot(&tangent) * reference.dot(&reference);
            let sine = (across.dot(&across) / lengths).sqrt();
            OutOfRange::check("sine of the angle between reference and tangent", sine, LEAST_SINE, 1.001)?;
        }
        Ok(())
    }

    /// c about `sigma` less a0, by its Taylor coefficients.
    #[inline]
    pub(super) fn local(&self, sigma: T, local: &mut Local<T>) {
        *local = self.derivatives(sigma);
        for (c, &factor) in local.iter_mut().zip(&T::PER_FACTORIAL) {
            *c *= factor;
        }
    }

    /// The longest Newton step: half of the shortest harmonic's radian.
    pub(super) fn longest_step() -> T {
        T::lit(0.5 / K as f64)
    }

    /// The nearest point's parameter, rad, from a search of the whole curve and Newton steps: 16 K
    /// + 8 evaluations, always.
    pub(super) fn search(&self, offset: &Vector3<T>) -> T {
        let distance_squared = |sigma| {
            let [point] = self.derivatives(sigma);
            let error = offset - point;
            error.dot(&error)
        };
        let start = T::lit(core::f64::consts::PI);
        let (sigma, _) = Self::samples().fold((start, distance_squared(start)), |best, sigma| {
            let distance = distance_squared(sigma);
            if distance < best.1 { (sigma, distance) } else { best }
        });
        (0..SEARCH_STEPS).fold(sigma, |sigma, _| {
            let [point, first, second] = self.derivatives(sigma);
            (sigma + newton(&(offset - point), &first, &second, Self::longest_step())).wrap_angle()
        })
    }
}
