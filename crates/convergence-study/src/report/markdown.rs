//! A table in Markdown whose columns line up in its source, for pages that are no reports.

use super::templates::escaped_markdown;
use crate::study::outcome::Table;
use crate::text::columns::Columns;

impl Table {
    /// The lines of the table in Markdown, without its title.
    pub fn markdown(&self) -> String {
        let Table { head, rows, .. } = self;
        let cells = |row: &Vec<String>| row.iter().map(|cell| escaped_markdown(cell)).collect();
        let head: Vec<String> = cells(head);
        let rows: Vec<Vec<String>> = rows.iter().map(cells).collect();
        let columns = Columns::of(&head, &rows);
        let rule = (0..columns.count()).map(|i| match columns.is_numeric(i) {
            true => format!("{:->1$}", ":", columns.width(i).max(2)),
            false => "-".repeat(columns.width(i).max(1)),
        });
        let mut lines = line(columns.pad(&head));
        lines += &line(rule);
        for row in &rows {
            lines += &line(columns.pad(row));
        }
        lines
    }
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.fold(String::from("|"), |line, cell| line + " " + &cell + " |") + "\n"
}
