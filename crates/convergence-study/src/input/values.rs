//! Values and tables of a document, with their places in the file.

use std::fs;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use super::{Complaint, InputError, Refusal, SourceText, settings};
use crate::text::names::nearest;
use crate::text::visible;

/// An error of a reader of texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misread {
    /// Byte offset in the text.
    pub offset: usize,
    /// What is wrong, in words.
    pub reason: String,
}

/// The values that [`Field::positive`] accepts, in words.
pub const POSITIVE: &str = "a finite number > 0";

/// A value of the document, with its dotted name.
#[derive(Debug, Clone)]
pub struct Field<'a> {
    source: SourceText<'a>,
    value: &'a DeValue<'a>,
    path: String,
    span: Range<usize>,
}

impl<'a> Field<'a> {
    /// An error about this value.
    pub fn refuse(&self, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        self.complain(
            0,
            Complaint::NotAllowed {
                found: found.into(),
                allowed: allowed.into(),
            },
        )
    }

    /// An error about this value, quoted as in the file.
    pub fn refuse_as_written(&self, allowed: impl Into<String>) -> InputError {
        self.refuse(self.as_written(), allowed)
    }

    /// The error of a refusal without a path, about this value.
    pub fn locate(&self, refusal: Refusal) -> InputError {
        refusal.about(self)
    }

    /// A finite number. A whole number will do, without a point.
    pub fn number(&self) -> Result<f64, InputError> {
        self.number_where("a finite number", |_| true)
    }

    /// A finite number that is `ok`; `allowed` says which numbers are.
    pub fn number_where(&self, allowed: &str, ok: impl Fn(f64) -> bool) -> Result<f64, InputError> {
        let value = match self.value {
            DeValue::Integer(integer) => settings::whole(integer).map(|value| value as f64),
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
            DeValue::Integer(integer) => {
                settings::whole(integer).and_then(|value| usize::try_from(value).ok())
            }
            _ => None,
        };
        value.filter(|value| range.contains(value)).ok_or_else(|| {
            let least = *range.start();
            let most = *range.end();
            let most = if most == usize::MAX {
                String::new()
            } else {
                format!(" and <= {most}")
            };
            self.refuse_as_written(format!("a whole number >= {least}{most}"))
        })
    }

    /// `true` or `false`.
    pub fn boolean(&self) -> Result<bool, InputError> {
        self.value
            .as_bool()
            .ok_or_else(|| self.refuse_as_written("true or false"))
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, InputError> {
        self.value
            .as_str()
            .ok_or_else(|| self.refuse_as_written("a text in quotes"))
    }

    /// The file of that name in `folder`; a missing one is refused here, where it is named.
    pub fn file(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join(self.text()?);
        match fs::metadata(&path) {
            Ok(_) => Ok(path),
            Err(error) => {
                let found = format!(
                    "{}, but {}: {error}",
                    self.as_written(),
                    visible::path(&path)
                );
                Err(self.refuse(found, "the name of a file, relative to this file's folder"))
            }
        }
    }

    /// One of `choices`, each with its name.
    pub fn choice<T: Copy>(&self, choices: &[(&'static str, T)]) -> Result<T, InputError> {
        let found = choices
            .iter()
            .find(|(name, _)| Some(*name) == self.value.as_str());
        found.map(|(_, choice)| *choice).ok_or_else(|| {
            let names: Vec<String> = choices
                .iter()
                .map(|(name, _)| format!("\"{name}\""))
                .collect();
            let suggestion = self
                .value
                .as_str()
                .and_then(|name| nearest(name, choices.iter().map(|(name, _)| *name)));
            let hint = suggestion
                .map(|name| format!(" (did you mean \"{name}\"?)"))
                .unwrap_or_default();
            self.refuse(format!("{}{hint}", self.as_written()), names.join(", "))
        })
    }

    /// An error about this value with a message of its own.
    pub fn invalid(&self, reason: impl Into<String>) -> InputError {
        self.complain(
            0,
            Complaint::Invalid {
                reason: reason.into(),
            },
        )
    }

    /// The values of a list.
    pub fn items(&self, allowed: &str) -> Result<Vec<Field<'a>>, InputError> {
        let DeValue::Array(items) = self.value else {
            return Err(self.refuse_as_written(allowed));
        };
        let item = |(index, item): (usize, &'a toml::Spanned<DeValue<'a>>)| Field {
            source: self.source,
            value: item.get_ref(),
            path: format!("{}[{index}]", self.path),
            span: item.span(),
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
            DeValue::Table(table) => {
                let path = self.path.clone();
                let span = self.span.clone();
                Ok(Section {
                    source: self.source,
                    table,
                    path,
                    span,
                })
            }
            _ => Err(self.refuse_as_written("a table")),
        }
    }

    /// The value as in the file, with its type if that is not obvious.
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

    pub(super) fn complain(&self, offset: usize, complaint: Complaint) -> InputError {
        self.source
            .error(self.span.start + offset, Some(self.path.clone()), complaint)
    }
}

/// A table of the document, with its dotted name.
#[derive(Debug, Clone)]
pub struct Section<'a> {
    pub(super) source: SourceText<'a>,
    pub(super) table: &'a DeTable<'a>,
    /// Empty for the document itself.
    pub(super) path: String,
    pub(super) span: Range<usize>,
}

impl<'a> Section<'a> {
    pub(super) fn root(source: SourceText<'a>, table: &'a DeTable<'a>) -> Self {
        Self {
            source,
            table,
            path: String::new(),
            span: 0..0,
        }
    }

