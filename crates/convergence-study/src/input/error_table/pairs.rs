//! Lines such as `h = 3.54E-01, E = 1.66E-01` or `h: 3.54E-01 E: 1.66E-01`: a name before each number, the same ones in each line.

use super::cells::Cell;
use super::complaint;
use super::grid::{Grid, Row};
use super::number::number;
use crate::input::{InputError, Place};

/// Names and numbers of a line.
type Pairs<'t> = Vec<(Cell<'t>, Cell<'t>)>;

/// Reads such lines, and passes over others; `None` where there are none.
///
/// # Errors
/// A line that begins as they do and is not of their form, and one with other names.
pub(super) fn read<'t>(text: &'t str, file: &str) -> Result<Option<Grid<'t>>, InputError> {
    let lines = || text.lines().enumerate().map(|(k, line)| (k + 1, line));
    let Some((line, first)) = lines().find_map(|(number, line)| Some((number, pairs(line)?))) else { return Ok(None) };
    let names: Vec<Cell<'_>> = first.iter().map(|(name, _)| *name).collect();
    let texts = |pairs: &Pairs<'_>| pairs.iter().map(|(name, _)| name.text.to_owned()).collect::<Vec<_>>().join(", ");
    let expected = format!("{} with a number behind each, as in line {line}", texts(&first));
    let mut rows = vec![];
    for (line, text) in lines() {
        let begins = || text.split_once(['=', ':']).is_some_and(|(name, _)| name.trim() == names[0].text);
        let refuse = |found: &str| Err(complaint(file, Some(Place { line, column: 1 }), &expected, found));
        match pairs(text) {
            Some(pairs) if pairs.iter().map(|(name, _)| name.text).eq(names.iter().map(|name| name.text)) => {
                rows.push(Row { line, cells: pairs.into_iter().map(|(_, value)| value).collect() });
            }
            Some(pairs) => return refuse(&texts(&pairs)),
            None if begins() => return refuse(&super::shown(text.trim())),
            None => {}
        }
    }
    Ok(Some(Grid { line, names, rows, decimal_comma: false }))
}

/// The pairs of a line that has two or more of them, and nothing else.
fn pairs(line: &str) -> Option<Pairs<'_>> {
    let mut pairs = vec![];
    let mut rest = line;
    while !rest.trim().is_empty() {
        let (name, behind) = rest.split_once(['=', ':'])?;
        let begin = behind.trim_start();
        let end = begin.find(|c: char| c.is_whitespace() || matches!(c, ',' | ';')).unwrap_or(begin.len());
        let (value, behind) = begin.split_at(end);
        let column = |tail: &str| line[..line.len() - tail.len()].chars().count() + 1;
        let (named, name) = (rest.trim_start(), name.trim());
        if name.is_empty() || number(name, false).is_some() || number(value, false).is_none() {
            return None;
        }
        pairs.push((Cell { column: column(named), text: name }, Cell { column: column(begin), text: value }));
        rest = behind.trim_start_matches(|c: char| c.is_whitespace() || matches!(c, ',' | ';'));
    }
    Some(pairs).filter(|pairs| pairs.len() > 1)
}
