//! JSON: an object of lists, a list of objects, or lines of objects, at any depth.

use std::collections::HashSet;

use super::super::Refused;
use super::super::cell::{is_failure, is_number};
use super::super::grid::Grid;
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

/// The values of a text of JSON, or of one on each line; `None` for other texts, also for an object
/// that has a name twice.
pub(super) fn values(text: &str) -> Option<Vec<Json>> {
    let text = text.trim();
    if !text.starts_with(['{', '[']) {
        return None;
    }
    let mut reader = Reader { rest: text };
    let mut values = vec![];
    while !reader.rest.is_empty() {
        values.push(reader.value(0)?);
        reader.skip(&[]);
    }
    Some(values)
}

struct Reader<'t> {
    rest: &'t str,
}

impl Reader<'_> {
    /// Skips blanks and one of these characters; whether it was there.
    fn skip(&mut self, marks: &[char]) -> bool {
        self.rest = self.rest.trim_start();
        let rest = self.rest.strip_prefix(marks);
        self.rest = rest.unwrap_or(self.rest).trim_start();
        rest.is_some()
    }

    fn value(&mut self, depth: usize) -> Option<Json> {
        if depth > DEPTH {
            return None;
        }
        if self.skip(&['[']) {
            let mut list = vec![];
            while !self.skip(&[']']) {
                list.push(self.value(depth + 1)?);
                if !self.skip(&[',']) && !self.rest.starts_with(']') {
                    return None;
                }
            }
            return Some(Json::List(list));
        }
        if self.skip(&['{']) {
            let mut object: Vec<(String, Json)> = vec![];
            let mut names = HashSet::new();
            while !self.skip(&['}']) {
                let name = self.text()?;
                if !names.insert(name.clone()) || !self.skip(&[':']) {
                    return None;
                }
                object.push((name, self.value(depth + 1)?));
                if !self.skip(&[',']) && !self.rest.starts_with('}') {
                    return None;
                }
            }
            return Some(Json::Object(object));
        }
        if self.rest.starts_with('"') {
            return self.text().map(Json::Scalar);
        }
        let end = self
            .rest
            .find(|c: char| c.is_whitespace() || ",]}:".contains(c));
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        let is_word = is_number(word) || ["true", "false"].contains(&word) || is_failure(word);
        (is_word && !word.is_empty()).then(|| Json::Scalar(word.to_owned()))
    }

    /// A text in quotes.
    fn text(&mut self) -> Option<String> {
        let text = self.rest.strip_prefix('"')?;
        let mut is_escaped = false;
        let is_end = |c: char| {
            let ends = c == '"' && !is_escaped;
            is_escaped = c == '\\' && !is_escaped;
            ends
        };
        let (text, rest) = text.split_once(is_end)?;
        self.rest = rest;
        Some(unescaped(text))
    }
}

/// A text of JSON without its escapes.
fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, escape)) = rest.split_once('\\') {
        plain += before;
        let code = escape
            .get(1..5)
            .and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let code = code
            .and_then(char::from_u32)
            .filter(|_| escape.starts_with('u'));
        let mut behind = escape.chars();
        plain.extend(code.or(behind.next().filter(|_| code.is_none())));
        rest = if code.is_some() {
            &escape[5..]
        } else {
            behind.as_str()
        };
    }
    plain + rest
}

impl Json {
    fn scalar(&self) -> Option<&str> {
        match self {
            Self::Scalar(text) => Some(text),
            _ => None,
        }
    }

    /// A list of at least two numbers or words.
    fn cells(&self) -> Option<Vec<String>> {
        let Self::List(list) = self else { return None };
        let cells = list.iter().map(|one| one.scalar().map(str::to_owned));
        cells
            .collect::<Option<Vec<_>>>()
            .filter(|cells| cells.len() > 1)
    }

    fn get(&self, name: &str) -> Option<&Self> {
        let Self::Object(object) = self else {
            return None;
        };
        object
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, value)| value)
    }
}

/// Finds the tables.
pub(super) fn find(values: &[Json]) -> Result<Found, Refused> {
    let mut found = Found::default();
    match values {
        [one] => walk(one, "", &mut found)?,
        several => walk(&Json::List(several.to_vec()), "", &mut found)?,
    }
    Ok(found)
}

/// * `path`: the names that lead to the value.
fn walk(value: &Json, path: &str, found: &mut Found) -> Result<(), Refused> {
    let below = |name: &str| format!("{path} {name}").trim().to_owned();
    match value {
        Json::List(list)
            if list.len() > 1 && list.iter().all(|one| matches!(one, Json::Object(_))) =>
        {
            records(list, path, found)?;
        }
        Json::List(list) => {
            for one in list {
                walk(one, path, found)?;
            }
        }
        Json::Object(object) => {
            let lists: Vec<(&String, Vec<String>)> = object
                .iter()
                .filter_map(|(name, value)| Some((name, value.cells()?)))
                .collect();
            let mut taken: Vec<&String> = vec![];
            if lists.len() > 1 {
                let columns = lists.iter().map(|(name, cells)| List {
                    name: (*name).clone(),
                    cells: cells.clone(),
                });
                if let Some((grid, is_column)) = table(columns.collect()) {
                    let names = lists.iter().zip(is_column).filter(|(_, is)| *is);
                    taken.extend(names.map(|((name, _), _)| *name));
                    found.add(Ok(Grid {
                        heading: path.to_owned(),
                        ..grid
                    }))?;
                }
            }
            for (name, value) in object.iter().filter(|(name, _)| !taken.contains(&name)) {
                walk(value, &below(name), found)?;
            }
        }
        Json::Scalar(text) if is_number(text) || is_failure(text) || text == "false" => {
            let words = format!("{path}: {text}");
            found.doubts.push(Doubt::Outside {
                line: 0,
                words,
                count: 1,
                offer: None,
            });
        }
        Json::Scalar(_) => {}
    }
    Ok(())
}

/// A list of objects: a row each, with a column for each name that has no list or object.
fn records(list: &[Json], path: &str, found: &mut Found) -> Result<(), Refused> {
    let mut names: Vec<&str> = vec![];
    let objects = list.iter().filter_map(|one| match one {
        Json::Object(object) => Some(object),
        _ => None,
    });
    for (name, _) in objects.flatten() {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let is_flat = |name: &&str| {
        list.iter()
            .all(|one| one.get(name).is_none_or(|value| value.scalar().is_some()))
    };
    let (flat, deep): (Vec<&str>, Vec<&str>) = names.into_iter().partition(is_flat);
    if flat.len() > 1 {
        let cell = |one: &Json, name: &str| {
            one.get(name)
                .and_then(Json::scalar)
                .unwrap_or_default()
                .to_owned()
        };
        let rows = list
            .iter()
            .map(|one| flat.iter().map(|name| cell(one, name)).collect());
        let grid = Grid {
            heading: path.to_owned(),
            names: flat.iter().map(|name| (*name).to_owned()).collect(),
            rows: rows.collect(),
            ..Grid::default()
        };
        found.add(Ok(grid))?;
    }
    for one in list {
        let left = if flat.len() > 1 { &[][..] } else { &flat };
        for name in deep.iter().chain(left) {
            if let Some(value) = one.get(name) {
                walk(value, &format!("{path} {name}"), found)?;
            }
        }
    }
    Ok(())
}
