//! Formulas: values, precedence, errors with their column, and totality of the parser.

use hil_sim::describe::formula::{Constants, Formula};
use proptest::prelude::*;
use witness::jet::{Scalar, Taylor};

fn constants() -> Constants {
    [("r".to_owned(), 5.0), ("height".to_owned(), -10.0)].into()
}

fn value(text: &str, p: [f64; 3]) -> f64 {
    Formula::parse(text, &constants()).unwrap_or_else(|error| panic!("{error}")).evaluate(p)
}

#[test]
fn values_are_those_of_the_written_expression() {
    let [x, y, z] = [1.3_f64, -0.7, 2.1];
    let cases: [(&str, f64); 22] = [
        ("x", x),
        (" ( x / 5 )^4 + (y/4)^4 - 1", (x / 5.0).powi(4) + (y / 4.0).powi(4) - 1.0),
        ("z + 10 - 0.5*sin(x/2)", z + 10.0 - 0.5 * (x / 2.0).sin()),
        ("-x^2", -(x * x)),
        ("(-x)^2", x * x),
        ("2^3^2", 512.0),
        ("x^-1", 1.0 / x),
        ("2 - 3 - 4", -5.0),
        ("x - y - z", x - y - z),
        ("12/3/2", 2.0),
        ("z / x / y", z / x / y),
        ("--x", x),
        ("2*-x", -2.0 * x),
        ("x^2.5", x.powf(2.5)),
        ("2^x", 2.0_f64.powf(x)),
        ("x^z", x.powf(z)),
        ("3 - x", 3.0 - x),
        ("3 / x", 3.0 / x),
        ("atan2(y, x) + tanh(z)*exp(y)", y.atan2(x) + z.tanh() * y.exp()),
        ("sqrt(x^2 + y^2) - r", (x * x + y * y).sqrt() - 5.0),
        ("ln(x)*cos(pi*y) - height", x.ln() * (std::f64::consts::PI * y).cos() + 10.0),
        ("1.5e1 + .5 + 2.", 17.5),
    ];
    for (text, expected) in cases {
        let found = value(text, [x, y, z]);
        // A few roundings each way.
        assert!((found - expected).abs() <= 1e-14 * expected.abs().max(1.0), "{text}: {found} against {expected}");
    }
}

#[test]
fn constant_parts_fold() {
    let formula = Formula::parse("2*r^2 + sin(pi/2) - height", &constants()).unwrap();
    assert_eq!(formula.as_constant(), Some(61.0));
    assert_eq!(Formula::parse("x - x", &constants()).unwrap().as_constant(), None);
}

/// Along a straight line the formula's jet is that of the same expression written in Rust.
#[test]
fn jets_go_through() {
    type Series = Taylor<f64, 7>;
    let line = |at: f64, rate: f64| {
        let mut series = Series::constant(at);
        series.c[1] = rate;
        series
    };
    let p = [line(1.2, 0.5), line(-0.4, 0.9), line(0.3, -0.2)];
    let formula = Formula::parse("x^1.7*exp(y) / (1 + z^2) - tanh(x*y)^3", &constants()).unwrap();
    let [x, y, z] = p;
    let expected = x.powf(1.7) * y.exp() / (z.powi(2) + 1.0) - (x * y).tanh().powi(3);
    for (order, (found, expected)) in formula.evaluate(p).c.iter().zip(expected.c).enumerate() {
        assert!((found - expected).abs() <= 1e-13 * expected.abs().max(1.0), "order {order}: {found}, {expected}");
    }
}

#[test]
fn errors_point_at_the_column() {
    let cases = [
        ("", 1, "expected a number"),
        ("x +", 4, "found the end"),
        ("x + * 3", 5, "expected a number"),
        ("(x/5)^4 + (u/4)^4", 12, "unknown name `u`"),
        ("x + sine(y)", 5, "unknown function `sine`"),
        ("sin(x, y)", 1, "one argument"),
        ("atan2(x)", 1, "two arguments"),
        ("2 x", 3, "expected an operator"),
        ("(x + 1", 7, "found the end"),
        ("x + ln(0)", 5, "no finite value"),
        ("x/(1 - 1)", 2, "no finite value"),
        ("1e999 + x", 1, "no finite value"),
        ("(-2)^x", 5, "not a real function"),
        ("abs(x)", 1, "unknown function"),
        ("µ*x", 1, "expected a number"),
        ("x + µ", 5, "expected a number"),
    ];
    for (text, column, message) in cases {
        let error = Formula::parse(text, &constants()).expect_err(text);
        assert_eq!(error.column, column, "{error}");
        assert!(error.message.contains(message), "{error}");
    }
}

#[test]
fn nesting_is_bounded() {
    for text in ["(".repeat(3000), "-".repeat(3000), "x^".repeat(1900), "sin(".repeat(900), "x".repeat(5000)] {
        assert!(Formula::parse(&text, &constants()).is_err());
    }
    // A long sum is no deep one.
    let sum = "x+".repeat(1500) + "x";
    assert_eq!(value(&sum, [1.0, 0.0, 0.0]), 1501.0);
}

proptest! {
    /// Whatever the text, the parser answers.
    #[test]
    fn parsing_is_total(text in "[-+*/^()xyz,. 0-9a-e]{0,60}") {
        if let Ok(formula) = Formula::parse(&text, &constants()) {
            let _ = formula.evaluate([1.0, 2.0, 3.0]);
        }
    }
}

/// Of a long formula the part that matters.
#[test]
fn an_error_shows_an_excerpt() {
    let text = format!("{}q{}", "x + ".repeat(400), " + y".repeat(400));
    let error = Formula::parse(&text, &constants()).unwrap_err();
    let shown = error.to_string();
    assert_eq!(error.column, 1601);
    assert!(shown.contains("column 1601 of \"…x + ") && shown.contains("q + y"), "{shown}");
    assert!(shown.chars().count() < 200, "{shown}");
    assert!(Formula::parse("x + q", &constants()).unwrap_err().to_string().contains("column 5 of \"x + q\":"));
}
