//! Every function of the series arithmetic, in every order, against Cauchy's integral: the Taylor
//! coefficients of an analytic f are cₖ = (1/2π) ∫ f(r e^{iθ}) r⁻ᵏ e^{−ikθ} dθ, which
//! the trapezoidal rule gives to rounding in complex arithmetic that shares nothing with the
//! recurrences under test.

use controller::{Analytic, Real, Series};
use controller::{Dual, variables};
use num_complex::Complex64;

/// Number of orders under test: all that the library has.
const N: usize = 7;
/// Coefficients of the arguments x(t) and y(t): values near 1.3 and 0.7, no coefficient zero, and
/// no zero within [`RADIUS`] of the origin.
const X: [f64; N] = [1.3, 0.4, -0.3, 0.25, 0.15, -0.2, 0.1];
const Y: [f64; N] = [0.7, -0.2, 0.15, 0.3, -0.1, 0.05, -0.15];
/// Of the circle of integration: inside every convergence radius here.
const RADIUS: f64 = 0.6;
/// Points on it; aliasing falls as (r/R)^POINTS, below rounding.
const POINTS: usize = 256;

type Function<A> = fn(A, A) -> A;

fn polynomial(c: &[f64; N], t: Complex64) -> Complex64 {
    c.iter().rev().fold(Complex64::default(), |sum, &c| sum * t + c)
}

/// Taylor coefficients of f(x(t), y(t)).
fn cauchy(f: Function<Complex64>) -> [f64; N] {
    let mut c = [0.0; N];
    for point in 0..POINTS {
        let angle = std::f64::consts::TAU * point as f64 / POINTS as f64;
        let t = Complex64::from_polar(RADIUS, angle);
        let value = f(polynomial(&X, t), polynomial(&Y, t));
        for (k, c) in c.iter_mut().enumerate() {
            *c += (value * t.powi(-(k as i32))).re / POINTS as f64;
        }
    }
    c
}

/// tan θ = y/x through the complex logarithm, on the branch of the arguments' values.
fn atan2(y: Complex64, x: Complex64) -> Complex64 {
    let i = Complex64::i();
    -i * ((x + i * y) / (x * x + y * y).sqrt()).ln()
}

/// Name, function on complex numbers, and the same on series.
fn functions<T: Real, A: Analytic<T>>() -> Vec<(&'static str, Function<Complex64>, Function<A>)> {
    vec![
        ("x + y", |x, y| x + y, |x, y| x + y),
        ("x - y", |x, y| x - y, |x, y| x - y),
        ("-x", |x, _| -x, |x, _| -x),
        ("x * y", |x, y| x * y, |x, y| x * y),
        ("x / y", |x, y| x / y, |x, y| x / y),
        ("x + c", |x, _| x + 0.3, |x, _| x + T::lit(0.3)),
        ("x - c", |x, _| x - 0.3, |x, _| x - T::lit(0.3)),
        ("x * c", |x, _| x * 0.3, |x, _| x * T::lit(0.3)),
        ("x / c", |x, _| x / 0.3, |x, _| x / T::lit(0.3)),
        ("constant", |_, _| Complex64::from(0.3), |_, _| A::constant(T::lit(0.3))),
        ("square", |x, _| x * x, |x, _| x.square()),
        ("recip", |x, _| x.inv(), |x, _| x.recip()),
        ("sqrt", |x, _| x.sqrt(), |x, _| x.sqrt()),
        ("rsqrt", |x, _| x.sqrt().inv(), |x, _| x.rsqrt()),
        ("powi 0", |_, _| Complex64::from(1.0), |x, _| x.powi(0)),
        ("powi 1", |x, _| x, |x, _| x.powi(1)),
        ("powi 7", |x, _| x.powi(7), |x, _| x.powi(7)),
        ("powi -3", |x, _| x.powi(-3), |x, _| x.powi(-3)),
        ("powi 4 below zero", |x, _| (-x).powi(4), |x, _| (-x).powi(4)),
        ("powf 2.5", |x, _| x.powf(2.5), |x, _| x.powf(T::lit(2.5))),
        ("powf -0.7", |x, _| x.powf(-0.7), |x, _| x.powf(T::lit(-0.7))),
        ("exp", |x, _| x.exp(), |x, _| x.exp()),
        ("ln", |x, _| x.ln(), |x, _| x.ln()),
        ("sin", |x, _| x.sin(), |x, _| x.sin()),
        ("cos", |x, _| x.cos(), |x, _| x.cos()),
        ("atan2, first quadrant", |x, y| atan2(y, x), |x, y| y.atan2(x)),
        ("atan2, third quadrant", |x, y| atan2(y, x) - std::f64::consts::PI, |x, y| (-y).atan2(-x)),
        ("atan2, fourth quadrant", |x, y| -atan2(y, x), |x, y| (-y).atan2(x)),
        ("tanh", |x, _| x.tanh(), |x, _| x.tanh()),
        ("all together", |x, y| (x.sin() * y.exp() / x.sqrt()).tanh(), |x, y| (x.sin() * y.exp() / x.sqrt()).tanh()),
    ]
}

