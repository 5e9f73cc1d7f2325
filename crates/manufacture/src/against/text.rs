//! Edits as texts: what the file has, and what it would have after the edit.

use super::bench::{Alteration, FACTOR, Rewrite};
use super::candidates::{Candidate, EditKind, number};
use super::cause::{Edit, Named, kind};
use super::site::{self, Home, Span};
use super::solve::simple;
use crate::derive::Basis;
use crate::language::names::{self, Callee, Operator};
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
    let change = candidate.change;
    let kind = kind(change, factor);
    let about_all = |old: String, new: String| Edit {
        kind,
        key: whole.key.clone(),
        line: whole.text.line,
        column: whole.text.column,
        old,
        new,
    };
    let edit = match &candidate.alteration {
        Alteration::Normal => about_all("n".to_owned(), "-n".to_owned()),
        Alteration::Over(tree) => about_all(tree.to_string(), String::new()),
        Alteration::Time(time) => {
            about_all(problem.time.clone().unwrap_or_default(), time.to_string())
        }
        Alteration::Exchange(places) => {
            let [first, second] = places.map(|place| problem.coordinates[place].clone());
            about_all(first, second)
        }
        Alteration::Basis(basis) => {
            let system = problem.system.name();
            let new = match basis {
                Basis::Flat => "cartesian",
                _ => "without the derivatives of the basis",
            };
            about_all(system.to_owned(), new.to_owned())
        }
        Alteration::Rewrite(rewrite) => match rewrite.home.expression(problem) {
            Some(expression) => Edit {
                kind,
                ..rewritten(problem, expression, rewrite, change, factor)
            },
            None => about_all(String::new(), String::new()),
        },
    };
    let factors = match (change, &candidate.alteration) {
        (_, Alteration::Time(time)) => vec![*time],
        (EditKind::Parameter, _) => edit.new.parse().into_iter().collect(),
        _ if change.has_factor() => vec![factor],
        _ => vec![],
    };
    Named {
        change,
        terms: terms(problem, candidate),
        factors,
        edit,
    }
}

