//! What speaks against a table that was read.

use std::fmt::{self, Display, Formatter};

use super::Offer;
use crate::text::visible::visible;

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
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(column) = &self.column {
            write!(f, "`{}` ", visible(column))?;
        }
        f.write_str(&visible(&self.because))
    }
}
