//! Values and derivatives of expressions, and error messages.

use std::f64::consts::{E, PI};

use proptest::prelude::*;
use thermobeam_exact::expression::{Expression, Variable};
use thermobeam_exact::function::Function as _;

use crate::refused::{each_is_refused, says};

fn function(text: &str) -> Expression {
    Expression::parse(text, Variable::X).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn rejection(text: &str) -> String {
    Expression::parse(text, Variable::X)
        .expect_err(text)
        .to_string()
}

#[test]
fn expressions_follow_mathematical_precedence() {
    let x = 0.7;
    for (text, value) in [
        ("-x^2", -(x * x)),
        ("(-x)^2", x * x),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("2^-1", 0.5),
        ("2^-1^2", 0.5),
        ("2^-x*3", 2f64.powf(-x) * 3.0),
        ("-2^2", -4.0),
        ("--x", x),
        ("+x", x),
        ("2*-x", -2.0 * x),
        ("2 - -x", 2.0 + x),
        ("8/4/2", 1.0),
        ("8/4*2", 4.0),
        ("5-3-1", 1.0),
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("1e-3", 1e-3),
        ("1E3", 1e3),
        ("2.e0 + .5", 2.5),
        ("2*e", 2.0 * E),
        ("pi", PI),
        ("e^x", x.exp()),
        ("(-2)^3", -8.0),
        ("0^0", 1.0),
        ("x^x", x.powf(x)),
        ("x^0.5", x.sqrt()),
        ("x^-2", 1.0 / (x * x)),
        ("sin(x)", x.sin()),
        ("cos(x)", x.cos()),
        ("tan(x)", x.tan()),
        ("asin(x)", x.asin()),
        ("acos(x)", x.acos()),
        ("atan(x)", x.atan()),
        ("sinh(x)", x.sinh()),
        ("cosh(x)", x.cosh()),
        ("tanh(x)", x.tanh()),
        ("exp(x)", x.exp()),
        ("ln(x)", x.ln()),
        ("log10(x)", x.log10()),
        ("sqrt(x)", x.sqrt()),
        ("abs(-x)", x),
        ("min(x, 1)", x),
        ("max(x, 1)", 1.0),
        ("min(max(0, x), 0.5)", 0.5),
        (" sin ( x )\n\t+ 1 ", x.sin() + 1.0),
    ] {
        let found = function(text).eval(x);
        assert!(
            (found - value).abs() <= 2.0 * f64::EPSILON * value.abs(),
            "{text}: {found} instead of {value}"
        );
    }
}

#[test]
fn each_variable_is_known_by_its_own_name_only() {
    for (variable, name) in [(Variable::X, "x"), (Variable::T, "t"), (Variable::S, "s")] {
        for other in ["x", "t", "s"] {
            let read = Expression::parse(other, variable);
            assert_eq!(
                read.is_ok(),
                other == name,
                "{other} as a function of {name}"
            );
        }
    }
}

#[test]
fn whole_powers_and_the_absolute_value_have_exact_derivatives_at_zero() {
    for (text, derivatives) in [
        ("x^0", [1.0, 0.0, 0.0]),
        ("x^1", [0.0, 1.0, 0.0]),
        ("x^2", [0.0, 0.0, 2.0]),
        ("x^3", [0.0, 0.0, 0.0]),
        ("(x-2)^3", [-8.0, 12.0, -12.0]),
        ("(x^2)^1", [0.0, 0.0, 2.0]),
        ("x*(x-1)^2", [0.0, 1.0, -4.0]),
        ("sqrt(0)*x", [0.0, 0.0, 0.0]),
        // The slope of its right side.
        ("abs(x)", [0.0, 1.0, 0.0]),
    ] {
        assert_eq!(function(text).derivatives(0.0), derivatives, "{text}");
    }
}

#[test]
fn derivatives_agree_with_finite_differences() {
    for text in [
        "x^3 - 2*x",
        "x^x",
        "x^2.5",
        "x^-1.5",
        "2^x",
        "(1+x)^(1-x)",
        "-x^2",
        "1/(1+x^2)",
        "sin(3*x)*exp(-x)",
        "tan(x)",
        "asin(x/2)",
        "acos(x/2)",
        "atan(5*x)",
        "sinh(2*x)",
        "cosh(x^2)",
        "tanh(3*x)",
        "ln(1+x)",
        "log10(2+x)",
        "sqrt(x + x^2)",
        "abs(x-2)",
        "min(x^2, sin(x))",
        "max(x^2, sin(x))",
        "20*cos(5*pi*x/2)",
        "exp(-x)/sqrt(1+x)",
    ] {
        let f = function(text);
        for x in [0.2, 0.45, 0.8] {
            // The errors of the central differences are h²/6 and h²/12 times the next derivatives.
            let h = 1e-4;
            let (minus, middle, plus) = (f.eval(x - h), f.eval(x), f.eval(x + h));
            let expected = [
                middle,
                (plus - minus) / (2.0 * h),
                (plus - 2.0 * middle + minus) / (h * h),
            ];
            let scale = expected.iter().fold(1.0, |a: f64, b| a.max(b.abs()));
            for (order, slack) in [4.0 * f64::EPSILON, 1e-5, 1e-5].into_iter().enumerate() {
                let found = f.derivatives(x)[order];
                let error = (found - expected[order]).abs();
                assert!(
                    error <= slack * scale,
                    "{text}, x = {x}, order {order}: {found} and {}",
                    expected[order]
                );
            }
        }
    }
}

#[test]
fn steep_functions_keep_finite_derivatives() {
    let [value, first, second] = function("tanh(1000*x)").derivatives(1.0);
    assert_eq!([value, first.abs(), second.abs()], [1.0, 0.0, 0.0]);
}

#[test]
fn minimum_and_maximum_keep_nan() {
    for text in [
        "min(ln(-1), x)",
        "min(x, ln(-1))",
        "max(ln(-1), x)",
        "max(x, ln(-1))",
    ] {
        assert!(function(text).eval(0.5).is_nan(), "{text}");
    }
}

#[test]
fn a_text_that_cannot_be_read_or_has_no_finite_value_is_refused_at_its_place() {
    each_is_refused(include_str!("refused.txt"), |case| {
        let order = case.kind.strip_prefix("derivatives up to the order ");
        if let Some(order) = order {
            let checked = function(&case.new).check_finite(1.0, order.parse().unwrap());
            return checked.expect_err(&case.new).to_string();
        }
        let error = Expression::parse(&case.new, Variable::X).expect_err(&case.new);
        format!("byte {}: {error}", error.offset)
    });
    assert!(rejection("  ").contains("an empty text"));
}

#[test]
fn the_caret_points_at_the_error() {
    assert_eq!(
        rejection("ä + 2x").lines().skip(1).collect::<Vec<_>>()[1].find('^'),
        Some(4)
    );
    let long = format!("{}2x{}", "x+".repeat(200), "+x".repeat(200));
    let lines: Vec<String> = rejection(&long).lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), 3);
    assert!(
        lines[1].starts_with("    ...") && lines[1].ends_with("..."),
        "{lines:?}"
    );
    assert_eq!(rejection("ä + 2x").lines().nth(1), Some("    ä + 2x"));
    assert!(
        lines.iter().all(|line| line.chars().count() < 120),
        "{lines:?}"
    );
    let column = lines[2].find('^').expect("a caret");
    assert!(
        lines[1][..column].ends_with("+2") && lines[1][column..].starts_with("x+x"),
        "{lines:?}"
    );
}