/// The label of a term, if the edit is about all of it; the names that it is about.
fn terms(problem: &Problem, candidate: &Candidate) -> Vec<String> {
    match &candidate.alteration {
        Alteration::Exchange(places) => {
            let names = places.map(|place| problem.coordinates[place].clone());
            names.to_vec()
        }
        Alteration::Rewrite(rewrite) => match rewrite.home {
            Home::Term { equation, term } if candidate.change == EditKind::Term => {
                vec![problem.equations[equation].terms[term].label.clone()]
            }
            Home::Parameter(place) => vec![problem.parameters[place].name.clone()],
            _ => vec![],
        },
        _ => vec![],
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
    change: EditKind,
    factor: f64,
) -> Edit {
    let part = site::at(&expression.tree, &rewrite.route).unwrap_or(&expression.tree);
    let own = Span::of(part, &expression.text);
    let texts = match change {
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
        EditKind::Basis => Texts {
            span: own,
            new: match &rewrite.new.kind {
                TreeKind::Call(
                    Callee::Operator(Operator::Altered(names::OperandAlteration::Flat)),
                    _,
                ) => {
                    format!("{part} as in Cartesian coordinates")
                }
                _ => format!("{part} without the derivatives of the basis"),
            },
        },
        EditKind::Held => Texts {
            span: own,
            new: format!("{part}, held constant"),
        },
        EditKind::OneDifferentiated => Texts {
            span: own,
            new: differentiated(&rewrite.new),
        },
        _ => Texts {
            span: own,
            new: rewrite.new.to_string(),
        },
    };
    let Span { start, end } = texts.span;
    let place = expression.place.of_text(&expression.text, start);
    Edit {
        kind: "",
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

/// The one factor of a product that is not held.
fn differentiated(tree: &Tree) -> String {
    match &tree.kind {
        TreeKind::Call(Callee::Operator(Operator::Altered(names::OperandAlteration::Held)), _)
        | TreeKind::Number(..) => String::new(),
        TreeKind::Name(name) => name.clone(),
        TreeKind::Binary(Binary::Multiply | Binary::Divide, _)
        | TreeKind::Negate(_)
        | TreeKind::Bracket(_)
        | TreeKind::Call(
            Callee::Operator(Operator::Dot | Operator::Inner | Operator::Outer | Operator::Cross),
            _,
        ) => {
            let mut parts = tree.children().into_iter().map(differentiated);
            parts.find(|part| !part.is_empty()).unwrap_or_default()
        }
        _ => tree.to_string(),
    }
}

/// A part times a number; a sign before it is part of the text.
fn with_factor(expression: &Expression, rewrite: &Rewrite, part: &Tree, factor: f64) -> Texts {
    let own = Span::of(part, &expression.text);
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
pub(super) fn written(value: f64) -> String {
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
pub(super) fn with_number(part: &Tree, factor: f64) -> Option<Tree> {
    let mut found = vec![];
    numbers(part, &mut vec![], false, &mut found);
    for Literal {
        route,
        value,
        is_below,
    } in found
    {
        let new = if is_below {
            value / factor
        } else {
            value * factor
        };
        let new = simple(new);
        if (new * 20.0 - (new * 20.0).round()).abs() > 1e-9 * new.abs() || new == 0.0 {
            continue;
        }
        let mut tree = part.clone();
        *site::at_mut(&mut tree, &route)? = number(&format!("{new}"), new);
        if new == 1.0 {
            drop_one(&mut tree, &route);
        }
        return Some(tree);
    }
    None
}

/// Drops a factor or a divisor of 1.
fn drop_one(tree: &mut Tree, route: &[usize]) {
    let Some((place, above)) = route.split_last() else {
        return;
    };
    let Some(product) = site::at_mut(tree, above) else {
        return;
    };
    let other = match (&product.kind, place) {
        (TreeKind::Binary(Binary::Multiply, operands), place) => operands[1 - place].clone(),
        (TreeKind::Binary(Binary::Divide, operands), 1) => operands[0].clone(),
        _ => return,
    };
    *product = other;
}

/// A number of a product.
struct Literal {
    route: Vec<usize>,
    value: f64,
    is_below: bool,
}

fn numbers(tree: &Tree, route: &mut Vec<usize>, is_below: bool, found: &mut Vec<Literal>) {
    let mut go = |child: &Tree, place: usize, is_below: bool| {
        route.push(place);
        numbers(child, route, is_below, found);
        route.pop();
    };
    match &tree.kind {
        TreeKind::Number(value, _) => found.push(Literal {
            route: route.clone(),
            value: *value,
            is_below,
        }),
        TreeKind::Binary(Binary::Multiply, operands) => {
            go(&operands[0], 0, is_below);
            go(&operands[1], 1, is_below);
        }
        TreeKind::Binary(Binary::Divide, operands) => {
            go(&operands[0], 0, is_below);
            go(&operands[1], 1, !is_below);
        }
        TreeKind::Negate(inner) | TreeKind::Bracket(inner) => go(inner, 0, is_below),
        _ => (),
    }
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
    let span = |tree: &Tree| Span::of(tree, &expression.text);
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
    let Alteration::Rewrite(rewrite) = &candidate.alteration else {
        return false;
    };
    // The part times the unknown factor.
    let TreeKind::Binary(Binary::Multiply, operands) = &rewrite.new.kind else {
        return false;
    };
    let is_factor = matches!(&operands[1].kind, TreeKind::Name(name) if name == FACTOR);
    match (&operands[0].kind, candidate.change) {
        (TreeKind::Number(value, _), EditKind::Exponent) => {
            let new = simple(value * factor);
            (new * 12.0 - (new * 12.0).round()).abs() <= 1e-9
        }
        _ => is_factor && with_number(&operands[0], factor.abs()).is_some(),
    }
}
