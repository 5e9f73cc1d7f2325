//! JSON: an object of lists, a list of objects, or lines of objects, at any depth.

use std::collections::{HashMap, HashSet};

use super::super::Refused;
use super::super::cell::{is_failure, is_number};
use super::super::grid::Grid;
use super::super::names::{key, says_error_alone};
use super::lists::{List, table};
use super::{Doubt, Found};

/// Deepest nesting that is read.
const DEPTH: usize = 64;

/// A value, with numbers as they are written.
#[derive(Debug, Clone)]
pub(super) enum Json {
    Scalar(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

/// The value of a text of JSON, or the list of those of its lines; `None` for other texts, also for
/// an object that has a name twice.
pub(super) fn value(text: &str) -> Option<Json> {
    let mut reader = Reader { rest: text.trim() };
    let mut values = vec![];
    while !reader.rest.is_empty() && text.trim().starts_with(['{', '[']) {
        values.push(reader.value(0)?);
        reader.skip(' ');
    }
    match values.len() {
        0 => None,
        1 => values.pop(),
        _ => Some(Json::List(values)),
    }
}

struct Reader<'t> {
    rest: &'t str,
}

impl Reader<'_> {
    /// Skips blanks and a mark; whether the mark was there.
    fn skip(&mut self, mark: char) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(mark);
        self.rest = rest.unwrap_or(self.rest).trim_start();
        rest.is_some()
    }

    /// Goes on to the next item of a list or an object, or behind its end; whether there is one.
    fn has_next(&mut self, is_first: bool, end: char) -> Option<bool> {
        let is_parted = is_first || self.skip(',');
        let ends = self.skip(end);
        (is_parted || ends).then_some(!ends)
    }

    fn value(&mut self, depth: usize) -> Option<Json> {
        if depth > DEPTH {
            return None;
        }
        if self.skip('[') {
            let mut list = vec![];
            while self.has_next(list.is_empty(), ']')? {
                list.push(self.value(depth + 1)?);
            }
            return Some(Json::List(list));
        }
        if self.skip('{') {
            let mut object: Vec<(String, Json)> = vec![];
            let mut names = HashSet::new();
            while self.has_next(object.is_empty(), '}')? {
                let name = self.quoted()?;
                if !names.insert(name.clone()) || !self.skip(':') {
                    return None;
                }
                object.push((name, self.value(depth + 1)?));
            }
            return Some(Json::Object(object));
        }
        if self.rest.starts_with('"') {
            return self.quoted().map(Json::Scalar);
        }
        let is_end = |c: char| c.is_whitespace() || ",]}:".contains(c);
        let end = self.rest.find(is_end).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        let is_word = is_number(word) || ["true", "false"].contains(&word) || is_failure(word);
        (is_word && !word.is_empty()).then(|| Json::Scalar(word.to_owned()))
    }

    /// A text in quotes.
    fn quoted(&mut self) -> Option<String> {
        let mut texts = serde_json::Deserializer::from_str(self.rest).into_iter::<String>();
        let text = texts.next()?.ok()?;
        self.rest = &self.rest[texts.byte_offset()..];
        Some(text)
    }
}

impl Json {
    fn scalar(&self) -> Option<&str> {
        match self {
            Self::Scalar(text) => Some(text),
            _ => None,
        }
    }

    /// A list of at least two numbers or words, or an object of them by the numbers of their rows.
    fn cells(&self) -> Option<Vec<String>> {
        let values: Vec<&Self> = match self {
            Self::List(list) => list.iter().collect(),
            Self::Object(object) => {
                let mut rows = object.iter().enumerate();
                let are_numbered = rows.all(|(row, (name, _))| *name == row.to_string());
                are_numbered.then(|| object.iter().map(|(_, value)| value).collect())?
            }
            Self::Scalar(_) => return None,
        };
        let cells = values
            .into_iter()
            .map(|one| one.scalar().map(str::to_owned));
        let cells: Option<Vec<String>> = cells.collect();
        cells.filter(|cells| cells.len() > 1)
    }

    /// Whether it is a list or an object without anything in it.
    fn is_empty(&self) -> bool {
        match self {
            Self::List(list) => list.is_empty(),
            Self::Object(object) => object.is_empty(),
            Self::Scalar(_) => false,
        }
    }
}

