//! Edits as texts: what the file has, and what it would have after the edit.

use super::bench::{self, Alteration, Rewrite};
use super::candidates::trees::{
    Binding, binary, bracketed, in_place, is_sum, node, number, unscaled,
};
use super::candidates::{Candidate, EditKind, Wording};
use super::cause::{Edit, Named, word};
use super::site::{self, Span};
use super::solve::simple;
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::problem::{Expression, Location, Problem};

/// An edit with the factor that fits, in the words of the file.
///
/// * `whole`: the place of the quantity, for an edit that is about all of it.
pub(crate) fn named(
    problem: &Problem,
    whole: &Location,
    candidate: &Candidate<'_>,
    factor: f64,
) -> Named {
    let kind = candidate.kind;
    let mut terms = vec![];
    let edit = match (&candidate.alteration, &candidate.wording) {
        (Alteration::Parameter(place), _) => {
            let parameter = &problem.parameters[*place];
            terms.push(parameter.name.clone());
            let values = problem.parameter_values(&[]).unwrap_or_default();
            let text = Texts {
                span: Span::of(&parameter.expression.tree),
                new: decimal(simple(bench::scaled(values[*place], factor))).to_string(),
            };
            text.edit(kind, factor, &parameter.expression)
        }
        (_, Some(Wording::Whole { old, new })) => Edit {
            kind: word(kind, factor),
            key: whole.key.clone(),
            line: whole.text.line,
            column: whole.text.column,
            old: old.clone(),
            new: new.clone(),
        },
        (alteration, wording) => {
            let Alteration::Rewrites(rewrites) = alteration else {
                unreachable!("edits of all of a quantity have words of their own")
            };
            let rewrite = &rewrites[0];
            if kind == EditKind::Term {
                terms.push(label(problem, rewrite.within));
            }
            let mut texts = rewritten(kind, rewrite, factor);
            if let Some(Wording::New(new)) = wording {
                texts.new.clone_from(new);
            }
            texts.edit(kind, factor, rewrite.within)
        }
    };
    if kind == EditKind::Coordinates {
        terms = vec![edit.old.clone(), edit.new.clone()];
    }
    Named {
        terms,
        factors: match kind {
            EditKind::Time | EditKind::Parameter => edit.new.parse().into_iter().collect(),
            _ if kind.has_factor() => vec![factor],
            _ => vec![],
        },
        edit,
    }
}

/// The label of a term.
fn label(problem: &Problem, expression: &Expression) -> String {
    let mut terms = problem
        .equations
        .iter()
        .flat_map(|equation| &equation.terms);
    let term = terms.find(|term| term.expression == *expression);
    term.map_or(String::new(), |term| term.label.clone())
}

/// The bytes of an expression that an edit changes, and what it makes of them.
struct Texts {
    span: Span,
    new: String,
}

impl Texts {
    fn edit(self, kind: EditKind, factor: f64, within: &Expression) -> Edit {
        let Span { start, end } = self.span;
        let place = within.place.of_text(&within.text, start);
        Edit {
            kind: word(kind, factor),
            key: within.place.key.clone(),
            line: place.line,
            column: place.column,
            old: within.text.get(start..end).unwrap_or("").to_owned(),
            new: self.new,
        }
    }
}

/// The texts of a part: of all of a power, if it belongs to one; with the sign before it, if a
/// factor changes it.
fn rewritten(kind: EditKind, rewrite: &Rewrite<'_>, factor: f64) -> Texts {
    let Rewrite { within, route, new } = rewrite;
    let whole = &within.tree;
    let part = site::at(whole, route).unwrap_or(whole);
    let span = Span::of(part);
    if let (EditKind::Added, TreeKind::Binary(_, operands)) = (kind, &new.kind) {
        let start = span.end;
        return Texts {
            span: Span { start, ..span },
            new: format!(" {}", signed('+', &with_factor(&operands[1], factor))),
        };
    }
    let new = with_factor(new, factor);
    let above = route.split_last();
    let above = above.and_then(|(place, route)| Some((*place, site::at(whole, route)?)));
    if let Some((place, power)) = above
        && let TreeKind::Binary(Binary::Power, operands) = &power.kind
    {
        let [base, exponent] = operands.as_ref();
        let new = match (place, &new.kind) {
            (1, TreeKind::Number(1.0, _)) => base.clone(),
            (1, _) => binary(Binary::Power, base, &new),
            _ => binary(Binary::Power, &new, exponent),
        };
        return Texts {
            span: Span::of(power),
            new: new.to_string(),
        };
    }
    let is_last = above.is_none_or(|(place, above)| place == 1 && is_sum(above));
    let before = within.text.get(..span.start).unwrap_or("").trim_end();
    let sign = before
        .chars()
        .next_back()
        .filter(|c| ['+', '-'].contains(c));
    match sign {
        Some(sign) if is_last && unscaled(&rewrite.new).is_some() => Texts {
            span: Span {
                start: before.len() - 1,
                ..span
            },
            new: match factor == 0.0 {
                true => String::new(),
                false => signed(sign, &new),
            },
        },
        _ => Texts {
            span,
            new: match above {
                Some((place, above)) => in_place(above, place, &new).to_string(),
                // A term of a text behind its sign.
                None if sign.is_some() => bracketed(&new, Binding::Product).to_string(),
                None => new.to_string(),
            },
        },
    }
}

