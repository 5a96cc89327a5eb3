//! Output gains from poles, and the test that they make a stable loop.
//!
//! Linearized, output i is a chain of r integrators closed by ν = −Σ kⱼ h⁽ʲ⁾, with the
//! characteristic polynomial (8.1), sʳ + k_{r−1} s^{r−1} + … + k₀. Integral action makes it
//! (8.2), s (sʳ + … + k₀) + k̃, which **bounds k̃ from above**: the paper's K̃ with slower
//! poles is unstable. So gains are tested by Routh's criterion wherever they are set.

// The Routh table and polynomial products index over compile-time bounds.
#![allow(clippy::indexing_slicing)]

use core::fmt;

use model::{OutOfRange, Real};

use crate::ranges::POLE;

/// One real pole or one complex-conjugate pair, 1/s.
///
/// ```
/// use controller::{Pole, place};
///
/// // (s + 2)(s² + 2 s + 5), low order first and without the leading 1.
/// let k: [f64; 3] = place(&[Pole::Real(-2.0), Pole::Pair { re: -1.0, im: 2.0 }])?;
/// assert_eq!(k, [10.0, 9.0, 4.0]);
/// # Ok::<(), controller::GainError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pole<T> {
    /// A real pole.
    Real(T),
    /// The pair `re` ± j `im`.
    Pair {
        /// Real part.
        re: T,
        /// Imaginary part.
        im: T,
    },
}

/// Why gains or poles were refused. Outputs are counted as in the paper: 1 to 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GainError<T> {
    /// The poles do not make a polynomial of the output's relative degree.
    PoleCount {
        /// The chain's length.
        expected: usize,
        /// Poles given, a pair counting two.
        given: usize,
    },
    /// A pole is not in the open left half-plane.
    UnstablePole {
        /// Its real part, 1/s; must be < 0.
        re: T,
    },
    /// A pole is too far from zero for its gains to be numbers.
    PoleTooFast {
        /// The larger of its real and imaginary parts' sizes, 1/s.
        size: T,
        /// The largest allowed, 1/s.
        limit: T,
    },
    /// The characteristic polynomial of an output is not Hurwitz.
    NotHurwitz {
        /// The output, 1 to 4.
        output: usize,
    },
    /// With its integral gain the characteristic polynomial of an output is not Hurwitz.
    Integral {
        /// The output, 1 to 3.
        output: usize,
        /// The integral gain given.
        value: T,
        /// Stable are 0 ≤ k̃ < `limit` with these output gains.
        limit: T,
    },
}

impl<T: Real> GainError<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> GainError<U> {
        match *self {
            Self::PoleCount { expected, given } => GainError::PoleCount { expected, given },
            Self::UnstablePole { re } => GainError::UnstablePole { re: re.cast() },
            Self::PoleTooFast { size, limit } => GainError::PoleTooFast { size: size.cast(), limit: limit.cast() },
            Self::NotHurwitz { output } => GainError::NotHurwitz { output },
            Self::Integral { output, value, limit } => {
                GainError::Integral { output, value: value.cast(), limit: limit.cast() }
            }
        }
    }
}

impl<T: Real> fmt::Display for GainError<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::PoleCount { expected, given } => {
                write!(f, "{given} poles where the relative degree needs {expected}")
            }
            Self::UnstablePole { re } => write!(f, "a pole with real part {re} is not in the open left half-plane"),
            Self::PoleTooFast { size, limit } => write!(f, "a pole of size {size} is beyond {limit}"),
            Self::NotHurwitz { output } => write!(f, "the gains of output {output} do not make a stable loop"),
            Self::Integral { output, value, limit } => write!(
                f,
                "the integral gain {value} of output {output} does not make a stable loop: allowed are 0 up to, not \
                 including, {limit}"
            ),
        }
    }
}

impl<T: Real> core::error::Error for GainError<T> {}

/// The gains that put real poles at −first, −(first + 1), … times `bandwidth` on a chain of R
/// integrators.
pub(crate) fn spread<T: Real, const R: usize>(bandwidth: T, first: u8) -> [T; R] {
    let mut k = [T::zero(); R];
    for (degree, pole) in (first..).take(R).enumerate() {
        multiply(&mut k, degree, &[T::lit(f64::from(pole)) * bandwidth]);
    }
    k
}

