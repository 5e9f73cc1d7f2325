//! Edits as texts: what the file has, and what it would have after the edit.

use super::bench::{Alteration, FACTOR, Rewrite};
use super::candidates::{Candidate, EditKind, Wording, node, number};
use super::cause::{Edit, Named, word};
use super::site::{self, Home, Span};
use super::solve::simple;
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::{Expression, Location, Problem};

/// An edit with the factor that fits, in the words of the file.
///
/// * `whole`: the place of the quantity, for an edit that is about all of it.
pub(crate) fn named(
    problem: &Problem,
    whole: &Location,
    candidate: &Candidate,
    factor: f64,
) -> Named {
    let kind = candidate.kind;
    let rewrite = match &candidate.alteration {
        Alteration::Rewrites(rewrites) => rewrites.first(),
        _ => None,
    };
    let home = rewrite.map(|rewrite| &rewrite.home);
    let expression = home.and_then(|home| home.expression(problem));
    let wording = candidate.wording.as_ref();
    let edit = match (rewrite.zip(expression), wording) {
        (Some((rewrite, expression)), None | Some(Wording::New(_))) => {
            rewritten(problem, expression, rewrite, candidate, factor)
        }
        (_, wording) => {
            let [old, new] = match wording {
                Some(Wording::Whole { old, new }) => [old.clone(), new.clone()],
                _ => Default::default(),
            };
            Edit {
                kind: word(kind, factor),
                key: whole.key.clone(),
                line: whole.text.line,
                column: whole.text.column,
                old,
                new,
            }
        }
    };
    Named {
        terms: match (kind, home) {
            (EditKind::Term, Some(Home::Term { equation, term })) => {
                vec![problem.equations[*equation].terms[*term].label.clone()]
            }
            (EditKind::Parameter, Some(Home::Parameter(place))) => {
                vec![problem.parameters[*place].name.clone()]
            }
            (EditKind::Coordinates, _) => vec![edit.old.clone(), edit.new.clone()],
            _ => vec![],
        },
        factors: match kind {
            EditKind::Time | EditKind::Parameter => edit.new.parse().into_iter().collect(),
            _ if kind.has_factor() => vec![factor],
            _ => vec![],
        },
        edit,
    }
}

/// The old and the new text of a part.
struct Texts {
    span: Span,
    new: String,
}

fn rewritten(
    problem: &Problem,
    expression: &Expression,
    rewrite: &Rewrite,
    candidate: &Candidate,
    factor: f64,
) -> Edit {
    let part = site::at(&expression.tree, &rewrite.route).unwrap_or(&expression.tree);
    let own = Span::of(part);
    let texts = match candidate.kind {
        EditKind::Term | EditKind::Summand | EditKind::Part => {
            with_factor(expression, rewrite, part, factor)
        }
        EditKind::Exponent => exponent(expression, rewrite, part, factor),
        EditKind::Parameter => Texts {
            span: own,
            new: parameter(problem, &rewrite.home, factor).to_string(),
        },
        EditKind::Added => Texts {
            span: Span {
                start: own.end,
                ..own
            },
            new: added(&rewrite.new, factor),
        },
        _ => Texts {
            span: own,
            new: match &candidate.wording {
                Some(Wording::New(new)) => new.clone(),
                _ => rewrite.new.to_string(),
            },
        },
    };
    let Span { start, end } = texts.span;
    let place = expression.place.of_text(&expression.text, start);
    Edit {
        kind: word(candidate.kind, factor),
        key: expression.place.key.clone(),
        line: place.line,
        column: place.column,
        old: expression.text.get(start..end).unwrap_or("").to_owned(),
        new: texts.new,
    }
}

/// The value of a parameter times a factor.
fn parameter(problem: &Problem, home: &Home, factor: f64) -> f64 {
    let values = problem.parameter_values(&[]).unwrap_or_default();
    match home {
        Home::Parameter(place) if values[*place] != 0.0 => simple(factor * values[*place]),
        _ => factor,
    }
}

/// A summand with a factor: the last one of a sum, whose own factor is unknown.
fn added(sum: &Tree, factor: f64) -> String {
    let TreeKind::Binary(_, operands) = &sum.kind else {
        return String::new();
    };
    let summand = operands[1].children().first().map(|name| name.to_string());
    let summand = summand.unwrap_or_default();
    let sign = if factor < 0.0 { '-' } else { '+' };
    match factor.abs() {
        1.0 => format!(" {sign} {summand}"),
        size => format!(" {sign} {}*{summand}", written(size)),
    }
}

/// A part times a number; a sign before it is part of the text.
fn with_factor(expression: &Expression, rewrite: &Rewrite, part: &Tree, factor: f64) -> Texts {
    let own = Span::of(part);
    let before = expression.text.get(..own.start).unwrap_or("").trim_end();
    let parent = rewrite.route.split_last();
    let is_right = match parent {
        None => matches!(rewrite.home, Home::Term { .. }),
        Some((place, route)) => {
            let parent = site::at(&expression.tree, route).map(|parent| &parent.kind);
            let is_sum = matches!(
                parent,
                Some(TreeKind::Binary(Binary::Add | Binary::Subtract, _))
            );
            *place == 1 && is_sum
        }
    };
    let sign = match before.chars().next_back() {
        Some('+') if is_right => Some(1.0),
        Some('-') if is_right => Some(-1.0),
        _ => None,
    };
    let is_tight = matches!(parent, Some((_, route))
        if matches!(site::at(&expression.tree, route).map(|tree| &tree.kind),
            Some(TreeKind::Binary(Binary::Power, _))));
    match sign {
        Some(sign) => {
            let size = times(part, factor.abs());
            let symbol = if sign * factor < 0.0 { '-' } else { '+' };
            let new = match factor == 0.0 {
                true => String::new(),
                false => format!("{symbol} {size}"),
            };
            Texts {
                span: Span {
                    start: before.len() - 1,
                    ..own
                },
                new,
            }
        }
        None => {
            let new = match factor == 0.0 {
                true => "0".to_owned(),
                false => times(part, factor),
            };
            let new = match is_tight {
                true => format!("({new})"),
                false => new,
            };
            Texts { span: own, new }
        }
    }
}

