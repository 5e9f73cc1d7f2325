//! What can be wrong with the text of a function, and with its values.

use std::fmt;

use thiserror::Error;

use super::Variable;
use crate::nearest::did_you_mean;

/// A text that is not a function of its variable, and the place.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct ExpressionError {
    /// The whole text.
    pub source_text: String,
    /// Byte of the text at which the problem is; its length where something is missing at the end.
    pub offset: usize,
    /// What is wrong.
    pub problem: ExpressionProblem,
}

/// What is wrong with the text of a function.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ExpressionProblem {
    /// A piece of text that cannot stand where it does.
    #[error("found {found}; allowed is {allowed}")]
    Unexpected {
        /// The piece, in words.
        found: String,
        /// What could stand there, in words.
        allowed: String,
    },
    /// A bracket that is never closed.
    #[error("found {found}; allowed is `)`, which closes the bracket at byte {opened}, or an operator")]
    Unclosed {
        /// The piece where the closing bracket could have been, in words.
        found: String,
        /// Byte of the text at which the bracket opens.
        opened: usize,
    },
    /// A name that is neither the variable, nor a constant, nor a function.
    #[error("unknown name `{name}`{}; allowed is {allowed}", did_you_mean(.suggestion))]
    UnknownName {
        /// The name.
        name: String,
        /// A known name that is a typing error away.
        suggestion: Option<String>,
        /// The names known.
        allowed: String,
    },
    /// A function with too few or too many arguments.
    #[error("found {found} argument(s) of `{function}`; allowed is {allowed}")]
    Arguments {
        /// The function.
        function: &'static str,
        /// Arguments found.
        found: usize,
        /// Arguments that it takes.
        allowed: usize,
    },
    /// A number beyond the range of `f64`.
    #[error("found the number {found}; allowed is at most {:e}", f64::MAX)]
    NumberTooLarge {
        /// The number as written.
        found: String,
    },
    /// More operations inside one another than the tree may be deep.
    #[error(
        "found more than {allowed} operations inside one another; allowed is {allowed}: split long sums by brackets"
    )]
    TooDeep {
        /// The depth allowed.
        allowed: usize,
    },
}

impl ExpressionError {
    /// Two lines: the text, and a caret below the place.
    ///
    /// Of a long text only the neighbourhood of the place is shown.
    pub fn excerpt(&self) -> String {
        const BEFORE: usize = 48;
        const AFTER: usize = 24;
        let printable = |c: char| if c.is_control() { ' ' } else { c };
        let (left, right) = self.source_text.split_at(self.offset);
        let left: Vec<char> = left.chars().map(printable).collect();
        let cut = left.len().saturating_sub(BEFORE);
        let shown: String = left[cut..].iter().collect();
        let rest: String = right.chars().take(AFTER).map(printable).collect();
        let (start, end) =
            (if cut > 0 { "..." } else { "" }, if right.chars().nth(AFTER).is_some() { "..." } else { "" });
        format!("    {start}{shown}{rest}{end}\n    {:1$}^", "", start.len() + left.len() - cut)
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (byte {})\n{}", self.problem, self.offset, self.excerpt())
    }
}

/// A place at which a function or a derivative of it is infinite or not a number.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{} is {found} at {} = {at}; allowed is a finite value on all of [0, {end}]",
    ["the value", "the first derivative", "the second derivative"][*.order],
    .variable.name()
)]
pub struct NotFinite {
    /// The variable.
    pub variable: Variable,
    /// Where.
    pub at: f64,
    /// The interval asked about is [0, end].
    pub end: f64,
    /// Order of the derivative: 0, 1 or 2.
    pub order: usize,
    /// The value found there.
    pub found: f64,
}
