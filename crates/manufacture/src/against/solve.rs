//! The unknown factor of an edit, from the values of another program at a few points.

use super::bench::Evaluation;
use crate::arithmetic::tape::SizedValue;
use crate::fit::{self, Column};

/// The values of a component at a few points.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub(super) component: usize,
    pub(super) right: Column,
    pub(super) foreign: Column,
    /// How close is close enough.
    pub(super) allowed: Column,
}

impl Sample {
    /// Whether these values are those of the other program.
    pub(super) fn fits(&self, values: &[f64]) -> bool {
        let mut triples = self.foreign.iter().zip(values).zip(&self.allowed);
        triples.all(|((f, value), allowed)| (f - value).abs() <= *allowed)
    }

    /// What another value leaves, as a share of the difference from the right values.
    pub(super) fn left_by(&self, values: &[f64]) -> f64 {
        // Values that are not finite leave everything.
        if values.iter().any(|value| !value.is_finite()) {
            return f64::INFINITY;
        }
        let left = fit::norm(&difference(&self.foreign, values));
        left / fit::norm(&difference(&self.foreign, &self.right))
    }
}

pub(super) fn difference(first: &[f64], second: &[f64]) -> Column {
    first.iter().zip(second).map(|(a, b)| a - b).collect()
}

/// A quantity as a function of one unknown factor.
pub(super) struct Curve<'c> {
    evaluation: Evaluation<'c>,
    points: &'c [Vec<f64>],
    known: Vec<(f64, Vec<Column>)>,
}

impl<'c> Curve<'c> {
    pub(super) fn new(evaluation: Evaluation<'c>, points: &'c [Vec<f64>]) -> Self {
        Self {
            evaluation,
            points,
            known: vec![],
        }
    }

    /// Of each component its values at the points.
    pub(super) fn at(&mut self, factor: f64) -> &[Column] {
        let place = self.known.iter().position(|entry| entry.0 == factor);
        let place = place.unwrap_or_else(|| {
            let at = |point: &[f64]| self.evaluation.at(point, factor);
            self.known.push((factor, columns(self.points, at)));
            self.known.len() - 1
        });
        &self.known[place].1
    }
}

/// Of each component its values at points.
pub(super) fn columns(points: &[Vec<f64>], at: impl Fn(&[f64]) -> Vec<SizedValue>) -> Vec<Column> {
    let mut columns: Vec<Column> = vec![];
    for point in points {
        let values = at(point);
        columns.resize(values.len(), vec![]);
        for (column, value) in columns.iter_mut().zip(values) {
            column.push(value.value);
        }
    }
    columns
}

/// What became of the search for a factor.
#[derive(Debug, Clone, Default)]
pub(super) struct Solved {
    /// That with which all points fit.
    pub(super) factor: Option<f64>,
    /// The factor that comes nearest, and the share of the difference that it leaves.
    pub(super) nearest: f64,
    pub(super) left: f64,
}

/// Changes below this share of the values are rounding.
const ROUNDING: f64 = 1e-11;

/// The factors that are tried where the quantity is not linear in it.
const TRIED: [f64; 16] = [
    -1.0,
    0.0,
    2.0,
    0.5,
    1.5,
    2.0 / 3.0,
    3.0,
    1.0 / 3.0,
    4.0,
    0.25,
    0.75,
    4.0 / 3.0,
    -2.0,
    -0.5,
    10.0,
    0.1,
];

/// The factor that gives the values of the other program; `None` if it has no effect.
pub(super) fn factor(curve: &mut Curve<'_>, sample: &Sample) -> Option<Solved> {
    let mut value = |factor: f64| curve.at(factor)[sample.component].clone();
    let [zero, one, two] = [0.0, 1.0, 2.0].map(&mut value);
    let slope = difference(&two, &one);
    let before = difference(&one, &zero);
    let scale = fit::norm(&one).max(fit::norm(&two));
    if fit::norm(&slope) <= ROUNDING * scale && fit::norm(&before) <= ROUNDING * scale {
        return None;
    }
    let bend = fit::norm(&difference(&slope, &before));
    if bend <= 1e-9 * (fit::norm(&slope) + ROUNDING * scale) {
        return Some(linear(sample, &one, &slope));
    }
    Some(bent(&mut value, sample))
}

fn linear(sample: &Sample, one: &Column, slope: &Column) -> Solved {
    let rest = difference(&sample.foreign, one);
    let factor = 1.0 + fit::least_squares(&[slope], &rest).factors[0];
    let with = |factor: f64| -> Column {
        let pairs = one.iter().zip(slope);
        pairs
            .map(|(one, slope)| one + (factor - 1.0) * slope)
            .collect()
    };
    // Rounding of large other terms limits how exactly the factor of a small one is found.
    let mut factors = SIMPLE.into_iter().chain([simple(factor), factor]);
    Solved {
        factor: factors.find(|factor| sample.fits(&with(*factor))),
        nearest: simple(factor),
        left: sample.left_by(&with(factor)),
    }
}

/// Gauss-Newton on one number from the best of some; the slope is a difference.
fn bent(value: &mut impl FnMut(f64) -> Column, sample: &Sample) -> Solved {
    const STARTS: usize = 3;
    const STEPS: usize = 12;
    let mut tried: Vec<[f64; 2]> = vec![];
    for factor in TRIED {
        let values = value(factor);
        if sample.fits(&values) {
            return Solved {
                factor: Some(factor),
                ..Solved::default()
            };
        }
        let left = sample.left_by(&values);
        if left.is_finite() {
            tried.push([left, factor]);
        }
    }
    tried.push([1.0, 1.0]);
    tried.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut best = Solved {
        nearest: tried[0][1],
        left: tried[0][0],
        ..Solved::default()
    };
    for [_, start] in tried.into_iter().take(STARTS) {
        let mut factor = start;
        for _ in 0..STEPS {
            let step = 1e-6 * factor.abs().max(1e-2);
            let here = value(factor);
            let slope = difference(&value(factor + step), &here);
            let rest = difference(&sample.foreign, &here);
            let change = step * fit::least_squares(&[&slope], &rest).factors[0];
            if !change.is_finite() {
                break;
            }
            factor += change;
            if change.abs() <= 1e-14 * factor.abs() {
                break;
            }
        }
        let left = sample.left_by(&value(factor));
        if left < best.left {
            best.left = left;
            best.nearest = simple(factor);
        }
        let mut factors = [simple(factor), factor].into_iter();
        best.factor = factors.find(|factor| sample.fits(&value(*factor)));
        if best.factor.is_some() {
            break;
        }
    }
    best
}

/// The fraction of small whole numbers that a number is but for rounding, or the number.
pub(super) fn simple(number: f64) -> f64 {
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

/// How far-fetched a factor is: those that are most frequent in their order, then by size.
pub(super) fn complexity(factor: f64) -> f64 {
    match SIMPLE.iter().position(|entry| *entry == factor) {
        Some(place) => place as f64,
        None if simple(factor * 12.0) == (factor * 12.0).round() => {
            10.0 + factor.abs().max(1.0 / factor.abs())
        }
        None => 1000.0 + factor.abs().max(1.0 / factor.abs()),
    }
}
