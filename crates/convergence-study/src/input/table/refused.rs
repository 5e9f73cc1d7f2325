//! Why a table is not read, with the choices that would read it.

use super::{Choice, Offer, RateTable};
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

/// Reads tables; a refusal offers those choices alone that read them, without a column in doubt.
pub(super) fn with_offers(
    read: impl Fn(&Choice) -> Result<Vec<RateTable>, Refused>,
    choice: &Choice,
    file: &str,
) -> Result<Vec<RateTable>, InputError> {
    /// Most offers that are tried.
    const TRIED: usize = 6;
    let reads = |offer: &Offer| {
        let doubts = |table: &RateTable| table.doubts.iter().any(|doubt| doubt.column.is_some());
        read(&offer.choice).is_ok_and(|tables| !tables.iter().any(doubts))
    };
    read(choice).map_err(|mut refused| {
        refused.offers.truncate(TRIED);
        refused.offers.retain(reads);
        refused.error(file)
    })
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