/// Multiplies a monic polynomial of `degree`, its coefficients below the leading one in `k`, low
/// order first, by the monic one whose coefficients below the leading one are `factor`.
fn multiply<T: Real, const R: usize, const N: usize>(k: &mut [T; R], degree: usize, factor: &[T; N]) {
    let old = *k;
    for (j, k) in k.iter_mut().enumerate().take(degree + N) {
        let at = |shift: usize| match j.checked_sub(shift) {
            Some(i) if i == degree => T::one(),
            Some(i) => old.get(i).copied().unwrap_or_else(T::zero),
            None => T::zero(),
        };
        *k = factor.iter().enumerate().rev().fold(at(N), |sum, (shift, &c)| sum + c * at(shift));
    }
}

/// The gains k₀ … k_{R−1}, low order first, that place `poles` on a chain of R integrators.
///
/// # Errors
/// The poles are not R, or one of them is not in the open left half-plane, or further from zero
/// than [its range](crate::ranges::POLE).
pub fn place<T: Real, const R: usize>(poles: &[Pole<T>]) -> Result<[T; R], GainError<T>> {
    let given = poles.iter().map(|pole| if matches!(pole, Pole::Real(_)) { 1 } else { 2 }).sum();
    if given != R {
        return Err(GainError::PoleCount { expected: R, given });
    }
    // A monic polynomial below its leading term, low order first, padded with zeros above its
    // degree.
    let mut k = [T::zero(); R];
    let mut degree = 0;
    for pole in poles {
        let (re, im) = match *pole {
            Pole::Real(re) => (re, T::zero()),
            Pole::Pair { re, im } => (re, im),
        };
        if re >= T::zero() || !re.is_finite() || !im.is_finite() {
            return Err(GainError::UnstablePole { re });
        }
        let size = re.abs().max(im.abs());
        POLE.check(size).map_err(|OutOfRange { max, .. }| GainError::PoleTooFast { size, limit: max })?;
        match pole {
            Pole::Real(_) => {
                multiply(&mut k, degree, &[-re]);
                degree += 1;
            }
            Pole::Pair { .. } => {
                multiply(&mut k, degree, &[re * re + im * im, -(re + re)]);
                degree += 2;
            }
        }
    }
    Ok(k)
}

/// Whether sᴿ + k_{R−1} s^{R−1} + … + k₀ has all its roots in the open left half-plane:
/// Routh's criterion.
pub fn is_hurwitz<T: Real, const R: usize>(k: &[T; R]) -> bool {
    const { assert!(R >= 1 && R <= 7) };
    // Two rows of Routh's table: coefficients of sᴿ, sᴿ⁻², … and of sᴿ⁻¹, sᴿ⁻³, …
    let coefficient = |below: usize| match below {
        0 => T::one(),
        n if n <= R => k[R - n],
        _ => T::zero(),
    };
    let mut upper: [T; 5] = core::array::from_fn(|i| coefficient(2 * i));
    let mut lower: [T; 5] = core::array::from_fn(|i| coefficient(2 * i + 1));
    for _ in 0..R {
        if !(lower[0] > T::zero() && lower[0].is_finite()) {
            return false;
        }
        let ratio = upper[0] / lower[0];
        let mut next = [T::zero(); 5];
        for i in 0..4 {
            next[i] = upper[i + 1] - ratio * lower[i + 1];
        }
        upper = lower;
        lower = next;
    }
    true
}

