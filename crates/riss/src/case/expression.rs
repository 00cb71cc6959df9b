//! Expressions of the case file: `2*y^2 - sin(pi*x)`, compiled once, evaluated without allocation.
//!
//! Precedence as on paper: `-x^2` is `-(x^2)`, `2^3^2` is `2^9`. The grammar is `expression.pest`. A ready evaluator such
//! as exmex would do, but binds a minus sign tighter than `^` and cannot read `1e-1`.

use crate::math::Vector3;
use crate::model::FieldPoint;
use pest::Parser;
use pest::error::{Error, ErrorVariant, InputLocation};
use pest::iterators::{Pair, Pairs};
use pest::pratt_parser::{Assoc, Op, PrattParser};
use std::sync::LazyLock;

type Unary = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

/// What an expression may depend on; the last two only in space.
const VARIABLES: [&str; 6] = ["x", "y", "nx", "ny", "z", "nz"];
/// How many of them there are in the plane.
const IN_PLANE: usize = 4;
/// Functions of one argument.
const UNARY: [(&str, Unary); 17] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sqrt", f64::sqrt),
    ("abs", f64::abs),
    ("sign", sign),
    ("floor", f64::floor),
    ("ceil", f64::ceil),
];
/// Functions of two arguments.
const BINARY: [(&str, Binary); 4] =
    [("min", f64::min), ("max", f64::max), ("atan2", f64::atan2), ("hypot", f64::hypot)];
/// Whether a name means something in every expression.
pub(super) fn is_reserved(name: &str) -> bool {
    let functions = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0));
    VARIABLES.into_iter().chain(["pi", "PI", "π"]).chain(functions).any(|n| n == name)
}

/// Longer texts are no expressions.
const MAX_LENGTH: usize = 1000;
/// Nesting and intermediate values that are provided for.
const MAX_DEPTH: usize = 32;

/// From the loosest operator to the tightest.
static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    let (left, right) = (Assoc::Left, Assoc::Right);
    PrattParser::new()
        .op(Op::infix(Rule::add, left) | Op::infix(Rule::subtract, left))
        .op(Op::infix(Rule::multiply, left) | Op::infix(Rule::divide, left))
        .op(Op::prefix(Rule::signs))
        .op(Op::infix(Rule::power, right))
});

#[derive(pest_derive::Parser)]
#[grammar = "case/expression.pest"]
struct Grammar;

/// A compiled expression.
#[derive(Clone, Debug)]
pub(super) struct Expression {
    steps: Vec<Step>,
}

/// One step on a stack of values.
#[derive(Clone, Copy, Debug)]
enum Step {
    Number(f64),
    Variable(usize),
    Negate,
    Unary(Unary),
    Binary(Binary),
}

/// Why a text is no expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BadExpression {
    pub message: String,
    /// A name that is not known, and those that are.
    pub unknown: Option<(String, Vec<&'static str>)>,
}

impl BadExpression {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), unknown: None }
    }
}

impl Expression {
    /// Compiles a text for the plane.
    pub fn parse(text: &str) -> Result<Self, BadExpression> {
        let names = || VARIABLES[..IN_PLANE].iter().copied().chain(["pi"]).collect();
        let is_spatial = |name: &&str| VARIABLES[IN_PLANE..].contains(name);
        let expression = Self::parse_in_space(text).map_err(|mut bad| {
            bad.unknown.iter_mut().for_each(|(_, known)| known.retain(|name| !is_spatial(name)));
            bad
        })?;
        let stranger = expression.steps.iter().find_map(|s| match s {
            Step::Variable(k) if *k >= IN_PLANE => Some(VARIABLES[*k]),
            Step::Variable(_) | Step::Number(_) | Step::Negate | Step::Unary(_) | Step::Binary(_) => None,
        });
        match stranger {
            Some(name) => Err(unknown(format!("unknown variable `{name}`"), name, names())),
            None => Ok(expression),
        }
    }

