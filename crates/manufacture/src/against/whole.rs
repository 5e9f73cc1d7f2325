//! Causes that concern all of a component: its sign, a factor of it, its terms, another component.

use super::Comparison;
use super::ask::ForeignQuantity;
use super::cause::{of_factors, of_terms};
use super::right::{Right, RightComponent};
use super::site::Span;
use super::solve::{Sample, difference, simple};
use crate::derive::Part;
use crate::fit::{self, Column};
use crate::problem::LineColumn;

/// A term depends on others if less than this share of it is left.
const DEPENDENT: f64 = 1e-9;

/// A value explains another within this many spreads of the file's own two evaluations, of the
/// larger of both sides, or within the digits printed.
///
/// Another program sums in another order, and may expand products: its rounding is larger than the
/// spread, but of its kind.
const SPREADS: f64 = 1000.0;

/// A component of a foreign source beside the right one.
pub(super) struct Component<'a, 'm> {
    pub(super) right: &'a RightComponent<'m>,
    pub(super) all: &'a Right<'m>,
    /// At all points.
    pub(super) values: Sample,
}

impl<'a, 'm> Component<'a, 'm> {
    /// * `spreads`: those of [`Right::spreads`].
    pub(super) fn new(all: &'a Right<'m>, spreads: &[f64], answer: &ForeignQuantity) -> Self {
        let mut components = all.components.iter();
        let place = components.position(|right| right.name == answer.name);
        let place = place.unwrap_or(0);
        let right = &all.components[place];
        let triples = right.values.iter().zip(&answer.values).zip(&answer.units);
        let allowed = triples.map(|((right, foreign), unit)| {
            SPREADS * spreads[place] * right.size.max(foreign.abs()) + unit
        });
        Self {
            all,
            values: Sample {
                component: right.place,
                allowed: allowed.collect(),
                right: right.column(),
                foreign: answer.values.clone(),
            },
            right,
        }
    }

    /// The name of its quantity.
    pub(super) fn quantity(&self) -> &'m str {
        &self.right.quantity.name
    }

    pub(super) fn differences(&self) -> Column {
        let values = &self.values;
        let differences = difference(&values.foreign, &values.right).into_iter();
        differences.map(f64::abs).collect()
    }

    /// What is said of it.
    pub(super) fn said(&self, cause: &'static str, words: &str) -> Comparison {
        let quantity = self.right.name.clone();
        Comparison {
            difference: self.differences().into_iter().fold(0.0, f64::max),
            sentence: format!("{quantity}: {words}"),
            quantity,
            cause,
            terms: vec![],
            factors: vec![],
            edits: vec![],
            alternatives: vec![],
        }
    }

    /// What is said of all of it, with its place in the file.
    fn said_of_all(&self, cause: &'static str, words: &str) -> Comparison {
        self.said_at(self.right.quantity.place.text, cause, words)
    }

    fn said_at(&self, place: LineColumn, cause: &'static str, words: &str) -> Comparison {
        let LineColumn { line, column } = place;
        let file = &self.all.model.problem.file;
        self.said(cause, &format!("{words} ({file}:{line}:{column})"))
    }

    /// Whether the right values plus these columns, times their factors, are the foreign ones.
    fn fits_with(&self, columns: &[&Column], factors: &[f64]) -> bool {
        let mut sum = self.values.right.clone();
        for (column, factor) in columns.iter().zip(factors) {
            for (sum, value) in sum.iter_mut().zip(*column) {
                *sum += factor * value;
            }
        }
        self.values.fits(&sum)
    }

    /// Right; sign, constant, factor.
    pub(super) fn of_source(&self) -> Option<Comparison> {
        let Sample { right, foreign, .. } = &self.values;
        if self.values.fits(right) {
            return Some(self.equal());
        }
        if self.all.sampled.part == Part::Interior && self.fits_with(&[right], &[-2.0]) {
            let words =
                "your source has the opposite sign: the equation was written on the other side";
            return Some(self.said_of_all("sign-of-source", words));
        }
        let ones = vec![1.0; right.len()];
        let constant = fit::least_squares(&[&ones], &difference(foreign, right)).factors[0];
        let factor = simple(fit::least_squares(&[right], foreign).factors[0]);
        let found = if self.fits_with(&[&ones], &[constant]) {
            let constant = simple(constant);
            let words =
                format!("your values differ from the right ones by the constant {constant}");
            Comparison {
                factors: vec![constant],
                ..self.said_of_all("constant", &words)
            }
        } else if factor != -1.0
            && fit::norm(right) > 0.0
            && self.fits_with(&[right], &[factor - 1.0])
        {
            let words = format!("your values are the right ones times {factor}");
            Comparison {
                factors: vec![factor],
                ..self.said_of_all("factor-of-source", &words)
            }
        } else {
            return None;
        };
        Some(found)
    }

    fn equal(&self) -> Comparison {
        let said = self.said("equal", "your values are right");
        let how = match said.difference {
            0.0 => ", to the last digit".to_owned(),
            largest => format!(
                ": the largest difference, {largest:.1e}, is within {SPREADS} times the spread \
                 of the two evaluations of the file, or within the digits printed"
            ),
        };
        Comparison {
            sentence: said.sentence.clone() + &how,
            ..said
        }
    }

    /// Several terms with other factors, by least squares over those that are independent.
    pub(super) fn of_several_terms(&self) -> Option<Comparison> {
        let terms = &self.right.terms;
        let independent = fit::independent(terms, DEPENDENT);
        let columns: Vec<&Column> = independent.iter().map(|term| &terms[*term]).collect();
        let Sample { right, foreign, .. } = &self.values;
        let fitted = fit::least_squares(&columns, &difference(foreign, right));
        let factors = fitted.factors.iter().map(|factor| simple(1.0 + factor));
        let factors: Vec<f64> = factors.collect();
        let changes: Vec<f64> = factors.iter().map(|factor| factor - 1.0).collect();
        if columns.is_empty() || !self.fits_with(&columns, &changes) {
            return None;
        }
        let labels = self.right.labels();
        let mut terms = vec![];
        let mut changed = vec![];
        for (term, factor) in independent.into_iter().zip(factors) {
            if factor != 1.0 {
                terms.push(labels[term].to_owned());
                changed.push(factor);
            }
        }
        let words = of_terms(&terms, &changed, &labels);
        // Labels of different equations may be equal.
        let mut equations = self.all.model.problem.equations.iter();
        let equation = equations.find(|equation| equation.name == self.quantity())?;
        let mut first = equation.terms.iter();
        let first = &first.find(|term| term.label == terms[0])?.expression;
        let start = Span::of(&first.tree).start;
        let place = first.place.of_text(&first.text, start);
        let said = self.said_at(place, of_factors(changed.iter().copied()), &words);
        Some(Comparison {
            terms,
            factors: changed,
            ..said
        })
    }

    /// Another component.
    pub(super) fn of_component(&self) -> Option<Comparison> {
        let mut others = self.all.components.iter();
        let other = others
            .find(|other| !std::ptr::eq(*other, self.right) && self.values.fits(&other.column()))?;
        let name = &other.name;
        Some(Comparison {
            terms: vec![name.clone()],
            ..self.said_of_all("components", &format!("your values are those of `{name}`"))
        })
    }
}
