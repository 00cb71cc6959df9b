//! Expressions: what they mean, and what is refused.

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
        ("2^-1^2*4 - x^-y/2", 1.9375),
        ("- - +x ^ 2", 4.0),
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
    for (text, message) in [
        ("2*(x", "expected a closing parenthesis, found the end at character 5"),
        ("(x y)", "expected a closing parenthesis, found `y` at character 4"),
        ("é", "unknown variable `é`"),
        ("é;", "expected an operator, found `;` at character 2"),
        ("2x", "expected an operator, found `x` at character 2"),
        ("x)", "expected an operator, found `)` at character 2"),
        ("1 + ", "expected a number, a name or a parenthesis, found the end at character 5"),
        ("2*()", "expected a number, a name or a parenthesis, found `)` at character 4"),
        ("sin()", "expected a number, a name or a parenthesis, found `)` at character 5"),
        ("min(1)", "`min` takes 2 arguments, here it has 1"),
        ("sin(1, 2)", "`sin` takes 1 argument, here it has 2"),
        ("log(1)", "unknown function `log`"),
    ] {
        let found = Expression::parse(text).unwrap_err().message;
        assert!(found.ends_with(message), "{text}: {found}");
    }
}

#[test]
fn no_text_overflows_the_stack() {
    for text in ["(".repeat(900), "1^".repeat(400) + "1", "1+(".repeat(300), "-".repeat(999), "1".repeat(1001)] {
        assert!(Expression::parse(&text).is_err());
    }
    let nested = |n: usize| "sin(".repeat(n) + "1" + &")".repeat(n);
    assert!(Expression::parse(&nested(31)).is_ok() && Expression::parse(&nested(32)).is_err());
    assert_eq!(value(&("-".repeat(901) + "x")), -2.0);
    assert!(Expression::parse(&("x^2 + ".repeat(100) + "1")).is_ok());
}