/// Finds the tables.
pub(super) fn find(value: Json) -> Result<Found, Refused> {
    let mut found = Found::default();
    walk(value, "", &mut found)?;
    Ok(found)
}

/// * `path`: the names that lead to the value.
fn walk(value: Json, path: &str, found: &mut Found) -> Result<(), Refused> {
    match value {
        Json::List(list) => match lists_of_records(&list) {
            Some(lists) => walk(lists, path, found),
            None => list.into_iter().try_for_each(|one| walk(one, path, found)),
        },
        Json::Object(object) => {
            if let Some(columns) = columns_of_rows(&object) {
                return walk(columns, path, found);
            }
            let is_list = |(_, value): &(String, Json)| value.cells().is_some();
            let (lists, mut others): (Vec<_>, Vec<_>) = object.into_iter().partition(is_list);
            if lists.len() > 1 {
                let columns = lists.iter().map(|(name, list)| List {
                    name: name.clone(),
                    cells: list.cells().unwrap_or_default(),
                });
                let (grid, is_column) = table(columns.collect());
                found.add(Ok(Grid {
                    heading: path.to_owned(),
                    ..grid
                }))?;
                let left = lists.into_iter().zip(is_column).filter(|(_, is)| !*is);
                others.extend(left.map(|(list, _)| list));
            } else {
                others.extend(lists);
            }
            let empty = others.iter().filter(|(name, value)| {
                value.is_empty() && name != "errors" && says_error_alone(&key(name))
            });
            let doubts =
                empty.map(|(name, _)| Doubt::new(format!("outside the tables: `{name}` is empty")));
            found.outside.extend(doubts);
            let mut others = others.into_iter();
            others.try_for_each(|(name, value)| walk(value, format!("{path} {name}").trim(), found))
        }
        Json::Scalar(text) => {
            if is_number(&text) || is_failure(&text) || text == "false" {
                let doubt = Doubt::new(format!("outside the tables: `{path}: {text}`"));
                found.outside.push(doubt);
            }
            Ok(())
        }
    }
}

/// A list of names and one of rows, with what else there is, as an object of lists, each a column:
/// pandas writes it so with `orient="split"`; `None` for other objects.
fn columns_of_rows(object: &[(String, Json)]) -> Option<Json> {
    let list = |name: &str| match object.iter().find(|entry| entry.0 == name) {
        Some((_, Json::List(list))) => Some(list),
        _ => None,
    };
    let names: Option<Vec<&str>> = list("columns")?.iter().map(Json::scalar).collect();
    let names = names?;
    let mut columns: Vec<(String, Vec<Json>)> = vec![];
    columns.extend(names.iter().map(|name| ((*name).to_owned(), vec![])));
    for row in list("data")? {
        let Json::List(row) = row else {
            return None;
        };
        if row.len() != names.len() {
            return None;
        }
        let pairs = columns.iter_mut().zip(row);
        pairs.for_each(|((_, column), cell)| column.push(cell.clone()));
    }
    let others = object
        .iter()
        .filter(|(name, _)| !["columns", "data"].contains(&&**name));
    let columns = columns
        .into_iter()
        .map(|(name, cells)| (name, Json::List(cells)));
    Some(Json::Object(others.cloned().chain(columns).collect()))
}

/// Objects, each a row, as an object of lists, each a column; `None` for other lists. A name that
/// an object lacks has an empty cell.
fn lists_of_records(list: &[Json]) -> Option<Json> {
    let mut columns: Vec<(String, Json)> = vec![];
    let mut places = HashMap::new();
    for (row, one) in list.iter().enumerate() {
        let Json::Object(object) = one else {
            return None;
        };
        for (name, value) in object {
            let place = *places.entry(name).or_insert_with(|| {
                let empty = vec![Json::Scalar(String::new()); list.len()];
                columns.push((name.clone(), Json::List(empty)));
                columns.len() - 1
            });
            if let Json::List(cells) = &mut columns[place].1 {
                cells[row] = value.clone();
            }
        }
    }
    (list.len() > 1).then_some(Json::Object(columns))
}
