//! What speaks against a table that was read: nothing of it should pass.

use std::fmt::{self, Display, Formatter};

use super::Column;
use crate::judge::fit::pairwise_rates;
use crate::text::number::plain_text;
use crate::text::visible::visible;

/// Why no column of a table should pass.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// A line of the text says that the run has failed.
    FailedRun {
        /// Its number, from 1.
        line: usize,
        /// Its words.
        words: String,
    },
    /// The errors fall by steady rates on either side of a jump, as those of two tables do.
    Jump {
        /// The name of the column.
        column: String,
        /// The step before it.
        before: f64,
        /// The step behind it.
        behind: f64,
    },
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::FailedRun { line, words } => {
                write!(f, "the run has failed: line {line} is `{}`", visible(words))
            }
            Self::Jump {
                column,
                before,
                behind,
            } => write!(
                f,
                "{} jumps between the steps {} and {}, as if another table began",
                visible(column),
                plain_text(*before),
                plain_text(*behind)
            ),
        }
    }
}

/// The jump of a column between two runs of steady rates.
pub(super) fn jump(column: &Column) -> Option<Doubt> {
    /// Largest difference between steady rates.
    const STEADY: f64 = 0.25;
    /// Least rate that is one of convergence.
    const FALLS: f64 = 0.5;
    /// Least difference between a jump and the rates on either side.
    const JUMP: f64 = 1.0;
    let rates = pairwise_rates(&column.levels);
    let spread = |rates: &[f64]| {
        let least = rates.iter().copied().fold(f64::INFINITY, f64::min);
        let most = rates.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (rates.len() > 1 && most - least < STEADY && least > FALLS).then_some([least, most])
    };
    let is_jump = |k: &usize| {
        let sides = [&rates[..*k], &rates[k + 1..]];
        let [Some(before), Some(behind)] = sides.map(spread) else {
            return false;
        };
        let least = before[0].min(behind[0]);
        let most = before[1].max(behind[1]);
        rates[*k] > most + JUMP || rates[*k] < least - JUMP
    };
    let k = (0..rates.len()).find(is_jump)?;
    Some(Doubt::Jump {
        column: column.name.clone(),
        before: column.levels[k].step,
        behind: column.levels[k + 1].step,
    })
}
