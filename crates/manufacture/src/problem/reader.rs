//! Values of a TOML file with their places.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys;
use super::{Expression, InputError, LineColumn, Location, TensorValue};
use crate::language::names::did_you_mean;
use crate::language::parse;

/// A table of the file with the path of its keys.
pub(super) struct FileSection<'t> {
    pub(super) path: String,
    table: &'t DeTable<'t>,
    reader: &'t Reader<'t>,
    line: usize,
}

/// A value of the file with its place.
pub(super) struct FileField<'t> {
    pub(super) name: String,
    pub(super) place: Location,
    /// The byte at which the value begins.
    pub(super) start: usize,
    value: &'t DeValue<'t>,
    /// The value as written.
    written: &'t str,
    reader: &'t Reader<'t>,
}

/// The text of the file and its name.
pub(super) struct Reader<'t> {
    pub(super) file: &'t str,
    pub(super) text: &'t str,
}

impl<'t> Reader<'t> {
    pub(super) fn line(&self, offset: usize) -> usize {
        let offset = offset.min(self.text.len());
        self.text.as_bytes()[..offset]
            .iter()
            .filter(|byte| **byte == b'\n')
            .count()
            + 1
    }

    pub(super) fn place(&self, offset: usize) -> LineColumn {
        let before = self.text.get(..offset).unwrap_or(self.text);
        let line_start = before.rfind('\n').map_or(0, |end| end + 1);
        LineColumn {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// Where the text of a value begins: a number is its own text, others have one or three quotes.
    fn start_of_text(&self, start: usize) -> LineColumn {
        let value = self.text.get(start..).unwrap_or("");
        let mut quotes = ["\"\"\"", "'''", "\"", "'"].into_iter();
        let quote = quotes.find(|quote| value.starts_with(quote)).unwrap_or("");
        let mut start = start + quote.len();
        if quote.len() == 3 && self.text[start..].starts_with('\n') {
            start += 1;
        }
        self.place(start)
    }

    pub(super) fn parse(&self) -> Result<Spanned<DeTable<'t>>, InputError> {
        DeTable::parse(self.text).map_err(|error| InputError {
            line: error.span().map_or(0, |span| self.line(span.start)),
            ..InputError::whole(self.file, error.message())
        })
    }

    pub(super) fn whole(&'t self, table: &'t DeTable<'t>) -> FileSection<'t> {
        FileSection {
            path: String::new(),
            table,
            reader: self,
            line: 0,
        }
    }

    fn field(&'t self, path: &str, name: &str, value: &'t Spanned<DeValue<'t>>) -> FileField<'t> {
        let span = value.span();
        FileField {
            name: name.to_owned(),
            start: span.start,
            place: Location {
                file: self.file.to_owned(),
                line: self.line(span.start),
                start: span.start,
                text: self.start_of_text(span.start),
                key: joined(path, name),
            },
            value: value.get_ref(),
            written: &self.text[span],
            reader: self,
        }
    }
}

fn joined(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}.{name}")
    }
}

impl<'t> FileSection<'t> {
    pub(super) fn place(&self) -> Location {
        Location {
            file: self.reader.file.to_owned(),
            line: self.line,
            start: 0,
            text: LineColumn {
                line: self.line,
                column: 1,
            },
            key: self.path.clone(),
        }
    }

    /// The keys in alphabetical order: no result depends on their order in the file.
    pub(super) fn fields(&self) -> Vec<FileField<'t>> {
        let mut fields: Vec<FileField<'t>> = self
            .table
            .iter()
            .map(|(key, value)| self.reader.field(&self.path, key.get_ref(), value))
            .collect();
        fields.sort_by(|a, b| a.name.cmp(&b.name));
        fields
    }

