//! The causes, in the order in which they are tried: the first that explains all points is
//! reported.

use super::ask::Answer;
use super::right::{Place, Right};
use super::{Comparison, sentence};
use crate::derive::{Part, Slip};
use crate::fit::{self, Column};

/// A value explains another within this many spreads of the file's own two evaluations, or within
/// the digits printed.
///
/// Another program sums in another order, and may expand products: its rounding is larger than the
/// spread, but of its kind.
pub(super) const SPREADS: f64 = 1000.0;

/// A term depends on others if less than this share of it is left.
const DEPENDENT: f64 = 1e-9;

/// A cause, and what it is about.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cause {
    pub(super) name: &'static str,
    pub(super) terms: Vec<String>,
    pub(super) factors: Vec<f64>,
    pub(super) alternatives: Vec<String>,
}

impl Cause {
    fn plain(name: &'static str) -> Self {
        Self::of(name, vec![], vec![])
    }

    fn of(name: &'static str, terms: Vec<String>, factors: Vec<f64>) -> Self {
        Self {
            name,
            terms,
            factors,
            alternatives: vec![],
        }
    }
}

/// A component of a foreign source beside the right one.
struct Case<'a, 'm> {
    right: &'a Right<'m>,
    place: Place,
    foreign: &'a [f64],
    source: Column,
    /// How close is close enough, at each point.
    allowed: Vec<f64>,
    labels: Vec<&'a str>,
    terms: Vec<Column>,
}

/// Explains what another program answers.
///
/// * `spreads`: those of [`Right::spreads`].
pub(super) fn explain(right: &Right<'_>, spreads: &[Vec<f64>], answer: &Answer) -> Comparison {
    let place = right.place_of(answer).unwrap_or(Place {
        quantity: 0,
        component: 0,
    });
    let values = right.values(place);
    let spread = spreads[place.quantity][place.component];
    let allowed = values
        .iter()
        .zip(&answer.units)
        .map(|(v, unit)| SPREADS * spread * v.size + unit);
    let quantity = right.quantities[place.quantity].quantity;
    let case = Case {
        right,
        place,
        foreign: &answer.values,
        allowed: allowed.collect(),
        source: values.iter().map(|v| v.value).collect(),
        labels: quantity.terms.iter().map(|term| term.0.as_str()).collect(),
        terms: right.terms(place),
    };
    let cause = case.cause();
    let differences = case.differences();
    Comparison {
        quantity: answer.name.clone(),
        difference: differences.iter().copied().fold(0.0, f64::max),
        sentence: sentence::sentence(right, &answer.name, &case.labels, &cause, &differences),
        cause: cause.name,
        terms: cause.terms,
        factors: cause.factors,
        alternatives: cause.alternatives,
    }
}

impl Case<'_, '_> {
    fn differences(&self) -> Vec<f64> {
        let pairs = self.foreign.iter().zip(&self.source);
        pairs.map(|(f, s)| (f - s).abs()).collect()
    }

    /// Whether these values are those of the foreign source.
    fn fits(&self, values: &[f64]) -> bool {
        let mut triples = self.foreign.iter().zip(values).zip(&self.allowed);
        triples.all(|((f, value), allowed)| (f - value).abs() <= *allowed)
    }

