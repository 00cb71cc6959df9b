//! Expressions of the case file: `2*y^2 - sin(pi*x)`, compiled once, evaluated without allocation.
//!
//! Precedence as on paper: `-x^2` is `-(x^2)`, `2^3^2` is `2^9`.

use crate::model::FieldPoint;

type Unary = fn(f64) -> f64;
type Binary = fn(f64, f64) -> f64;

/// What an expression may depend on.
const VARIABLES: [&str; 4] = ["x", "y", "nx", "ny"];
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
/// Longer texts are no expressions.
const MAX_LENGTH: usize = 1000;
/// Nesting and intermediate values that are provided for.
const MAX_DEPTH: usize = 32;

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
    /// Compiles a text.
    pub fn parse(text: &str) -> Result<Self, BadExpression> {
        if text.len() > MAX_LENGTH {
            return Err(BadExpression::new(format!("an expression has at most {MAX_LENGTH} characters")));
        }
        let mut parser = Parser { text, at: 0, depth: 0, steps: vec![] };
        parser.sum()?;
        if !parser.rest().is_empty() {
            return Err(parser.unexpected("an operator"));
        }
        let expression = Self { steps: parser.steps };
        match expression.stack_depth() <= MAX_DEPTH {
            true => Ok(expression),
            false => Err(BadExpression::new("this expression is nested too deeply")),
        }
    }

    /// The value, if it depends on nothing.
    pub fn constant(&self) -> Option<f64> {
        let depends = self.steps.iter().any(|s| matches!(s, Step::Variable(_)));
        (!depends).then(|| self.run(&[0.0; VARIABLES.len()]))
    }

    /// The value at a point.
    pub fn value(&self, at: &FieldPoint) -> f64 {
        self.run(&[at.position.x, at.position.y, at.normal.x, at.normal.y])
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

struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    steps: Vec<Step>,
}

impl<'t> Parser<'t> {
    /// What is left, blanks skipped.
    fn rest(&mut self) -> &'t str {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        rest
    }

    fn take(&mut self, symbol: &str) -> bool {
        let found = self.rest().starts_with(symbol);
        if found {
            self.at += symbol.len();
        }
        found
    }

    fn binary(&mut self, f: Binary) {
        self.steps.push(Step::Binary(f));
    }

    /// `term + term - term`
    fn sum(&mut self) -> Result<(), BadExpression> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(BadExpression::new("this expression is nested too deeply"));
        }
        self.product()?;
        loop {
            if self.take("+") {
                self.product()?;
                self.binary(|a, b| a + b);
            } else if self.take("-") {
                self.product()?;
                self.binary(|a, b| a - b);
            } else {
                self.depth -= 1;
                return Ok(());
            }
        }
    }

    /// `factor * factor / factor`
    fn product(&mut self) -> Result<(), BadExpression> {
        self.factor()?;
        loop {
            if self.take("*") {
                self.factor()?;
                self.binary(|a, b| a * b);
            } else if self.take("/") {
                self.factor()?;
                self.binary(|a, b| a / b);
            } else {
                return Ok(());
            }
        }
    }

    /// `-factor`, `atom`, or `atom ^ factor`
    fn factor(&mut self) -> Result<(), BadExpression> {
        let mut negative = false;
        loop {
            if self.take("-") {
                negative = !negative;
            } else if !self.take("+") {
                break;
            }
        }
        self.atom()?;
        if self.take("^") || self.take("**") {
            self.depth += 1;
            if self.depth > MAX_DEPTH {
                return Err(BadExpression::new("this expression is nested too deeply"));
            }
            self.factor()?;
            self.depth -= 1;
            self.binary(f64::powf);
        }
        if negative {
            self.steps.push(Step::Negate);
        }
        Ok(())
    }

    /// A number, a variable, a function with its arguments, or a sum in parentheses.
    fn atom(&mut self) -> Result<(), BadExpression> {
        let rest = self.rest();
        let first = rest.chars().next().unwrap_or(' ');
        if first.is_ascii_digit() || first == '.' {
            return self.number(rest);
        }
        if first.is_alphabetic() || first == '_' {
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
            self.at += end;
            return self.name(&rest[..end]);
        }
        if !self.take("(") {
            return Err(self.unexpected("a number, a name or a parenthesis"));
        }
        self.sum()?;
        self.close()
    }

    fn close(&mut self) -> Result<(), BadExpression> {
        if self.take(")") { Ok(()) } else { Err(self.unexpected("a closing parenthesis")) }
    }

    fn number(&mut self, rest: &str) -> Result<(), BadExpression> {
        let digits = |s: &str| s.len() - s.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let mut end = digits(rest);
        if rest[end..].starts_with('.') {
            end += 1 + digits(&rest[end + 1..]);
        }
        if let Some(exponent) = rest[end..].strip_prefix(['e', 'E']) {
            let sign = usize::from(exponent.starts_with(['+', '-']));
            let n = digits(&exponent[sign..]);
            end += if n > 0 { 1 + sign + n } else { 0 };
        }
        match rest[..end].parse() {
            Ok(value) => {
                self.at += end;
                self.steps.push(Step::Number(value));
                Ok(())
            }
            Err(_) => Err(self.unexpected("a number")),
        }
    }

    fn name(&mut self, name: &str) -> Result<(), BadExpression> {
        if self.rest().starts_with('(') {
            return self.call(name);
        }
        if let Some(k) = VARIABLES.iter().position(|v| *v == name) {
            self.steps.push(Step::Variable(k));
        } else if ["pi", "PI", "π"].contains(&name) {
            self.steps.push(Step::Number(std::f64::consts::PI));
        } else {
            let names = VARIABLES.into_iter().chain(["pi"]).collect();
            return Err(unknown(format!("unknown variable `{name}`"), name, names));
        }
        Ok(())
    }

    fn call(&mut self, name: &str) -> Result<(), BadExpression> {
        let unary = UNARY.iter().find(|f| f.0 == name);
        let binary = BINARY.iter().find(|f| f.0 == name);
        if unary.is_none() && binary.is_none() {
            let names = UNARY.iter().map(|f| f.0).chain(BINARY.iter().map(|f| f.0)).collect();
            return Err(unknown(format!("unknown function `{name}`"), name, names));
        }
        self.take("(");
        self.sum()?;
        if let Some((_, f)) = unary {
            self.steps.push(Step::Unary(*f));
        }
        if let Some((_, f)) = binary {
            if !self.take(",") {
                return Err(self.unexpected("a comma and a second argument"));
            }
            self.sum()?;
            self.binary(*f);
        }
        self.close()
    }

    fn unexpected(&mut self, wanted: &str) -> BadExpression {
        let rest = self.rest();
        let found = rest.chars().next().map_or("the end".to_string(), |c| format!("`{c}`"));
        let position = self.text[..self.at].chars().count() + 1;
        BadExpression::new(format!("not an expression: expected {wanted}, found {found} at character {position}"))
    }
}

