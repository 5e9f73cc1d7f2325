//! A file as a struct: serde reads it, and an error names file, line, column, field, what
//! was found and what is allowed. What a struct cannot say, a condition between fields or an
//! expression that must be parsed, is a [`Refusal`], which names its field.
//!
//! Where something stands is looked up by its path in the document. So a file must not be read by
//! way of `flatten`, `untagged` or `tag`, which lose the path.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::Value;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::{Complaint, InputError, SourceText, schema, settings, shorten};
use crate::text::names::nearest;
use crate::text::visible;

/// Why a file that was read is refused: at which field, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal(Box<Reason>);

#[derive(Debug, Clone, PartialEq)]
enum Reason {
    /// At a field of the table, by its dotted name.
    Field { path: String, wrong: Wrong },
    /// In another file, which the field names.
    File(InputError),
}

#[derive(Debug, Clone, PartialEq)]
enum Wrong {
    /// The value as it is written, and these words after it.
    Written { more: String, allowed: String },
    /// Something else; of a text that a parser refuses with the place in it.
    Other {
        offset: Option<usize>,
        complaint: Complaint,
    },
}

impl Refusal {
    /// What was found at a field, in words, and what is allowed.
    ///
    /// * `path`: the field's dotted name in the struct, such as `refine.steps[1]`.
    pub fn new(
        path: impl Into<String>,
        found: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        let (found, allowed) = (found.into(), allowed.into());
        Self::of(path, None, Complaint::NotAllowed { found, allowed })
    }

    /// The value of a field as it is written, and what is allowed.
    pub fn written(path: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::written_and(path, "", allowed)
    }

    /// The value of a field as it is written with more words about it, and what is allowed.
    pub fn written_and(
        path: impl Into<String>,
        more: impl Into<String>,
        allowed: impl Into<String>,
    ) -> Self {
        let (more, allowed) = (more.into(), allowed.into());
        Self(Box::new(Reason::Field {
            path: path.into(),
            wrong: Wrong::Written { more, allowed },
        }))
    }

    /// A field that must be there.
    pub fn missing(path: impl Into<String>, allowed: &str) -> Self {
        Self::invalid(path, format!("missing; expected {allowed}"))
    }

    /// A field with a message of its own.
    pub fn invalid(path: impl Into<String>, reason: impl Into<String>) -> Self {
        let reason = reason.into();
        Self::of(path, None, Complaint::Invalid { reason })
    }

    /// A text that a parser refuses.
    ///
    /// * `offset`: the byte of the text at which it does.
    pub fn misread(path: impl Into<String>, offset: usize, reason: String) -> Self {
        Self::of(path, Some(offset), Complaint::Invalid { reason })
    }

    /// A key that the table does not have.
    pub fn unknown(path: &str, known: &[&str]) -> Self {
        let name = path.rsplit('.').next().unwrap_or(path);
        let complaint = Complaint::UnknownKey {
            found: shorten(name),
            suggestion: nearest(name, known.iter().copied()).map(str::to_owned),
            allowed: known.join(", "),
        };
        Self::of(path, None, complaint)
    }

    /// Puts the name of a table before that of a refused field, for `map_err`.
    pub fn within(table: &str) -> impl Fn(Self) -> Self {
        move |refusal| match *refusal.0 {
            Reason::Field { path, wrong } => Self(Box::new(Reason::Field {
                path: joined(table, &path),
                wrong,
            })),
            Reason::File(_) => refusal,
        }
    }

    /// What is made of each item of a list, whose name stands before that of a refused field.
    pub fn of_each<T, U>(
        list: &str,
        items: impl IntoIterator<Item = T>,
        make: impl Fn(T) -> Result<U, Self>,
    ) -> Result<Vec<U>, Self> {
        let items = items.into_iter().enumerate();
        let made = items
            .map(|(place, item)| make(item).map_err(Self::within(&format!("{list}[{place}]"))));
        made.collect()
    }

    fn of(path: impl Into<String>, offset: Option<usize>, complaint: Complaint) -> Self {
        Self(Box::new(Reason::Field {
            path: path.into(),
            wrong: Wrong::Other { offset, complaint },
        }))
    }
}

impl From<InputError> for Refusal {
    fn from(error: InputError) -> Self {
        Self(Box::new(Reason::File(error)))
    }
}

