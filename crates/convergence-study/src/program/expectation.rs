//! What a study expects of every answer, and what it claims about it.

use crate::study::Claim;
use convergence_judge::claims::Bound;
use convergence_judge::verdict::Of;

/// A table `[[expect]]`: a number that every answer must contain, and the claim about it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expectation {
    pub(super) name: String,
    /// Whether it is a value whose error is not known.
    pub(super) is_value: bool,
    /// For a grid: the order in h.
    pub(super) claim: Claim,
    /// For a grid: the order in dt.
    pub(super) time: Claim,
    /// The order is that of a factor per degree, n being the degree.
    pub(super) by_degree: bool,
    /// The bound on the error; nothing else is claimed.
    pub(super) exact: Option<f64>,
    /// How samples make it.
    pub(super) of: Of,
}

impl Expectation {
    /// A value of which nothing is claimed.
    pub(super) fn of_value(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            is_value: true,
            claim: Claim::usual(1.0, Bound::Both),
            time: Claim::usual(1.0, Bound::Both),
            by_degree: false,
            exact: None,
            of: Of::Mean,
        }
    }

    /// The key that names it.
    pub(super) fn what(&self) -> &'static str {
        if self.is_value { "value" } else { "error" }
    }
}
