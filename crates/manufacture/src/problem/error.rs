//! A file that cannot be used.

use std::fmt;

use thiserror::Error;

use crate::language::excerpt;

/// A file, or another input, that cannot be used: where, what was found and what is expected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub struct InputError {
    /// The file, as given.
    pub file: String,
    /// The line of the value, or of the part of an expression, from 1; 0 for the whole file.
    pub line: usize,
    /// The character of the line, from 1, of an error in an expression; 0 for the whole line.
    pub column: usize,
    /// The path of the key, such as `define.k`; empty for the whole file.
    pub key: String,
    /// What is wrong.
    pub problem: String,
    /// The text with a caret below the error, if it is in an expression.
    pub excerpt: Option<String>,
}

impl InputError {
    /// An error about an input as a whole.
    pub fn whole(file: &str, problem: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            line: 0,
            column: 0,
            key: String::new(),
            problem: problem.into(),
            excerpt: None,
        }
    }

    /// An error in a line of an input, counted from 1.
    pub(crate) fn at_line(file: &str, line: usize, problem: impl Into<String>) -> Self {
        Self {
            line,
            ..Self::whole(file, problem)
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        if self.column > 0 {
            write!(f, ":{}", self.column)?;
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        write!(f, ": {}", self.problem)?;
        match &self.excerpt {
            Some(excerpt) => write!(f, "\n{excerpt}"),
            None => Ok(()),
        }
    }
}

/// A line and a character of it, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LineColumn {
    pub(crate) line: usize,
    pub(crate) column: usize,
}

/// A place in the file: whose value, and in which line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Location {
    pub(crate) file: String,
    pub(crate) line: usize,
    /// Where the text begins, behind the quotes.
    pub(crate) text: LineColumn,
    pub(crate) key: String,
}

impl Location {
    pub(crate) fn error(&self, problem: impl Into<String>) -> InputError {
        InputError {
            file: self.file.clone(),
            line: self.line,
            column: 0,
            key: self.key.clone(),
            problem: problem.into(),
            excerpt: None,
        }
    }

    /// An error at a byte of the value's text.
    pub(crate) fn error_at(
        &self,
        text: &str,
        offset: usize,
        problem: impl Into<String>,
    ) -> InputError {
        let LineColumn { line, column } = self.of_text(text, offset);
        InputError {
            line,
            column,
            excerpt: Some(excerpt(text, offset)),
            ..self.error(problem)
        }
    }

    /// The place of a byte of the value's text.
    pub(crate) fn of_text(&self, text: &str, offset: usize) -> LineColumn {
        let before = text.get(..offset).unwrap_or(text);
        match before.rfind('\n') {
            None => LineColumn {
                column: self.text.column + before.chars().count(),
                ..self.text
            },
            Some(end) => LineColumn {
                line: self.text.line + before.matches('\n').count(),
                column: before[end + 1..].chars().count() + 1,
            },
        }
    }
}
