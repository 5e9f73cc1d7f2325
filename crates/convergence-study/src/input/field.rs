//! A value with its place in the file.

use std::fs;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use toml::de::{DeInteger, DeValue};

use super::error::{Complaint, InputError};
use super::{Section, Source};
use crate::text::names::nearest;
use crate::text::visible;

/// An error of a reader of texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misread {
    /// Byte of the text.
    pub offset: usize,
    /// What is wrong, in words.
    pub reason: String,
}

/// What [`Field::positive`] takes, in words.
pub const POSITIVE: &str = "a finite number > 0";

/// A value of the document, with its dotted name.
#[derive(Debug, Clone)]
pub struct Field<'a> {
    source: Source<'a>,
    value: &'a DeValue<'a>,
    path: String,
    span: Range<usize>,
}

impl<'a> Field<'a> {
    pub(super) fn new(source: Source<'a>, value: &'a DeValue<'a>, path: String, span: Range<usize>) -> Self {
        Self { source, value, path, span }
    }

    /// An error about this value.
    pub fn refuse(&self, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        self.complain(self.span.start, Complaint::NotAllowed { found: found.into(), allowed: allowed.into() })
    }

    /// An error about this value, which is quoted as the file has it.
    pub fn refuse_as_written(&self, allowed: impl Into<String>) -> InputError {
        self.refuse(self.as_written(), allowed)
    }

    /// A finite number. A whole number is as good as one with a point.
    pub fn number(&self) -> Result<f64, InputError> {
        self.number_where("a finite number", |_| true)
    }

    /// A finite number that is `ok`; `allowed` says which numbers are.
    pub fn number_where(&self, allowed: &str, ok: impl Fn(f64) -> bool) -> Result<f64, InputError> {
        let value = match self.value {
            DeValue::Integer(integer) => whole(integer).map(|value| value as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        };
        match value {
            Some(value) if value.is_finite() && ok(value) => Ok(value),
            _ => Err(self.refuse_as_written(allowed)),
        }
    }

    /// A finite number > 0.
    pub fn positive(&self) -> Result<f64, InputError> {
        self.number_where(POSITIVE, |value| value > 0.0)
    }

    /// A whole number in `range`.
    pub fn count(&self, range: RangeInclusive<usize>) -> Result<usize, InputError> {
        let value = match self.value {
            DeValue::Integer(integer) => whole(integer).and_then(|value| usize::try_from(value).ok()),
            _ => None,
        };
        value.filter(|value| range.contains(value)).ok_or_else(|| {
            let (least, most) = (*range.start(), *range.end());
            let most = if most == usize::MAX { String::new() } else { format!(" and <= {most}") };
            self.refuse_as_written(format!("a whole number >= {least}{most}"))
        })
    }

    /// `true` or `false`.
    pub fn boolean(&self) -> Result<bool, InputError> {
        self.value.as_bool().ok_or_else(|| self.refuse_as_written("true or false"))
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, InputError> {
        self.value.as_str().ok_or_else(|| self.refuse_as_written("a text in quotes"))
    }

    /// The file of that name in `folder`; one that is not there is refused here, where it is named.
    pub fn file(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join(self.text()?);
        match fs::metadata(&path) {
            Ok(_) => Ok(path),
            Err(error) => {
                let found = format!("{}, but {}: {error}", self.as_written(), visible::path(&path));
                Err(self.refuse(found, "the name of a file, relative to this file's folder"))
            }
        }
    }

    /// One of `choices`, each with its name.
    pub fn choice<T: Copy>(&self, choices: &[(&'static str, T)]) -> Result<T, InputError> {
        let found = choices.iter().find(|(name, _)| Some(*name) == self.value.as_str());
        found.map(|(_, choice)| *choice).ok_or_else(|| {
            let names: Vec<String> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            let meant = self.value.as_str().and_then(|name| nearest(name, choices.iter().map(|(name, _)| *name)));
            let hint = meant.map(|name| format!(" (did you mean \"{name}\"?)")).unwrap_or_default();
            self.refuse(format!("{}{hint}", self.as_written()), names.join(", "))
        })
    }

    /// What `parse` makes of a text; an error points into the text.
    ///
    /// * `expected`: what the text would have to be, for a value that is no text.
    pub fn parsed<T>(&self, expected: &str, parse: impl FnOnce(&str) -> Result<T, Misread>) -> Result<T, InputError> {
        let text = self.value.as_str().ok_or_else(|| self.refuse_as_written(expected))?;
        parse(text).map_err(|misread| {
            // A text with escapes is not in the file as it is; its first byte is then the place.
            let inside = self.raw().find(text).map_or(0, |start| start + misread.offset);
            self.complain(self.span.start + inside, Complaint::Invalid { reason: misread.reason })
        })
    }

    /// An error about this value with a message of its own.
    pub fn invalid(&self, reason: impl Into<String>) -> InputError {
        self.complain(self.span.start, Complaint::Invalid { reason: reason.into() })
    }

    /// The values of a list.
    pub fn items(&self, allowed: &str) -> Result<Vec<Field<'a>>, InputError> {
        let DeValue::Array(items) = self.value else { return Err(self.refuse_as_written(allowed)) };
        let item = |(index, item): (usize, &'a toml::Spanned<DeValue<'a>>)| {
            Field::new(self.source, item.get_ref(), format!("{}[{index}]", self.path), item.span())
        };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// Is it a table?
    pub fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// Is it a list?
    pub fn is_list(&self) -> bool {
        self.value.is_array()
    }

    /// A table.
    pub fn section(&self) -> Result<Section<'a>, InputError> {
        match self.value {
            DeValue::Table(table) => Ok(Section::new(self.source, table, self.path.clone(), self.span.clone())),
            _ => Err(self.refuse_as_written("a table")),
        }
    }

    /// The value as the file has it, with its type where that would not be seen.
    pub fn as_written(&self) -> String {
        match self.value {
            DeValue::Table(_) => "a table".to_owned(),
            DeValue::Array(_) => format!("the list {}", shorten(self.raw())),
            DeValue::String(_) => format!("the text {}", shorten(self.raw())),
            _ => shorten(self.raw()),
        }
    }

    fn raw(&self) -> &'a str {
        self.source.text.get(self.span.clone()).unwrap_or("")
    }

    fn complain(&self, offset: usize, complaint: Complaint) -> InputError {
        self.source.error(offset, Some(self.path.clone()), complaint)
    }
}

/// The value of an integer in any notation.
pub(super) fn whole(integer: &DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// A piece of the file on one line, cut where a message would become unreadable.
pub fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    let line: String = text.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() { format!("{line}...") } else { line }
}
