//! Causes that concern all of a component: its sign, a factor of it, its terms, another component.

use super::Comparison;
use super::ask::ForeignQuantity;
use super::cause::{TermFactor, of_factors, of_terms};
use super::explain::place_of;
use super::right::{ComponentPlace, Right};
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
    pub(super) right: &'a Right<'m>,
    pub(super) place: ComponentPlace,
    /// At all points.
    pub(super) values: Sample,
}

impl<'a, 'm> Component<'a, 'm> {
    /// * `spreads`: those of [`Right::spreads`].
    pub(super) fn new(
        right: &'a Right<'m>,
        spreads: &[Vec<f64>],
        answer: &ForeignQuantity,
    ) -> Self {
        let place = right.place_of(answer).unwrap_or(ComponentPlace {
            quantity: 0,
            component: 0,
        });
        let values = right.values(place);
        let spread = spreads[place.quantity][place.component];
        let triples = values.iter().zip(&answer.values).zip(&answer.units);
        let allowed = triples.map(|((right, foreign), unit)| {
            SPREADS * spread * right.size.max(foreign.abs()) + unit
        });
        Self {
            right,
            place,
            values: Sample {
                component: place.component,
                allowed: allowed.collect(),
                right: values.iter().map(|v| v.value).collect(),
                foreign: answer.values.clone(),
            },
        }
    }

    pub(super) fn differences(&self) -> Column {
        let values = &self.values;
        let differences = difference(&values.foreign, &values.right).into_iter();
        differences.map(f64::abs).collect()
    }

    /// What is said of it.
    pub(super) fn said(&self, cause: &'static str, words: &str) -> Comparison {
        let quantity = self.right.name(self.place).to_owned();
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
        let place = place_of(self.right, self.place.quantity);
        self.said_at(place.text, cause, words)
    }

    fn said_at(&self, place: LineColumn, cause: &'static str, words: &str) -> Comparison {
        let LineColumn { line, column } = place;
        let file = &self.right.model.problem.file;
        self.said(cause, &format!("{words} ({file}:{line}:{column})"))
    }

    fn combined(&self, columns: &[&Column], factors: &[f64]) -> Column {
        let mut sum = vec![0.0; self.values.right.len()];
        for (column, factor) in columns.iter().zip(factors) {
            for (sum, value) in sum.iter_mut().zip(*column) {
                *sum += factor * value;
            }
        }
        sum
    }

    /// Right; sign, constant, factor.
    pub(super) fn of_source(&self) -> Option<Comparison> {
        let Sample { right, foreign, .. } = &self.values;
        if self.values.fits(right) {
            return Some(self.equal());
        }
        let opposite: Column = right.iter().map(|s| -s).collect();
        if self.right.part == Part::Interior && self.values.fits(&opposite) {
            let words =
                "your source has the opposite sign: the equation was written on the other side";
            return Some(self.said_of_all("sign-of-source", words));
        }
        let ones = vec![1.0; right.len()];
        let constant = fit::least_squares(&[&ones], &difference(foreign, right)).factors[0];
        let shifted: Column = right.iter().map(|s| s + constant).collect();
        if self.values.fits(&shifted) {
            let constant = simple(constant);
            let words =
                format!("your values differ from the right ones by the constant {constant}");
            return Some(Comparison {
                factors: vec![constant],
                ..self.said_of_all("constant", &words)
            });
        }
        let factor = simple(fit::least_squares(&[right], foreign).factors[0]);
        let scaled = self.combined(&[right], &[factor]);
        let fits = factor != -1.0 && fit::norm(right) > 0.0 && self.values.fits(&scaled);
        fits.then(|| Comparison {
            factors: vec![factor],
            ..self.said_of_all(
                "factor-of-source",
                &format!("your values are the right ones times {factor}"),
            )
        })
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
        let terms = self.right.terms(self.place);
        let mut independent: Vec<usize> = vec![];
        for (term, column) in terms.iter().enumerate() {
            let others: Vec<&Column> = independent.iter().map(|i| &terms[*i]).collect();
            let rest = fit::least_squares(&others, column).residual;
            if rest > DEPENDENT * fit::norm(column) {
                independent.push(term);
            }
        }
        let columns: Vec<&Column> = independent.iter().map(|i| &terms[*i]).collect();
        let fitted = fit::least_squares(
            &columns,
            &difference(&self.values.foreign, &self.values.right),
        );
        let factors: Vec<f64> = fitted
            .factors
            .iter()
            .map(|factor| simple(1.0 + factor))
            .collect();
        let changes: Vec<f64> = factors.iter().map(|factor| factor - 1.0).collect();
        let columns: Vec<&Column> = std::iter::once(&self.values.right).chain(columns).collect();
        let changed = self.combined(&columns, &[vec![1.0], changes].concat());
        if columns.len() < 2 || !self.values.fits(&changed) {
            return None;
        }
        let labels = self.right.labels(self.place);
        let changed = independent
            .iter()
            .zip(&factors)
            .filter(|pair| *pair.1 != 1.0);
        let changed = changed.map(|(term, factor)| TermFactor {
            label: labels[*term].to_owned(),
            factor: *factor,
        });
        let changed: Vec<TermFactor> = changed.collect();
        let factors: Vec<f64> = changed.iter().map(|term| term.factor).collect();
        let words = of_terms(&changed, &labels);
        // Labels of different equations may be equal.
        let quantity = &self.right.quantities[self.place.quantity].quantity;
        let mut equations = self.right.model.problem.equations.iter();
        let equation = equations.find(|equation| equation.name == quantity.name)?;
        let mut terms = equation.terms.iter();
        let first = &terms
            .find(|term| term.label == changed[0].label)?
            .expression;
        let start = Span::of(&first.tree, &first.text).start;
        let place = first.place.of_text(&first.text, start);
        let said = self.said_at(place, of_factors(factors.iter().copied()), &words);
        Some(Comparison {
            terms: changed.into_iter().map(|term| term.label).collect(),
            factors,
            ..said
        })
    }

    /// Another component.
    pub(super) fn of_component(&self) -> Option<Comparison> {
        let mut others = self.right.places().into_iter();
        let other = others.find(|other| {
            let values: Column = self.right.values(*other).iter().map(|v| v.value).collect();
            *other != self.place && self.values.fits(&values)
        })?;
        let name = self.right.name(other);
        Some(Comparison {
            terms: vec![name.to_owned()],
            ..self.said_of_all("components", &format!("your values are those of `{name}`"))
        })
    }
}
