//! Numbers and expressions of the case file.

use crate::case::schema::Scalar;
use crate::model::{FieldPoint, ScalarField};
use exmex::{Express, FlatEx};
use std::sync::Arc;

/// What an expression may depend on.
const VARIABLES: [&str; 4] = ["x", "y", "nx", "ny"];
/// Longer texts are no expressions, and nested parentheses cost stack.
const MAX_LENGTH: usize = 1000;

/// Why a text is no expression.
pub(super) struct BadExpression {
    pub message: String,
    pub allowed: Option<String>,
}

/// A field from what the case says.
pub(super) fn field(scalar: &Scalar) -> Result<ScalarField, BadExpression> {
    match scalar {
        Scalar::Number(value) => Ok(ScalarField::Constant(*value)),
        Scalar::Expression(text) => compile(text),
    }
}

fn compile(text: &str) -> Result<ScalarField, BadExpression> {
    if text.len() > MAX_LENGTH {
        let message = format!("an expression has at most {MAX_LENGTH} characters");
        return Err(BadExpression { message, allowed: None });
    }
    let expression: FlatEx<f64> = exmex::parse(text).map_err(|e| BadExpression {
        message: format!("not an expression: {}", e.msg().replace('\n', ", ")),
        allowed: Some(
            "numbers, x, y, nx, ny, PI, + - * / ^ ( ), and functions such as sin, sqrt, abs, min, max".into(),
        ),
    })?;
    let mut slots = vec![];
    for name in expression.var_names() {
        match VARIABLES.iter().position(|v| v == name) {
            Some(slot) => slots.push(slot),
            None => {
                let message = format!("unknown variable `{name}`");
                return Err(BadExpression { message, allowed: Some(VARIABLES.join(", ")) });
            }
        }
    }
    if slots.is_empty() {
        return Ok(ScalarField::Constant(expression.eval(&[]).unwrap_or(f64::NAN)));
    }
    Ok(ScalarField::Function(Arc::new(move |at| evaluate(&expression, &slots, at))))
}

fn evaluate(expression: &FlatEx<f64>, slots: &[usize], at: &FieldPoint) -> f64 {
    let all = [at.position.x, at.position.y, at.normal.x, at.normal.y];
    let mut values = [0.0; VARIABLES.len()];
    for (value, &slot) in values.iter_mut().zip(slots) {
        *value = all[slot];
    }
    // The number of values always fits; an error could only be one of the evaluation.
    expression.eval(&values[..slots.len()]).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector2;

    fn value(text: &str) -> f64 {
        let at = FieldPoint { position: Vector2::new(2.0, 3.0), normal: Vector2::new(0.6, 0.8) };
        match field(&Scalar::Expression(text.into())) {
            Ok(f) => f.value(&at),
            Err(e) => panic!("{}", e.message),
        }
    }

    #[test]
    fn expressions_mean_what_they_say() {
        assert_eq!(value("1 + 2*3^2"), 19.0);
        assert_eq!(value("-x^2"), -4.0);
        assert_eq!(value("y - x"), 1.0);
        assert!((value("ny*sin(PI/x) + nx") - 1.4).abs() < 1e-15);
        assert_eq!(value("max(x, y) + sqrt(4)"), 5.0);
    }

    #[test]
    fn bad_expressions_are_refused() {
        for text in ["", "1 +", "((", "sin", "x y", "t + 1", "x;y", "1..2", "é", "{x y}"] {
            assert!(field(&Scalar::Expression(text.into())).is_err(), "{text}");
        }
        assert!(field(&Scalar::Expression("(".repeat(2000))).is_err());
    }
}
