//! Reads TOML files; every error names file, line, field, the value found and the values allowed.
//!
//! A [`Document`] is read into a struct, and finds the place of a field in the file: readers never
//! compute the position of a message.

pub(crate) mod advice;
mod file;
mod ranges;
pub(crate) mod schema;
mod settings;
pub(crate) mod table;

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use advice::{CommandLine, Surface, Text};
use table::{Choice, Offer};

use crate::text::names::did_you_mean;
use crate::text::visible;

pub(crate) use crate::text::visible::visible;
pub use file::{Document, Refusal, named_file};
pub(crate) use ranges::{AllowedText, Texts};
pub use ranges::{Ascending, Choices, Count, Counts, Finite, Number, OneOf, Positive, Range};

/// A finite number > 0, in words.
pub(crate) const POSITIVE: &str = "a finite number > 0";

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
/// Shown as one line `file:line:column: field: complaint`; a complaint about an expression may add
/// two lines, with a caret below the place. [`InputError::words`] adds what it offers.
#[derive(Debug, Clone, PartialEq, Error)]
pub struct InputError {
    /// The file, as given. Of a data frame the argument that it is, or the cell, `L2[0]`.
    pub file: String,
    /// The place; `None` if the file could not be read at all, or is a data frame.
    pub place: Option<Place>,
    /// The field by its dotted name, such as `solver.tolerance`; `None` for the whole file.
    pub field: Option<String>,
    /// What is wrong.
    pub(crate) complaint: Box<Complaint>,
    /// Choices that read a table that is refused.
    pub(crate) offers: Vec<Offer>,
}

/// What is wrong with an input file.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum Complaint {
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
    /// A table that cannot be read.
    #[error("expected {expected}, found {found}")]
    Table {
        /// What must be there, or must be said.
        expected: Text,
        /// What is there, in words.
        found: String,
    },
    /// A file or a text that cannot be read, or a missing key without a default.
    #[error("{reason}")]
    Invalid {
        /// Why.
        reason: String,
    },
}

impl Complaint {
    /// What is wrong, in the words of a surface.
    fn words(&self, surface: &dyn Surface) -> String {
        match self {
            Self::Table { expected, found } => {
                format!("expected {}, found {found}", expected.words(surface))
            }
            other => other.to_string(),
        }
    }
}

impl InputError {
    /// What is wrong, without the place.
    pub fn complaint(&self) -> String {
        self.complaint.to_string()
    }

    /// The choices that read a table which is refused.
    pub fn offered(&self) -> impl Iterator<Item = &Choice> {
        self.offers.iter().map(|offer| &offer.choice)
    }

    /// The message in the words of a surface, with a line for each call that it offers.
    pub fn words(&self, surface: &dyn Surface) -> String {
        let offers = self.offers.iter().filter_map(|offer| offer.line(surface));
        let mut text = visible(&self.file);
        if let Some(Place { line, column }) = self.place {
            text += &format!(":{line}:{column}");
        }
        if let Some(field) = &self.field {
            text += &format!(": {}", visible(field));
        }
        let complaint = self.complaint.words(surface) + &offers.collect::<String>();
        text + ": " + &visible::lines(&complaint)
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words(&CommandLine::default()))
    }
}

/// Largest file that is read, in bytes. Study files are small; this prevents a wrong path from
/// filling the memory.
const FILE_BYTES: u64 = 10_000_000;

/// A text and the name of the file that it comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SourceText<'a> {
    pub(crate) file: &'a str,
    pub(crate) text: &'a str,
}

impl SourceText<'_> {
    /// Line and column, from 1, of a byte of the text.
    pub(crate) fn place(&self, offset: usize) -> Place {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// An error about the byte of the text at `offset`.
    fn error(&self, offset: usize, field: Option<String>, complaint: Complaint) -> InputError {
        InputError {
            place: Some(self.place(offset)),
            field,
            ..failed(self.file, complaint)
        }
    }
}

fn failed(file: &str, complaint: Complaint) -> InputError {
    InputError {
        file: file.to_owned(),
        place: None,
        field: None,
        complaint: Box::new(complaint),
        offers: vec![],
    }
}

fn unreadable(file: &str, error: &io::Error) -> InputError {
    failed(
        file,
        Complaint::Invalid {
            reason: format!("cannot be read: {error}"),
        },
    )
}

