//! Steps in space and in time. Where both vary, only printed rates or the user can tell over which
//! one the errors are judged.

use super::columns::{Cells, DIMENSIONS, are_in_proportion};
use super::names::{Word, reciprocal};
use super::reader::{NEIGHBOURS, TableReader};
use super::step::StepColumn;
use crate::input::InputError;
use crate::input::advice::{Argument, Text};

/// What is refined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    Space,
    Time,
}

impl Family {
    /// The family of a step or a count, by its name; `None` for other columns.
    pub(super) fn of(column: &Cells<'_>) -> Option<Self> {
        let lower = column.name.to_lowercase();
        let base = reciprocal(&lower).unwrap_or(&lower);
        let letters = base.chars().filter(|c| c.is_alphanumeric() || *c == '∆');
        let joined: String = letters.collect();
        let is_time = joined.contains("time") || joined.ends_with("steps");
        let is_time = is_time
            || ["dt", "tau", "τ", "deltat", "δt", "∆t", "nt", "stepsize"].contains(&&*joined);
        // Random samples refine neither.
        let is_other = ["sample", "path", "particle"];
        match column.word {
            Word::Count(_) if is_other.iter().any(|other| joined.contains(other)) => None,
            Word::Step | Word::Count(_) if is_time => Some(Self::Time),
            Word::Step | Word::Count(_) => Some(Self::Space),
            _ => None,
        }
    }
}

/// Whether what a name counts has one dimension: 1/h, time steps.
pub(super) fn is_edge(name: &str) -> bool {
    reciprocal(name).is_some() || name.to_lowercase().ends_with("steps") || name == "nt"
}

/// A column that may be the step, with the steps that it then gives.
struct Candidate {
    column: usize,
    family: Family,
    /// One list of steps for each dimension that a count may have.
    ladders: Vec<Vec<f64>>,
}

impl Candidate {
    /// Whether it is the same ladder as another, so that it does not matter which one is taken.
    fn is_same_as(&self, other: &Self) -> bool {
        match (&self.ladders[..], &other.ladders[..]) {
            ([own], [others]) => are_in_proportion(own, others),
            _ => false,
        }
    }
}

impl TableReader<'_> {
    /// The step where columns of both families vary: that over which the printed rates are those of
    /// the errors. `None` where there is one family, or where both are one ladder.
    ///
    /// # Errors
    /// No rates decide, or they fit both families; each column is offered.
    pub(super) fn step_of_families(&self) -> Result<Option<StepColumn>, InputError> {
        let candidates = self.steps_and_counts();
        let of = |family: Family| candidates.iter().filter(move |one| one.family == family);
        let mut pairs = of(Family::Space).flat_map(|a| of(Family::Time).map(move |b| (a, b)));
        if self.choice.dim.is_some() || pairs.all(|(a, b)| a.is_same_as(b)) {
            return Ok(None);
        }
        let fitting: Vec<&Candidate> = candidates
            .iter()
            .filter(|one| {
                one.ladders
                    .iter()
                    .any(|steps| self.has_rates_over(one.column, steps))
            })
            .collect();
        if let Some(first) = fitting.first()
            && fitting.iter().all(|one| one.family == first.family)
        {
            // A step before a count, as where there is one family.
            let step = fitting
                .iter()
                .find(|one| self.columns[one.column].word == Word::Step);
            return Ok(Some(StepColumn {
                column: step.unwrap_or(first).column,
                how: step.map_or(String::new(), |_| ", as the printed rates say".to_owned()),
                is_chosen: true,
            }));
        }
        let columns: Vec<usize> = candidates.iter().map(|one| one.column).collect();
        let expected =
            Text::from("a step in space or one in time: name it with ") + Argument::Step.alone();
        let found = format!("both vary: {}", self.quoted(&columns));
        let offers = columns.iter().map(|k| self.with_step(*k));
        Err(self.refuse(expected, &found).offering(offers))
    }

    /// The columns that may be the step by their names, and vary.
    fn steps_and_counts(&self) -> Vec<Candidate> {
        let candidate = |column: usize| {
            let cells = &self.columns[column];
            let family = Family::of(cells)?;
            let is_count = matches!(cells.word, Word::Count(_));
            let are_numbers = cells
                .values
                .iter()
                .all(|value| *value > 0.0 && value.is_finite());
            if !are_numbers || is_count && !cells.is_whole() {
                return None;
            }
            let ladder = |dim: &f64| {
                cells
                    .values
                    .iter()
                    .map(|count| count.powf(-1.0 / dim))
                    .collect()
            };
            let ladders = match is_count {
                false => vec![cells.values.clone()],
                true if is_edge(&cells.name) => vec![ladder(&1.0)],
                true => DIMENSIONS.iter().map(ladder).collect(),
            };
            Some(Candidate {
                column,
                family,
                ladders,
            })
        };
        let near = self
            .candidates(|k, word| k < NEIGHBOURS && matches!(word, Word::Step | Word::Count(_)));
        near.into_iter().filter_map(candidate).collect()
    }

    /// Whether all columns named like rates are the rates of errors over these steps.
    fn has_rates_over(&self, column: usize, steps: &[f64]) -> bool {
        let of_errors = self.columns_of_rates(column, steps);
        let columns = self.columns.iter().enumerate();
        let mut named = columns.filter(|(_, cells)| {
            cells.word == Word::Rate
                && !cells.is_steep()
                && cells.values.iter().any(|v| v.is_finite())
        });
        let is_rates =
            |(k, _): (usize, &Cells<'_>)| of_errors.iter().any(|rates| rates.column == k);
        !of_errors.is_empty() && named.all(is_rates)
    }
}
