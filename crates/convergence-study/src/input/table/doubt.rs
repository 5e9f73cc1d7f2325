//! What speaks against a table that was read.

use std::fmt::{self, Display, Formatter};

use super::{Column, Offer};
use crate::text::number::plain_text;
use crate::text::visible::visible;
use convergence_judge::fit::pairwise_rates;

/// What speaks against a table that was read: nothing of it should pass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Doubt {
    /// The column that may hide an error; `None` if it is about the whole table.
    pub(crate) column: Option<String>,
    /// What is wrong.
    pub(crate) because: String,
    /// The choice that removes it, if there is one.
    pub(crate) offer: Option<Offer>,
}

impl Doubt {
    pub(super) fn new(because: impl Into<String>) -> Self {
        Self {
            column: None,
            because: because.into(),
            offer: None,
        }
    }

    pub(super) fn of_column(column: &str, because: impl Into<String>) -> Self {
        Self {
            column: Some(column.to_owned()),
            ..Self::new(because)
        }
    }

    /// The doubt that errors fall by steady rates on either side of a jump, as those of two tables.
    pub(super) fn of_jump(column: &Column) -> Option<Self> {
        /// Largest difference between steady rates.
        const STEADY: f64 = 0.25;
        /// Least rate of convergence.
        const FALLS: f64 = 0.5;
        /// Least difference between a jump and the rates on either side.
        const JUMP: f64 = 1.0;
        let rates = pairwise_rates(&column.levels);
        let at = (1..rates.len()).find(|k| (rates[*k] - rates[k - 1]).abs() > STEADY)?;
        let is_steady = |side: &[f64]| {
            let low = side.iter().copied().fold(f64::INFINITY, f64::min);
            let high = side.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let is_apart = rates[at] > high + JUMP || rates[at] < low - JUMP;
            side.len() > 1 && high - low < STEADY && low > FALLS && is_apart
        };
        (is_steady(&rates[..at]) && is_steady(&rates[at + 1..])).then(|| {
            let [before, after] = [at, at + 1].map(|k| plain_text(column.levels[k].step));
            let because =
                format!("jumps between the steps {before} and {after}, as if another table began");
            Self::of_column(&column.name, because)
        })
    }
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(column) = &self.column {
            write!(f, "`{}` ", visible(column))?;
        }
        f.write_str(&visible(&self.because))
    }
}