/// The file that a field names, in a folder.
///
/// # Errors
/// There is none.
pub fn named_file(path: &str, name: &str, folder: &Path) -> Result<PathBuf, Refusal> {
    let file = folder.join(name);
    match fs::metadata(&file) {
        Ok(_) => Ok(file),
        Err(error) => Err(Refusal::written_and(
            path,
            format!(", but {}: {error}", visible::path(&file)),
            "the name of a file, relative to this file's folder",
        )),
    }
}

/// A TOML file.
#[derive(Debug, Clone, Copy)]
pub struct Document<'a> {
    pub(super) source: SourceText<'a>,
    pub(super) table: &'a DeTable<'a>,
}

/// What a schema allows at a path, in words.
fn allowed_at(schema: &Value, path: &str) -> String {
    schema::at(schema, path).map_or("another value".to_owned(), schema::allowed)
}

/// A field that has been looked up: its value, if it is there, and the place to name.
struct Found<'a> {
    value: Option<&'a Spanned<DeValue<'a>>>,
    key: Range<usize>,
}

impl Found<'_> {
    fn start(&self) -> usize {
        self.value
            .map_or(self.key.start, |value| value.span().start)
    }
}

impl<'a> Document<'a> {
    /// The document as a struct.
    ///
    /// # Errors
    /// A key that is unknown or missing, or a value that is not allowed.
    pub fn read<T: DeserializeOwned + JsonSchema>(&self) -> Result<T, InputError> {
        self.read_keys(|_| true)
    }

    /// The topmost keys for which `is_read` holds as a struct; the others are read elsewhere.
    pub(crate) fn read_keys<T: DeserializeOwned + JsonSchema>(
        &self,
        is_read: impl Fn(&str) -> bool,
    ) -> Result<T, InputError> {
        let own = self.table.iter();
        let own = own.filter(|(key, _)| is_read(key.get_ref()));
        let table = own
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect();
        let table = toml::Deserializer::from(Spanned::new(0..0, table));
        // A `Value` refuses what is left of a list of fixed length; this deserializer drops it.
        let value: Result<toml::Value, _> = serde_path_to_error::deserialize(table);
        let read = value.and_then(serde_path_to_error::deserialize);
        read.map_err(|error| {
            let path = match error.path().to_string() {
                root if root == "." => String::new(),
                path => path,
            };
            self.misfit(path, error.inner().message(), &schema::of::<T>())
        })
    }