#[test]
fn a_value_that_is_not_finite_is_rejected_only_where_it_is_needed() {
    assert_eq!(function("sqrt(x)").check_finite(1.0, 0), Ok(()));
    assert_eq!(function("x^1.5").check_finite(1.0, 1), Ok(()));
    assert_eq!(function("x^3").check_finite(1.0, 2), Ok(()));
    let removable = "sin(x - 0.12345)/(x - 0.12345)";
    assert_eq!(function(removable).check_finite(1.0, 0), Ok(()));
    let late = Expression::parse("1/(2-t)", Variable::T).expect("a function");
    assert_eq!(late.check_finite(1.0, 2), Ok(()));
    let pole = late.check_finite(4.0, 0).expect_err("a pole").to_string();
    assert!(says(&pole, "at t = 2 … [0, 4]"), "{pole}");
}

#[test]
fn an_expression_displays_its_source_text() {
    assert_eq!(function(" 0.01*x * (x-2)").to_string(), " 0.01*x * (x-2)");
    assert_eq!(function("2 * x").source(), "2 * x");
}

#[test]
fn the_rounding_bound_of_a_function_includes_the_error_of_its_argument() {
    // max (|f| + |x f'|): for x² it is 3x² at the end, for 1 + x/2 it is 1 + x.
    for (text, size) in [("x^2", 12.0), ("-x^2", 12.0), ("1 + x/2", 3.0), ("7", 7.0)] {
        let function = function(text);
        assert_eq!(
            (function.size(2.0), function.roundoff(2.0)),
            (size, 8.0 * f64::EPSILON * size),
            "{text}"
        );
    }
    // The slope of the root is infinite at 0 and is omitted.
    assert!((function("sqrt(x)").size(4.0) - 3.0).abs() < 1e-12);
}

