//! Causes that concern all of a component: its sign, a factor of it, its terms, its time, its
//! parameters.

use super::cause::{Cause, TermFactor};
use super::right::{ComponentPlace, Right};
use super::solve::{difference, simple};
use crate::derive::Part;
use crate::fit::{self, Column};
use crate::model::TensorRows;

/// A term depends on others if less than this share of it is left.
const DEPENDENT: f64 = 1e-9;

/// A component of a foreign source beside the right one.
pub(super) struct Component<'a, 'm> {
    pub(super) right: &'a Right<'m>,
    pub(super) place: ComponentPlace,
    pub(super) foreign: &'a [f64],
    pub(super) source: Column,
    /// How close is close enough, at each point.
    pub(super) allowed: Vec<f64>,
}

impl Component<'_, '_> {
    pub(super) fn differences(&self) -> Column {
        let differences = difference(self.foreign, &self.source).into_iter();
        differences.map(f64::abs).collect()
    }

    /// Whether these values are those of the foreign source.
    pub(super) fn fits(&self, values: &[f64]) -> bool {
        let mut triples = self.foreign.iter().zip(values).zip(&self.allowed);
        triples.all(|((f, value), allowed)| (f - value).abs() <= *allowed)
    }

    pub(super) fn is_right(&self) -> bool {
        self.fits(&self.source)
    }

    fn combined(&self, columns: &[&Column], factors: &[f64]) -> Column {
        let mut sum = vec![0.0; self.source.len()];
        for (column, factor) in columns.iter().zip(factors) {
            for (sum, value) in sum.iter_mut().zip(*column) {
                *sum += factor * value;
            }
        }
        sum
    }

    /// Sign, constant, factor.
    pub(super) fn of_source(&self) -> Option<Cause> {
        if self.fits(&self.source) {
            return Some(Cause::Equal);
        }
        let opposite: Column = self.source.iter().map(|s| -s).collect();
        if self.fits(&opposite) {
            return Some(match self.right.part {
                Part::Interior => Cause::SignOfSource,
                _ => Cause::Normal,
            });
        }
        let ones = vec![1.0; self.source.len()];
        let difference = difference(self.foreign, &self.source);
        let constant = fit::least_squares(&[&ones], &difference).factors[0];
        let shifted: Column = self.source.iter().map(|s| s + constant).collect();
        if self.fits(&shifted) {
            return Some(Cause::Constant(simple(constant)));
        }
        let foreign = self.foreign.to_vec();
        let factor = simple(fit::least_squares(&[&self.source], &foreign).factors[0]);
        let scaled = self.combined(&[&self.source], &[factor]);
        let fits = fit::norm(&self.source) > 0.0 && self.fits(&scaled);
        fits.then_some(Cause::FactorOfSource(factor))
    }

    /// Several terms with other factors, by least squares over those that are independent.
    pub(super) fn of_terms(&self) -> Option<Cause> {
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
        let fitted = fit::least_squares(&columns, &difference(self.foreign, &self.source));
        let factors: Vec<f64> = fitted
            .factors
            .iter()
            .map(|factor| simple(1.0 + factor))
            .collect();
        let changes: Vec<f64> = factors.iter().map(|factor| factor - 1.0).collect();
        let columns: Vec<&Column> = std::iter::once(&self.source).chain(columns).collect();
        let changed = self.combined(&columns, &[vec![1.0], changes].concat());
        if columns.len() < 2 || !self.fits(&changed) {
            return None;
        }
        let labels = self.right.labels(self.place);
        let changed = independent
            .iter()
            .zip(&factors)
            .filter(|pair| *pair.1 != 1.0);
        let terms = changed.map(|(term, factor)| TermFactor {
            label: labels[*term].to_owned(),
            factor: *factor,
        });
        Some(Cause::Terms(terms.collect()))
    }

    /// The values of the first or of the last time at all times.
    pub(super) fn of_time(&self) -> Option<Cause> {
        let problem = &self.right.model.problem;
        problem.time.as_ref()?;
        let mut ends = problem.intervals.last()?.iter();
        let time = ends.find(|time| self.fits_at(**time))?;
        Some(Cause::Time(*time))
    }

