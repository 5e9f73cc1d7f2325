//! The text of a file: its struct, the places of its values, and what a message says about them.

use std::ops::Range;

use schemars::generate::SchemaSettings;

use super::entries::{EXPRESSION, Entry, Located};
use super::file::{Named, ProblemFile};
use super::{Expression, InputError, LineColumn, Location, TensorValue};
use crate::language::names::did_you_mean;
use crate::language::parse;

/// The text of the file and its name.
#[derive(Clone, Copy)]
pub(super) struct Reader<'t> {
    pub(super) file: &'t str,
    pub(super) text: &'t str,
}

/// What serde and toml say of a value, and what is expected in the words of a message.
const EXPECTED: [(&str, &str); 7] = [
    ("a map", "a table"),
    ("a sequence", "a list"),
    ("a string", "a text"),
    ("a nonzero u64", "a whole number >= 1"),
    ("f64", "a number"),
    ("wanted string or table", "a text"),
    ("floating-point number overflowed", "a finite number"),
];

impl Reader<'_> {
    /// The file as a struct.
    pub(super) fn read(self) -> Result<ProblemFile, InputError> {
        let whole = toml::Deserializer::parse(self.text).map_err(|error| InputError {
            line: error.span().map_or(0, |span| self.place(span.start).line),
            ..InputError::whole(self.file, error.message())
        })?;
        serde_path_to_error::deserialize(whole).map_err(|error| {
            use serde_path_to_error::Segment;
            // A value that knows its place is a table of its own for serde.
            let names = error.path().iter().filter_map(|segment| match segment {
                Segment::Map { key } if key.starts_with("$__serde_spanned") => None,
                Segment::Map { key } => Some(key.as_str()),
                _ => None,
            });
            let path = names.collect::<Vec<_>>().join(".");
            let span = error.inner().span().unwrap_or(0..0);
            self.misfit(&path, span, error.inner().message())
        })
    }

    /// What serde says about a value, in the words of this crate.
    fn misfit(self, path: &str, span: Range<usize>, message: &str) -> InputError {
        let mut place = self.location(path, &span);
        let (problem, expected) = message.split_once(", expected ").unwrap_or((message, ""));
        let [found, known] = [problem, expected].map(|text| {
            let quoted = text.split('`').skip(1).step_by(2);
            quoted.collect::<Vec<&str>>()
        });
        let found = found.first().copied().unwrap_or_default();
        let near = did_you_mean(found, known.iter().copied());
        let known = known.join(" ");
        let in_words = EXPECTED.iter().find(|entry| message.ends_with(entry.0));
        let expected = in_words.map_or(expected, |entry| entry.1);
        let written = self.written(span);
        let problem = match problem.split_once(' ') {
            Some(("missing", _)) => {
                if path.is_empty() {
                    place.line = 0;
                }
                let meaning = meaning(path, found);
                format!("expected the key `{found}`{meaning}, found none")
            }
            Some(("unknown", rest)) if rest.starts_with("field") => {
                format!("unknown key `{found}`{near}; expected one of {known}")
            }
            Some(("unknown", _)) if found == "spherical" => {
                "spherical coordinates are left out; write the problem in others".to_owned()
            }
            Some(("unknown", _)) => match path.strip_prefix("norms.") {
                Some(norm) if known.contains(norm) => format!(
                    "expected a field and its norms, `{found} = [\"{norm}\"]`; found a norm as a key"
                ),
                _ => format!("found `{found}`{near}; expected one of {known}"),
            },
            Some(("invalid", "length 0")) => format!("expected {expected}, found none"),
            _ if expected.is_empty() => message.to_owned(),
            _ => format!("expected {expected}, found {written}"),
        };
        place.error(problem)
    }

    fn place(self, offset: usize) -> LineColumn {
        let before = self.text.get(..offset).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |end| end + 1);
        LineColumn {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// Where the text of a value begins: a number is its own text, others have one or three quotes.
    fn start_of_text(self, start: usize) -> LineColumn {
        let value = self.text.get(start..).unwrap_or("");
        let mut quotes = ["\"\"\"", "'''", "\"", "'"].into_iter();
        let quote = quotes.find(|quote| value.starts_with(quote)).unwrap_or("");
        let mut start = start + quote.len();
        if quote.len() == 3 && self.text[start..].starts_with('\n') {
            start += 1;
        }
        self.place(start)
    }

    /// The place of the value of a key.
    pub(super) fn location(self, key: impl Into<String>, span: &Range<usize>) -> Location {
        Location {
            file: self.file.to_owned(),
            line: self.place(span.start).line,
            text: self.start_of_text(span.start),
            key: key.into(),
        }
    }

    /// What the file has there.
    fn written(self, span: Range<usize>) -> String {
        self.text[span].chars().take(40).collect()
    }

    /// The error of a value that is something else.
    pub(super) fn unexpected(
        self,
        key: &str,
        entry: &Located<Entry>,
        expected: &str,
    ) -> InputError {
        let found = self.written(entry.span.clone());
        let place = self.location(key, &entry.span);
        place.error(format!("expected {expected}, found {found}"))
    }

    /// A text, or a number as it is written, as an expression.
    pub(super) fn expression(
        self,
        key: &str,
        entry: &Located<Entry>,
    ) -> Result<Expression, InputError> {
        let text = match &entry.value {
            Entry::Text(text) => text.clone(),
            Entry::Number => self.text[entry.span.clone()].to_owned(),
            _ => return Err(self.unexpected(key, entry, EXPRESSION)),
        };
        let place = self.location(key, &entry.span);
        let tree =
            parse(&text).map_err(|error| place.error_at(&text, error.offset, error.problem))?;
        Ok(Expression { place, text, tree })
    }

    /// An expression, or a list of them, or a list of lists.
    pub(super) fn tensor(
        self,
        key: &str,
        entry: &Located<Entry>,
    ) -> Result<TensorValue, InputError> {
        let Entry::List(parts) = &entry.value else {
            return self.expression(key, entry).map(TensorValue::One);
        };
        let place = self.location(key, &entry.span);
        if parts.is_empty() {
            return Err(place.error("expected at least one component, found none"));
        }
        let parts = parts.iter().map(|part| self.tensor(key, part));
        Ok(TensorValue::List(place, parts.collect::<Result<_, _>>()?))
    }

    pub(super) fn table<'e>(
        self,
        key: &str,
        entry: &'e Located<Entry>,
    ) -> Result<&'e Named<Entry>, InputError> {
        match &entry.value {
            Entry::Table(table) => Ok(table),
            _ => Err(self.unexpected(key, entry, "a table")),
        }
    }
}

/// What a key of the file, or of one of its tables, means, in brackets.
fn meaning(table: &str, name: &str) -> String {
    let mut settings = SchemaSettings::draft07();
    settings.inline_subschemas = true;
    let schema = settings
        .into_generator()
        .into_root_schema_for::<ProblemFile>();
    let path = table.split('.').filter(|name| !name.is_empty());
    let key = path.chain([name]).fold(schema.as_value(), |schema, name| {
        &schema["properties"][name]
    });
    key["description"]
        .as_str()
        .map_or(String::new(), |meaning| {
            format!(" ({})", meaning.replace('\n', " "))
        })
}
