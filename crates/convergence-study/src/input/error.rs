//! The error of all code that reads input files.

use std::fmt;

use thiserror::Error;

use crate::text::names::did_you_mean;
use crate::text::visible::{self, visible};

/// A place in a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// An input file that cannot be used: where, which field, what was found and what is allowed.
///
/// Shown as one line `file:line:column: field: complaint`; a complaint about an expression may add two lines, with a
/// caret below the place.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct InputError {
    /// The file, as given.
    pub file: String,
    /// The place; `None` if the file could not be read at all.
    pub place: Option<Place>,
    /// The field by its dotted name, such as `solver.tolerance`; `None` for the whole file.
    pub field: Option<String>,
    /// What is wrong.
    pub complaint: Box<Complaint>,
}

/// What is wrong with an input file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Complaint {
    /// A key that has no meaning here.
    #[error("unknown key `{found}`{}; expected {allowed}", did_you_mean(.suggestion))]
    UnknownKey {
        /// The key.
        found: String,
        /// A known key that is one typing error away.
        suggestion: Option<String>,
        /// The keys known here.
        allowed: String,
    },
    /// A value of the wrong type, out of range, or in conflict with another.
    #[error("found {found}; expected {allowed}")]
    NotAllowed {
        /// The value, as written or in words.
        found: String,
        /// The values allowed, in words.
        allowed: String,
    },
    /// A file or a text that cannot be read, or a missing key without a default.
    #[error("{reason}")]
    Invalid {
        /// Why.
        reason: String,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(&self.file))?;
        if let Some(Place { line, column }) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        if let Some(field) = &self.field {
            write!(f, ": {}", visible(field))?;
        }
        write!(f, ": {}", visible::lines(&self.complaint.to_string()))
    }
}
