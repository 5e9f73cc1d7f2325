//! How large a text of tables may be. Reading takes a time in proportion to the text, judging more.

use super::original::Original;
use super::parts::Part;
use crate::input::{InputError, shorten};
use crate::text::number::counted;

/// Most tables of a text.
const TABLES: usize = 1_000;
/// Most rows of a table.
const ROWS: usize = 10_000;
/// Most columns of a table.
const COLUMNS: usize = 5_000;
/// Most characters of a name.
const NAME: usize = 200;

/// Refuses a text with more tables, or a table with more rows or columns, or a longer name.
pub(super) fn check(original: Original<'_>, parts: &[Part<'_>]) -> Result<(), InputError> {
    let most = |count: usize, noun: &str| format!("at most {}", counted(count, noun));
    if parts.len() > TABLES {
        return Err(original.refuse(most(TABLES, "table"), &counted(parts.len(), "table")));
    }
    for Part { table, .. } in parts {
        let first = table.rows.iter().flatten().next().unwrap_or(&original.text);
        let width = table.width().max(table.names.len());
        for (limit, count, noun) in [(ROWS, table.rows.len(), "row"), (COLUMNS, width, "column")] {
            if count > limit {
                let found = counted(count, noun);
                return Err(original.error(first, None, most(limit, noun), &found));
            }
        }
        let mut names = table.names.iter().chain(&table.groups);
        if let Some(name) = names.find(|name| name.chars().nth(NAME).is_some()) {
            let count = counted(name.chars().count(), "character");
            let found = format!("{count}, `{}`", shorten(name));
            let expected = format!("a name of {}", most(NAME, "character"));
            return Err(original.error(name, None, expected, &found));
        }
    }
    Ok(())
}
