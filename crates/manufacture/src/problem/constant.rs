//! Expressions of numbers and parameters: their values without any graph.

use super::{Expression, InputError};
use crate::arithmetic::{apply, operate};
use crate::language::names::{CONSTANTS, Callee, Piecewise, did_you_mean};
use crate::language::tree::{Tree, TreeKind};

/// The value of an expression of numbers and these names.
pub(crate) fn constant(expression: &Expression, known: &[(&str, f64)]) -> Result<f64, InputError> {
    let value = evaluate(&expression.tree, expression, known)?;
    if value.is_finite() {
        return Ok(value);
    }
    let problem = format!("found {value}; expected a finite number");
    Err(expression.place.error_at(&expression.text, 0, problem))
}

fn evaluate(
    tree: &Tree,
    expression: &Expression,
    known: &[(&str, f64)],
) -> Result<f64, InputError> {
    let value = |tree: &Tree| evaluate(tree, expression, known);
    let refused = |problem: String| {
        Err(expression
            .place
            .error_at(&expression.text, tree.at, problem))
    };
    match &tree.kind {
        TreeKind::Number(number, _) => Ok(*number),
        TreeKind::Name(name) => {
            let mut names = known.iter().chain(&CONSTANTS);
            match names.find(|entry| entry.0 == name) {
                Some(entry) => Ok(entry.1),
                None => {
                    let near = did_you_mean(name, known.iter().map(|entry| entry.0));
                    refused(format!(
                        "unknown name `{name}`{near}; expected numbers and parameters"
                    ))
                }
            }
        }
        TreeKind::Negate(operand) => Ok(-value(operand)?),
        TreeKind::Bracket(inner) => value(inner),
        TreeKind::Binary(operator, operands) => Ok(operate(
            *operator,
            value(&operands[0])?,
            value(&operands[1])?,
        )),
        TreeKind::Call(callee, parts) => match (callee, parts.as_slice()) {
            (Callee::Piecewise(Piecewise::Min), [a, b]) => Ok(value(a)?.min(value(b)?)),
            (Callee::Piecewise(Piecewise::Max), [a, b]) => Ok(value(a)?.max(value(b)?)),
            (Callee::Piecewise(Piecewise::Abs), [a]) => Ok(value(a)?.abs()),
            (Callee::Function(function), [a]) => Ok(apply(*function, value(a)?)),
            _ => refused("expected numbers, parameters and functions of them".to_owned()),
        },
        _ => refused("expected an expression of numbers and parameters".to_owned()),
    }
}
