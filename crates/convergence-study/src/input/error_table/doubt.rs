//! What speaks against a table that was read: nothing of it should pass.

use std::fmt::{self, Display, Formatter};

use super::{Column, NotError};
use crate::input::InputError;
use crate::judge::fit::pairwise_rates;
use crate::text::number::{counted, plain_text};
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
    /// A name in a log has more numbers or fewer than there are levels: it is no column, but may be an
    /// error.
    Uneven(NotError),
    /// Lines that look like rows belong to no table.
    RowsOutside {
        /// The number of the first, from 1.
        line: usize,
        /// How many there are.
        count: usize,
    },
    /// Another table of the text cannot be read.
    Unread(Box<InputError>),
    /// The errors fall by steady rates on either side of a jump, as those of two tables do.
    Jump {
        /// The name of the column.
        column: String,
        /// The step before it.
        before: f64,
        /// The step behind it.
        behind: f64,
    },
    /// A step is smaller than the ratio of the others says, by a power of ten, and the errors do not
    /// follow it.
    Unit {
        /// The name of the column.
        column: String,
        /// The step before it.
        before: f64,
        /// The step behind it.
        behind: f64,
        /// The ratio of the other steps.
        ratio: f64,
    },
    /// A column is named like rates, and has those of no column over the step.
    Rates {
        /// The name of the column.
        rates: String,
        /// The name of the step.
        step: String,
    },
    /// The rates that the table prints are those of another dimension than the chosen one.
    Dimension {
        /// The dimension that the user has chosen.
        chosen: f64,
        /// The dimension of the rates.
        stated: f64,
        /// The column whose rates they are.
        column: String,
    },
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::FailedRun { line, words } => {
                write!(f, "the run has failed: line {line} is `{}`", visible(words))
            }
            Self::Uneven(NotError {
                column, because, ..
            }) => write!(
                f,
                "{} is no column, {because}: a table of its own, or no error?",
                visible(column)
            ),
            Self::RowsOutside { line, count } => write!(
                f,
                "outside the tables: {} of numbers, from line {line}",
                counted(*count, "line")
            ),
            Self::Unread(error) => write!(f, "a table is not read: {error}"),
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
            Self::Unit {
                column,
                before,
                behind,
                ratio,
            } => write!(
                f,
                "the step falls from {} to {} and not by {}, and {} does not follow: another unit?",
                plain_text(*before),
                plain_text(*behind),
                plain_text(*ratio),
                visible(column)
            ),
            Self::Rates { rates, step } => write!(
                f,
                "the rates {} are those of no column over {}: choose the columns of errors if they do not count",
                visible(rates),
                visible(step)
            ),
            Self::Dimension {
                chosen,
                stated,
                column,
            } => write!(
                f,
                "the printed rates of {} are those of dimension {stated}, not {chosen}",
                visible(column)
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
    let before = ranges(rates.iter());
    let mut behind = ranges(rates.iter().rev());
    behind.reverse();
    let is_steady = |range: &Range, count: usize| {
        count > 1 && range.most - range.least < STEADY && range.least > FALLS
    };
    let is_jump = |k: &usize| {
        let sides = [&before[*k - 1], &behind[*k + 1]];
        let are_steady = is_steady(sides[0], *k) && is_steady(sides[1], rates.len() - k - 1);
        let least = sides[0].least.min(sides[1].least);
        let most = sides[0].most.max(sides[1].most);
        are_steady && (rates[*k] > most + JUMP || rates[*k] < least - JUMP)
    };
    let k = (1..rates.len().saturating_sub(1)).find(is_jump)?;
    Some(Doubt::Jump {
        column: column.name.clone(),
        before: column.levels[k].step,
        behind: column.levels[k + 1].step,
    })
}

/// A step that is written in another unit than those before it, if the errors of a column say so.
pub(super) fn unit(column: &Column) -> Option<Doubt> {
    /// Largest relative difference of equal ratios.
    const SAME: f64 = 0.02;
    /// Least difference between the rate at the change and the others.
    const OTHER: f64 = 0.5;
    let ratios: Vec<f64> = column
        .levels
        .windows(2)
        .map(|two| two[0].step / two[1].step)
        .collect();
    let ratio = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let is_regular = |one: &f64| (one / ratio - 1.0).abs() < SAME;
    let k = ratios.iter().position(|one| !is_regular(one))?;
    let others = ratios.iter().filter(|one| is_regular(one)).count();
    let power = (ratios[k] / ratio).log10();
    let is_unit = power.round() >= 1.0 && (power - power.round()).abs() < SAME;
    let rates = pairwise_rates(&column.levels);
    let is_near = |other: usize| {
        rates
            .get(other)
            .is_some_and(|rate| (rate - rates[k]).abs() < OTHER)
    };
    let follows = is_near(k + 1) || k > 0 && is_near(k - 1);
    (others > 1 && others + 1 == ratios.len() && is_unit && !follows).then(|| Doubt::Unit {
        column: column.name.clone(),
        before: column.levels[k].step,
        behind: column.levels[k + 1].step,
        ratio,
    })
}

/// The least and the greatest of some rates.
#[derive(Clone, Copy)]
struct Range {
    least: f64,
    most: f64,
}

/// The range of the first rates, of one, of two and so on. NaN is no rate.
fn ranges<'r>(rates: impl Iterator<Item = &'r f64>) -> Vec<Range> {
    let mut range = Range {
        least: f64::INFINITY,
        most: f64::NEG_INFINITY,
    };
    let wider = |rate: &f64| {
        range = Range {
            least: range.least.min(*rate),
            most: range.most.max(*rate),
        };
        range
    };
    rates.map(wider).collect()
}
