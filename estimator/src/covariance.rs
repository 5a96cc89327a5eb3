//! A covariance, and what one scalar measurement makes of it. Both filters stand on this.

use model::Real;

/// Repeats a block for the numbers from 0 up to a bound below 16, each as a constant: an index that
/// can't fail, no loop, and nothing loaded twice. Half of what a filter costs is in such blocks.
macro_rules! unrolled {
    ($i:ident < $bound:expr, $body:block) => {
        $crate::covariance::unrolled!(@ $i $bound, $body, 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14)
    };
    (@ $i:ident $bound:expr, $body:block, $($number:literal)*) => {{
        $({
            let $i: usize = $number;
            if $i < $bound $body
        })*
    }};
}
pub(crate) use unrolled;

/// A symmetric, positive matrix of N rows: its lower triangle, row by row, SIZE = N (N + 1)/2
/// entries.
#[derive(Clone, Debug)]
pub(crate) struct Covariance<T, const N: usize, const SIZE: usize>(pub(crate) [T; SIZE]);

/// Where the entry of row `i` and column `j` stands, in either order.
#[inline(always)]
pub(crate) const fn at(i: usize, j: usize) -> usize {
    if i < j { j * (j + 1) / 2 + i } else { i * (i + 1) / 2 + j }
}

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

/// What a scalar was: K ν is to be added to the state, and how surprising it came.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Absorbed<T, const N: usize> {
    /// K.
    pub(crate) gain: [T; N],
    /// ν, within its bound.
    pub(crate) innovation: T,
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

impl<T: Real, const N: usize, const SIZE: usize> Covariance<T, N, SIZE> {
    const IS_TRIANGLE: () = assert!(2 * SIZE == N * (N + 1) && N < 16);

    /// Independent components of these standard deviations.
    pub(crate) fn diagonal(deviations: &[T; N]) -> Self {
        let () = Self::IS_TRIANGLE;
        let mut matrix = Self([T::zero(); SIZE]);
        for (i, &deviation) in deviations.iter().enumerate() {
            matrix.set(i, i, deviation * deviation);
        }
        matrix
    }

    /// An entry; zero outside.
    #[inline(always)]
    pub(crate) fn get(&self, i: usize, j: usize) -> T {
        self.0.get(at(i, j)).copied().unwrap_or_else(T::zero)
    }

    #[inline(always)]
    fn set(&mut self, i: usize, j: usize, value: T) {
        if let Some(entry) = self.0.get_mut(at(i, j)) {
            *entry = value;
        }
    }

    /// Adds to the variance of component `i`.
    #[inline(always)]
    pub(crate) fn add(&mut self, i: usize, variance: T) {
        self.set(i, i, self.get(i, i) + variance);
    }

    /// Both halves.
    pub(crate) fn full(&self) -> [[T; N]; N] {
        core::array::from_fn(|i| core::array::from_fn(|j| self.get(i, j)))
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
        unrolled!(i < N, {
            let mut sum = g[i];
            unrolled!(j < N, { sum += self.0[at(i, j)] * h[j] });
            s_prior += h[i] * (sum + g[i]);
            g[i] = sum;
        });
        let s = (s_prior + *variance).max(s_prior * T::lit(1.0 + SHARPEST));
        let per_s = T::one() / s;
        let kept = considered.map(|i| (i, self.get(i, i)));
        unrolled!(i < N, {
            let scaled = g[i] * per_s;
            unrolled!(j < i + 1, { self.0[at(i, j)] -= scaled * g[j] });
        });
        if let Some((i, kept)) = kept {
            self.set(i, i, kept);
        }
        let deviation = s.sqrt();
        let bounded = innovation.clamp(-deviation * T::lit(BOUND), deviation * T::lit(BOUND));
        Absorbed { gain: g.map(|g| g * per_s), innovation: bounded, surprise: innovation * innovation * per_s }
    }

    /// Keeps variances above `least`, which rounding could take to zero.
    #[inline(always)]
    pub(crate) fn floor(&mut self, least: T) {
        unrolled!(i < N, { self.0[at(i, i)] = self.0[at(i, i)].max(least) });
    }

    /// Whatever is less certain than such a variance is not known at all: it keeps that variance,
    /// and hangs together with nothing.
    pub(crate) fn limit(&mut self, most: &[(usize, T)]) {
        for &(component, most) in most {
            let entry = self.get(component, component);
            if entry > most || !entry.is_finite() {
                self.forget(component, most);
            }
        }
    }

    /// Forgets all that is known of a component but for its `variance`.
    pub(crate) fn forget(&mut self, component: usize, variance: T) {
        for i in 0..N {
            self.set(component, i, T::zero());
        }
        self.set(component, component, variance);
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
