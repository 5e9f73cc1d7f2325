//! Samples: several answers at each level, one for each seed. Each level becomes one error by name,
//! whose scatter says how well it is known.

use super::over_levels::Levels;
use crate::judge::verdict::{Of, Samples};
use crate::text::lists::distinct;
use crate::text::named::NamedNumber;

/// The errors of all levels, coarse to fine, and of each level the errors of all seeds, which are
/// the same on all levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled(pub Vec<Vec<Vec<NamedNumber>>>);

/// How the errors of a name are made of samples: as claimed of it, or `None`.
type OfName<'o> = &'o dyn Fn(&str) -> Option<Of>;

impl Sampled {
    /// The seeds of so many samples.
    pub fn seeds(count: usize) -> std::ops::RangeInclusive<usize> {
        1..=count
    }

    /// The numbers of a name; NaN where a seed has none.
    fn samples(&self, name: &str, of: OfName<'_>) -> Samples {
        let number =
            |errors: &Vec<NamedNumber>| NamedNumber::find(errors, name).unwrap_or(f64::NAN);
        let numbers = self
            .0
            .iter()
            .map(|level| level.iter().map(number).collect());
        let numbers: Vec<Vec<f64>> = numbers.collect();
        // No claim is made of the others, which may have either sign.
        let is_signed = numbers.iter().flatten().any(|number| *number < 0.0);
        let usual = if is_signed {
            Of::RootMeanSquare
        } else {
            Of::Mean
        };
        Samples {
            of: of(name).unwrap_or(usual),
            numbers,
            are_shared: true,
        }
    }

    /// The errors of each level by name.
    pub fn errors(&self, of: OfName<'_>) -> Vec<Vec<NamedNumber>> {
        let names = distinct(
            self.0
                .iter()
                .flatten()
                .flatten()
                .map(|error| error.name.as_str()),
        );
        let columns = names
            .iter()
            .map(|name| (name, self.samples(name, of).errors()));
        let columns: Vec<_> = columns.collect();
        let at = |level: usize| {
            let errors = columns.iter();
            let errors = errors.map(|(name, errors)| NamedNumber::new(**name, errors[level]));
            errors.collect()
        };
        (0..self.0.len()).map(at).collect()
    }

    /// Levels of these errors, whose rates are judged by the scatter of the samples.
    pub fn judging(&self, mut levels: Levels, of: OfName<'_>) -> Levels {
        for column in &mut levels.columns {
            column.samples = Some(self.samples(&column.name, of));
        }
        levels
    }

    /// What a level is, in words.
    pub fn words(count: usize) -> String {
        format!("each level is made of {count} samples, by the same seeds on all levels")
    }
}