/// The text of a part times a number, which goes into a number that the part has, if it becomes
/// simple.
fn times(part: &Tree, factor: f64) -> String {
    let size = factor.abs();
    let text = bracketed(part);
    // The sign of a product stands before all of it.
    let (is_negative, positive) = match text.strip_prefix('-') {
        Some(positive) => (true, positive.to_owned()),
        None => (false, text),
    };
    let new = with_number(part, size).map(|new| new.to_string());
    let positive = match (size == 1.0, new) {
        (true, _) => positive,
        (false, Some(new)) => new.strip_prefix('-').unwrap_or(&new).to_owned(),
        (false, None) => format!("{}*{positive}", written(size)),
    };
    if is_negative == (factor < 0.0) {
        positive
    } else {
        format!("-{positive}")
    }
}

fn bracketed(part: &Tree) -> String {
    match part.kind {
        TreeKind::Binary(Binary::Add | Binary::Subtract, _) => format!("({part})"),
        _ => part.to_string(),
    }
}

/// A number as people write it.
fn written(value: f64) -> String {
    for below in [3.0, 6.0, 7.0, 9.0, 11.0, 12.0] {
        let above = value * below;
        let is_decimal = [1.0, 2.0, 4.0, 5.0, 8.0, 10.0]
            .iter()
            .any(|scale| (value * scale).fract() == 0.0);
        if !is_decimal && (above - above.round()).abs() <= 1e-12 * above.abs() {
            return format!("{}/{below}", above.round());
        }
    }
    format!("{value}")
}

/// The same product with one of its numbers changed, if that makes a simple one.
fn with_number(part: &Tree, factor: f64) -> Option<Tree> {
    let kind = match &part.kind {
        TreeKind::Number(value, _) => {
            let new = simple(value * factor);
            let is_short = (new * 20.0 - (new * 20.0).round()).abs() <= 1e-9 * new.abs();
            return (is_short && new != 0.0).then(|| number(&format!("{new}"), new));
        }
        TreeKind::Negate(inner) => TreeKind::Negate(Box::new(with_number(inner, factor)?)),
        TreeKind::Bracket(inner) => TreeKind::Bracket(Box::new(with_number(inner, factor)?)),
        TreeKind::Binary(operator @ (Binary::Multiply | Binary::Divide), operands) => {
            let [left, right] = operands.as_ref();
            let of_right = match operator {
                Binary::Divide => 1.0 / factor,
                _ => factor,
            };
            let is_one = |tree: &Tree| matches!(tree.kind, TreeKind::Number(1.0, _));
            let operands = match with_number(left, factor) {
                Some(left) if is_one(&left) && *operator == Binary::Multiply => {
                    return Some(right.clone());
                }
                Some(left) => [left, right.clone()],
                None => match with_number(right, of_right)? {
                    one if is_one(&one) => return Some(left.clone()),
                    right => [left.clone(), right],
                },
            };
            TreeKind::Binary(*operator, Box::new(operands))
        }
        _ => return None,
    };
    Some(node(kind))
}

/// A power with another exponent.
fn exponent(expression: &Expression, rewrite: &Rewrite, part: &Tree, factor: f64) -> Texts {
    let value = match &part.kind {
        TreeKind::Number(value, _) => Some(simple(value * factor)),
        _ => None,
    };
    let new = match value {
        Some(1.0) => String::new(),
        Some(value) if value < 0.0 => format!("^({value})"),
        Some(value) => format!("^{}", within_power(&written(value))),
        None => format!("^({})", times(part, factor)),
    };
    let power = rewrite.route.split_last();
    let power = power.and_then(|(_, route)| site::at(&expression.tree, route));
    let span = |tree: &Tree| Span::of(tree);
    match power.map(|power| (power, &power.kind)) {
        Some((power, TreeKind::Binary(_, operands))) => Texts {
            span: span(power),
            new: format!("{}{new}", operands[0]),
        },
        _ => Texts {
            span: span(part),
            new,
        },
    }
}

/// A fraction needs brackets as an exponent.
fn within_power(number: &str) -> String {
    match number.contains('/') {
        true => format!("({number})"),
        false => number.to_owned(),
    }
}

/// Whether an edit with this factor changes a number of the file into a simple one.
pub(super) fn has_simple_number(candidate: &Candidate, factor: f64) -> bool {
    let Alteration::Rewrites(rewrites) = &candidate.alteration else {
        return false;
    };
    // The part times the unknown factor.
    let Some(TreeKind::Binary(Binary::Multiply, operands)) = rewrites.first().map(|r| &r.new.kind)
    else {
        return false;
    };
    let is_factor = matches!(&operands[1].kind, TreeKind::Name(name) if name == FACTOR);
    match (&operands[0].kind, candidate.kind) {
        (TreeKind::Number(value, _), EditKind::Exponent) => {
            let new = simple(value * factor);
            (new * 12.0 - (new * 12.0).round()).abs() <= 1e-9
        }
        _ => is_factor && with_number(&operands[0], factor.abs()).is_some(),
    }
}
