//! The same quantities by Taylor jets on the expressions as written.

use crate::arithmetic::SAME;
use crate::arithmetic::tape::SizedValue;

use super::{Finding, Sampled, finding, role_words};
use crate::derive::components;
use crate::model::Model;
use crate::problem::InputError;

/// A component of a quantity at a point in both ways.
pub(crate) struct BothWays<'s> {
    /// The place of the quantity among those of the part.
    pub(crate) quantity: usize,
    /// The place among the components of the quantity.
    pub(crate) place: usize,
    point: &'s [f64],
    rules: SizedValue,
    series: f64,
}

impl BothWays<'_> {
    fn difference(&self) -> f64 {
        (self.rules.value - self.series).abs()
    }

    /// The difference of the two as a share of the size; 0 over 0 is none.
    pub(crate) fn share(&self) -> Option<f64> {
        let share = self.difference() / self.rules.size;
        share.is_finite().then_some(share)
    }
}

/// All components at the first points of a part, at most this many.
///
/// # Errors
/// An integral without accurate values.
pub(crate) fn both_ways<'s>(
    model: &Model,
    sampled: &'s Sampled<'_>,
    most: usize,
) -> Result<Vec<BothWays<'s>>, InputError> {
    let jets = model.jets();
    let mut all = vec![];
    for (point, values) in sampled.points.iter().zip(&sampled.values).take(most) {
        let second = jets.at(sampled.part, point)?;
        for (quantity, (first, second)) in values.iter().zip(second).enumerate() {
            let pairs = first.iter().zip(second.tensor.parts).enumerate();
            all.extend(pairs.map(|(place, (rules, series))| BothWays {
                quantity,
                place,
                point,
                rules: *rules,
                series: series.value(),
            }));
        }
    }
    Ok(all)
}

/// * `most`: points of the part where the two ways are compared. A rule that is wrong is wrong
///   almost everywhere.
pub(super) fn compare(
    model: &Model,
    sampled: &Sampled<'_>,
    most: usize,
) -> Result<Vec<Finding>, InputError> {
    let mut findings: Vec<Finding> = vec![];
    for both in both_ways(model, sampled, most)? {
        let quantity = &sampled.quantities[both.quantity];
        let difference = both.difference();
        // NaN is a difference, too.
        let is_same = difference <= SAME * both.rules.size;
        if is_same || findings.iter().any(|known| known.key == quantity.place.key) {
            continue;
        }
        let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
        let text = format!(
            "{} {} is {:e} by the rules of derivatives and {:e} by Taylor series at {}",
            role_words(quantity.role),
            names[both.place],
            both.rules.value,
            both.series,
            model.place_in_words(both.point)
        );
        findings.push(finding(
            "second-way",
            &quantity.place.key,
            text,
            Some(difference),
        ));
    }
    Ok(findings)
}
