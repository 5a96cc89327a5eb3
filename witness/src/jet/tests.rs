use super::{Dual, Scalar, Taylor};

type Series = Taylor<f64, 7>;

/// x(t) = 0.3 + 0.7 t − 0.4 t² + …, shifted by `value` at order zero.
fn series(value: f64) -> Series {
    Series { c: [value, 0.7, -0.4, 0.25, 0.6, -0.8, 0.35] }
}

/// Equal to the accuracy that seven orders of recurrences leave, relative to the larger of the
/// coefficient and 1.
fn assert_same(left: Series, right: Series) {
    for (order, (l, r)) in left.c.iter().zip(right.c).enumerate() {
        let bound = 1e-13 * r.abs().max(1.0);
        assert!((l - r).abs() <= bound, "order {order}: {l} against {r}");
    }
}

#[test]
fn functions_satisfy_their_identities_at_every_order() {
    let one = Series::constant(1.0);
    for value in [0.4, 1.0, 2.3] {
        let x = series(value);
        assert_same(x.sqrt() * x.sqrt(), x);
        assert_same(x.exp().ln(), x);
        assert_same(x.ln().exp(), x);
        assert_same(x / x, one);
        assert_same(x.powf(2.5), x * x * x.sqrt());
        assert_same(x.powi(5), x * x * x * x * x);
        assert_same(x.powi(-2), one / (x * x));
        let (sin, cos) = x.sin_cos();
        assert_same(sin * sin + cos * cos, one);
        assert_same(x.tan() * cos, sin);
        // The angle comes back whatever the (varying) radius.
        let radius = series(1.5);
        assert_same((radius * sin).atan2(radius * cos), x);
        let squared = (x * 2.0).exp();
        assert_same(x.tanh() * (squared + 1.0), squared - 1.0);
    }
}

#[test]
fn known_series_come_out() {
    let mut t = Series::constant(0.0);
    t.c[1] = 1.0;
    // Maclaurin series, from any table.
    assert_same(t.sin(), Series { c: [0.0, 1.0, 0.0, -1.0 / 6.0, 0.0, 1.0 / 120.0, 0.0] });
    assert_same(t.tanh(), Series { c: [0.0, 1.0, 0.0, -1.0 / 3.0, 0.0, 2.0 / 15.0, 0.0] });
    assert_same(t.atan2(Series::constant(1.0)), Series { c: [0.0, 1.0, 0.0, -1.0 / 3.0, 0.0, 1.0 / 5.0, 0.0] });
    assert_same((t + 1.0).ln(), Series { c: [0.0, 1.0, -1.0 / 2.0, 1.0 / 3.0, -1.0 / 4.0, 1.0 / 5.0, -1.0 / 6.0] });
    assert_same(t.powi(4), Series { c: [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0] });
}

/// A formula through every function.
fn formula<S: Scalar>(x: S) -> S {
    let wave = (x * 1.3).sin() + x.cos() * 0.5 + x.tan() * 0.1;
    let angle = (x + 0.2).atan2(x * x + 0.5);
    (wave.exp() + x.sqrt() * x.ln() - angle / (x.powf(1.7) + 2.0)) * x.tanh() - x.powi(3)
}

#[test]
fn dual_numbers_and_series_agree() {
    for x in [0.3, 0.9, 1.4] {
        let mut t = Series::constant(x);
        t.c[1] = 1.0;
        let series = formula(t);
        let nested = formula(Dual { value: Dual::<f64, 1>::variable(x, 0), parts: [Dual::<f64, 1>::constant(1.0)] });
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} {b}");
        close(series.c[0], formula(x));
        close(series.c[1], nested.value.parts[0]);
        close(2.0 * series.c[2], nested.parts[0].parts[0]);
    }
}
