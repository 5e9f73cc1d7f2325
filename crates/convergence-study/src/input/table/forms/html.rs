//! Tables of HTML.

use super::super::Refused;
use super::super::grid::Grid;
use super::lines::Lines;
use super::{Found, outside};

/// Characters by their names in HTML.
const NAMED: [(&str, &str); 6] = [
    ("&nbsp;", " "),
    ("&times;", "×"),
    ("&minus;", "-"),
    ("&lt;", "<"),
    ("&gt;", ">"),
    ("&amp;", "&"),
];

/// Finds the tables; what stands outside is a doubt if it looks like a row.
pub(super) fn find(text: &str) -> Result<Found, Refused> {
    let mut found = Found::default();
    let mut outside_text = String::new();
    let mut rest = text;
    while let Some(start) = position(rest, "<table") {
        let end = position(&rest[start..], "</table").map_or(rest.len(), |end| start + end);
        outside_text += &rest[..start];
        outside_text.push('\n');
        found.add(grid(&rest[start..end]))?;
        rest = &rest[end..];
    }
    let outside_text = without_tags(&(outside_text + rest));
    let names = found.grids.iter().flatten().flat_map(|grid| &grid.names);
    let doubts = outside::doubts(&Lines::of(&outside_text, &[]), names);
    found.doubts.extend(doubts);
    Ok(found)
}

/// Where a tag begins.
fn position(text: &str, tag: &str) -> Option<usize> {
    let mut starts = text.match_indices('<').map(|(start, _)| start);
    starts.find(|start| begins(&text[*start..], tag))
}

/// Whether a text begins with a tag, in capital or small letters.
fn begins(text: &str, tag: &str) -> bool {
    let start = text.get(..tag.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(tag))
}

fn without_tags(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, tag)) = rest.split_once('<') {
        plain += before;
        rest = tag.split_once('>').map_or("", |(_, behind)| behind);
    }
    plain += rest;
    NAMED
        .iter()
        .fold(plain, |text, (name, c)| text.replace(name, c))
}

/// The pieces that begin with one of these tags.
fn pieces<'t>(text: &'t str, tags: &[&str]) -> Vec<&'t str> {
    let is_start = |start: &usize| tags.iter().any(|tag| begins(&text[*start..], tag));
    let starts = text.match_indices('<').map(|(start, _)| start);
    let starts: Vec<usize> = starts.filter(is_start).chain([text.len()]).collect();
    starts.windows(2).map(|two| &text[two[0]..two[1]]).collect()
}

fn grid(table: &str) -> Result<Grid, Refused> {
    if ["colspan", "rowspan"]
        .iter()
        .any(|span| table.to_lowercase().contains(span))
    {
        return Err(Refused::new(
            "one cell below each name",
            "an HTML table with spans",
        ));
    }
    let cells = |row: &str| -> Vec<String> {
        let cells = pieces(row, &["<td", "<th"]).into_iter();
        cells
            .map(|cell| without_tags(cell).trim().to_owned())
            .collect()
    };
    let mut rows: Vec<Vec<String>> = pieces(table, &["<tr"]).into_iter().map(cells).collect();
    rows.retain(|row| !row.is_empty());
    if rows.len() < 3 || rows.iter().any(|row| row.len() != rows[0].len()) {
        let expected = "an HTML table with a row of names and two others, of as many cells";
        return Err(Refused::new(expected, "another"));
    }
    let names = rows.remove(0);
    Ok(Grid {
        names,
        rows,
        ..Grid::default()
    })
}
