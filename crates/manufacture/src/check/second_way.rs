//! The same quantities by Taylor jets on the expressions as written.

use crate::arithmetic::SAME;

use super::{Finding, Sampled, finding, role_words};
use crate::derive::components;
use crate::model::Model;
use crate::problem::InputError;

/// * `most`: points of the part where the two ways are compared. A rule that is wrong is wrong
///   almost everywhere.
pub(super) fn compare(
    model: &Model,
    sampled: &Sampled<'_>,
    most: usize,
) -> Result<Vec<Finding>, InputError> {
    let jets = model.jets();
    let mut findings: Vec<Finding> = vec![];
    for (point, values) in sampled.points.iter().zip(&sampled.values).take(most) {
        let second = jets.at(sampled.part, point)?;
        for ((first, second), quantity) in values.iter().zip(&second).zip(sampled.quantities) {
            let names = components(&model.problem, &quantity.name, &quantity.tensor.shape);
            for ((first, second), name) in first.iter().zip(&second.tensor.parts).zip(names) {
                let difference = (first.value - second.value()).abs();
                let is_known = findings.iter().any(|entry| entry.key == quantity.key);
                // NaN is a difference, too.
                if !(difference <= SAME * first.size) && !is_known {
                    let text = format!(
                        "{} {name} is {:e} by the rules of derivatives and {:e} by Taylor series at {}",
                        role_words(quantity.role),
                        first.value,
                        second.value(),
                        model.place_in_words(point)
                    );
                    findings.push(finding("second-way", &quantity.key, text, Some(difference)));
                }
            }
        }
    }
    Ok(findings)
}
