//! How large a text of tables may be. Reading takes a time in proportion to the text, judging more.

use super::frame::Original;
use super::parts::Part;
use crate::input::{Complaint, InputError, Source, failed, shorten};
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
    if parts.len() > TABLES {
        return Err(refusal(
            original,
            None,
            &format!("at most {}", counted(TABLES, "table")),
            &counted(parts.len(), "table"),
        ));
    }
    for Part { table, .. } in parts {
        let first = table.rows.iter().flatten().next().copied();
        let width = table
            .rows
            .iter()
            .map(Vec::len)
            .max()
            .unwrap_or(0)
            .max(table.names.len());
        for (most, count, noun) in [(ROWS, table.rows.len(), "row"), (COLUMNS, width, "column")] {
            if count > most {
                return Err(refusal(
                    original,
                    first,
                    &format!("at most {}", counted(most, noun)),
                    &counted(count, noun),
                ));
            }
        }
        let names = table.names.iter().chain(&table.groups);
        for name in names.filter(|name| name.len() > NAME) {
            let count = name.chars().count();
            if count > NAME {
                let found = format!("{}, `{}`", counted(count, "character"), shorten(name));
                let most = format!("a name of at most {}", counted(NAME, "character"));
                return Err(refusal(original, Some(name), &most, &found));
            }
        }
    }
    Ok(())
}

/// * `piece`: the text at which the limit is passed.
fn refusal(original: Original<'_>, piece: Option<&str>, most: &str, found: &str) -> InputError {
    let complaint = Complaint::Table {
        expected: most.into(),
        found: found.to_owned(),
    };
    let Original { text, name, .. } = original;
    match piece {
        Some(piece) => {
            let offset = (piece.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
            Source { file: name, text }.error(offset.min(text.len()), None, complaint)
        }
        None => failed(name, complaint),
    }
}
