//! Numerical integration of ẋ = f(t, x): a fixed-step method for the simulation loop, an adaptive
//! one for references.

/// One step of the classical Runge-Kutta method, order 4, from `x` at time `t` over `step` seconds.
#[inline]
pub fn rk4_step<const N: usize>(f: impl Fn(f64, &[f64; N]) -> [f64; N], t: f64, x: &[f64; N], step: f64) -> [f64; N] {
    let rates = rk4_rates(|t, x| f(*t, x), &[t, t + 0.5 * step, t + step], x, step);
    rk4_end(x, &rates, step)
}

/// The rates at the four stages of such a step, with what acts at its beginning, middle and end.
#[inline]
pub fn rk4_rates<const N: usize, A>(
    f: impl Fn(&A, &[f64; N]) -> [f64; N],
    [begin, middle, end]: &[A; 3],
    x: &[f64; N],
    step: f64,
) -> [[f64; N]; 4] {
    let half = 0.5 * step;
    // Each is written where it stays.
    let mut rates = [[0.0; N]; 4];
    rates[0] = f(begin, x);
    rates[1] = f(middle, &advance(x, &rates[0], half));
    rates[2] = f(middle, &advance(x, &rates[1], half));
    rates[3] = f(end, &advance(x, &rates[2], step));
    rates
}

/// Where such a step from `x` ends.
#[inline]
pub fn rk4_end<const N: usize>(x: &[f64; N], [k1, k2, k3, k4]: &[[f64; N]; 4], step: f64) -> [f64; N] {
    let sixth = step / 6.0;
    let mut end = *x;
    for (i, end) in end.iter_mut().enumerate() {
        *end += sixth * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    }
    end
}

#[inline]
fn advance<const N: usize>(x: &[f64; N], rate: &[f64; N], step: f64) -> [f64; N] {
    let mut end = *x;
    for (end, rate) in end.iter_mut().zip(rate) {
        *end += step * rate;
    }
    end
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

/// An adaptive integration that could not reach its end: the step that the tolerance asks for
/// vanished, or there were too many.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("adaptive integration stopped at t = {0}")]
pub struct Stopped(pub f64);

/// Substeps of the midpoint rule in each column of the extrapolation: five of them make order 10.
const SUBSTEPS: [u32; 5] = [2, 4, 6, 8, 10];
/// The error that is measured is that of the column before the last, of order 8: in one step it
/// grows with the step's ninth power.
const ERROR_POWER: f64 = 1.0 / 9.0;
/// Steps, accepted or not: at order 10 a smooth system takes tens.
const MAX_STEPS: u32 = 100_000;

/// Integrates from `x` at `span[0]` to `span[1]`, ending there exactly, by Gragg's extrapolated
/// midpoint rule of order 10 (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I,
/// section II.9).
///
/// # Errors
/// [`Stopped`] if the steps become too small or too many, as where the solution has a pole or is
/// not finite.
pub fn adaptive<const N: usize>(
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    span: [f64; 2],
    x: &[f64; N],
    tolerance: Tolerance,
) -> Result<[f64; N], Stopped> {
    let [mut t, end] = span;
    let (mut x, mut step) = (*x, end - t);
    for _ in 0..MAX_STEPS {
        let left = end - t;
        if left == 0.0 {
            return Ok(x);
        }
        let is_last = step.abs() >= left.abs();
        if is_last {
            step = left;
        }
        if t + 0.1 * step == t {
            return Err(Stopped(t));
        }
        let (moved, error) = extrapolate(&f, t, &x, step, tolerance);
        if error <= 1.0 {
            (t, x) = (if is_last { end } else { t + step }, moved);
        }
        let change = 0.9 * error.powf(-ERROR_POWER);
        // An error that is no number shortens the step as much as one that is too large.
        step *= if change > 0.1 { change.min(4.0) } else { 0.1 };
    }
    Err(Stopped(t))
}

/// One step, and its error as a multiple of the tolerance: root mean square over the coordinates.
fn extrapolate<const N: usize>(
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
    t: f64,
    x: &[f64; N],
    step: f64,
    tolerance: Tolerance,
) -> ([f64; N], f64) {
    let first = f(t, x);
    let mut row = [[0.0; N]; SUBSTEPS.len()];
    let mut before = row;
    for (j, count) in SUBSTEPS.into_iter().enumerate() {
        let h = step / f64::from(count);
        let (mut last, mut now) = (*x, advance(x, &first, h));
        for substep in 1..count {
            let next = advance(&last, &f(t + h * f64::from(substep), &now), 2.0 * h);
            (last, now) = (now, next);
        }
        // Aitken's and Neville's scheme: the error is a series in h².
        row[0] = now;
        for k in 1..=j {
            let ratio = f64::from(count) / f64::from(SUBSTEPS[j - k]);
            let weight = 1.0 / (ratio * ratio - 1.0);
            row[k] = std::array::from_fn(|i| row[k - 1][i] + weight * (row[k - 1][i] - before[k - 1][i]));
        }
        before = row;
    }
    let [.., lower, moved] = row;
    let square = |i: usize| {
        let scale = tolerance.absolute + tolerance.relative * x[i].abs().max(moved[i].abs());
        ((moved[i] - lower[i]) / scale).powi(2)
    };
    let error = ((0..N).map(square).sum::<f64>() / N as f64).sqrt();
    (moved, error)
}
