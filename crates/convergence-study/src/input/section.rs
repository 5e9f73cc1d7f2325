//! A table with its place in the file.

use std::fmt::Display;
use std::ops::{Range, RangeInclusive};

use toml::de::DeTable;

use super::error::{Complaint, InputError};
use super::{Field, POSITIVE, Source, settings, shorten};
use crate::text::names::nearest;

/// A table of the document, with its dotted name.
#[derive(Debug, Clone)]
pub struct Section<'a> {
    source: Source<'a>,
    table: &'a DeTable<'a>,
    /// Empty for the document itself.
    path: String,
    span: Range<usize>,
}

impl<'a> Section<'a> {
    pub(super) fn root(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        Self { source, table, path: String::new(), span: 0..0 }
    }

    pub(super) fn new(source: Source<'a>, table: &'a DeTable<'a>, path: String, span: Range<usize>) -> Self {
        Self { source, table, path, span }
    }

    /// The whole text of the document.
    pub fn text(&self) -> &'a str {
        self.source.text
    }

    /// The name of the document's file, as messages have it.
    pub fn file(&self) -> &'a str {
        self.source.file
    }

    /// Every value of the table and of the tables in it: its dotted path, such as `expect[0].tolerance`, and its text.
    ///
    /// Numbers have one text however they are written: 0.05 and 5e-2 are equal. A list of plain values is one value.
    pub fn settings(&self) -> Vec<(String, String)> {
        settings::of_table(self.table)
    }

    /// Refuses every key but these.
    pub fn allow(&self, keys: &[&str]) -> Result<(), InputError> {
        let unknown = self.table.keys().filter(|key| !keys.contains(&key.get_ref().as_ref()));
        // The table is sorted by name; a reader starts at the top of the file.
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let (found, shown) = (key.get_ref().as_ref(), shorten(key.get_ref()));
        let (name, suggestion) = (self.name_of(&shown), nearest(found, keys.iter().copied()).map(str::to_owned));
        let complaint = Complaint::UnknownKey { found: shown, suggestion, allowed: keys.join(", ") };
        Err(self.source.error(key.span().start, Some(name), complaint))
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<Field<'a>> {
        let value = self.table.get(key)?;
        Some(Field::new(self.source, value.get_ref(), self.name_of(key), value.span()))
    }

    /// The value of a key that has no default; `allowed` says what would have to be there.
    pub fn require(&self, key: &str, allowed: &str) -> Result<Field<'a>, InputError> {
        self.get(key).ok_or_else(|| self.missing(key, allowed))
    }

    /// The table of that name, which has no keys but these.
    pub fn table(&self, key: &str, keys: &[&str]) -> Result<Section<'a>, InputError> {
        let table = self.require(key, &format!("a table with {}", keys.join(", ")))?.section()?;
        table.allow(keys)?;
        Ok(table)
    }

    /// The values of a list that has no default, each by `read`.
    ///
    /// * `fits`: whether the list as a whole is one that `allowed` describes.
    pub fn list<T>(
        &self,
        key: &str,
        allowed: &str,
        read: impl FnMut(&Field<'a>) -> Result<T, InputError>,
        fits: impl Fn(&[T]) -> bool,
    ) -> Result<Vec<T>, InputError> {
        let field = self.require(key, allowed)?;
        let list = field.items(allowed)?.iter().map(read).collect::<Result<Vec<T>, InputError>>()?;
        if fits(&list) { Ok(list) } else { Err(field.refuse_as_written(allowed)) }
    }

    /// A list of levels, at least so many, each of which `follows` the one before; `relation` says so in words, such as `a number >`.
    pub fn sequence<T: Copy + Display>(
        &self,
        (key, allowed, least): (&str, &str, usize),
        read: impl Fn(&Field<'a>) -> Result<T, InputError>,
        (relation, follows): (&str, fn(T, T) -> bool),
    ) -> Result<Vec<T>, InputError> {
        let mut last = None;
        let level = |item: &Field<'a>| {
            let level = read(item)?;
            match last.replace(level) {
                Some(before) if !follows(before, level) => {
                    Err(item.refuse_as_written(format!("{relation} {before}, the level before")))
                }
                _ => Ok(level),
            }
        };
        self.list(key, allowed, level, |list| list.len() >= least)
    }

    /// The tables `[[key]]`, at least one, each by `read`.
    ///
    /// * `keys`: what follows in a message, such as ` with order and tolerance`.
    pub fn tables<T>(
        &self,
        key: &str,
        keys: &str,
        mut read: impl FnMut(&Section<'a>) -> Result<T, InputError>,
    ) -> Result<Vec<T>, InputError> {
        let allowed = format!("at least one table [[{key}]]{keys}");
        self.list(key, &allowed, |item| read(&item.section()?), |list| !list.is_empty())
    }

    /// The whole number of a key that has no default.
    pub fn count(&self, key: &str, range: RangeInclusive<usize>) -> Result<usize, InputError> {
        self.require(key, &format!("a whole number >= {}", range.start()))?.count(range)
    }

    /// The finite number > 0 of a key that has no default.
    pub fn positive(&self, key: &str) -> Result<f64, InputError> {
        self.require(key, POSITIVE)?.positive()
    }

    /// The error about a key that is missing.
    pub fn missing(&self, key: &str, allowed: &str) -> InputError {
        self.complain(key, Complaint::Missing { allowed: allowed.to_owned() })
    }

    /// An error about a key: at its value, or at the head of the table where the key is missing.
    pub fn refuse(&self, key: &str, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        match self.get(key) {
            Some(field) => field.refuse(found, allowed),
            None => self.complain(key, Complaint::NotAllowed { found: found.into(), allowed: allowed.into() }),
        }
    }

    /// The table of that name; `None` if it is not there.
    pub fn section(&self, key: &str) -> Result<Option<Section<'a>>, InputError> {
        self.get(key).map(|field| field.section()).transpose()
    }

    fn name_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    fn complain(&self, key: &str, complaint: Complaint) -> InputError {
        self.source.error(self.span.start, Some(self.name_of(key)), complaint)
    }
}
