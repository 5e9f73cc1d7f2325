//! What speaks against a table that was read.

use std::fmt::{self, Display, Formatter};

use super::Offer;
use crate::input::InputError;
use crate::text::lists::and_more;
use crate::text::visible::visible;

/// What speaks against a table that was read: nothing of it should pass.
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
    /// Lines outside the tables look like rows, or name a column.
    Outside {
        /// The number of the first, from 1; 0 without lines.
        line: usize,
        /// Its words.
        words: String,
        /// How many there are.
        count: usize,
        /// The choice of the lines of the tables.
        offer: Option<Offer>,
    },
    /// Another table of the text cannot be read.
    Unread(Box<InputError>),
    /// A column that may hide an error.
    Column {
        /// Its name.
        column: String,
        /// What is wrong with it.
        because: String,
    },
}

impl Doubt {
    /// The choice that removes it, if there is one.
    pub fn offer(&self) -> Option<&Offer> {
        match self {
            Self::Outside { offer, .. } => offer.as_ref(),
            _ => None,
        }
    }
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::FailedRun { line, words } => {
                write!(f, "the run has failed: line {line} is `{}`", visible(words))
            }
            Self::Outside {
                line, words, count, ..
            } => {
                let place = if *line == 0 {
                    String::new()
                } else {
                    format!("line {line}, ")
                };
                let more = and_more(*count, 1);
                write!(f, "outside the tables: {place}`{}`{more}", visible(words))
            }
            Self::Unread(error) => write!(f, "a table is not read: {error}"),
            Self::Column { column, because } => write!(f, "`{}` {because}", visible(column)),
        }
    }
}
