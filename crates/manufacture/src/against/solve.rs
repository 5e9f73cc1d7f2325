//! The unknown factor of an edit, from the values of another program at a few points.

use super::bench::{Altered, Points};
use crate::fit::{self, Column};

/// The values of a component at some points.
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
        let mut pairs = values.iter().zip(&self.foreign).zip(&self.allowed);
        pairs.all(|((value, foreign), allowed)| (foreign - value).abs() <= *allowed)
    }

    /// The same at a few of the points.
    pub(super) fn at(&self, places: &[usize]) -> Self {
        let [right, foreign, allowed] = [&self.right, &self.foreign, &self.allowed]
            .map(|column| places.iter().map(|place| column[*place]).collect());
        Self {
            component: self.component,
            right,
            foreign,
            allowed,
        }
    }

    /// What other values leave of the difference; values that are not finite leave everything.
    fn left_by(&self, values: &[f64]) -> f64 {
        let left = fit::norm(&difference(&self.foreign, values));
        if left.is_nan() { f64::INFINITY } else { left }
    }
}

pub(super) fn difference(first: &[f64], second: &[f64]) -> Column {
    first.iter().zip(second).map(|(a, b)| a - b).collect()
}

/// A quantity as a function of one unknown factor.
pub(super) struct Curve<'c> {
    altered: &'c Altered<'c>,
    points: &'c Points,
    known: Vec<(f64, Vec<Column>)>,
}

impl<'c> Curve<'c> {
    pub(super) fn new(altered: &'c Altered<'c>, points: &'c Points) -> Self {
        Self {
            altered,
            points,
            known: vec![],
        }
    }

    /// Of each component its values at the points.
    pub(super) fn at(&mut self, factor: f64) -> &[Column] {
        let place = self.known.iter().position(|entry| entry.0 == factor);
        let place = place.unwrap_or_else(|| {
            let columns = self.altered.columns(self.points, factor);
            self.known.push((factor, columns));
            self.known.len() - 1
        });
        &self.known[place].1
    }
}

/// Changes below this share of the values are rounding.
const ROUNDING: f64 = 1e-11;

/// The factors that are tried where the quantity is not linear in it.
const TRIED: [f64; 17] = [
    1.0,
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

/// The factor that gives the values of the other program.
pub(super) fn factor(curve: &mut Curve<'_>, sample: &Sample) -> Option<f64> {
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
        return linear(sample, &one, &slope);
    }
    bent(&mut value, sample)
}

fn linear(sample: &Sample, one: &Column, slope: &Column) -> Option<f64> {
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
    factors.find(|factor| sample.fits(&with(*factor)))
}

/// Gauss-Newton on one number from the best of some; the slope is a difference.
fn bent(value: &mut impl FnMut(f64) -> Column, sample: &Sample) -> Option<f64> {
    const STARTS: usize = 3;
    const STEPS: usize = 12;
    let mut tried: Vec<[f64; 2]> = vec![];
    for factor in TRIED {
        let values = value(factor);
        if sample.fits(&values) {
            return Some(factor);
        }
        tried.push([sample.left_by(&values), factor]);
    }
    tried.sort_by(|a, b| a[0].total_cmp(&b[0]));
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
        let mut factors = [simple(factor), factor].into_iter();
        let found = factors.find(|factor| sample.fits(&value(*factor)));
        if found.is_some() {
            return found;
        }
    }
    None
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

/// Whether people write a factor: a fraction of small whole numbers.
pub(super) fn is_simple(factor: f64) -> bool {
    simple(factor * 12.0) == (factor * 12.0).round()
}
