//! Text to operations, with constant parts folded.

use super::{Constants, FormulaError, Op};
use pest::Parser;
use pest::error::{ErrorVariant, InputLocation};
use pest::iterators::{Pair, Pairs};
use pest::pratt_parser::{Assoc, PrattParser};
use std::sync::LazyLock;

/// The grammar's parser. In its own module, since the generated rules carry no documentation.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "describe/formula/grammar.pest"]
    pub struct FormulaParser;
}
use grammar::{FormulaParser, Rule};

/// Longest text and deepest nesting accepted: far beyond any curve, and within any thread's stack.
const MAX_LENGTH: usize = 4000;
const MAX_NESTING: usize = 50;
/// Integer powers up to here are products; above, and for fractions, the base must be positive.
const MAX_INTEGER_POWER: f64 = 1024.0;

static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    use pest::pratt_parser::Op;
    PrattParser::new()
        .op(Op::infix(Rule::add, Assoc::Left) | Op::infix(Rule::subtract, Assoc::Left))
        .op(Op::infix(Rule::multiply, Assoc::Left) | Op::infix(Rule::divide, Assoc::Left))
        .op(Op::prefix(Rule::negate))
        .op(Op::infix(Rule::power, Assoc::Right))
});

/// A part of a formula.
enum Part {
    Constant(f64),
    Code(Vec<Op>),
}

impl Part {
    fn code(self) -> Vec<Op> {
        match self {
            Self::Constant(value) => vec![Op::Constant(value)],
            Self::Code(code) => code,
        }
    }

    fn then(self, op: Op) -> Self {
        let mut code = self.code();
        code.push(op);
        Self::Code(code)
    }

    fn with(self, right: Self, op: Op) -> Self {
        let mut code = self.code();
        code.extend(right.code());
        code.push(op);
        Self::Code(code)
    }
}

/// A reason at a byte of the text.
type Fault = (usize, String);

pub fn parse(text: &str, constants: &Constants) -> Result<Vec<Op>, FormulaError> {
    let result = bound(text).and_then(|()| {
        let mut pairs = FormulaParser::parse(Rule::formula, text).map_err(|error| syntax(text, &error))?;
        let sum = pairs.next().and_then(|formula| formula.into_inner().next());
        sum.map_or_else(|| Err((0, "no formula".to_owned())), |sum| part(sum.into_inner(), constants))
    });
    result.map(Part::code).map_err(|(byte, message)| FormulaError {
        text: text.to_owned(),
        column: 1 + text.get(..byte).map_or(0, |before| before.chars().count()),
        message,
    })
}

/// Refuses text that would nest the parser's recursion too deeply.
fn bound(text: &str) -> Result<(), Fault> {
    if text.len() > MAX_LENGTH {
        return Err((MAX_LENGTH, format!("longer than {MAX_LENGTH} characters")));
    }
    let (mut depth, mut run) = (0_usize, 0_usize);
    for (byte, character) in text.char_indices() {
        // Signs and powers recurse to the right, so that a run of them nests as parentheses do.
        match character {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        run = match character {
            '-' | '^' => run + 1,
            '+' | '*' | '/' | ',' | '(' | ')' => 0,
            _ => run,
        };
        if depth > MAX_NESTING || run > MAX_NESTING {
            return Err((byte, format!("nested deeper than {MAX_NESTING}")));
        }
    }
    Ok(())
}

/// The grammar's complaint in words.
fn syntax(text: &str, error: &pest::error::Error<Rule>) -> Fault {
    let byte = match error.location {
        InputLocation::Pos(byte) | InputLocation::Span((byte, _)) => byte,
    };
    let found = text.get(byte..).and_then(|rest| rest.chars().next());
    let expected = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => {
            let value =
                positives.iter().any(|rule| matches!(rule, Rule::number | Rule::name | Rule::sum | Rule::call));
            if value { "a number, a name or `(`" } else { "an operator, `,` or `)`" }
        }
        ErrorVariant::CustomError { message } => message,
    };
    match found {
        Some(character) => (byte, format!("expected {expected}, found `{character}`")),
        None => (byte, format!("expected {expected}, found the end")),
    }
}

/// Compiles the inside of a `sum`.
fn part(pairs: Pairs<'_, Rule>, constants: &Constants) -> Result<Part, Fault> {
    PRECEDENCE
        .map_primary(|pair| primary(pair, constants))
        .map_prefix(|_, operand| {
            Ok(match operand? {
                Part::Constant(value) => Part::Constant(-value),
                code => code.then(Op::Negate),
            })
        })
        .map_infix(|left, operator, right| infix(left?, &operator, right?))
        .parse(pairs)
}

fn primary(pair: Pair<'_, Rule>, constants: &Constants) -> Result<Part, Fault> {
    let byte = pair.as_span().start();
    match pair.as_rule() {
        Rule::number => {
            let value: f64 = pair.as_str().parse().map_err(|error| (byte, format!("{error}")))?;
            finite(byte, value)
        }
        Rule::name => name(byte, pair.as_str(), constants),
        Rule::call => call(pair, constants),
        _ => part(pair.into_inner(), constants),
    }
}