#[test]
fn a_missing_product_sign_is_no_hint_without_two_operands() {
    for text in ["x $ 2", "sin x", "x)"] {
        assert!(!rejection(text).contains("a product needs its *"), "{text}");
    }
}

/// Texts that are often nearly valid.
fn nearly_valid() -> impl Strategy<Value = String> {
    let pieces = [
        "x", "pi", "e", "1", "1e-3", ".", "sin", "max", "(", ")", ",", "+", "-", "*", "/", "^",
        " ", "ä",
    ];
    prop::collection::vec(prop::sample::select(pieces.to_vec()), 0..40)
        .prop_map(|pieces| pieces.concat())
}

/// Parses a text, and evaluates the expression or checks the error.
fn parse_and_use(text: &str) {
    match Expression::parse(text, Variable::X) {
        Ok(f) => {
            assert_eq!(f.to_string(), text);
            let _ = (f.eval(0.5), f.derivatives(0.5));
        }
        Err(error) => {
            assert!(
                text.is_char_boundary(error.offset),
                "{text:?}: byte {}",
                error.offset
            );
            assert_eq!(error.to_string().lines().count(), 3, "{error}");
        }
    }
}

proptest! {
    #[test]
    fn any_text_parses_or_is_rejected_without_panic(text in prop_oneof![any::<String>(), nearly_valid()]) {
        parse_and_use(&text);
    }
}

#[test]
fn kinks_are_where_the_branch_changes() {
    for (text, expected) in [
        ("x^2 + sin(9*x)", &[][..]),
        ("abs((x-0.5)^2)", &[]),
        ("max(0,x-0.37)", &[0.37]),
        ("0.3*min(x,1-x)", &[0.5]),
        ("1 + -2*abs(x-0.25)^3/exp(x)", &[0.25]),
        ("min(1, max(0, 1e5*(x-0.6)))", &[0.6, 0.60001]),
        (
            "abs(sin(4*pi*x+1))",
            &[
                0.170_422_528_45,
                0.420_422_528_45,
                0.670_422_528_45,
                0.920_422_528_45,
            ],
        ),
        // Hats: of the narrowest width that samples see, and one that is seen because its middle
        // is.
        ("max(0, 1 - abs(x-0.6137)/1e-4)", &[0.6136, 0.6137, 0.6138]),
        (
            "max(0, 1 - abs(x-0.6137)/1e-7)",
            &[0.613_699_9, 0.6137, 0.613_700_1],
        ),
        (
            "max(0, exp(-((x-0.61375)/1e-4)^2) - 0.5)",
            &[0.613_666_744_54, 0.613_833_255_46],
        ),
    ] {
        let kinks = function(text).kinks();
        let is_found = kinks
            .iter()
            .zip(expected)
            .all(|(kink, expected)| (kink - expected).abs() < 1e-10);
        assert!(
            kinks.len() == expected.len() && is_found,
            "{text}: {kinks:?}, not {expected:?}"
        );
    }
    // The point itself, not one of its neighbours.
    assert_eq!(function("max(0,x-0.37)").kinks(), [0.37]);
    assert_eq!(function("abs(0.37-x)").kinks(), [0.37]);
}
