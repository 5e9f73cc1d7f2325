//! Samples: several answers at each level, one for each seed. Each level becomes one error by name,
//! whose scatter says how well it is known.

use super::errors_over_levels::is_step;
use super::kind::CaseFailure;
use super::over_levels::Levels;
use crate::text::lists::distinct;
use crate::text::named::NamedNumber;
use convergence_judge::verdict::{Of, Samples};

/// A level, and its errors for each seed; the seeds are the same on all levels.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledLevel {
    /// The label of its [refinement](super::over_levels::Refinement).
    pub label: String,
    /// The errors by name, one list for each seed; why it has none, where a sample failed.
    pub samples: Result<Vec<Vec<NamedNumber>>, CaseFailure>,
}

/// The levels, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled(pub Vec<SampledLevel>);

/// How the errors of a name are made of samples: as claimed of it, or `None`.
type OfName<'o> = &'o dyn Fn(&str) -> Option<Of>;

impl SampledLevel {
    /// The numbers of a name, if it has all samples; NaN where a seed has none.
    fn numbers(&self, name: &str) -> Vec<f64> {
        let samples = self.samples.iter().flatten();
        samples
            .map(|errors| NamedNumber::find(errors, name).unwrap_or(f64::NAN))
            .collect()
    }
}

impl Sampled {
    /// The seeds of so many samples.
    pub fn seeds(count: usize) -> std::ops::RangeInclusive<usize> {
        1..=count
    }

    /// How samples make the errors of a name.
    fn made_of(&self, name: &str, of: OfName<'_>) -> Of {
        let mut numbers = self.0.iter().flat_map(|level| level.numbers(name));
        // No claim is made of the others, which may have either sign.
        let usual = match numbers.any(|number| number < 0.0) {
            true => Of::RootMeanSquare,
            false => Of::Mean,
        };
        of(name).unwrap_or(usual)
    }

    /// The errors of each level by name, with its step, if it reports one.
    ///
    /// # Errors
    /// [`CaseFailure`] of a level whose samples have failed or report different steps.
    pub fn errors(&self, of: OfName<'_>) -> Vec<Result<Vec<NamedNumber>, CaseFailure>> {
        let all = self
            .0
            .iter()
            .flat_map(|level| level.samples.iter().flatten().flatten());
        let names = distinct(all.map(|error| error.name.as_str()));
        let ways: Vec<(&str, Of)> = names
            .into_iter()
            .map(|name| (name, self.made_of(name, of)))
            .collect();
        self.0.iter().map(|level| errors_of(level, &ways)).collect()
    }

    /// Levels of these errors, whose rates are judged by the scatter of the samples.
    pub fn judging(&self, mut levels: Levels, of: OfName<'_>) -> Levels {
        for column in &mut levels.columns {
            let refinements = levels.refinements.iter().zip(&column.errors);
            let labels = refinements.filter_map(|(level, error)| error.map(|_| &level.label));
            let sampled = labels.filter_map(|label| self.0.iter().find(|own| own.label == *label));
            let numbers: Vec<Vec<f64>> = sampled.map(|level| level.numbers(&column.name)).collect();
            let seeds = numbers.iter().map(|numbers| (0..numbers.len()).collect());
            column.samples = Some(Samples {
                of: self.made_of(&column.name, of),
                seeds: seeds.collect(),
                numbers,
            });
        }
        levels
    }

    /// What a level is, in words.
    pub fn words(count: usize) -> String {
        format!("each level is made of {count} samples, by the same seeds on all levels")
    }
}

/// * `ways`: how samples make the error of each name.
fn errors_of(level: &SampledLevel, ways: &[(&str, Of)]) -> Result<Vec<NamedNumber>, CaseFailure> {
    if let Err(failure) = &level.samples {
        return Err(failure.clone());
    }
    let mut errors = vec![];
    for &(name, of) in ways {
        let numbers = level.numbers(name);
        let error = if !is_step(name) {
            of.error(&numbers)
        } else if numbers
            .windows(2)
            .all(|pair| pair[0].to_bits() == pair[1].to_bits())
        {
            numbers[0]
        } else {
            let message = "expected one step for all samples of a level, found others";
            return Err(CaseFailure::new(format!("{message} in \"{name}\"")));
        };
        errors.push(NamedNumber::new(name, error));
    }
    // A level of which no sample reports a step has none.
    errors.retain(|error| !is_step(&error.name) || !error.value.is_nan());
    Ok(errors)
}