    /// The foreign source minus the right one.
    fn difference(&self) -> Column {
        let pairs = self.foreign.iter().zip(&self.source);
        pairs.map(|(f, s)| f - s).collect()
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

    fn label(&self, term: usize) -> String {
        self.labels[term].to_owned()
    }

    fn cause(&self) -> Cause {
        if self.fits(&self.source) {
            return Cause::plain("equal");
        }
        self.of_source()
            .or_else(|| self.of_one_term())
            .or_else(|| self.of_terms())
            .or_else(|| self.of_slip())
            .or_else(|| self.of_time())
            .or_else(|| self.of_exchange())
            .or_else(|| self.of_parameter())
            .unwrap_or_else(|| Cause::plain("none"))
    }

    /// Sign, constant, factor.
    fn of_source(&self) -> Option<Cause> {
        let is_on_face = self.right.part != Part::Interior;
        let inward = self.right.with_inward_normal(self.place);
        if inward.is_some_and(|inward| self.fits(&inward)) {
            return Some(Cause::plain("normal"));
        }
        let opposite: Column = self.source.iter().map(|s| -s).collect();
        if self.fits(&opposite) {
            let name = if is_on_face {
                "normal"
            } else {
                "sign-of-source"
            };
            return Some(Cause::plain(name));
        }
        let ones = vec![1.0; self.source.len()];
        let constant = fit::least_squares(&[&ones], &self.difference()).factors[0];
        let shifted: Column = self.source.iter().map(|s| s + constant).collect();
        if self.fits(&shifted) {
            return Some(Cause::of("constant", vec![], vec![simple(constant)]));
        }
        let factor = simple(fit::least_squares(&[&self.source], self.foreign).factors[0]);
        let scaled = self.combined(&[&self.source], &[factor]);
        let fits = fit::norm(&self.source) > 0.0 && self.fits(&scaled);
        fits.then(|| Cause::of("factor-of-source", vec![], vec![factor]))
    }

    /// One term with another factor; the simplest factor wins, the others are alternatives.
    fn of_one_term(&self) -> Option<Cause> {
        let difference = self.difference();
        let mut fitting: Vec<(usize, f64)> = vec![];
        for (term, column) in self.terms.iter().enumerate() {
            if fit::norm(column) == 0.0 {
                continue;
            }
            let fitted = 1.0 + fit::least_squares(&[column], &difference).factors[0];
            // Rounding of large other terms limits how exactly the factor of a small one is found.
            let mut factors = SIMPLE.into_iter().chain([simple(fitted), fitted]);
            let factor = factors.find(|factor| {
                self.fits(&self.combined(&[&self.source, column], &[1.0, factor - 1.0]))
            });
            fitting.extend(factor.map(|factor| (term, factor)));
        }
        fitting.sort_by(|a, b| complexity(a.1).total_cmp(&complexity(b.1)));
        let (term, factor) = *fitting.first()?;
        let others = fitting[1..].iter();
        Some(Cause {
            alternatives: others
                .map(|(term, factor)| format!("{} times {factor}", self.label(*term)))
                .collect(),
            ..Cause::of(of_factors(&[factor]), vec![self.label(term)], vec![factor])
        })
    }

    /// Several terms with other factors, by least squares over those that are independent.
    fn of_terms(&self) -> Option<Cause> {
        let mut independent: Vec<usize> = vec![];
        for (term, column) in self.terms.iter().enumerate() {
            let others: Vec<&Column> = independent.iter().map(|i| &self.terms[*i]).collect();
            let rest = fit::least_squares(&others, column).residual;
            if rest > DEPENDENT * fit::norm(column) {
                independent.push(term);
            }
        }
        let columns: Vec<&Column> = independent.iter().map(|i| &self.terms[*i]).collect();
        let fitted = fit::least_squares(&columns, &self.difference());
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
        let changed = independent
            .iter()
            .zip(&factors)
            .filter(|pair| *pair.1 != 1.0);
        let (terms, factors): (Vec<String>, Vec<f64>) = changed
            .map(|(term, factor)| (self.label(*term), *factor))
            .unzip();
        Some(Cause::of(of_factors(&factors), terms, factors))
    }

    fn of_slip(&self) -> Option<Cause> {
        let slip = Slip::ALL.into_iter().find(|slip| {
            let values = self.right.with_slip(self.place, *slip);
            values.is_some_and(|values| self.fits(&values))
        })?;
        Some(Cause::of(
            slip.cause(),
            vec![slip.words().to_owned()],
            vec![],
        ))
    }

    /// The values of the first or of the last time at all times.
    fn of_time(&self) -> Option<Cause> {
        let problem = &self.right.model.problem;
        problem.time.as_ref()?;
        let ends = problem.intervals.last()?;
        let time = ends.iter().find(|time| self.fits_at_time(**time))?;
        Some(Cause::of("time", vec![], vec![*time]))
    }

    fn fits_at_time(&self, time: f64) -> bool {
        let mut points = self.right.points.clone();
        for point in &mut points {
            if let Some(t) = point.last_mut() {
                *t = time;
            }
        }
        self.fits(&self.right.at_points(self.place, &points))
    }

    /// Another component, or two coordinates exchanged.
    fn of_exchange(&self) -> Option<Cause> {
        let right = self.right;
        for other in right.places() {
            let values: Column = right.values(other).iter().map(|v| v.value).collect();
            if other != self.place && self.fits(&values) {
                let name = right.name(other).to_owned();
                return Some(Cause::of("components", vec![name], vec![]));
            }
        }
        let coordinates = &right.model.problem.coordinates;
        for first in 0..coordinates.len() {
            for second in first + 1..coordinates.len() {
                let mut points = right.points.clone();
                points
                    .iter_mut()
                    .for_each(|point| point.swap(first, second));
                if self.fits(&right.at_points(self.place, &points)) {
                    let names = [first, second].map(|place| coordinates[place].clone());
                    return Some(Cause::of("coordinates", names.to_vec(), vec![]));
                }
            }
        }
        None
    }

    fn of_parameter(&self) -> Option<Cause> {
        let problem = &self.right.model.problem;
        for (index, parameter) in problem.parameters.iter().enumerate() {
            let value = self.right.model.graph.parameters[index];
            for start in [value, 0.0, 1.0] {
                let Some(fitted) = self.fit_parameter(index, start) else {
                    continue;
                };
                let fitted = simple(fitted);
                let values =
                    self.right
                        .with_parameter(self.place, index, fitted, &self.right.points);
                if values.is_some_and(|values| self.fits(&values)) {
                    let name = parameter.name.clone();
                    return Some(Cause::of("parameter", vec![name], vec![fitted]));
                }
            }
        }
        None
    }

    /// Gauss-Newton on one number; the slope is a central difference.
    fn fit_parameter(&self, index: usize, start: f64) -> Option<f64> {
        const STEPS: usize = 25;
        const POINTS: usize = 50;
        let points = &self.right.points[..self.right.points.len().min(POINTS)];
        let mut value = start;
        for _ in 0..STEPS {
            let step = 1e-6 * value.abs().max(1e-3);
            let [here, above, below] = [value, value + step, value - step]
                .map(|value| self.right.with_parameter(self.place, index, value, points));
            let [here, above, below] = [here?, above?, below?];
            let pairs = above.iter().zip(&below);
            let slope: Column = pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect();
            let pairs = self.foreign.iter().zip(&here);
            let rest: Column = pairs.map(|(f, s)| f - s).collect();
            let change = fit::least_squares(&[&slope], &rest).factors[0];
            if !change.is_finite() {
                return None;
            }
            value += change;
            if change.abs() <= 1e-14 * value.abs() {
                break;
            }
        }
        Some(value)
    }
}

/// The name of a cause by the factors of its terms.
fn of_factors(factors: &[f64]) -> &'static str {
    if factors.iter().all(|factor| *factor == -1.0) {
        "sign-of-term"
    } else if factors.iter().all(|factor| *factor == 0.0) {
        "missing-term"
    } else {
        "factor-of-term"
    }
}

/// The fraction of small whole numbers that a number is but for rounding, or the number.
fn simple(number: f64) -> f64 {
    const NEAR: f64 = 1e-8;
    for below in 1..=12 {
        let fraction = (number * f64::from(below)).round() / f64::from(below);
        if (number - fraction).abs() <= NEAR * number.abs().max(1.0) {
            // One zero: -0 is 0.
            return fraction + 0.0;
        }
    }
    number
}

/// The factors that mistakes have most often.
const SIMPLE: [f64; 4] = [-1.0, 0.0, 2.0, 0.5];

/// How far-fetched a factor is: those of [`SIMPLE`] in their order, then by size.
fn complexity(factor: f64) -> f64 {
    match SIMPLE.iter().position(|entry| *entry == factor) {
        Some(place) => place as f64,
        None => 10.0 + factor.abs().max(1.0 / factor.abs()),
    }
}
