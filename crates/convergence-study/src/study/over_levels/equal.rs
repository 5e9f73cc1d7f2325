//! Two errors that are one number: answers that are equal on all levels.

use super::Levels;
use crate::column::{Column, EqualPair};
use crate::study::{Check, Subject};
use convergence_judge::verdict::RateVerdict;

impl Levels {
    /// The pairs of equal answers.
    pub(crate) fn equal_pairs(&self) -> Vec<EqualPair> {
        let answers = self.columns.iter().filter(|_| self.are_answers);
        let columns: Vec<Column> = answers.map(|column| self.as_column(column)).collect();
        let claims = self.columns.iter().map(|column| column.claim.is_some());
        EqualPair::all(&columns.iter().zip(claims).collect::<Vec<_>>())
    }

    /// A verdict on the error of a name; no pass if another column with a claim is equal.
    pub(crate) fn unless_equal(
        &self,
        pairs: &[EqualPair],
        name: &str,
        rate: RateVerdict,
    ) -> RateVerdict {
        let mut columns = self.columns.iter();
        let own = columns.position(|column| column.name == name);
        match own.and_then(|own| EqualPair::other(pairs, own)) {
            Some(other) => rate.equal_to(&self.columns[other].name),
            None => rate,
        }
    }

    /// A check that says so for each error that equals one before it, unless both have claims.
    pub(crate) fn equal_columns(&self) -> Vec<Check> {
        let pairs = self.equal_pairs().into_iter();
        let idle = pairs.filter(|pair| !pair.are_claimed);
        idle.map(|pair| Check::of_equal([pair.first, pair.later].map(|k| &*self.columns[k].name)))
            .collect()
    }
}

impl Check {
    /// It says that two errors are equal, which do not both have claims.
    pub(crate) fn of_equal([one, other]: [&str; 2]) -> Self {
        let claim = format!("{one} and {other}, equal in all digits, are not both claimed");
        Self::that(true, claim, "equal on all levels").about(Subject::of(other))
    }
}