    /// Whether the values at one time explain all points.
    fn fits_at(&self, time: f64) -> bool {
        let mut points = self.right.points.clone();
        for point in &mut points {
            if let Some(last) = point.last_mut() {
                *last = time;
            }
        }
        self.fits_everywhere(&points, &self.right.model.graph.parameters)
    }

    /// Points for numbers that are found step by step.
    fn few(&self) -> &[Vec<f64>] {
        const FEW: usize = 8;
        let points = &self.right.points;
        &points[..points.len().min(FEW)]
    }

    fn column(
        &self,
        rows: &TensorRows<'_>,
        points: impl Iterator<Item = Vec<f64>>,
        parameters: &[f64],
    ) -> Column {
        let component = self.place.component;
        points
            .map(|point| rows.with(&point, parameters).tensors[0][component].value)
            .collect()
    }

    /// Whether the values at these points, one for each of the question, and with these parameters
    /// are those of the foreign source, from point to point.
    fn fits_everywhere(&self, points: &[Vec<f64>], parameters: &[f64]) -> bool {
        let rows = self.right.rows(self.place);
        let component = self.place.component;
        points.iter().enumerate().all(|(place, point)| {
            let value = rows.with(point, parameters).tensors[0][component].value;
            (self.foreign[place] - value).abs() <= self.allowed[place]
        })
    }

    /// Another component, or two coordinates exchanged.
    pub(super) fn of_exchange(&self) -> Option<Cause> {
        let right = self.right;
        for other in right.places() {
            let values: Column = right.values(other).iter().map(|v| v.value).collect();
            if other != self.place && self.fits(&values) {
                return Some(Cause::Component(right.name(other).to_owned()));
            }
        }
        let coordinates = &right.model.problem.coordinates;
        for first in 0..coordinates.len() {
            for second in first + 1..coordinates.len() {
                let mut points = right.points.clone();
                points
                    .iter_mut()
                    .for_each(|point| point.swap(first, second));
                if self.fits_everywhere(&points, &right.model.graph.parameters) {
                    let names = [first, second].map(|place| coordinates[place].clone());
                    return Some(Cause::Coordinates(names));
                }
            }
        }
        None
    }

    /// A parameter with another value.
    pub(super) fn of_parameters(&self) -> Option<Cause> {
        let parameters = &self.right.model.problem.parameters;
        let values = &self.right.model.graph.parameters;
        let rows = self.right.rows(self.place);
        for (index, parameter) in parameters.iter().enumerate() {
            let with = |value: f64| {
                let values = self.right.parameters(index, value)?;
                Some(self.column(&rows, self.few().iter().cloned(), &values))
            };
            for start in [values[index], 0.0, 1.0] {
                let Some(value) = self.newton(start, f64::INFINITY, with).map(simple) else {
                    continue;
                };
                let all = self.right.parameters(index, value);
                if all.is_some_and(|values| self.fits_with(&values)) {
                    let name = parameter.name.clone();
                    return Some(Cause::Parameter { name, value });
                }
            }
        }
        None
    }

    fn fits_with(&self, parameters: &[f64]) -> bool {
        self.fits_everywhere(&self.right.points, parameters)
    }

    /// Gauss-Newton on one number; the slope is a central difference.
    ///
    /// * `longest`: the longest step.
    fn newton(
        &self,
        start: f64,
        longest: f64,
        with: impl Fn(f64) -> Option<Column>,
    ) -> Option<f64> {
        const STEPS: usize = 15;
        let mut value = start;
        for _ in 0..STEPS {
            let step = 1e-6 * value.abs().max(1e-3);
            let [here, above, below] = [value, value + step, value - step].map(&with);
            let slope: Column = difference(&above?, &below?)
                .iter()
                .map(|change| change / (2.0 * step))
                .collect();
            let rest = difference(self.foreign, &here?);
            let change = fit::least_squares(&[&slope], &rest).factors[0];
            if !change.is_finite() {
                return None;
            }
            value += change.clamp(-longest, longest);
            if change.abs() <= 1e-14 * value.abs() {
                break;
            }
        }
        Some(value)
    }
}
