//! Tables of HTML.

use super::super::Refused;
use super::{Found, lines};

/// Characters by their names in HTML.
const NAMED: [(&str, &str); 6] = [
    ("&nbsp;", " "),
    ("&times;", "×"),
    ("&minus;", "-"),
    ("&lt;", "<"),
    ("&gt;", ">"),
    ("&amp;", "&"),
];

pub(super) fn has_table(text: &str) -> bool {
    text.to_lowercase().contains("<table")
}

/// Finds the tables, as those of a text in lines, which are not those of the source.
pub(super) fn find(text: &str, names: Option<&[String]>) -> Result<Found, Refused> {
    let lower = text.to_ascii_lowercase();
    let mut read = String::new();
    let mut refused = vec![];
    let mut end = 0;
    let mut searched = 0;
    for (start, _) in lower.match_indices("<table") {
        // What begins inside a table ends with it.
        if start < searched {
            continue;
        }
        let table = &lower[start..];
        let table = &table[..table.find("</table").unwrap_or(table.len())];
        searched = start + table.len();
        if ["colspan", "rowspan"]
            .iter()
            .any(|span| table.contains(span))
        {
            let expected = "one cell below each name";
            refused.push(Refused::new(expected, "an HTML table with spans"));
            read += &text[end..start];
            end = searched;
        }
    }
    let mut found = lines::find(&in_lines(&(read + &text[end..])), &[], names)?;
    for grid in found.grids.iter_mut().flatten() {
        grid.lines = None;
        grid.row_lines.clear();
    }
    refused
        .into_iter()
        .try_for_each(|one| found.add(Err(one)))?;
    Ok(found)
}

/// HTML as lines of text: a row of a table is one, with a bar before each cell.
fn in_lines(text: &str) -> String {
    let mut lines = String::new();
    let mut is_table = false;
    for (k, part) in text.split('<').enumerate() {
        let (tag, words) = part.split_once('>').filter(|_| k > 0).unwrap_or(("", part));
        let tag = tag.to_lowercase();
        match tag.split_whitespace().next().unwrap_or_default() {
            "td" | "th" => lines.push('|'),
            name @ ("tr" | "table" | "/table") => {
                is_table = name != "/table";
                lines.push('\n');
            }
            _ => {}
        }
        let words = NAMED
            .iter()
            .fold(words.to_owned(), |words, (name, c)| words.replace(name, c));
        lines += &if is_table {
            words.replace('|', "\\|").replace('\n', " ")
        } else {
            words
        };
    }
    lines
}