    /// Compiles a text that may depend on z and nz too.
    pub fn parse_in_space(text: &str) -> Result<Self, BadExpression> {
        if text.len() > MAX_LENGTH {
            return Err(BadExpression::new(format!("an expression has at most {MAX_LENGTH} characters")));
        }
        // Before the parser sees it, because it calls itself for every parenthesis.
        if nesting(text) > MAX_DEPTH {
            return Err(too_deep());
        }
        let mut whole = Grammar::parse(Rule::whole, text).map_err(|e| unexpected(text, &e))?;
        let sum = whole.next().ok_or_else(too_deep)?;
        let expression = Self { steps: compile(sum.into_inner(), 0)? };
        if expression.stack_depth() > MAX_DEPTH { Err(too_deep()) } else { Ok(expression) }
    }

    /// The value, if it depends on nothing.
    pub fn constant(&self) -> Option<f64> {
        let depends = self.steps.iter().any(|s| matches!(s, Step::Variable(_)));
        (!depends).then(|| self.run(&[0.0; VARIABLES.len()]))
    }

    /// The value at a point.
    pub fn value(&self, at: &FieldPoint) -> f64 {
        self.run(&[at.position.x, at.position.y, at.normal.x, at.normal.y, 0.0, 0.0])
    }

    /// The value at a point in space.
    pub fn value_in_space(&self, position: Vector3, normal: Vector3) -> f64 {
        self.run(&[position.x, position.y, normal.x, normal.y, position.z, normal.z])
    }

    fn run(&self, variables: &[f64; VARIABLES.len()]) -> f64 {
        let mut stack = [0.0; MAX_DEPTH];
        let mut n = 0;
        for step in &self.steps {
            match *step {
                Step::Number(v) => {
                    stack[n] = v;
                    n += 1;
                }
                Step::Variable(k) => {
                    stack[n] = variables[k];
                    n += 1;
                }
                Step::Negate => stack[n - 1] = -stack[n - 1],
                Step::Unary(f) => stack[n - 1] = f(stack[n - 1]),
                Step::Binary(f) => {
                    n -= 1;
                    stack[n - 1] = f(stack[n - 1], stack[n]);
                }
            }
        }
        stack[0]
    }

    fn stack_depth(&self) -> usize {
        let (mut n, mut deepest) = (0, 0);
        for step in &self.steps {
            match step {
                Step::Number(_) | Step::Variable(_) => n += 1,
                Step::Binary(_) => n -= 1,
                Step::Negate | Step::Unary(_) => {}
            }
            deepest = deepest.max(n);
        }
        deepest
    }
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}

