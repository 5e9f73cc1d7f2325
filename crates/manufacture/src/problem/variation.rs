//! What a variant does to the exact fields.

use std::collections::BTreeMap;

/// Exact fields that are replaced by others made of them, one step after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Variation {
    pub(crate) steps: Vec<VariationStep>,
    /// The one field that is changed; all are without it.
    pub(crate) field: Option<String>,
    /// Added to the components of a field, so that what must be positive stays so.
    pub(crate) lifts: BTreeMap<String, Vec<f64>>,
}

/// A change of a function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum VariationStep {
    /// A variable set to a value.
    Fix { variable: usize, at: f64 },
    /// A function u becomes u - T u, with the Taylor polynomial T u of this degree at one end of an
    /// interval: it vanishes there with its derivatives up to the degree.
    Flatten {
        variable: usize,
        end: f64,
        degree: usize,
    },
    /// A function is multiplied by a bubble.
    Weigh(Bubble),
}

/// The bubble w(x) = (4 (x - a) (b - x) / (b - a)^2)^(m+1) of an interval from a to b, m the
/// `degree`.
///
/// The product w u vanishes at both ends with its derivatives up to m, and w is at most 1, in the
/// middle. To subtract Hermite's polynomial at both ends instead leaves a remainder of the size of
/// the derivative of order 2m+2, far below u: the errors of a program are round-off then, and
/// decide nothing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bubble {
    pub(crate) variable: usize,
    pub(crate) interval: [f64; 2],
    pub(crate) degree: usize,
}

impl Variation {
    /// Whether it changes that field.
    pub(crate) fn concerns(&self, field: &str) -> bool {
        self.field.as_deref().is_none_or(|only| only == field)
    }
}
