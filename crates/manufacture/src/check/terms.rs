//! The terms of an equation: their shares, and which of them cannot be told apart.

use super::{Finding, Sampled, Share, finding, is_zero};
use crate::arithmetic::tape::SizedValue;
use crate::derive::Role;
use crate::fit::{self, Column};
use crate::model::{Model, TensorRows};

/// A term below this share of the largest term at every point would not be missed.
const SMALL: f64 = 0.01;

/// A residual below this share of a column means that it depends on the others.
const DEPENDENT: f64 = 1e-10;

pub(super) struct TermFindings {
    pub(super) findings: Vec<Finding>,
    pub(super) shares: Vec<Share>,
}

pub(super) fn of_equations(model: &Model, sampled: &Sampled<'_>) -> TermFindings {
    let mut terms = TermFindings {
        findings: vec![],
        shares: vec![],
    };
    let sources = sampled.quantities.iter().filter(|q| q.role == Role::Source);
    for source in sources {
        let labels: Vec<&str> = source.terms.iter().map(|term| term.0.as_str()).collect();
        let rows = TensorRows::new(&model.graph, source.terms.iter().map(|term| &term.1));
        let values: Vec<_> = sampled
            .points
            .iter()
            .map(|point| rows.at(point).tensors)
            .collect();
        let columns: Vec<Column> = (0..labels.len())
            .map(|term| column(&values, term))
            .collect();
        let norms: Vec<f64> = columns.iter().map(|column| fit::norm(column)).collect();
        let largest = norms.iter().copied().fold(0.0, f64::max);
        for (term, label) in labels.iter().enumerate() {
            let share = if largest > 0.0 {
                norms[term] / largest
            } else {
                0.0
            };
            terms.shares.push(Share {
                equation: source.name.clone(),
                term: (*label).to_owned(),
                share,
            });
            if norms[term] == 0.0 {
                let text = format!("`{label}` is zero: losing it would not be noticed");
                terms
                    .findings
                    .push(finding("term-absent", &source.place.key, text, Some(0.0)));
            } else if is_small(&columns, term, source.tensor.parts.len()) {
                let text = format!(
                    "`{label}` is less than 1 % of the largest term everywhere: losing it would hardly be noticed"
                );
                terms
                    .findings
                    .push(finding("term-small", &source.place.key, text, Some(share)));
            }
        }
        terms
            .findings
            .extend(dependent(&source.place.key, &labels, &columns));
    }
    terms
}

/// All components of a term at all points; zeros if only rounding is left of it.
fn column(values: &[Vec<Vec<SizedValue>>], term: usize) -> Column {
    let is_absent = values.iter().all(|point| is_zero(&point[term]));
    let parts = values.iter().flat_map(|point| &point[term]);
    parts
        .map(|v| if is_absent { 0.0 } else { v.value })
        .collect()
}

/// Whether a term is small against the largest one at every point.
fn is_small(columns: &[Column], term: usize, components: usize) -> bool {
    let length = |column: &Column, point: usize| fit::norm(&column[point..point + components]);
    let points = (0..columns[term].len()).step_by(components);
    points.into_iter().all(|point| {
        let largest = columns
            .iter()
            .map(|column| length(column, point))
            .fold(0.0, f64::max);
        length(&columns[term], point) < SMALL * largest
    })
}

/// Terms with a constant ratio to another, and sums of several others.
fn dependent(key: &str, labels: &[&str], columns: &[Column]) -> Vec<Finding> {
    let mut findings = vec![];
    let independent = fit::independent(columns, DEPENDENT);
    for (term, column) in columns.iter().enumerate() {
        if fit::norm(column) == 0.0 || independent.contains(&term) {
            continue;
        }
        let before = independent.iter().filter(|other| **other < term);
        let others: Vec<&Column> = before.clone().map(|other| &columns[*other]).collect();
        let fitted = fit::least_squares(&others, column);
        let used = before.zip(fitted.factors);
        let share = |other: usize, factor: f64| factor.abs() * fit::norm(&columns[other]);
        let used =
            used.filter(|(other, factor)| share(**other, *factor) > DEPENDENT * fit::norm(column));
        let used: Vec<(&usize, f64)> = used.collect();
        let label = labels[term];
        let (text, ratio) = match used.as_slice() {
            [(other, ratio)] => {
                let text = format!(
                    "`{label}` is {ratio:.6} times `{}`: a mistake in one cannot be told from a mistake in the other",
                    labels[**other]
                );
                (text, Some(*ratio))
            }
            _ => {
                let names = used
                    .iter()
                    .map(|(other, _)| format!("`{}`", labels[**other]));
                let names: Vec<String> = names.collect();
                let text = format!(
                    "`{label}` is a combination of {}: mistakes in them cannot be told apart",
                    names.join(", ")
                );
                (text, None)
            }
        };
        findings.push(finding("terms-proportional", key, text, ratio));
    }
    findings
}