    /// Whether it has this topmost key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    /// A topmost key that may be meant for `key`.
    pub(crate) fn key_like(&self, key: &str) -> Option<&'a str> {
        let mut keys = self.table.keys().map(|found| found.get_ref().as_ref());
        keys.find(|found| nearest(found, [key]).is_some())
    }

    /// Every value: its dotted path, such as `expect[0].tolerance`, and its text.
    ///
    /// Numbers have one text however they are written: 0.05 and 5e-2 are equal. A list of plain
    /// values is one value.
    pub fn settings(&self) -> Vec<(String, String)> {
        settings::of_table(self.table)
    }

    /// The error of a refusal.
    pub fn locate(&self, refusal: Refusal) -> InputError {
        let (path, wrong) = match *refusal.0 {
            Reason::Field { path, wrong } => (path, wrong),
            Reason::File(error) => return error,
        };
        let found = self.find(&path);
        let (offset, complaint) = match wrong {
            Wrong::Written { more, allowed } => {
                let found = self.written(&found) + &more;
                (None, Complaint::NotAllowed { found, allowed })
            }
            Wrong::Other { offset, complaint } => (offset, complaint),
        };
        self.error_at(&found, &path, offset, complaint)
    }

    /// The byte of the text at which a field begins.
    pub fn start_of(&self, path: &str) -> usize {
        self.find(path).start()
    }

    /// What serde says about a value, in the words of this project.
    fn misfit(&self, path: String, message: &str, schema: &Value) -> InputError {
        let found = self.find(&path);
        let (problem, expected) = message.split_once(", expected ").unwrap_or((message, ""));
        let complaint = match problem.split(' ').next() {
            Some("missing") => {
                let path = joined(&path, quoted(problem).next().unwrap_or_default());
                let meaning = schema::at(schema, &path)
                    .and_then(|schema| schema["description"].as_str())
                    .map_or(String::new(), |meaning| {
                        format!(": {}", meaning.replace('\n', " "))
                    });
                let allowed = allowed_at(schema, &path);
                let reason = format!("missing; expected {allowed}{meaning}");
                return self.error_at(&found, &path, None, Complaint::Invalid { reason });
            }
            Some("unknown") if problem.starts_with("unknown field") => {
                let at_key = Found {
                    value: None,
                    ..found
                };
                let name = self.raw(&at_key).trim_matches(['"', '\'']);
                let complaint = Complaint::UnknownKey {
                    found: shorten(name),
                    suggestion: nearest(name, quoted(expected)).map(str::to_owned),
                    allowed: quoted(expected).collect::<Vec<_>>().join(", "),
                };
                return self.error_at(&at_key, &path, None, complaint);
            }
            Some("found") => Complaint::Invalid {
                reason: message.to_owned(),
            },
            _ => {
                let texts = schema::at(schema, &path).map_or(vec![], schema::texts);
                let suggestion = self.text_of(&found).and_then(|text| nearest(text, texts));
                let hint = suggestion.map(|name| format!(" (did you mean \"{name}\"?)"));
                Complaint::NotAllowed {
                    found: self.written(&found) + &hint.unwrap_or_default(),
                    allowed: allowed_at(schema, &path),
                }
            }
        };
        self.error_at(&found, &path, None, complaint)
    }

    /// A field by its dotted name; of one that is missing, the place of the table that lacks it.
    fn find(&self, path: &str) -> Found<'a> {
        let mut found = Found {
            value: None,
            key: 0..0,
        };
        let mut table = Some(self.table);
        let mut rest = path;
        while !rest.is_empty() {
            let step = match (table, found.value.map(Spanned::get_ref)) {
                (Some(table), _) => key_of(table, rest),
                (None, Some(DeValue::Array(items))) => item_of(items, rest),
                _ => None,
            };
            let Some((key, value, below)) = step else {
                // A key that is missing: its table.
                let key = found.value.map_or(found.key, Spanned::span);
                return Found { value: None, key };
            };
            table = value.get_ref().as_table();
            found = Found {
                value: Some(value),
                key,
            };
            rest = below;
        }
        found
    }

    fn error_at(
        &self,
        found: &Found<'_>,
        path: &str,
        offset: Option<usize>,
        complaint: Complaint,
    ) -> InputError {
        // A text with escapes differs from the file; the place is then its first byte.
        let text = self.text_of(found).zip(offset);
        let inside = text.and_then(|(text, offset)| Some(self.raw(found).find(text)? + offset));
        let start = found.start() + inside.unwrap_or(0);
        let path = Some(path.to_owned()).filter(|path| !path.is_empty());
        self.source.error(start, path, complaint)
    }

    fn text_of<'f>(&self, found: &Found<'f>) -> Option<&'f str> {
        found.value?.get_ref().as_str()
    }

    fn raw(&self, found: &Found<'_>) -> &'a str {
        let span = found.value.map_or(found.key.clone(), Spanned::span);
        self.source.text.get(span).unwrap_or("")
    }

    fn written(&self, found: &Found<'_>) -> String {
        let raw = shorten(self.raw(found));
        match found.value.map(Spanned::get_ref) {
            None => "nothing".to_owned(),
            Some(DeValue::Table(table)) if table.is_empty() => "an empty table".to_owned(),
            Some(DeValue::Table(_)) => "a table".to_owned(),
            Some(DeValue::Array(_)) => format!("the list {raw}"),
            Some(DeValue::String(_)) => format!("the text {raw}"),
            Some(_) => raw,
        }
    }
}

/// A step of a path: where its key stands, its value, and the path below it.
type Step<'a, 'p> = (Range<usize>, &'a Spanned<DeValue<'a>>, &'p str);

/// The key of a table with which a path begins.
fn key_of<'a, 'p>(table: &'a DeTable<'a>, path: &'p str) -> Option<Step<'a, 'p>> {
    // A name of the user's may have a dot.
    table.iter().find_map(|(key, value)| {
        let rest = path.strip_prefix(key.get_ref().as_ref())?;
        let below = rest.strip_prefix('.').unwrap_or(rest);
        let is_end = rest.is_empty() || rest.starts_with(['.', '[']);
        is_end.then(|| (key.span(), value, below))
    })
}

/// The item of a list with which a path begins, such as `[1].x`.
fn item_of<'a, 'p>(items: &'a DeArray<'a>, path: &'p str) -> Option<Step<'a, 'p>> {
    let (index, rest) = path.strip_prefix('[')?.split_once(']')?;
    let item = items.get(index.parse::<usize>().ok()?)?;
    Some((item.span(), item, rest.strip_prefix('.').unwrap_or(rest)))
}

fn joined(table: &str, name: &str) -> String {
    let dot = if table.is_empty() || name.is_empty() || name.starts_with('[') {
        ""
    } else {
        "."
    };
    format!("{table}{dot}{name}")
}

/// The names in backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}
