//! A covariance, and what one scalar measurement makes of it. Both filters stand on this.

use model::Real;

/// A symmetric, positive matrix: both halves are kept, and written together.
#[derive(Clone, Debug)]
pub(crate) struct Covariance<T, const N: usize>(pub(crate) [[T; N]; N]);

/// One scalar z = h·x + noise, with noise that may be correlated with x.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar<T, const N: usize> {
    /// What of the state is measured.
    pub(crate) h: [T; N],
    /// E(x · noise).
    pub(crate) correlation: [T; N],
    /// z less what was expected of it.
    pub(crate) innovation: T,
    /// Variance of the noise.
    pub(crate) variance: T,
}

impl<T: Real, const N: usize> Scalar<T, N> {
    /// A measurement of nothing yet.
    pub(crate) fn of(innovation: T, variance: T) -> Self {
        Self { h: [T::zero(); N], correlation: [T::zero(); N], innovation, variance }
    }
}

/// What a scalar was: its correction, and how surprising it came.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Absorbed<T, const N: usize> {
    /// K ν, to be added to the state.
    pub(crate) correction: [T; N],
    /// ν²/S: 1 in the mean where the noise is as told.
    pub(crate) surprise: T,
}

/// Innovations beyond so many of their standard deviations count as so many: bounded influence, and
/// never locked out.
const BOUND: f64 = 5.0;

/// A scalar counts as no sharper than this share of the prior variance, since what is left of it is
/// a difference that single precision has to hold. A start that knows nothing takes two fixes
/// rather than one.
const SHARPEST: f64 = 1e-3;

impl<T: Real, const N: usize> Covariance<T, N> {
    /// Independent components of these standard deviations.
    pub(crate) fn diagonal(deviations: &[T; N]) -> Self {
        let mut matrix = Self([[T::zero(); N]; N]);
        for (i, (row, &deviation)) in matrix.0.iter_mut().zip(deviations).enumerate() {
            if let Some(entry) = row.get_mut(i) {
                *entry = deviation * deviation;
            }
        }
        matrix
    }

    /// Takes in one scalar, with an `innovation` that is less what its batch has corrected already:
    /// g = P h + c, S = h·P h + 2 h·c + R, K = g/S, P ← P − g gᵀ/S.
    ///
    /// A `considered` component (Schmidt) has its variance left as it is; its gain is for the
    /// caller to leave out, its covariances follow the others' gains by the same formula.
    #[inline(never)]
    pub(crate) fn absorb(
        &mut self,
        scalar: &Scalar<T, N>,
        innovation: T,
        considered: Option<usize>,
    ) -> Absorbed<T, N> {
        let Scalar { h, correlation, variance, .. } = scalar;
        let mut g = *correlation;
        let mut s_prior = T::zero();
        for ((row, g), (&h_i, &c)) in self.0.iter().zip(&mut g).zip(h.iter().zip(correlation)) {
            *g += dot(row, h);
            s_prior += h_i * (*g + c);
        }
        let s = (s_prior + *variance).max(s_prior * T::lit(1.0 + SHARPEST));
        let per_s = T::one() / s;
        let kept = considered.and_then(|i| self.0.get(i)?.get(i).copied());
        for i in 0..N {
            let scaled = g[i] * per_s;
            for j in 0..N {
                // A bound that the compiler sees: an index that can't fail.
                if j > i {
                    break;
                }
                let entry = self.0[i][j] - scaled * g[j];
                self.0[i][j] = entry;
                self.0[j][i] = entry;
            }
        }
        if let (Some(i), Some(kept)) = (considered, kept)
            && let Some(entry) = self.0.get_mut(i).and_then(|row| row.get_mut(i))
        {
            *entry = kept;
        }
        let deviation = s.sqrt();
        let bounded = innovation.clamp(-deviation * T::lit(BOUND), deviation * T::lit(BOUND));
        let scale = bounded * per_s;
        Absorbed { correction: g.map(|g| g * scale), surprise: innovation * innovation * per_s }
    }

    /// Keeps variances above these, which rounding could take to zero.
    #[inline]
    pub(crate) fn floor(&mut self, least: &[T; N]) {
        for i in 0..N {
            self.0[i][i] = self.0[i][i].max(least[i]);
        }
    }

    /// Whatever is less certain than such a variance is not known at all: it keeps that variance,
    /// and hangs together with nothing.
    pub(crate) fn limit(&mut self, most: &[(usize, T)]) {
        for &(component, most) in most {
            let is_beyond = self
                .0
                .get(component)
                .and_then(|row| row.get(component))
                .is_some_and(|&entry| entry > most || !entry.is_finite());
            if is_beyond {
                self.forget(component, most);
            }
        }
    }

    /// Forgets all that is known of a component but for its `variance`.
    pub(crate) fn forget(&mut self, component: usize, variance: T) {
        for i in 0..N {
            if let Some(entry) = self.0[i].get_mut(component) {
                *entry = T::zero();
            }
        }
        if let Some(row) = self.0.get_mut(component) {
            *row = [T::zero(); N];
            if let Some(entry) = row.get_mut(component) {
                *entry = variance;
            }
        }
    }
}

/// The inner product.
#[inline(always)]
pub(crate) fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    let mut sum = T::zero();
    for (&a, &b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
