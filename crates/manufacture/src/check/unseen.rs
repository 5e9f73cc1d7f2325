//! Edits that no point sees: mistakes in an equation that leave the source of this solution as it
//! is.

use std::cell::OnceCell;
use std::collections::HashSet;

use super::{Finding, Sampled, finding, general, is_same};
use crate::against::bench::{Alteration, Bench, Points, Rewrite};
use crate::against::candidates::{self, Candidate, EditKind};
use crate::against::{cause, site, text};
use crate::arithmetic::tape::SizedValue;
use crate::derive::Part;
use crate::language::names::{Callee, Operator};
use crate::language::tree::{Binary, Tree, TreeKind};
use crate::model::Model;

/// Points at which general fields are compared.
const GENERAL_POINTS: usize = 20;

/// One finding for each equation and kind of edit: the first edit that changes the source for other
/// fields, but not for this solution.
///
/// An edit that changes nothing for any fields, as a gradient transposed inside a symmetric form,
/// is no mistake.
pub(super) fn edits(model: &Model, sampled: &Sampled<'_>) -> Vec<Finding> {
    let problem = &model.problem;
    let few = &sampled.points[..sampled.points.len().min(GENERAL_POINTS)];
    let general = OnceCell::new();
    let differential = problem.depending(|part| has_derivative(&part.tree, &HashSet::new()));
    let mut findings = vec![];
    for equation in &problem.equations {
        let mut kinds: Vec<&'static str> = vec![];
        let Some(mut of_this) = Trial::new(model, &equation.name, &sampled.points) else {
            continue;
        };
        for candidate in &candidates::all(problem, Part::Interior, &equation.name) {
            let kind = cause::word(candidate.kind, 1.0);
            if kinds.contains(&kind)
                || !is_common(candidate, &differential)
                || of_this.is_changed_by(&candidate.alteration) != Some(false)
            {
                continue;
            }
            let general: &Option<Model> = general.get_or_init(|| general::model(model, few));
            let trial = general
                .as_ref()
                .and_then(|general| Trial::new(general, &equation.name, few));
            // Without values nothing is known, and the edit counts.
            if trial
                .is_none_or(|mut trial| trial.is_changed_by(&candidate.alteration) != Some(false))
            {
                kinds.push(kind);
                let named = text::named(problem, &equation.place, candidate, 1.0);
                let text = cause::unseen(candidate.kind, &named.edit, &problem.file);
                findings.push(finding("slip-invisible", &equation.place.key, text, None));
            }
        }
    }
    findings
}

/// A source at some points, on which edits are tried.
struct Trial<'t> {
    bench: Bench<'t>,
    source: &'t str,
    points: Points,
    right: Vec<Vec<SizedValue>>,
}

impl<'t> Trial<'t> {
    fn new(model: &'t Model, source: &'t str, points: &[Vec<f64>]) -> Option<Self> {
        let mut bench = Bench::new(model, Part::Interior)?;
        let points = Points::plain(points);
        let right = bench.altered(None, source, |right| right.at(&points, 1.0).collect())?;
        Some(Self {
            bench,
            source,
            points,
            right,
        })
    }

    /// Whether an edit changes a value; `None` if it leaves none.
    fn is_changed_by(&mut self, edit: &Alteration<'_>) -> Option<bool> {
        self.bench.altered(Some(edit), self.source, |altered| {
            let mut pairs = altered.at(&self.points, 1.0).zip(&self.right);
            pairs.any(|(edited, right)| edited.iter().zip(right).any(|(a, b)| !is_same(a, b)))
        })
    }
}

/// Mistakes that people often make: the product rule, a gradient by its transpose, a transpose that
/// is missing.
fn is_common(candidate: &Candidate<'_>, differential: &HashSet<&str>) -> bool {
    let Alteration::Rewrites(rewrites) = &candidate.alteration else {
        return false;
    };
    let [rewrite] = rewrites.as_slice() else {
        return false;
    };
    match candidate.kind {
        _ if rewrite.within.place.key.starts_with("exact.") => false,
        EditKind::TransposedGradient | EditKind::MissingTranspose => true,
        EditKind::Held => is_coefficient(rewrite, differential),
        _ => false,
    }
}

/// Whether a factor without a derivative stands in a product that has one.
fn is_coefficient(rewrite: &Rewrite<'_>, differential: &HashSet<&str>) -> bool {
    let part = |length: usize| site::at(&rewrite.within.tree, &rewrite.route[..length]);
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
    let mut children = tree.children().iter();
    is_derivative || children.any(|child| has_derivative(child, differential))
}
