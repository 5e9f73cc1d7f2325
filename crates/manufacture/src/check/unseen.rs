//! Edits that no point sees: mistakes in an equation that leave the source of this solution as it
//! is.

use std::collections::HashSet;

use super::general::General;
use super::{Finding, Sampled, finding, is_same};
use crate::against::bench::{Alteration, Bench, Rewrite};
use crate::against::candidates::{self, Candidate, EditKind};
use crate::against::{cause, site, text};
use crate::derive::{Part, Role};
use crate::language::names::{Callee, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::model::Model;
use crate::problem::Problem;

/// One finding for each equation and kind of edit: the first edit that changes the expression and,
/// for other fields, the source, but not the source of this solution.
///
/// An edit that changes nothing for any fields, as a gradient transposed inside a symmetric form,
/// is no mistake.
pub(super) fn edits(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let problem = &model.problem;
    let Some(mut bench) = Bench::new(model, Part::Interior) else {
        return vec![];
    };
    let differential = differential(problem);
    let mut findings: Vec<Finding> = vec![];
    let mut general: Option<General> = None;
    for equation in &problem.equations {
        let mut kinds: Vec<&'static str> = vec![];
        let mut candidates = candidates::all(problem, Part::Interior, &equation.name);
        candidates.retain(|candidate| is_common(problem, candidate, &differential));
        for candidate in &candidates {
            let kind = cause::word(candidate.kind, 1.0);
            if kinds.contains(&kind) || !is_unseen(&mut bench, candidate, sampled, &equation.name) {
                continue;
            }
            let general = general.get_or_insert_with(|| General::of(sampled, model));
            if general.sees(&candidate.alteration, &equation.name) {
                kinds.push(kind);
                let named = text::named(problem, &equation.place, candidate, 1.0);
                let key = format!("equations.{}", equation.name);
                let text = cause::unseen(candidate.kind, &named.edit, &problem.file);
                findings.push(finding("slip-invisible", &key, text, None));
            }
        }
    }
    findings
}

/// Mistakes that people often make: the product rule, a gradient by its transpose, a transpose that
/// is missing.
fn is_common(problem: &Problem, candidate: &Candidate, differential: &HashSet<&str>) -> bool {
    let Alteration::Rewrites(rewrites) = &candidate.alteration else {
        return false;
    };
    let [rewrite] = rewrites.as_slice() else {
        return false;
    };
    match candidate.kind {
        _ if rewrite.home.is_exact(problem) => false,
        EditKind::TransposedGradient | EditKind::MissingTranspose => true,
        EditKind::Held => is_coefficient(problem, rewrite, differential),
        _ => false,
    }
}

/// Whether a factor without a derivative stands in a product that has one.
fn is_coefficient(problem: &Problem, rewrite: &Rewrite, differential: &HashSet<&str>) -> bool {
    let Some(expression) = rewrite.home.expression(problem) else {
        return false;
    };
    let part = |length: usize| site::at(&expression.tree, &rewrite.route[..length]);
    let mut length = rewrite.route.len();
    while length > 0 && part(length - 1).is_some_and(is_product) {
        length -= 1;
    }
    let [factor, product] = [rewrite.route.len(), length].map(part);
    let has = |tree: Option<&Tree>| tree.is_some_and(|tree| has_derivative(tree, differential));
    has(product) && !has(factor)
}

/// Whether a tree multiplies or divides, or passes on what does.
fn is_product(tree: &Tree) -> bool {
    matches!(
        tree.kind,
        TreeKind::Binary(Binary::Multiply | Binary::Divide, _)
            | TreeKind::Negate(_)
            | TreeKind::Bracket(_)
    )
}

/// The definitions with a derivative, their own or that of another definition that they name.
fn differential(problem: &Problem) -> HashSet<&str> {
    let mut found = HashSet::new();
    loop {
        let before = found.len();
        for (name, definition) in &problem.definitions {
            let mut parts = site::parts(&definition.value);
            if !definition.is_exact && parts.any(|part| has_derivative(&part.tree, &found)) {
                found.insert(name.as_str());
            }
        }
        if found.len() == before {
            return found;
        }
    }
}

/// Whether a derivative occurs in it, or the name of a definition with one.
fn has_derivative(tree: &Tree, differential: &HashSet<&str>) -> bool {
    let is_derivative = match &tree.kind {
        TreeKind::Name(name) => differential.contains(name.as_str()),
        TreeKind::Call(Callee::Operator(operator), _) => matches!(
            operator,
            Operator::Derivative
                | Operator::TimeDerivative
                | Operator::Gradient
                | Operator::Divergence
                | Operator::Laplacian
                | Operator::Curl
        ),
        _ => false,
    };
    let mut children = tree.children().into_iter();
    is_derivative || children.any(|child| has_derivative(child, differential))
}

/// Whether an edit changes the expression, but its value at no point.
fn is_unseen(
    bench: &mut Bench,
    candidate: &Candidate,
    sampled: &Sampled<'_>,
    equation: &str,
) -> bool {
    let mut sources = sampled.quantities.iter();
    let is_source =
        |q: &crate::derive::DerivedQuantity<_>| q.role == Role::Source && q.name == equation;
    let Some(index) = sources.position(is_source) else {
        return false;
    };
    let Some(right) = bench.altered(None, equation, |right| right.tensor.clone()) else {
        return false;
    };
    let unseen = bench.altered(Some(&candidate.alteration), equation, |altered| {
        let values = altered.at(&sampled.points, 1.0);
        altered.tensor != right
            && sampled
                .over(index)
                .zip(values)
                .all(|((_, right), values)| right.iter().zip(&values).all(|(a, b)| is_same(a, b)))
    });
    unseen == Some(true)
}
