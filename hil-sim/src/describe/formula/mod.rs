//! Formulas in the position's coordinates x, y, z (metres in N, **z down**), for curves that are
//! written in a scenario file.
//!
//! A formula is parsed once into a flat list of operations and evaluated over any number type:
//! plain numbers, the controller's series and dual numbers in either scalar, and the witness's
//! jets. The grammar (`grammar.pest`) and the Pratt parser are the `pest` library's; expression
//! crates that evaluate directly either fix the number type or give errors without a place.
//!
//! | | |
//! |---|---|
//! | operators | `+ - * / ^`; `^` binds to the right and more tightly than a sign: `-x^2` is −(x²), `2^-1` is ½ |
//! | functions | `sqrt exp ln sin cos tanh`, `atan2(y, x)` |
//! | names | `x y z`, `pi`, and the constants given beside the formula |
//!
//! Every function here is analytic where it is defined. There is no `abs`, since the law needs six
//! derivatives.

mod analytic;
mod parse;

use parse::parse;
use std::collections::BTreeMap;

/// Named constants of a formula.
pub type Constants = BTreeMap<String, f64>;

/// What a formula may do with a number, whatever derivatives the number carries.
pub trait Number:
    Copy
    + std::ops::Add<Output = Self>
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
    + std::ops::Neg<Output = Self>
{
    /// A constant: all derivatives are zero.
    fn constant(value: f64) -> Self;
    /// The number times a constant.
    fn scale(self, factor: f64) -> Self;
    /// The number plus a constant.
    fn offset(self, constant: f64) -> Self;
    /// Integer power.
    fn powi(self, exponent: i32) -> Self;
    /// Real power of a positive number.
    fn powf(self, exponent: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine, in this order.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Angle of the point (`x`, `self`) from the first axis, rad.
    fn atan2(self, x: Self) -> Self;
}

/// One operation on the evaluation stack.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Op {
    Constant(f64),
    Coordinate(usize),
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Scale(f64),
    Offset(f64),
    PowerInteger(i32),
    PowerReal(f64),
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tanh,
    Atan2,
}

/// A parsed formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    text: String,
    code: Vec<Op>,
}

/// Where and why a text is not a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FormulaError {
    /// The text.
    pub text: String,
    /// The column of the first character at fault, from 1.
    pub column: usize,
    /// What is wrong there.
    pub message: String,
}

/// Characters that an error shows of a formula, about the place at fault.
const EXCERPT: usize = 80;

impl std::fmt::Display for FormulaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let start = self.column.saturating_sub(1 + EXCERPT / 2);
        let excerpt: String = self.text.chars().skip(start).take(EXCERPT).collect();
        let before = if start > 0 { "…" } else { "" };
        let after = if start + EXCERPT < self.text.chars().count() { "…" } else { "" };
        write!(f, "column {} of \"{before}{excerpt}{after}\": {}", self.column, self.message)
    }
}

impl std::error::Error for FormulaError {}

impl Formula {
    /// Parses `text` with the given named constants.
    ///
    /// # Errors
    /// The place and the reason, for text that is not a formula, an unknown name, or a constant
    /// part that has no finite value.
    pub fn parse(text: &str, constants: &Constants) -> Result<Self, FormulaError> {
        Ok(Self { text: text.to_owned(), code: parse(text, constants)? })
    }

    /// A constant.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { text: value.to_string(), code: vec![Op::Constant(value)] }
    }

    /// The text it was parsed from.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its value if it does not depend on the position.
    #[must_use]
    pub fn as_constant(&self) -> Option<f64> {
        match self.code[..] {
            [Op::Constant(value)] => Some(value),
            _ => None,
        }
    }

    /// The value at a position in N, m; not finite where the formula is not defined.
    pub fn evaluate<N: Number>(&self, [x, y, z]: [N; 3]) -> N {
        let coordinates = [x, y, z];
        let mut stack: Vec<N> = Vec::with_capacity(self.code.len());
        for op in &self.code {
            let result = match *op {
                Op::Constant(value) => N::constant(value),
                Op::Coordinate(axis) => coordinates[axis],
                Op::Add | Op::Subtract | Op::Multiply | Op::Divide | Op::Atan2 => {
                    let right = pop(&mut stack);
                    let left = pop(&mut stack);
                    match op {
                        Op::Add => left + right,
                        Op::Subtract => left - right,
                        Op::Multiply => left * right,
                        Op::Divide => left / right,
                        _ => left.atan2(right),
                    }
                }
                unary => {
                    let operand = pop(&mut stack);
                    match unary {
                        Op::Negate => -operand,
                        Op::Scale(factor) => operand.scale(factor),
                        Op::Offset(constant) => operand.offset(constant),
                        Op::PowerInteger(exponent) => operand.powi(exponent),
                        Op::PowerReal(exponent) => operand.powf(exponent),
                        Op::Sqrt => operand.sqrt(),
                        Op::Exp => operand.exp(),
                        Op::Ln => operand.ln(),
                        Op::Sin => operand.sin_cos().0,
                        Op::Cos => operand.sin_cos().1,
                        _ => operand.tanh(),
                    }
                }
            };
            stack.push(result);
        }
        pop(&mut stack)
    }
}

/// The stack's top; the parser makes only code that keeps one.
fn pop<N: Number>(stack: &mut Vec<N>) -> N {
    stack.pop().unwrap_or_else(|| N::constant(f64::NAN))
}

/// Plain numbers and the witness's jets.
impl<S: witness::jet::Scalar> Number for S {
    fn constant(value: f64) -> Self {
        S::constant(value)
    }
    fn scale(self, factor: f64) -> Self {
        self * factor
    }
    fn offset(self, constant: f64) -> Self {
        self + constant
    }
    fn powi(self, exponent: i32) -> Self {
        S::powi(self, exponent)
    }
    fn powf(self, exponent: f64) -> Self {
        S::powf(self, exponent)
    }
    fn sqrt(self) -> Self {
        S::sqrt(self)
    }
    fn exp(self) -> Self {
        S::exp(self)
    }
    fn ln(self) -> Self {
        S::ln(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        S::sin_cos(self)
    }
    fn tanh(self) -> Self {
        S::tanh(self)
    }
    fn atan2(self, x: Self) -> Self {
        S::atan2(self, x)
    }
}