/// Greatest number of parentheses that are open at once.
fn nesting(text: &str) -> usize {
    let (mut open, mut deepest) = (0usize, 0);
    for c in text.bytes() {
        match c {
            b'(' => open += 1,
            b')' => open = open.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(open);
    }
    deepest
}

/// The steps of a sum inside `depth` others.
fn compile(sum: Pairs<Rule>, depth: usize) -> Result<Vec<Step>, BadExpression> {
    // Powers nest to the right.
    let (mut powers, mut most) = (0, 0);
    for token in sum.clone() {
        match token.as_rule() {
            Rule::power => powers += 1,
            Rule::add | Rule::subtract | Rule::multiply | Rule::divide => powers = 0,
            _ => {}
        }
        most = most.max(powers);
    }
    let depth = depth + 1 + most;
    if depth > MAX_DEPTH {
        return Err(too_deep());
    }
    PRECEDENCE
        .map_primary(|operand| compile_operand(operand, depth))
        .map_prefix(|signs, steps| {
            let mut steps = steps?;
            if signs.as_str().matches('-').count() % 2 == 1 {
                steps.push(Step::Negate);
            }
            Ok(steps)
        })
        .map_infix(|left, operator, right| {
            let mut steps = left?;
            steps.extend(right?);
            steps.push(Step::Binary(match operator.as_rule() {
                Rule::add => |a, b| a + b,
                Rule::subtract => |a, b| a - b,
                Rule::multiply => |a, b| a * b,
                Rule::divide => |a, b| a / b,
                Rule::power => f64::powf,
                rule => unreachable!("{rule:?} is no operator of the grammar"),
            }));
            Ok(steps)
        })
        .parse(sum)
}

fn compile_operand(operand: Pair<Rule>, depth: usize) -> Result<Vec<Step>, BadExpression> {
    match operand.as_rule() {
        Rule::number => match operand.as_str().parse() {
            Ok(value) => Ok(vec![Step::Number(value)]),
            Err(_) => Err(BadExpression::new(format!("not a number: `{}`", operand.as_str()))),
        },
        Rule::name => variable(operand.as_str()).map(|step| vec![step]),
        Rule::call => call(operand.into_inner(), depth),
        Rule::group => compile(arguments(operand.into_inner()).next().ok_or_else(too_deep)?, depth),
        rule => unreachable!("{rule:?} is no operand of the grammar"),
    }
}

fn variable(name: &str) -> Result<Step, BadExpression> {
    if let Some(k) = VARIABLES.iter().position(|v| *v == name) {
        Ok(Step::Variable(k))
    } else if ["pi", "PI", "π"].contains(&name) {
        Ok(Step::Number(std::f64::consts::PI))
    } else {
        let names = VARIABLES.into_iter().chain(["pi"]).collect();
        Err(unknown(format!("unknown variable `{name}`"), name, names))
    }
}

/// A function: its name, then its arguments.
fn call(mut parts: Pairs<Rule>, depth: usize) -> Result<Vec<Step>, BadExpression> {
    let name = parts.next().map_or("", |p| p.as_str());
    let (step, wanted) = if let Some((_, f)) = UNARY.iter().find(|f| f.0 == name) {
        (Step::Unary(*f), 1)
    } else if let Some((_, f)) = BINARY.iter().find(|f| f.0 == name) {
        (Step::Binary(*f), 2)
    } else {
        let names = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0)).collect();
        return Err(unknown(format!("unknown function `{name}`"), name, names));
    };
    let mut steps = vec![];
    let mut n = 0;
    for argument in arguments(parts) {
        steps.extend(compile(argument, depth)?);
        n += 1;
    }
    if n != wanted {
        let plural = if wanted == 1 { "" } else { "s" };
        return Err(BadExpression::new(format!("`{name}` takes {wanted} argument{plural}, here it has {n}")));
    }
    steps.push(step);
    Ok(steps)
}

/// The sums between parentheses; the closing one is a rule of its own to be named in messages.
fn arguments(parts: Pairs<Rule>) -> impl Iterator<Item = Pairs<Rule>> {
    parts.filter(|p| p.as_rule() == Rule::sum).map(Pair::into_inner)
}

fn too_deep() -> BadExpression {
    BadExpression::new("this expression is nested too deeply")
}

/// What was expected and what is there.
fn unexpected(text: &str, error: &Error<Rule>) -> BadExpression {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    let expected: &[Rule] = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => positives,
        ErrorVariant::CustomError { .. } => &[],
    };
    let wanted = if expected.contains(&Rule::close) {
        "a closing parenthesis"
    } else if expected.contains(&Rule::EOI) {
        "an operator"
    } else {
        "a number, a name or a parenthesis"
    };
    let found = text[at..].chars().next().map_or("the end".to_string(), |c| format!("`{c}`"));
    let position = text[..at].chars().count() + 1;
    BadExpression::new(format!("not an expression: expected {wanted}, found {found} at character {position}"))
}

fn unknown(message: String, name: &str, names: Vec<&'static str>) -> BadExpression {
    BadExpression { message, unknown: Some((name.into(), names)) }
}

#[cfg(test)]
mod tests;
