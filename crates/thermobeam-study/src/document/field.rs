//! A value that knows where it stands.

use std::fs;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use toml::de::{DeInteger, DeValue};

use super::error::{Complaint, InputError, visible};
use super::{Section, Source};
use crate::exact::nearest::nearest;
use crate::expression::{Expression, NotFinite, Variable};

/// A value of the document, with its dotted name.
#[derive(Debug, Clone)]
pub(crate) struct Field<'a> {
    source: Source<'a>,
    value: &'a DeValue<'a>,
    path: String,
    span: Range<usize>,
}

impl<'a> Field<'a> {
    pub(super) fn new(source: Source<'a>, value: &'a DeValue<'a>, path: String, span: Range<usize>) -> Self {
        Self { source, value, path, span }
    }

    /// A complaint about this value.
    pub(crate) fn refuse(&self, found: impl Into<String>, allowed: impl Into<String>) -> InputError {
        self.complain(self.span.start, Complaint::NotAllowed { found: found.into(), allowed: allowed.into() })
    }

    /// A complaint about this value, quoted as the file has it.
    pub(crate) fn refuse_as_written(&self, allowed: impl Into<String>) -> InputError {
        self.refuse(self.as_written(), allowed)
    }

    /// A finite number. A whole number is as good as one with a point.
    pub(crate) fn number(&self) -> Result<f64, InputError> {
        self.number_where("a finite number", |_| true)
    }

    /// A finite number that is `ok`; `allowed` says which numbers are.
    pub(crate) fn number_where(&self, allowed: &str, ok: impl Fn(f64) -> bool) -> Result<f64, InputError> {
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

    /// A whole number in `range`.
    pub(crate) fn count(&self, range: RangeInclusive<usize>) -> Result<usize, InputError> {
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
    pub(crate) fn boolean(&self) -> Result<bool, InputError> {
        self.value.as_bool().ok_or_else(|| self.refuse_as_written("true or false"))
    }

    /// A text.
    pub(crate) fn text(&self) -> Result<&'a str, InputError> {
        self.value.as_str().ok_or_else(|| self.refuse_as_written("a text in quotes"))
    }

    /// The file of that name in `folder`; one that is not there is refused here, where it is named.
    pub(crate) fn file(&self, folder: &Path) -> Result<PathBuf, InputError> {
        let path = folder.join(self.text()?);
        match fs::metadata(&path) {
            Ok(_) => Ok(path),
            Err(error) => {
                let found = format!("{}, but {}: {error}", self.as_written(), visible(&path.display().to_string()));
                Err(self.refuse(found, "the name of a file, relative to this file's folder"))
            }
        }
    }

    /// One of `choices`, each with its name.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&'static str, T)]) -> Result<T, InputError> {
        let found = choices.iter().find(|(name, _)| Some(*name) == self.value.as_str());
        found.map(|(_, choice)| *choice).ok_or_else(|| {
            let names: Vec<String> = choices.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            let meant = self.value.as_str().and_then(|name| nearest(name, choices.iter().map(|(name, _)| *name)));
            let hint = meant.map(|name| format!(" (did you mean \"{name}\"?)")).unwrap_or_default();
            self.refuse(format!("{}{hint}", self.as_written()), names.join(", "))
        })
    }

    /// A function of `variable`; a complaint points into the text.
    pub(crate) fn expression(&self, variable: Variable) -> Result<Expression, InputError> {
        let allowed = format!("a function of {} in quotes, such as \"1 - {}\"", variable.name(), variable.name());
        let text = self.value.as_str().ok_or_else(|| self.refuse_as_written(allowed))?;
        Expression::parse(text, variable).map_err(|error| {
            // With escapes in it the text is not in the file as it is; then the value has to do.
            let inside = self.raw().find(text).map_or(0, |start| start + error.offset);
            self.complain(self.span.start + inside, Complaint::Expression(error))
        })
    }

    /// Refuses a function that is not finite on [0, end], nor its derivatives up to `order`.
    pub(crate) fn finite(&self, function: &Expression, end: f64, order: usize) -> Result<(), InputError> {
        function.check_finite_up_to(end, order).map_err(|found| self.not_finite(found))
    }

    /// The complaint about a function that is not finite somewhere.
    pub(crate) fn not_finite(&self, found: NotFinite) -> InputError {
        self.complain(self.span.start, Complaint::NotFinite(found))
    }

    /// The values of a list.
    pub(crate) fn items(&self, allowed: &str) -> Result<Vec<Field<'a>>, InputError> {
        let DeValue::Array(items) = self.value else { return Err(self.refuse_as_written(allowed)) };
        let item = |(index, item): (usize, &'a toml::Spanned<DeValue<'a>>)| {
            Field::new(self.source, item.get_ref(), format!("{}[{index}]", self.path), item.span())
        };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// Is it a table?
    pub(crate) fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// Is it a list?
    pub(crate) fn is_list(&self) -> bool {
        self.value.is_array()
    }

    /// A table.
    pub(crate) fn section(&self) -> Result<Section<'a>, InputError> {
        match self.value {
            DeValue::Table(table) => Ok(Section::new(self.source, table, self.path.clone(), self.span.clone())),
            _ => Err(self.refuse_as_written("a table")),
        }
    }

    /// The value as the file has it, with its type where that would not be seen.
    pub(crate) fn as_written(&self) -> String {
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
        InputError {
            file: self.source.file.to_owned(),
            place: Some(self.source.place(offset)),
            field: Some(self.path.clone()),
            complaint: Box::new(complaint),
        }
    }
}

fn whole(integer: &DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// A piece of the file on one line, cut where a message would become unreadable.
pub(crate) fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    let line: String = text.chars().take(LONGEST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() { format!("{line}...") } else { line }
}
