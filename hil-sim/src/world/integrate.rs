//! Numerical integration of ẋ = f(t, x): a fixed-step method for the simulation loop, an adaptive
//! one for references.

use ode_solvers::{DVector, Dop853, OutputType, System};

/// One step of the classical Runge-Kutta method, order 4, from `x` at time `t` over `step` seconds.
#[inline]
pub fn rk4_step<const N: usize>(f: impl Fn(f64, &[f64; N]) -> [f64; N], t: f64, x: &[f64; N], step: f64) -> [f64; N] {
    let half = 0.5 * step;
    let k1 = f(t, x);
    let k2 = f(t + half, &advance(x, &k1, half));
    let k3 = f(t + half, &advance(x, &k2, half));
    let k4 = f(t + step, &advance(x, &k3, step));
    std::array::from_fn(|i| x[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}

#[inline]
fn advance<const N: usize>(x: &[f64; N], rate: &[f64; N], step: f64) -> [f64; N] {
    std::array::from_fn(|i| x[i] + step * rate[i])
}

/// `substeps` equal steps of [`rk4_step`] from `t` over `period` seconds: one control period, when
/// `f` holds the input.
#[inline]
pub fn rk4<const N: usize>(
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    x: &[f64; N],
    period: f64,
    substeps: u32,
) -> [f64; N] {
    let step = period / f64::from(substeps);
    let mut x = *x;
    for substep in 0..substeps {
        x = rk4_step(&f, t + step * f64::from(substep), &x, step);
    }
    x
}

/// Local error an adaptive integration accepts, per step and coordinate: absolute + relative·|x|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// In units of the coordinate.
    pub absolute: f64,
    /// Fraction of the coordinate.
    pub relative: f64,
}

/// An adaptive integration that could not reach its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped(String);

impl std::fmt::Display for Stopped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "adaptive integration failed: {}", self.0)
    }
}

impl std::error::Error for Stopped {}

/// A flow with time as its last coordinate.
///
/// `ode_solvers` 0.6.2 evaluates its twelfth stage at the start of the step instead of the end
/// (c12 = 0 in its table), which spoils every system that depends on time. As a coordinate, time is
/// right in all stages.
struct Flow<F, const N: usize>(F);

impl<F, const N: usize> System<f64, DVector<f64>> for Flow<F, N>
where
    F: Fn(f64, &[f64; N]) -> [f64; N],
{
    fn system(&self, _: f64, timed: &DVector<f64>, rate: &mut DVector<f64>) {
        let x = std::array::from_fn(|i| timed[i]);
        rate.as_mut_slice()[..N].copy_from_slice(&(self.0)(timed[N], &x));
        rate[N] = 1.0;
    }
}

/// Integrates from `x` at `span[0]` to `span[1]` by the Dormand-Prince method of order 8(5,3),
/// ending there exactly.
///
/// # Errors
/// [`Stopped`] if the steps become too small or too many, or the system stiff or not finite.
pub fn adaptive<const N: usize>(
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    span: [f64; 2],
    x: &[f64; N],
    tolerance: Tolerance,
) -> Result<[f64; N], Stopped> {
    let [start, end] = span;
    if start == end {
        return Ok(*x);
    }
    let timed = DVector::from_iterator(N + 1, x.iter().copied().chain([start]));
    let mut solver =
        Dop853::new(Flow::<_, N>(f), start, end, end - start, timed, tolerance.relative, tolerance.absolute);
    solver.set_output(OutputType::Sparse);
    solver.integrate().map_err(|error| Stopped(error.to_string()))?;
    let last = solver.y_out().last().ok_or_else(|| Stopped("no step was taken".to_owned()))?;
    Ok(std::array::from_fn(|i| last[i]))
}