    pub(super) fn field(&self, name: &str) -> Option<FileField<'t>> {
        let value = self.table.get(name)?;
        Some(self.reader.field(&self.path, name, value))
    }

    pub(super) fn require(&self, name: &str) -> Result<FileField<'t>, InputError> {
        self.field(name).ok_or_else(|| {
            let meaning = keys::meaning(&self.path, name);
            let meaning = meaning.map_or(String::new(), |meaning| format!(" ({meaning})"));
            let problem = format!("expected the key `{name}`{meaning}, found none");
            self.place().error(problem)
        })
    }

    pub(super) fn section(&self, name: &str) -> Result<Option<FileSection<'t>>, InputError> {
        self.field(name).map(|field| field.section()).transpose()
    }

    /// Refuses keys other than these.
    pub(super) fn allow(&self, known: &[&str]) -> Result<(), InputError> {
        for (key, _) in self.table.iter() {
            let name: &str = key.get_ref();
            if !known.contains(&name) {
                let near = did_you_mean(name, known.iter().copied());
                let known = known.join(" ");
                let place = Location {
                    line: self.reader.line(key.span().start),
                    key: joined(&self.path, name),
                    ..self.place()
                };
                let problem = format!("unknown key `{name}`{near}; expected one of {known}");
                return Err(place.error(problem));
            }
        }
        Ok(())
    }
}

impl<'t> FileField<'t> {
    fn expected(&self, what: &str) -> InputError {
        let written: String = self.written.chars().take(40).collect();
        self.place
            .error(format!("expected {what}, found {written}"))
    }

    pub(super) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    pub(super) fn section(&self) -> Result<FileSection<'t>, InputError> {
        match self.value {
            DeValue::Table(table) => Ok(FileSection {
                path: self.place.key.clone(),
                table,
                reader: self.reader,
                line: self.place.line,
            }),
            _ => Err(self.expected("a table")),
        }
    }

    pub(super) fn string(&self) -> Result<String, InputError> {
        match self.value {
            DeValue::String(text) => Ok(text.to_string()),
            _ => Err(self.expected("a text")),
        }
    }

    /// A whole number of at least 1.
    pub(super) fn count(&self) -> Result<u64, InputError> {
        let number = match self.value {
            DeValue::Integer(_) => self.written.parse().ok().filter(|count| *count >= 1),
            _ => None,
        };
        number.ok_or_else(|| self.expected("a whole number >= 1"))
    }

    /// The number as written.
    pub(super) fn number(&self) -> Result<String, InputError> {
        match self.value {
            DeValue::Integer(_) | DeValue::Float(_) => Ok(self.written.to_owned()),
            _ => Err(self.expected("a number")),
        }
    }

    pub(super) fn list(&self) -> Result<Vec<FileField<'t>>, InputError> {
        match self.value {
            DeValue::Array(values) => {
                let items = values.iter().map(|value| FileField {
                    place: Location {
                        line: self.reader.line(value.span().start),
                        start: value.span().start,
                        text: self.reader.start_of_text(value.span().start),
                        ..self.place.clone()
                    },
                    ..self.reader.field("", &self.name, value)
                });
                Ok(items.collect())
            }
            _ => Err(self.expected("a list")),
        }
    }

    /// A text, or a number, as an expression.
    pub(super) fn expression(&self) -> Result<Expression, InputError> {
        let text = match self.value {
            DeValue::String(text) => text.to_string(),
            DeValue::Integer(_) | DeValue::Float(_) => self.written.to_owned(),
            _ => return Err(self.expected("an expression as a text, or a number")),
        };
        let tree = parse(&text)
            .map_err(|error| self.place.error_at(&text, error.offset, error.problem))?;
        Ok(Expression {
            place: self.place.clone(),
            text,
            tree,
        })
    }

    /// An expression, or a list of them, or a list of lists.
    pub(super) fn value(&self) -> Result<TensorValue, InputError> {
        if !matches!(self.value, DeValue::Array(_)) {
            return Ok(TensorValue::One(self.expression()?));
        }
        let parts: Result<Vec<TensorValue>, _> =
            self.list()?.iter().map(FileField::value).collect();
        let parts = parts?;
        if parts.is_empty() {
            return Err(self.expected("at least one component"));
        }
        Ok(TensorValue::List(self.place.clone(), parts))
    }
}