/// The whole text of any reader; messages name `file`.
pub(crate) fn read_from(file: &str, source: impl Read) -> Result<String, InputError> {
    let mut bytes = Vec::new();
    // The size that the file system reports is 0 for a pipe or a device, so the reading itself is
    // limited.
    source
        .take(FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| unreadable(file, &error))?;
    if bytes.len() as u64 > FILE_BYTES {
        let allowed = format!("a file of at most {FILE_BYTES} bytes");
        let found = format!("more than {FILE_BYTES} bytes");
        return Err(failed(file, Complaint::NotAllowed { found, allowed }));
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let allowed = "UTF-8 text: save the file as UTF-8".to_owned();
        let found = "UTF-16".to_owned();
        return Err(failed(file, Complaint::NotAllowed { found, allowed }));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
        let place = SourceText { file, text: &text }.place(valid);
        let found = format!("the byte 0x{:02x}", error.as_bytes()[valid]);
        let allowed = "UTF-8 text".to_owned();
        InputError {
            place: Some(place),
            ..failed(file, Complaint::NotAllowed { found, allowed })
        }
    })
}

/// As [`Document::parse`]; `read` also receives the folder of the file, to which the file names in
/// it are relative.
pub(crate) fn parse_beside<T>(
    text: &str,
    file: &Path,
    read: impl FnOnce(&Document<'_>, &Path) -> Result<T, InputError>,
) -> Result<T, InputError> {
    let folder = file.parent().unwrap_or(Path::new("."));
    Document::parse(text, &file.display().to_string(), |root| read(root, folder))
}

impl Document<'_> {
    /// The whole text of a file.
    ///
    /// # Errors
    /// It cannot be read, or is no UTF-8.
    pub fn text_of_file(path: &Path) -> Result<String, InputError> {
        let name = path.display().to_string();
        let file = File::open(path).map_err(|error| unreadable(&name, &error))?;
        read_from(&name, file)
    }

    /// Parses `text`, which errors call `file`, and passes the document to `read`.
    ///
    /// # Errors
    /// The text is no TOML, or those of `read`.
    pub fn parse<T>(
        text: &str,
        file: &str,
        read: impl FnOnce(&Document<'_>) -> Result<T, InputError>,
    ) -> Result<T, InputError> {
        let source = SourceText { file, text };
        let root = table(source, text)?;
        read(&Document {
            source,
            table: &root,
        })
    }

    /// As [`parse`](Self::parse), with the tables of `overlay` laid over those of `text`: its keys
    /// win, key by key.
    ///
    /// Places in errors are those in `text`, a newline and `overlay`, one after the other.
    pub fn parse_overlaid<T>(
        text: &str,
        overlay: &str,
        file: &str,
        read: impl FnOnce(&Document<'_>) -> Result<T, InputError>,
    ) -> Result<T, InputError> {
        let whole = format!("{text}\n{overlay}");
        let source = SourceText { file, text: &whole };
        // Preceded by as much blank space as the text is long, values keep their places in the
        // whole.
        let shifted = " ".repeat(text.len() + 1) + overlay;
        let mut root = table(source, text)?;
        for (key, value) in table(source, &shifted)? {
            let below = root.get_mut(&key).map(Spanned::get_mut);
            match (below, value.get_ref()) {
                (Some(DeValue::Table(below)), DeValue::Table(above)) => below.extend(above.clone()),
                _ => drop(root.insert(key, value)),
            }
        }
        read(&Document {
            source,
            table: &root,
        })
    }
}

/// A piece of a file on one line, cut where a message would become unreadable.
pub(crate) fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    let line: String = text
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if text.chars().nth(LONGEST).is_some() {
        format!("{line}...")
    } else {
        line
    }
}

/// The topmost table of `text`, whose places are those of `source`.
fn table<'t>(source: SourceText<'_>, text: &'t str) -> Result<DeTable<'t>, InputError> {
    // The `toml` crate bounds how deeply tables and lists may nest, so what it returns can be
    // walked by recursion.
    DeTable::parse(text)
        .map(Spanned::into_inner)
        .map_err(|error| {
            let span = error.span().unwrap_or(text.len()..text.len());
            let start = span.start;
            let mut reason = format!("not valid TOML: {}", error.message());
            if error.message() == DUPLICATE {
                reason += &format!(" `{}`", shorten(text.get(span).unwrap_or_default()));
            } else if let Some(quotient) = quotient(text.get(start..).unwrap_or_default()) {
                reason = format!(
                    "not valid TOML: expected a number such as {quotient}, found a quotient"
                );
            }
            source.error(start, None, Complaint::Invalid { reason })
        })
}

/// The value of a text that begins with a quotient, such as `1/8`, which TOML does not have.
fn quotient(text: &str) -> Option<f64> {
    let is_end = |c: char| !(c.is_ascii_digit() || "./ ".contains(c));
    let (above, below) = text.split(is_end).next()?.split_once('/')?;
    let [above, below] = [above, below].map(|number| number.trim().parse::<f64>().ok());
    Some(above? / below?)
}

/// What the `toml` crate says of a key that a table has already; it does not name the key.
const DUPLICATE: &str = "duplicate key";