fn unknown(message: String, name: &str, names: Vec<&'static str>) -> BadExpression {
    BadExpression { message, unknown: Some((name.into(), names)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector2;

    fn value(text: &str) -> f64 {
        let at = FieldPoint { position: Vector2::new(2.0, 3.0), normal: Vector2::new(0.6, 0.8) };
        Expression::parse(text).unwrap_or_else(|e| panic!("{text}: {}", e.message)).value(&at)
    }

    #[test]
    fn precedence_is_that_of_paper() {
        for (text, expected) in [
            ("1 + 2*3^2", 19.0),
            ("-x^2", -4.0),
            ("1 - -x^2*2", 9.0),
            ("y*-x^2 + 8/-x^2", -14.0),
            ("2^3^2", 512.0),
            ("x^-1 + 2**-2", 0.75),
            ("8/4/2 - 3 - 2", -4.0),
            ("(1 + 2)*(3 - 5)", -6.0),
            ("--x + +y", 5.0),
            ("-(x)", -2.0),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn names_numbers_and_functions() {
        for (text, expected) in [
            ("1e-1 + 2.5E+2 + .5 + 1.", 251.6),
            ("ny*sin(pi/x) + nx", 1.4),
            ("max(x, min(y, 7)) + sqrt(4)", 5.0),
            ("sin(x)^2 + cos(x)^2", 1.0),
            ("atan2(1, 1)/π", 0.25),
            ("sign(-3) + abs(-2) + hypot(3, 4)", 6.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-13, "{text} = {}", value(text));
        }
        assert_eq!(Expression::parse("2*pi").unwrap().constant(), Some(std::f64::consts::TAU));
        assert_eq!(Expression::parse("2*x").unwrap().constant(), None);
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "",
            " ",
            "1 +",
            "((",
            "sin",
            "sin x",
            "x y",
            "2x",
            "t + 1",
            "x;y",
            "1..2",
            "é",
            "{x}",
            "min(1)",
            "sin(1, 2)",
            "f(1)",
            "1e",
            "x ^",
            ")",
        ] {
            assert!(Expression::parse(text).is_err(), "{text}");
        }
        for text in ["(".repeat(900), "1^".repeat(400) + "1", "1+(".repeat(300), "-".repeat(999), "1".repeat(1001)] {
            assert!(Expression::parse(&text).is_err());
        }
    }
}
