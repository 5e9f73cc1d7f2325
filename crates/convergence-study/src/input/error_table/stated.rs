//! What the rates that a table prints say about its steps: the dimension of a count, the ratio of
//! levels.

use super::Doubt;
use super::columns::{DIMENSIONS, Derived};
use super::names::Word;
use super::reader::{NEIGHBOURS, TableReader};

/// Ratios of steps from level to level.
const RATIOS: [f64; 5] = [1.5, 2.0, 3.0, 4.0, 10.0];

/// A number that the rates of a table decide.
pub(super) struct Stated<'t> {
    pub(super) number: f64,
    /// The error whose rates these are.
    pub(super) error: &'t str,
}

impl TableReader<'_> {
    /// The only dimension D with which a column has the rates of another over `count^(-1/D)`.
    pub(super) fn stated_dimension(&self, count: usize) -> Option<Stated<'_>> {
        self.only(count, &DIMENSIONS, |count, dim| count.powf(-1.0 / dim))
    }

    /// A dimension that the user has chosen, where the rates of the table say another.
    pub(super) fn contradiction(&self, count: usize) -> Option<Doubt> {
        let chosen = self.choice.dim?;
        let stated = self.stated_dimension(count)?;
        (stated.number != chosen).then(|| Doubt::Dimension {
            chosen,
            stated: stated.number,
            column: stated.error.to_owned(),
        })
    }

    /// The only ratio R with which a column has the rates of another over `R^(-level)`.
    pub(super) fn stated_ratio(&self, level: usize) -> Option<Stated<'_>> {
        self.only(level, &RATIOS, |level, ratio| ratio.powf(-level))
    }

    /// The only one of some numbers with which all columns that are rates are rates of another;
    /// `None` if several fit, or none does.
    ///
    /// * `step`: of a number in column `of` with a candidate.
    fn only(
        &self,
        of: usize,
        candidates: &[f64],
        step: impl Fn(f64, f64) -> f64,
    ) -> Option<Stated<'_>> {
        let mut fits = vec![];
        for candidate in candidates {
            let values = self.columns[of].values.iter();
            let steps: Vec<f64> = values.map(|value| step(*value, *candidate)).collect();
            fits.push((*candidate, self.columns_of_rates(of, &steps)));
        }
        // A rate of one error may be that of another in a wrong dimension.
        let most = fits.iter().map(|(_, rates)| rates.len()).max()?;
        let has_all = |rates: &[RatesOf]| {
            let columns = fits.iter().flat_map(|(_, others)| others);
            let mut columns = columns.map(|other| other.column);
            columns.all(|column| rates.iter().any(|own| own.column == column))
        };
        let mut best = fits.iter().filter(|(_, rates)| most > 0 && has_all(rates));
        let (number, rates) = best.next()?;
        if best.next().is_some() {
            return None;
        }
        Some(Stated {
            number: *number,
            error: self.columns[rates[0].error].name.as_str(),
        })
    }

    /// The columns that are rates over these steps, which fall from row to row.
    pub(super) fn columns_of_rates(&self, of: usize, steps: &[f64]) -> Vec<RatesOf> {
        let falls = steps.windows(2).all(|two| two[1] < two[0]);
        let columns = (0..self.columns.len().min(NEIGHBOURS)).filter(|k| falls && *k != of);
        columns
            .filter_map(|column| {
                let Derivation { error, derived } = self.derivation(column, of, steps)?;
                (derived == Derived::Rates).then_some(RatesOf { column, error })
            })
            .collect()
    }

    /// The error of which a column has the rates or factors: one before it, the nearest first, or
    /// one after it.
    ///
    /// * `of`: the column of the steps.
    pub(super) fn derivation(&self, column: usize, of: usize, steps: &[f64]) -> Option<Derivation> {
        let before = (column.saturating_sub(NEIGHBOURS)..column).rev();
        let behind = column + 1..(column + NEIGHBOURS).min(self.columns.len());
        // Neither a step nor a count is an error that rates are those of.
        let is_error = |error: &usize| {
            let cells = &self.columns[*error];
            let gives_step = matches!(cells.word, Word::Step | Word::Count(_));
            *error != of && (cells.is_claimed || !gives_step)
        };
        let mut errors = before.chain(behind).filter(is_error);
        errors.find_map(|error| {
            let derived = self.columns[column].derived_from(&self.columns[error], steps)?;
            Some(Derivation { error, derived })
        })
    }
}

/// What a column is computed from.
pub(super) struct Derivation {
    pub(super) error: usize,
    pub(super) derived: Derived,
}

/// A column with the rates of another.
pub(super) struct RatesOf {
    pub(super) column: usize,
    pub(super) error: usize,
}
