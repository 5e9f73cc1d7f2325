//! Why a table is not read, with the choices that would read it.

use super::{Choice, Doubt, Offer, RateTable};
use crate::input::advice::Text;
use crate::input::{Complaint, InputError, Place};

/// Why a table is not read.
#[derive(Debug, Clone)]
pub(super) struct Refused {
    line: usize,
    expected: Text,
    found: String,
    offers: Vec<Offer>,
}

impl Refused {
    pub(super) fn new(expected: impl Into<Text>, found: impl Into<String>) -> Self {
        Self {
            line: 0,
            expected: expected.into(),
            found: found.into(),
            offers: vec![],
        }
    }

    /// At this line, unless its own is known.
    pub(super) fn at(mut self, line: usize) -> Self {
        self.line = if self.line == 0 { line } else { self.line };
        self
    }

    pub(super) fn offering(mut self, offers: impl IntoIterator<Item = Offer>) -> Self {
        self.offers.extend(offers);
        self
    }

    /// The same with those offers alone that read the table, without a column in doubt.
    pub(super) fn trying(mut self, read: impl Fn(&Choice) -> Result<Vec<RateTable>, Self>) -> Self {
        /// Most offers that are tried.
        const TRIED: usize = 6;
        self.offers.truncate(TRIED);
        self.offers.retain(|offer| {
            let tables = read(&offer.choice).unwrap_or_default();
            let mut doubts = tables.iter().flat_map(|table| &table.doubts);
            !tables.is_empty() && !doubts.any(|doubt| matches!(doubt, Doubt::Column { .. }))
        });
        self
    }

    pub(super) fn error(self, file: &str) -> InputError {
        InputError {
            file: file.to_owned(),
            place: (self.line > 0).then_some(Place {
                line: self.line,
                column: 1,
            }),
            field: None,
            complaint: Box::new(Complaint::Table {
                expected: self.expected,
                found: self.found,
            }),
            offers: self.offers,
        }
    }
}