    /// The whole text of the document.
    pub fn text(&self) -> &'a str {
        self.source.text
    }

    /// The name of the document's file in messages.
    pub fn file(&self) -> &'a str {
        self.source.file
    }

    /// Every value of the table and of the tables in it: its dotted path, such as
    /// `expect[0].tolerance`, and its text.
    ///
    /// Numbers have one text however they are written: 0.05 and 5e-2 are equal. A list of plain
    /// values is one value.
    pub fn settings(&self) -> Vec<(String, String)> {
        settings::of_table(self.table)
    }

    /// The keys, sorted by name.
    pub fn keys(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.table.keys().map(|key| key.get_ref().as_ref())
    }

    /// Refuses every key but these.
    pub fn allow(&self, keys: &[&str]) -> Result<(), InputError> {
        let unknown = self
            .table
            .keys()
            .filter(|key| !keys.contains(&key.get_ref().as_ref()));
        // The table is sorted by name; a reader starts at the top of the file.
        let Some(key) = unknown.min_by_key(|key| key.span().start) else {
            return Ok(());
        };
        let found = key.get_ref().as_ref();
        let shown = shorten(key.get_ref());
        let name = self.name_of(&shown);
        let suggestion = nearest(found, keys.iter().copied()).map(str::to_owned);
        let complaint = Complaint::UnknownKey {
            found: shown,
            suggestion,
            allowed: keys.join(", "),
        };
        Err(self.source.error(key.span().start, Some(name), complaint))
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        let value = self.table.get(key)?;
        Some(Field {
            source: self.source,
            value: value.get_ref(),
            path: self.name_of(key),
            span: value.span(),
        })
    }

    /// The value of a key that has no default; `allowed` says what must be there.
    pub fn require(&self, key: &str, allowed: &str) -> Result<Field<'a>, InputError> {
        self.get(key).ok_or_else(|| self.missing(key, allowed))
    }

    /// The whole number of a key without a default.
    pub fn count(&self, key: &str, range: RangeInclusive<usize>) -> Result<usize, InputError> {
        self.require(key, &format!("a whole number >= {}", range.start()))?
            .count(range)
    }

    /// The finite number > 0 of a key without a default.
    pub fn positive(&self, key: &str) -> Result<f64, InputError> {
        self.require(key, POSITIVE)?.positive()
    }

    /// The values of a list without a default, each by `read`.
    ///
    /// * `fits`: whether the list as a whole matches `allowed`.
    pub fn list<T>(
        &self,
        key: &str,
        allowed: &str,
        read: impl FnMut(&Field<'a>) -> Result<T, InputError>,
        fits: impl Fn(&[T]) -> bool,
    ) -> Result<Vec<T>, InputError> {
        let field = self.require(key, allowed)?;
        let list = field
            .items(allowed)?
            .iter()
            .map(read)
            .collect::<Result<Vec<T>, InputError>>()?;
        if fits(&list) {
            Ok(list)
        } else {
            Err(field.refuse_as_written(allowed))
        }
    }

    /// The error about a missing key.
    pub fn missing(&self, key: &str, allowed: &str) -> InputError {
        self.complain(
            key,
            Complaint::Invalid {
                reason: format!("missing; expected {allowed}"),
            },
        )
    }

    /// An error about a key: at its value, or at the head of the table if the key is missing.
    pub fn refuse(
        &self,
        key: &str,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> InputError {
        match self.get(key) {
            Some(field) => field.refuse(found, allowed),
            None => self.complain(
                key,
                Complaint::NotAllowed {
                    found: found.into(),
                    allowed: allowed.into(),
                },
            ),
        }
    }

    /// The table of that name; `None` if it is absent.
    pub fn section(&self, key: &str) -> Result<Option<Section<'a>>, InputError> {
        self.get(key).map(|field| field.section()).transpose()
    }

    fn name_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    fn complain(&self, key: &str, complaint: Complaint) -> InputError {
        self.source
            .error(self.span.start, Some(self.name_of(key)), complaint)
    }
}

/// A piece of the file on one line, cut where a message would become unreadable.
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