/// A summand behind a sign, which its own turns.
fn signed(sign: char, summand: &Tree) -> String {
    let text = summand.to_string();
    match (text.strip_prefix('-'), sign) {
        (None, _) => format!("{sign} {text}"),
        (Some(positive), '-') => format!("+ {positive}"),
        (Some(positive), _) => format!("- {positive}"),
    }
}

/// The tree with a number in place of the unknown factor, if it has one.
fn with_factor(tree: &Tree, factor: f64) -> Tree {
    unscaled(tree).map_or_else(|| tree.clone(), |part| times(part, factor))
}

/// A part times a number, which goes into a number that the part has, if that becomes simple. The
/// sign of a product stands before all of it.
fn times(part: &Tree, factor: f64) -> Tree {
    if let Some(positive) = without_sign(part) {
        return times(&positive, -factor);
    }
    let size = factor.abs();
    let positive = match &part.kind {
        TreeKind::Number(value, _) => written(simple(value * size)),
        _ if size == 0.0 => written(size),
        _ if size == 1.0 => part.clone(),
        _ => with_number(part, size).unwrap_or_else(|| {
            let product = Box::new([written(size), bracketed(part, Binding::Product)]);
            node(TreeKind::Binary(Binary::Multiply, product))
        }),
    };
    match factor < 0.0 {
        true => node(TreeKind::Negate(Box::new(bracketed(
            &positive,
            Binding::Product,
        )))),
        false => positive,
    }
}

/// A product without the sign before it.
fn without_sign(part: &Tree) -> Option<Tree> {
    match &part.kind {
        TreeKind::Negate(inner) => Some((**inner).clone()),
        TreeKind::Binary(operator @ (Binary::Multiply | Binary::Divide), operands) => {
            let [left, right] = operands.as_ref();
            Some(binary(*operator, &without_sign(left)?, right))
        }
        _ => None,
    }
}

/// A number as people write it.
fn written(value: f64) -> Tree {
    for below in [3.0, 6.0, 7.0, 9.0, 11.0, 12.0] {
        let above = value * below;
        let is_decimal = [1.0, 2.0, 4.0, 5.0, 8.0, 10.0]
            .iter()
            .any(|scale| (value * scale).fract() == 0.0);
        if !is_decimal && (above - above.round()).abs() <= 1e-12 * above.abs() {
            let [above, below] = [above.round(), below].map(decimal);
            return binary(Binary::Divide, &above, &below);
        }
    }
    decimal(value)
}

/// With fifteen digits: those behind them are rounding of a product.
fn decimal(value: f64) -> Tree {
    let value = format!("{value:.14e}").parse().unwrap_or(value);
    number(&value.to_string(), value)
}

/// The same product with one of its numbers changed, if that makes a simple one.
fn with_number(part: &Tree, factor: f64) -> Option<Tree> {
    let is_one = |tree: &Tree| matches!(tree.kind, TreeKind::Number(1.0, _));
    match &part.kind {
        TreeKind::Number(value, _) => {
            let new = simple(value * factor);
            let is_short = (new * 20.0 - (new * 20.0).round()).abs() <= 1e-9 * new.abs();
            (is_short && new != 0.0).then(|| decimal(new))
        }
        TreeKind::Bracket(inner) => {
            let inner = with_number(inner, factor)?;
            Some(node(TreeKind::Bracket(Box::new(inner))))
        }
        TreeKind::Binary(operator @ (Binary::Multiply | Binary::Divide), operands) => {
            let [left, right] = operands.as_ref();
            if let Some(left) = with_number(left, factor) {
                let is_lost = *operator == Binary::Multiply && is_one(&left);
                return Some(match is_lost {
                    true => right.clone(),
                    false => binary(*operator, &left, right),
                });
            }
            let of_right = match operator {
                Binary::Divide => 1.0 / factor,
                _ => factor,
            };
            let right = with_number(right, of_right)?;
            Some(match is_one(&right) {
                true => left.clone(),
                false => binary(*operator, left, &right),
            })
        }
        _ => None,
    }
}

/// Whether an edit with this factor changes a number of the file into a simple one.
pub(super) fn has_simple_number(candidate: &Candidate<'_>, factor: f64) -> bool {
    let Alteration::Rewrites(rewrites) = &candidate.alteration else {
        return false;
    };
    let Some(part) = rewrites.first().and_then(|rewrite| unscaled(&rewrite.new)) else {
        return false;
    };
    match (&part.kind, candidate.kind) {
        (TreeKind::Number(value, _), EditKind::Exponent) => {
            let new = simple(value * factor);
            (new * 12.0 - (new * 12.0).round()).abs() <= 1e-9
        }
        _ => with_number(part, factor.abs()).is_some(),
    }
}