fn series<T: Real>(c: &[f64; N]) -> Series<T, N> {
    Series(c.map(T::lit))
}

/// Each coefficient's error, relative to the largest coefficient up to its order (a recurrence
/// can't keep more than that).
fn assert_close<T: Real>(name: &str, got: &Series<T, N>, expected: &[f64; N], bound: f64) {
    let mut scale: f64 = 0.0;
    for (k, (got, expected)) in got.0.iter().zip(expected).enumerate() {
        scale = scale.max(expected.abs());
        let error = (got.to_f64() - expected).abs() / scale;
        assert!(error <= bound, "{name}, order {k}: {got} for {expected}, off by {error:e}");
    }
}

fn check_values<T: Real>(bound: f64) {
    for (name, complex, function) in functions::<T, Series<T, N>>() {
        assert_close(name, &function(series(&X), series(&Y)), &cauchy(complex), bound);
    }
}

/// A dual number's derivative in direction (u, v), against the extra derivative of a function of
/// t + s along it: with u = ẋ and v = ẏ that is the time derivative, which the series knows by
/// itself.
fn check_partials<T: Real>(bound: f64) {
    const M: usize = N - 1;
    for (name, complex, function) in functions::<T, Dual<Series<T, M>, 2>>() {
        let along: [Series<T, N>; 2] = [series(&X), series(&Y)];
        let [x, y] = variables(along.map(|c| c.truncate::<M>()));
        let result = function(x, y);
        let [rate_x, rate_y] = along.map(|c| c.differentiate::<M>());
        let rate = result.partials[0] * rate_x + result.partials[1] * rate_y;
        // The derivative's coefficient k is k + 1 times the function's coefficient k + 1; of the
        // last nothing is known.
        let exact = cauchy(complex);
        let mut expected = [0.0; N];
        for (k, c) in exact.iter().enumerate().skip(1) {
            expected[k - 1] = k as f64 * c;
        }
        let mut got = [T::zero(); N];
        got[..M].copy_from_slice(&rate.0);
        if expected.iter().any(|c| c.abs() > 1e-9) {
            assert_close(name, &Series(got), &expected, bound);
        } else {
            assert!(got.iter().all(|c| c.to_f64().abs() < bound), "{name} is constant");
        }
    }
}

/// Some tens of roundings; unit roundoff is 1.1e-16 and 6e-8. In f64 the integral's own rounding, ε
/// r⁻⁶, is 5e-15 of it.
const F64: f64 = 2e-14;
const F32: f64 = 4e-6;

#[test]
fn series_f64() {
    check_values::<f64>(F64);
}

#[test]
fn series_f32() {
    check_values::<f32>(F32);
}

#[test]
fn duals_of_series_f64() {
    check_partials::<f64>(10.0 * F64);
}

#[test]
fn duals_of_series_f32() {
    check_partials::<f32>(10.0 * F32);
}

/// Outside a domain nothing panics, and the result says so.
#[test]
fn outside_their_domain_functions_are_not_finite() {
    let below = series::<f32>(&X) * -1.0;
    let zero = Series::<f32, N>([0.0; N]);
    let undefined = [below.sqrt(), below.rsqrt(), below.ln(), below.powf(0.5), zero.recip(), zero.ln(), zero.rsqrt()];
    for (case, result) in undefined.iter().enumerate() {
        assert!(!result.0.iter().all(|c| c.is_finite()), "case {case}: {result:?}");
    }
}
