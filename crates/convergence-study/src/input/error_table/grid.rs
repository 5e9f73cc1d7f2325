//! A table as written: rows of cells below names.

use super::NotError;
use super::columns::Cells;
use super::names::{self, Word};
use super::number::{Number, is_dash, number};

/// A table as written. Names and cells are slices of the text, which give their places.
#[derive(Debug, Clone, Default)]
pub(super) struct RawTable<'t> {
    /// A name for each column, or an empty one.
    pub(super) names: Vec<&'t str>,
    pub(super) rows: Vec<Vec<&'t str>>,
    /// For each column the name above its name; may be empty.
    pub(super) groups: Vec<&'t str>,
    /// Whether a blank cell stands between two separators: a level without a result.
    pub(super) is_separated: bool,
    /// Whether a comma in a cell is a decimal comma.
    pub(super) decimal_comma: bool,
    /// Whether the columns stand as rows in the text.
    pub(super) turned: Option<Turned>,
    /// What is not a column of the table.
    pub(super) left_out: Vec<NotError>,
    /// The first of these that may be an error.
    pub(super) uneven: Option<NotError>,
}

/// A table whose columns stand as rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turned {
    /// With the steps in its head, which are the first column.
    Stepped,
    /// Without steps in its head.
    Plain,
    /// With the rates of halved steps between the errors.
    Halved,
}

/// The name of a column, and what it says.
pub(super) struct ColumnName {
    pub(super) name: String,
    pub(super) word: Word,
}

impl ColumnName {
    fn of(name: &str) -> Self {
        let name = names::without_markup(name);
        let word = Word::of(&name);
        Self { name, word }
    }
}

impl<'t> RawTable<'t> {
    /// A table without cells.
    ///
    /// * `separator`: of its cells; `None` for blanks.
    pub(super) fn with_separator(separator: Option<char>) -> Self {
        Self {
            decimal_comma: separator != Some(','),
            is_separated: separator.is_some(),
            ..Self::default()
        }
    }

    /// Cells in the longest row.
    pub(super) fn width(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Whether each row has a cell for each name.
    pub(super) fn is_even(&self) -> bool {
        self.rows.iter().all(|row| row.len() == self.names.len())
    }

    /// The cells of a column.
    pub(super) fn column(&self, k: usize) -> Vec<&'t str> {
        self.rows.iter().map(|row| row[k]).collect()
    }

    /// The names of the columns, or those that the user has chosen. The errors of a variable have
    /// its name.
    pub(super) fn column_names(&self, chosen: Option<&[String]>) -> Vec<ColumnName> {
        if let Some(names) = chosen {
            let names = names.iter().map(|name| ColumnName {
                name: name.clone(),
                word: Word::of(name),
            });
            return names.collect();
        }
        let name = |(k, name): (usize, &&str)| {
            let ColumnName { name, word } = ColumnName::of(name);
            let group = self.groups.get(k).map(|group| names::without_markup(group));
            let name = match group.filter(|group| !group.is_empty()) {
                Some(group) if word == Word::Error => group,
                Some(group) => format!("{group} {name}"),
                None => name,
            };
            ColumnName { name, word }
        };
        self.names.iter().enumerate().map(name).collect()
    }

    /// Whether some column with numbers has a name that is not that of a step, a count, a rate or a
    /// cost, or numbers that are not.
    pub(super) fn may_have_errors(&self, chosen: Option<&[String]>) -> bool {
        let may_be_error = |(k, column): (usize, ColumnName)| {
            let cells: Vec<&str> = self
                .rows
                .iter()
                .filter_map(|row| row.get(k).copied())
                .collect();
            let read = |cell: &&str| number(cell, self.decimal_comma);
            let numbers: Vec<Option<Number>> = cells.iter().map(read).collect();
            let is_failure =
                |cell: &&str| names::is_failure(cell) || is_dash(cell) && !cell.is_empty();
            let has_numbers = numbers.iter().any(Option::is_some) || cells.iter().any(is_failure);
            let cells = Cells::new("", column, cells, numbers);
            has_numbers && !cells.is_no_error()
        };
        let mut names = self.column_names(chosen).into_iter().enumerate();
        self.uneven.is_some() || names.any(may_be_error)
    }

    /// Leaves out a name with more numbers or fewer than there are levels. If its name does not say
    /// that it is something else, it may be an error.
    pub(super) fn leave_out_uneven(&mut self, one: NotError) {
        if ColumnName::of(&one.column).word.noun().is_none() {
            self.uneven.get_or_insert_with(|| one.clone());
        }
        self.left_out.push(one);
    }
}
