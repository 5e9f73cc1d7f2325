//! The text of a table, and complaints about its pieces.

use crate::input::advice::Text;
use crate::input::{Complaint, InputError, SourceText, failed};

/// A table to be read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Original<'t> {
    /// Its text.
    pub(super) text: &'t str,
    /// Its name in messages.
    pub(super) name: &'t str,
    pub(super) rows: Rows,
}

/// What the rows of a table are to the caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rows {
    /// Lines of a text, from 1.
    Lines,
    /// Rows of a data frame, from 0; the text has the names in its first line.
    Frame,
}

/// The empty cell at the start of a text: a cell that is not printed stands where its text begins,
/// so that a message can name its place.
pub(super) fn blank_at(text: &str) -> &str {
    &text[..0]
}

/// The byte at which a piece of a text begins; its end for a piece of another text.
pub(super) fn offset(text: &str, piece: &str) -> usize {
    (piece.as_ptr() as usize)
        .wrapping_sub(text.as_ptr() as usize)
        .min(text.len())
}

impl<'t> Original<'t> {
    /// A text, and the name of its file.
    pub(super) fn of_text(text: &'t str, name: &'t str) -> Self {
        Self {
            text,
            name,
            rows: Rows::Lines,
        }
    }

    /// The number of the row with a piece, as the caller counts.
    pub(super) fn row(&self, piece: &str) -> usize {
        let before = self.text[..offset(self.text, piece)].matches('\n').count();
        match self.rows {
            Rows::Lines => before + 1,
            Rows::Frame => before.saturating_sub(1),
        }
    }

    /// What the caller calls several rows.
    pub(super) fn noun(&self) -> &'static str {
        match self.rows {
            Rows::Lines => "lines",
            Rows::Frame => "rows",
        }
    }

    /// A complaint about the whole.
    pub(super) fn refuse(&self, expected: impl Into<Text>, found: &str) -> InputError {
        failed(self.name, complaint(expected, found))
    }

    /// A complaint about a piece.
    ///
    /// * `field`: the name of its column.
    pub(super) fn error(
        &self,
        piece: &str,
        field: Option<&str>,
        expected: impl Into<Text>,
        found: &str,
    ) -> InputError {
        match (self.rows, field) {
            (Rows::Frame, Some(field)) => {
                let row = self.row(piece);
                failed(&format!("{field}[{row}]"), complaint(expected, found))
            }
            (Rows::Lines, _) if !self.text.trim().is_empty() => {
                let source = SourceText {
                    file: self.name,
                    text: self.text,
                };
                let offset = offset(self.text, piece);
                source.error(offset, field.map(str::to_owned), complaint(expected, found))
            }
            _ => self.refuse(expected, found),
        }
    }
}

fn complaint(expected: impl Into<Text>, found: &str) -> Complaint {
    Complaint::Table {
        expected: expected.into(),
        found: found.to_owned(),
    }
}
