//! An error in the text of an expression.

use std::fmt;

use thiserror::Error;

/// A text that is not an expression, with the position of the error.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub struct SyntaxError {
    /// The whole text.
    pub text: String,
    /// Byte offset of the error in the text; its length if something is missing at its end.
    pub offset: usize,
    /// What was found, and what is expected.
    pub problem: String,
}

impl SyntaxError {
    /// Two lines: the text, and a caret below the error. A long text is cut to the part around it.
    pub fn excerpt(&self) -> String {
        excerpt(&self.text, self.offset)
    }
}

impl fmt::Display for SyntaxError {
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

fn printable(c: char) -> char {
    if c.is_control() { ' ' } else { c }
}

/// Two lines: the text, and a caret below the byte `offset`. A long text is cut to the part around
/// it.
pub(crate) fn excerpt(text: &str, offset: usize) -> String {
    const BEFORE: usize = 48;
    const AFTER: usize = 24;
    let (left, right) = text.split_at(offset.min(text.len()));
    let left: Vec<char> = left.chars().map(printable).collect();
    let cut = left.len().saturating_sub(BEFORE);
    let shown: String = left[cut..].iter().collect();
    let rest: String = right.chars().take(AFTER).map(printable).collect();
    let start = if cut > 0 { "..." } else { "" };
    let is_longer = right.chars().nth(AFTER).is_some();
    let end = if is_longer { "..." } else { "" };
    let column = start.len() + left.len() - cut;
    format!("    {start}{shown}{rest}{end}\n    {:column$}^", "")
}
