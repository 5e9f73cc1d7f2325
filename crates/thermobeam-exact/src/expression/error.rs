//! The errors of an expression: in its text, and in its values.

use std::fmt;

use thiserror::Error;

use super::Variable;
use crate::nearest::did_you_mean;

/// A text that is not a function of its variable, with the position of the error.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct ExpressionError {
    /// The whole text.
    pub source_text: String,
    /// Byte offset of the error in the text; the length of the text if something is missing at its
    /// end.
    pub offset: usize,
    /// The cause.
    pub problem: ExpressionProblem,
}

/// The cause of an [`ExpressionError`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ExpressionProblem {
    /// A token that is not allowed at its position.
    #[error("expected {expected}, found {found}{hint}")]
    Unexpected {
        /// The token, in words.
        found: String,
        /// The tokens allowed there, in words.
        expected: String,
        /// A remedy that begins with `; `, or nothing.
        hint: &'static str,
    },
    /// A bracket that is never closed.
    #[error("expected an operator or `)` for the bracket at byte {opened}, found {found}")]
    Unclosed {
        /// The token instead of the closing bracket, in words.
        found: String,
        /// Byte offset of the opening bracket.
        opened: usize,
    },
    /// A name that is neither the variable, nor a constant, nor a function.
    #[error("unknown name `{name}`{}; expected one of {known}", did_you_mean(.suggestion))]
    UnknownName {
        /// The name.
        name: String,
        /// The known name that was probably meant.
        suggestion: Option<String>,
        /// The known names, separated by spaces.
        known: String,
    },
    /// A function with too few or too many arguments.
    #[error("`{function}`: expected {expected} argument(s), found {found}")]
    Arguments {
        /// The function.
        function: &'static str,
        /// Number of arguments in the text.
        found: usize,
        /// Number of arguments that the function takes.
        expected: usize,
    },
    /// A number beyond the range of `f64`.
    #[error("expected a number of at most {:e}, found {found}", f64::MAX)]
    NumberTooLarge {
        /// The number as in the text.
        found: String,
    },
    /// More nested operations than the depth of the syntax tree allows.
    #[error("expected at most {most} nested operations, found more: split long sums by brackets")]
    TooDeep {
        /// The largest depth.
        most: usize,
    },
}

impl ExpressionError {
    /// Two lines: the text, and a caret below the error. A long text is cut to the part around the
    /// error.
    pub fn excerpt(&self) -> String {
        const BEFORE: usize = 48;
        const AFTER: usize = 24;
        let printable = |c: char| if c.is_control() { ' ' } else { c };
        let (left, right) = self.source_text.split_at(self.offset);
        let left: Vec<char> = left.chars().map(printable).collect();
        let cut = left.len().saturating_sub(BEFORE);
        let shown: String = left[cut..].iter().collect();
        let rest: String = right.chars().take(AFTER).map(printable).collect();
        let (start, end) = (
            if cut > 0 { "..." } else { "" },
            if right.chars().nth(AFTER).is_some() {
                "..."
            } else {
                ""
            },
        );
        format!(
            "    {start}{shown}{rest}{end}\n    {:1$}^",
            "",
            start.len() + left.len() - cut
        )
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} (byte {})\n{}",
            self.problem,
            self.offset,
            self.excerpt()
        )
    }
}

/// A point at which a function or one of its derivatives is infinite or NaN.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "{} is {found} at {} = {at}; expected a finite value on all of [0, {end}]",
    ["the value", "the first derivative", "the second derivative"][*.order],
    .variable.name()
)]
pub struct NotFinite {
    /// The variable.
    pub variable: Variable,
    /// The point.
    pub at: f64,
    /// The interval that was checked is [0, end].
    pub end: f64,
    /// Order of the derivative: 0, 1 or 2.
    pub order: usize,
    /// The value there.
    pub found: f64,
}
