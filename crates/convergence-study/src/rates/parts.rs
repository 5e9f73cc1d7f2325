//! What a study of a table takes of its judgement.

use super::{JudgedColumn, Judgement, counts};
use crate::input::table::Doubt;
use crate::judge::verdict::Verdict;

impl<'t> Judgement<'t> {
    /// The heading, if the file has several tables; otherwise empty.
    pub(crate) fn heading(&self) -> &str {
        &self.source.table.name
    }

    /// The step, as the table has it.
    pub(crate) fn step(&self) -> &str {
        &self.source.table.step
    }

    /// How the table was read.
    pub(crate) fn reading(&self) -> String {
        self.source.table.reading.clone()
    }

    /// Its columns, errors first.
    pub(crate) fn judged_columns(&self) -> impl Iterator<Item = &JudgedColumn<'t>> {
        self.columns.iter()
    }

    /// The verdict on all columns that count, and on the reading.
    pub(crate) fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// What speaks against the verdict.
    pub(crate) fn doubts_that_count(&self) -> impl Iterator<Item = &Doubt> {
        let doubts = self.source.table.doubts.iter();
        doubts.filter(|doubt| counts(doubt, &self.columns))
    }
}

impl JudgedColumn<'_> {
    /// Whether it holds values, which tend to an unknown limit.
    pub(crate) fn is_value(&self) -> bool {
        self.estimate.is_some()
    }
}