fn name(byte: usize, word: &str, constants: &Constants) -> Result<Part, Fault> {
    if let Some(axis) = ["x", "y", "z"].iter().position(|&axis| axis == word) {
        return Ok(Part::Code(vec![Op::Coordinate(axis)]));
    }
    if word == "pi" {
        return Ok(Part::Constant(std::f64::consts::PI));
    }
    match constants.get(word) {
        Some(&value) => finite(byte, value),
        None => {
            let given: String = constants.keys().map(|name| format!(", {name}")).collect();
            Err((byte, format!("unknown name `{word}`; known here: x, y, z, pi{given}")))
        }
    }
}

fn call(pair: Pair<'_, Rule>, constants: &Constants) -> Result<Part, Fault> {
    let byte = pair.as_span().start();
    let mut inner = pair.into_inner();
    let word = inner.next().map_or("", |word| word.as_str());
    let mut arguments =
        inner.map(|argument| part(argument.into_inner(), constants)).collect::<Result<Vec<_>, _>>()?.into_iter();
    let (first, second, third) = (arguments.next(), arguments.next(), arguments.next());
    if word == "atan2" {
        return match (first, second, third) {
            (Some(Part::Constant(y)), Some(Part::Constant(x)), None) => finite(byte, y.atan2(x)),
            (Some(y), Some(x), None) => Ok(y.with(x, Op::Atan2)),
            _ => Err((byte, "`atan2` takes two arguments, y and x".to_owned())),
        };
    }
    let (op, function): (Op, fn(f64) -> f64) = match word {
        "sqrt" => (Op::Sqrt, f64::sqrt),
        "exp" => (Op::Exp, f64::exp),
        "ln" => (Op::Ln, f64::ln),
        "sin" => (Op::Sin, f64::sin),
        "cos" => (Op::Cos, f64::cos),
        "tanh" => (Op::Tanh, f64::tanh),
        _ => {
            let known = "sqrt, exp, ln, sin, cos, tanh, atan2";
            return Err((byte, format!("unknown function `{word}`; known: {known}")));
        }
    };
    match (first, second) {
        (Some(Part::Constant(value)), None) => finite(byte, function(value)),
        (Some(argument), None) => Ok(argument.then(op)),
        _ => Err((byte, format!("`{word}` takes one argument"))),
    }
}

fn infix(left: Part, operator: &Pair<'_, Rule>, right: Part) -> Result<Part, Fault> {
    use Part::{Code, Constant};
    let byte = operator.as_span().start();
    let rule = operator.as_rule();
    if let (Constant(a), Constant(b)) = (&left, &right) {
        let value = match rule {
            Rule::add => a + b,
            Rule::subtract => a - b,
            Rule::multiply => a * b,
            Rule::divide => a / b,
            _ => a.powf(*b),
        };
        return finite(byte, value);
    }
    Ok(match (rule, left, right) {
        (Rule::add, code, Constant(c)) | (Rule::add, Constant(c), code) => code.then(Op::Offset(c)),
        (Rule::subtract, code, Constant(c)) => code.then(Op::Offset(-c)),
        (Rule::subtract, Constant(c), code) => code.then(Op::Negate).then(Op::Offset(c)),
        (Rule::multiply, code, Constant(c)) | (Rule::multiply, Constant(c), code) => code.then(Op::Scale(c)),
        (Rule::divide, code, Constant(c)) => {
            finite(byte, 1.0 / c)?;
            code.then(Op::Scale(1.0 / c))
        }
        (Rule::add, a, b) => a.with(b, Op::Add),
        (Rule::subtract, a, b) => a.with(b, Op::Subtract),
        (Rule::multiply, a, b) => a.with(b, Op::Multiply),
        (Rule::divide, a, b) => a.with(b, Op::Divide),
        (_, base, Constant(exponent)) => base.then(constant_power(exponent)),
        (_, Constant(base), exponent) => {
            if base <= 0.0 {
                return Err((byte, format!("{base} to a power that varies is not a real function")));
            }
            exponent.then(Op::Scale(base.ln())).then(Op::Exp)
        }
        // aᵇ = exp(b ln a).
        (_, base, exponent @ Code(_)) => base.then(Op::Ln).with(exponent, Op::Multiply).then(Op::Exp),
    })
}

fn constant_power(exponent: f64) -> Op {
    if exponent.fract() == 0.0 && exponent.abs() <= MAX_INTEGER_POWER {
        Op::PowerInteger(exponent as i32)
    } else {
        Op::PowerReal(exponent)
    }
}

fn finite(byte: usize, value: f64) -> Result<Part, Fault> {
    if value.is_finite() {
        Ok(Part::Constant(value))
    } else {
        Err((byte, format!("this has no finite value ({value})")))
    }
}
