//! Two errors that are one number: answers that are equal on all levels.

use super::boundary::may_be_equal;
use super::{ErrorColumn, Levels};
use crate::study::{Check, Subject};
use convergence_judge::verdict::{RateVerdict, are_equal, significant_digits};

impl Levels {
    /// A verdict on a column; no pass if another column with a claim is equal.
    pub(crate) fn unless_equal(&self, column: &ErrorColumn, rate: RateVerdict) -> RateVerdict {
        let mut claimed = self.columns.iter().filter(|other| other.claim.is_some());
        match claimed.find(|other| self.equal(column, other)) {
            Some(other) => rate.equal_to(&other.name),
            None => rate,
        }
    }

    /// Whether two columns are equal on all levels, in all digits.
    fn equal(&self, one: &ErrorColumn, other: &ErrorColumn) -> bool {
        let points = self.points(one);
        self.are_answers
            && one.name != other.name
            && !may_be_equal(&one.name, &other.name)
            && one.errors == other.errors
            && are_equal(&points, &self.points(other), |level| {
                significant_digits(points[level].error)
            })
    }

    /// A check that says so for each error that equals one before it, unless both have claims.
    pub(crate) fn equal_columns(&self) -> Vec<Check> {
        let mut checks = vec![];
        for (k, column) in self.columns.iter().enumerate() {
            let mut before = self.columns[..k].iter();
            let Some(first) = before.find(|first| self.equal(first, column)) else {
                continue;
            };
            if first.claim.is_none() || column.claim.is_none() {
                let [one, other] = [&first.name, &column.name];
                let claim = format!("{one} and {other}, equal in all digits, are not both claimed");
                let check = Check::that(true, claim, "equal on all levels");
                checks.push(check.about(Subject::of(&column.name)));
            }
        }
        checks
    }
}
