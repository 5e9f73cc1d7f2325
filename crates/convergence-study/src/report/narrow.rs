//! Tables of the committed report, whose source people read in an editor and in a difference: no
//! line of a table is wider than [`WIDEST`].

use super::markdown::table;
use crate::text::columns::Columns;

/// Columns of the widest line.
const WIDEST: usize = 120;

/// Columns of a value; a longer cell is a sentence.
const VALUE: usize = 40;

/// The rows as a table, if that is narrow enough; wide tables of values as several tables, each
/// with the first column; sentences as a list. The cells are already escaped.
pub(super) fn narrow(head: &[String], rows: Vec<Vec<String>>) -> String {
    let columns = Columns::of(head, &rows);
    let groups = groups(&columns);
    if groups.len() == 1 {
        return table(head, rows);
    }
    let has_sentences = (0..columns.count()).any(|column| columns.width(column) > VALUE);
    if has_sentences {
        return rows.iter().map(|row| labelled(head, row)).collect();
    }
    let parts: Vec<String> = groups
        .iter()
        .map(|group| {
            let rows = rows.iter().map(|row| pick(row, group)).collect();
            table(&pick(head, group), rows)
        })
        .collect();
    parts.join("\n")
}

/// The columns of each part: the first column, and as many others as fit.
fn groups(columns: &Columns) -> Vec<Vec<usize>> {
    let mut groups = vec![vec![0]];
    // A cell has a space on each side, and a bar behind it; one more bar begins the line.
    let space = |column: usize| columns.width(column).max(2) + 3;
    let mut width = 1 + space(0);
    for column in 1..columns.count() {
        if width + space(column) > WIDEST {
            groups.push(vec![0]);
            width = 1 + space(0);
        }
        width += space(column);
        groups.last_mut().expect("one group at least").push(column);
    }
    groups
}

fn pick(row: &[String], columns: &[usize]) -> Vec<String> {
    columns
        .iter()
        .map(|&column| row.get(column).cloned().unwrap_or_default())
        .collect()
}

/// A row as an item of a list: the first cell, then each other cell after its title.
fn labelled(head: &[String], row: &[String]) -> String {
    let first = row.first().map_or("", String::as_str);
    let others: Vec<String> = head
        .iter()
        .zip(row)
        .skip(1)
        .filter(|(_, cell)| !cell.is_empty())
        .map(|(title, cell)| format!("*{title}*: {cell}"))
        .collect();
    item(&format!("**{first}**; {}", others.join("; ")))
}

/// An item of a list, in lines of at most [`WIDEST`] columns where words allow it.
///
/// A line begins with a letter, a bracket or a star before a word: another sign could begin a list
/// or a heading.
pub(super) fn item(text: &str) -> String {
    let mut lines = String::from("-");
    let mut width = 1;
    for word in text.split(' ') {
        let length = word.chars().count();
        let may_begin_a_line =
            length > 1 && word.starts_with(|c: char| c.is_alphabetic() || "([*".contains(c));
        if width + 1 + length > WIDEST && may_begin_a_line {
            lines += "\n  ";
            width = 2;
        } else {
            lines.push(' ');
            width += 1;
        }
        lines += word;
        width += length;
    }
    lines + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn owned(cells: &[&str]) -> Vec<String> {
        cells.iter().map(|cell| (*cell).to_owned()).collect()
    }

    fn widest(text: &str) -> usize {
        text.lines()
            .map(|line| line.chars().count())
            .max()
            .unwrap_or(0)
    }

    #[test]
    fn a_narrow_table_stays_as_it_is() {
        let rows = vec![owned(&["8", "1"])];
        assert_eq!(
            narrow(&owned(&["n", "norm"]), rows.clone()),
            table(&["n", "norm"], rows)
        );
    }

    #[test]
    fn a_wide_table_of_values_is_split_and_loses_nothing() {
        let head: Vec<String> = (0..20).map(|k| format!("column {k}")).collect();
        let row: Vec<String> = (0..20).map(|k| format!("{}", 1000 + k)).collect();
        let text = narrow(&head, vec![row.clone()]);
        assert!(widest(&text) <= WIDEST, "{text}");
        for cell in head.iter().chain(&row) {
            assert!(text.contains(cell.as_str()), "{cell} is lost:\n{text}");
        }
        let tables = text.matches("column 0 ").count();
        assert!(tables > 1, "{text}");
    }

    #[test]
    fn sentences_become_a_list_that_reads_the_same() {
        let sentence = "the rate is within 0.01 of - 1 # and 2. so on, at every level ".repeat(4);
        let rows = vec![owned(&["a claim", "pass", sentence.trim()])];
        let text = narrow(&owned(&["claim", "verdict", "evidence"]), rows);
        assert!(widest(&text) <= WIDEST, "{text}");
        let unwrapped: Vec<&str> = text.split_whitespace().collect();
        let expected = format!(
            "- **a claim**; *verdict*: pass; *evidence*: {}",
            sentence.trim()
        );
        assert_eq!(unwrapped.join(" "), expected);
        let html: Vec<_> = pulldown_cmark::Parser::new(&text).collect();
        let lists = html
            .iter()
            .filter(|event| matches!(event, pulldown_cmark::Event::Start(tag) if matches!(tag, pulldown_cmark::Tag::List(_) | pulldown_cmark::Tag::Heading { .. })));
        assert_eq!(lists.count(), 1, "{text}");
    }
}
