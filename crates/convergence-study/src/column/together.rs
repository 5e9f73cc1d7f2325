//! What columns of errors say of each other: two that are one number, and a boundary with a rate of
//! its own.

use super::Column;
use crate::text::number::RATE_PLACES;
use convergence_judge::verdict::{RateVerdict, Verdict};

/// The name of the largest error.
pub(crate) const MAX: &str = "max";
/// The same of points that are not at the boundary.
pub(crate) const INSIDE: &str = "max inside";

/// Two columns, by their numbers, that are equal on all levels, in all digits.
pub(crate) struct EqualPair {
    pub(crate) first: usize,
    pub(crate) later: usize,
    /// Whether both have claims, of which then neither passes.
    pub(crate) are_claimed: bool,
}

impl EqualPair {
    /// A pair for each column that equals one before it: one with a claim, if there is one.
    ///
    /// * `columns`: each with whether something is claimed of it.
    pub(crate) fn all(columns: &[(&Column, bool)]) -> Vec<Self> {
        let mut pairs = vec![];
        for (later, (column, is_claimed)) in columns.iter().enumerate() {
            let before = columns[..later].iter().enumerate();
            let equal = before.filter(|(_, (other, _))| other.equals(column));
            // The first of the claimed ones, or of all.
            if let Some((first, (_, claimed))) = equal.min_by_key(|(_, (_, claimed))| !claimed) {
                let are_claimed = *claimed && *is_claimed;
                pairs.push(Self {
                    first,
                    later,
                    are_claimed,
                });
            }
        }
        pairs
    }

    /// The column with a claim that this one, with a claim as well, equals.
    pub(crate) fn other(pairs: &[Self], column: usize) -> Option<usize> {
        let mut claimed = pairs.iter().filter(|pair| pair.are_claimed);
        claimed.find_map(|pair| match column {
            _ if column == pair.first => Some(pair.later),
            _ if column == pair.later => Some(pair.first),
            _ => None,
        })
    }
}

/// Whether two errors may be one number: the largest error is often one inside.
pub(super) fn may_be_equal(one: &str, other: &str) -> bool {
    [[one, other], [other, one]].contains(&[MAX, INSIDE])
}

/// That the boundary has another rate than the points inside.
#[derive(Clone)]
pub(crate) struct BoundaryLoss {
    /// A pass where claims about both pass, since theory may say it; otherwise inconclusive.
    pub(crate) verdict: Verdict,
    pub(crate) claim: String,
    pub(crate) evidence: String,
}

impl BoundaryLoss {
    /// * `names`, `observed`: of the largest error of all points, and of that of the points inside.
    /// * `passes`: whether a claim about a name does.
    pub(crate) fn of(
        names: [&str; 2],
        observed: [&RateVerdict; 2],
        passes: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let [lower, upper] = observed.map(|rate| rate.interval);
        if !(lower?.high < upper?.low) {
            return None;
        }
        let [max, inside] = names;
        let [max_in_words, inside_in_words] = observed.map(|rate| rate.rate_in_words(RATE_PLACES));
        let evidence = format!(
            "the boundary loses the order: {max} has the rate {max_in_words}, {inside} {inside_in_words}"
        );
        Some(if names.iter().all(|name| passes(name)) {
            Self {
                verdict: Verdict::Pass,
                claim: format!("{max} and {inside} fall as claimed"),
                evidence,
            }
        } else {
            Self {
                verdict: Verdict::Inconclusive,
                claim: format!("{max} falls as {inside} does"),
                evidence: evidence + "; claim both",
            }
        })
    }
}