/// Checks the gains `k` of `output` (1 to 4), with `integral` action where the closed loop is s
/// (sᴿ + … + k₀) + k̃, N = R + 1.
pub(crate) fn check<T: Real, const R: usize, const N: usize>(
    output: usize,
    k: &[T; R],
    integral: T,
) -> Result<(), GainError<T>> {
    const { assert!(N == R + 1) };
    if !is_hurwitz(k) {
        return Err(GainError::NotHurwitz { output });
    }
    let stable = |integral: T| {
        let mut closed = [T::zero(); N];
        closed[0] = integral;
        closed[1..].copy_from_slice(k);
        is_hurwitz(&closed)
    };
    if integral == T::zero() || stable(integral) {
        return Ok(());
    }
    // The limit between 0, where the loop is stable, and a gain where it is not: by bisection,
    // once, at set-up.
    let half = T::lit(0.5);
    let mut low = T::zero();
    let mut high = if integral > T::zero() && integral.is_finite() { integral } else { T::lit(1e12) };
    for _ in 0..200 {
        let middle = (low + high) * half;
        if stable(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Err(GainError::Integral { output, value: integral, limit: high })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_poles_give_binomial_gains() {
        let k: [f64; 6] = place(&[Pole::Real(-2.0); 6]).unwrap();
        assert_eq!(k, [64.0, 192.0, 240.0, 160.0, 60.0, 12.0]);
    }

    #[test]
    fn spread_poles_and_pairs_multiply_out() {
        let poles = [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0].map(Pole::Real);
        let k: [f64; 6] = place(&poles).unwrap();
        assert_eq!(k, [720.0, 1764.0, 1624.0, 735.0, 175.0, 21.0]);
        // (s + 3) ((s + 1)² + 4) = s³ + 5 s² + 11 s + 15.
        let k: [f64; 3] = place(&[Pole::Real(-3.0), Pole::Pair { re: -1.0, im: 2.0 }]).unwrap();
        assert_eq!(k, [15.0, 11.0, 5.0]);
    }

    #[test]
    fn spread_gains_are_those_of_their_poles() {
        let poles = [-2.0, -4.0, -6.0, -8.0, -10.0, -12.0].map(Pole::Real);
        assert_eq!(place(&poles), Ok(spread::<f64, 6>(2.0, 1)));
        assert_eq!(place(&[-3.0, -4.5].map(Pole::Real)), Ok(spread::<f64, 2>(1.5, 2)));
    }

    #[test]
    fn bad_poles_are_refused() {
        let count: Result<[f64; 3], _> = place(&[Pole::Real(-1.0)]);
        assert_eq!(count, Err(GainError::PoleCount { expected: 3, given: 1 }));
        let fast: Result<[f32; 6], _> = place(&[Pole::Real(-1e20); 6]);
        assert!(matches!(fast, Err(GainError::PoleTooFast { .. })), "{fast:?}");
        for re in [0.0, 1.0, f64::NAN] {
            let unstable: Result<[f64; 1], _> = place(&[Pole::Real(re)]);
            assert!(matches!(unstable, Err(GainError::UnstablePole { .. })), "{re}");
        }
    }

    #[test]
    fn routh_agrees_with_known_roots() {
        assert!(is_hurwitz(&[2.0, 3.0]));
        assert!(!is_hurwitz(&[-2.0, 1.0]));
        // s³ + s² + 2 s + 8 = (s + 2)(s² − s + 4).
        assert!(!is_hurwitz(&[8.0, 2.0, 1.0]));
        assert!(!is_hurwitz(&[f64::NAN, 1.0]));
    }

    #[test]
    fn integral_limit_is_where_a_root_crosses() {
        // s (s + 2)⁶ + k̃: a root crosses at s = jω where the phase of jω (jω + 2)⁶ is −π, so
        // atan(ω/2) = π/12.
        let omega = 2.0 * libm::tan(core::f64::consts::PI / 12.0);
        let limit = omega * libm::pow(omega * omega + 4.0, 3.0);
        let k: [f64; 6] = place(&[Pole::Real(-2.0); 6]).unwrap();
        assert_eq!(check::<_, 6, 7>(1, &k, 0.99 * limit), Ok(()));
        for integral in [120.0, -1.0, f64::INFINITY] {
            match check::<_, 6, 7>(1, &k, integral) {
                Err(GainError::Integral { output: 1, limit: found, .. }) if integral > 0.0 => {
                    assert!((found / limit - 1.0).abs() < 1e-9, "{found} against {limit}");
                }
                Err(GainError::Integral { .. }) => assert!(integral < 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}
