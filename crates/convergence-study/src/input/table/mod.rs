//! Convergence rates of any code: tables of steps and errors, of which every number is accounted
//! for, judged by the rule of [`verdict`](crate::judge::verdict).
//!
//! ```text
//! h,     L2,      rate, seconds
//! 0.1,   1.01e-3, -,    0.2
//! 0.05,  2.51e-4, 2.01, 0.9
//! 0.025, 6.26e-5, 2.00, 3.7
//! ```
//!
//! A number is a step, an error that is judged, or was set aside: by the caller, or by arithmetic
//! that can be checked. A column that falls is never set aside by its name. The way:
//!
//! 1. `forms`: a text to tables, each a line of names and rows of cells; what stands outside is a
//!    doubt if it looks like a row (`outside`).
//! 2. `unnamed`: a name for each cell; `cell`, `grid`: numbers in columns; `ladders`: the rows that
//!    belong together.
//! 3. `step`: the column that is the step; `fits`: whether printed rates are those of an error.
//! 4. `account`: what is judged, and what is set aside, with the reason.

mod account;
mod cell;
mod choice;
mod digits;
mod doubt;
mod fits;
mod forms;
mod frame;
mod grid;
mod ladders;
pub(crate) mod names;
mod refused;
mod samples;
mod step;
mod unnamed;

use std::io;
use std::path::Path;

use crate::input::advice::{Argument, Text};
use crate::input::{self, InputError};
use crate::judge::fit::Level;
use crate::text::number::counted;
use crate::text::visible::visible;
use account::{Account, Accounts};
use cell::is_number;
use grid::{Cells, Grid, Sense, moves};
use ladders::{Ladder, ladders};
use refused::Refused;
use step::Step;

pub use choice::{Choice, LineRange, Offer};
pub use digits::Column;
pub use doubt::Doubt;
pub use frame::{FrameCell, FrameColumn};

/// A table of errors that was read.
///
/// ```
/// use convergence_study::rates::{Choice, RateTable};
/// use convergence_study::{Claim, Floor};
///
/// let text = "h, L2, rate\n0.1, 1.01e-3, -\n0.05, 2.51e-4, 2.01\n0.025, 6.26e-5, 2.00\n";
/// let table = RateTable::parse_with(text, "errors.csv", &Choice::default())?;
/// let column = table.column("L2").expect("its name");
/// let rate = column.judge(&Claim::new(2.0, 0.25), Floor::NONE);
/// assert!(rate.verdict.is_pass(), "{}", rate.reason);
/// assert_eq!(table.left_out[0].because, "the rates of `L2`");
/// # Ok::<(), convergence_study::InputError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RateTable {
    /// The step: the name of its column, `cells^(-1/2)` if the column counts, `2^(-level)` if it
    /// numbers the levels.
    pub step: String,
    /// The errors.
    pub columns: Vec<Column>,
    /// The columns chosen as values.
    pub values: Vec<Column>,
    /// What was set aside.
    pub left_out: Vec<LeftOut>,
    /// How the table was read: the step, errors, values, and what was set aside with the reason.
    pub reading: String,
    /// The degree of the elements, which the heading or a column says.
    pub degree: Option<u32>,
    /// Why none of its columns should pass.
    pub doubts: Vec<Doubt>,
}

/// A column that was set aside.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub column: String,
    /// The reason.
    pub because: String,
}

impl LeftOut {
    fn of_samples(column: &Cells) -> Self {
        Self {
            column: column.name.clone(),
            because: "numbers of the samples".to_owned(),
        }
    }
}

/// A table with what tells it from others of a text.
struct NamedTable {
    name: String,
    table: RateTable,
}

impl RateTable {
    /// Reads a file, with the columns that `choice` selects; `-` is standard input.
    ///
    /// # Errors
    /// [`InputError`] with its line; also for a choice of missing columns.
    pub fn read_with(path: impl AsRef<Path>, choice: &Choice) -> Result<Self, InputError> {
        let (text, file_name) = text_and_name(path.as_ref())?;
        Self::parse_with(&text, &file_name, choice)
    }

    /// Reads a table from `text`; messages name `file_name`.
    ///
    /// # Errors
    /// As [`RateTable::read_with`], except for the file; also for several tables.
    pub fn parse_with(text: &str, file_name: &str, choice: &Choice) -> Result<Self, InputError> {
        let mut tables = Self::parse_all_with(text, file_name, choice)?;
        if tables.len() > 1 {
            let found = counted(tables.len(), "table");
            return Err(Refused::new("one table", found).error(file_name));
        }
        Ok(tables.remove(0).1)
    }

    /// Reads all tables of a file, each with its heading, which is empty for an only one; `-` is
    /// standard input.
    ///
    /// # Errors
    /// As [`RateTable::read_with`].
    pub fn read_all_with(
        path: impl AsRef<Path>,
        choice: &Choice,
    ) -> Result<Vec<(String, Self)>, InputError> {
        let (text, file_name) = text_and_name(path.as_ref())?;
        Self::parse_all_with(&text, &file_name, choice)
    }

    /// Reads all tables of `text`; messages name `file_name`.
    ///
    /// # Errors
    /// As [`RateTable::parse_with`], about the first table, if none can be read; otherwise a table
    /// that cannot be read is a doubt of the first that can.
    pub fn parse_all_with(
        text: &str,
        file_name: &str,
        choice: &Choice,
    ) -> Result<Vec<(String, Self)>, InputError> {
        let text = text
            .trim_start_matches('\u{feff}')
            .replace("\r\n", "\n")
            .replace('\r', "\n");
        let read = |choice: &Choice| tables(&text, file_name, choice);
        let trial = |choice: &Choice| {
            read(choice).map(|tables| tables.into_iter().map(|one| one.table).collect())
        };
        let tables = read(choice).map_err(|refused| refused.trying(trial).error(file_name))?;
        let is_alone = tables.len() == 1;
        let named = |(k, NamedTable { name, table }): (usize, NamedTable)| match name {
            _ if is_alone => (String::new(), table),
            name if name.is_empty() => (format!("table {}", k + 1), table),
            name => (name, table),
        };
        Ok(tables.into_iter().enumerate().map(named).collect())
    }

    /// The column of errors of this name, with or without its unit.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        self.columns.get(names::position(names, name)?)
    }
}

/// The tables of a text, with what stands against them in the first.
fn tables(text: &str, file: &str, choice: &Choice) -> Result<Vec<NamedTable>, Refused> {
    let found = forms::find(text, choice)?;
    let mut tables = vec![];
    let mut unread: Vec<Refused> = vec![];
    let mut lines: Vec<LineRange> = vec![];
    for grid in found.grids {
        let [first, last] = grid.as_ref().map_or([0, 0], |grid| grid.lines);
        match grid
            .and_then(|grid| table_of(&grid, choice).map_err(|refused| refused.at(grid.lines[0])))
        {
            Ok(read) => {
                tables.extend(read);
                lines.extend((first > 0).then_some(LineRange { first, last }));
            }
            Err(refused) => unread.push(refused),
        }
    }
    let Some(first) = tables.first_mut() else {
        return Err(unread.into_iter().next().unwrap_or_else(|| {
            let expected = "a line of names, such as `h L2 H1`, and at least two rows below, such as `0.1 1.6e-3 4e-2`";
            let found = text.lines().find(|line| !line.trim().is_empty());
            let found = found.map(|line| format!("no table, but `{}`", input::shorten(line.trim())));
            Refused::new(expected, found.unwrap_or_else(|| "an empty table".to_owned()))
        }));
    };
    let NamedTable { table, .. } = first;
    for mut doubt in found.doubts {
        if let Doubt::Outside { offer, .. } = &mut doubt
            && choice.lines.is_empty()
            && !lines.is_empty()
        {
            *offer = Some(choice.offer("", |choice| choice.lines.clone_from(&lines)));
        }
        table.doubts.push(doubt);
    }
    table.doubts.extend(
        unread
            .into_iter()
            .map(|refused| Doubt::Unread(Box::new(refused.error(file)))),
    );
    if let Some(dim) = choice.dim
        && !tables
            .iter()
            .any(|NamedTable { table, .. }| table.step.contains(['/', '^']))
    {
        let offer = choice.offer("", |choice| choice.dim = None);
        let expected = Text::from("no ")
            + Argument::Dim.with(&dim.to_string())
            + ", which is for counts such as `cells`";
        let steps: Vec<String> = tables
            .iter()
            .map(|one| format!("`{}`", one.table.step))
            .collect();
        return Err(
            Refused::new(expected, format!("the step {}", steps.join(", "))).offering([offer]),
        );
    }
    Ok(tables)
}

/// The names that the caller gives to all columns, if any.
///
/// # Errors
/// As many names as columns are expected.
fn names_given(choice: &Choice, columns: usize) -> Result<Option<&[String]>, Refused> {
    match &choice.names {
        Some(names) if names.len() != columns => {
            let expected = Argument::Names.alone() + format!(": {}", counted(columns, "name"));
            Err(Refused::new(expected, names.len().to_string()))
        }
        names => Ok(names.as_deref()),
    }
}

/// The tables of a grid: one for each ladder.
fn table_of(grid: &Grid, choice: &Choice) -> Result<Vec<NamedTable>, Refused> {
    let names = match names_given(choice, grid.rows[0].len())? {
        Some(names) => names.to_vec(),
        None => unnamed::names(grid, choice.dim)?,
    };
    let has_step = |name: &&String| {
        name.rsplit_once('=')
            .is_some_and(|(_, step)| is_number(step.trim()))
    };
    if names.iter().filter(has_step).count() > 1 {
        let found = "steps in the names of columns";
        return Err(Refused::new("one row a level: transpose the table", found));
    }
    if let Some(name) = names
        .windows(3)
        .find(|three| three[0] == three[1] && three[1] == three[2])
    {
        let found = format!("`{}` three times side by side", name[0]);
        let expected = Text::from("each name once, or ") + Argument::Names.with_placeholder();
        return Err(Refused::new(expected, found));
    }
    table_of_columns(grid, &grid.columns(&unique(&names)), choice)
}

/// The names, with the numbers of the columns where two are the same.
fn unique(names: &[String]) -> Vec<String> {
    let mut known = std::collections::HashSet::new();
    let mut repeated = std::collections::HashSet::new();
    repeated.extend(
        names
            .iter()
            .filter(|name| !known.insert(*name) && !name.is_empty()),
    );
    let name = |(k, name): (usize, &String)| {
        if repeated.contains(name) {
            format!("{name} (column {})", k + 1)
        } else {
            name.clone()
        }
    };
    names.iter().enumerate().map(name).collect()
}

fn table_of_columns(
    grid: &Grid,
    columns: &[Cells],
    choice: &Choice,
) -> Result<Vec<NamedTable>, Refused> {
    let ladders = ladders(grid, columns, choice)?;
    ladders
        .into_iter()
        .map(|ladder| {
            let name = format!("{} {}", grid.heading, ladder.name)
                .trim()
                .to_owned();
            Ok(NamedTable {
                name,
                table: table(ladder, choice)?,
            })
        })
        .collect()
}

/// The table of a ladder.
fn table(mut ladder: Ladder, choice: &Choice) -> Result<RateTable, Refused> {
    let mut sampled = None;
    if let Some(of) = choice.samples {
        let mut levels = samples::sampled(&ladder.columns, of, choice)?;
        std::mem::swap(&mut ladder.columns, &mut levels.columns);
        sampled = Some(levels);
    }
    let columns = &ladder.columns;
    let step = step::Ladder { columns, choice }.step()?;
    let accounts = Accounts::new(columns, &step, choice)?;
    let Account {
        errors,
        values,
        left_out,
        mut doubts,
    } = accounts.account()?;
    doubts.extend(ladder.doubt);
    let labels = ladder.labels.into_iter().map(|column| LeftOut {
        column,
        because: "labels".to_owned(),
    });
    let (numbers, words) = sampled.map_or((vec![], None), |one| (one.left_out, Some(one.words)));
    let judged = |numbers: Vec<usize>| {
        let column = |k: &usize| column(&columns[*k], &step, accounts.is_chosen(*k));
        numbers.iter().map(column).collect::<Vec<_>>()
    };
    let mut table = RateTable {
        columns: judged(errors),
        values: judged(values),
        left_out: labels.chain(numbers).chain(left_out).collect(),
        reading: String::new(),
        degree: ladder.degree,
        step: step.label,
        doubts,
    };
    let chosen = table.columns.iter().filter(|column| column.is_chosen);
    let jumps: Vec<Doubt> = chosen.filter_map(Column::jump).collect();
    table.doubts.extend(jumps);
    let words = words.map_or(String::new(), |words| format!("; samples: {words}"));
    table.reading = reading(&table) + &words;
    Ok(table)
}

/// A column with the coarsest level first.
fn column(cells: &Cells, step: &Step, is_chosen: bool) -> Column {
    let errors = cells
        .cells
        .iter()
        .map(|cell| cell.value().unwrap_or(f64::NAN));
    let level = |(step, error): (&f64, f64)| Level { step: *step, error };
    let mut column = Column {
        name: cells.name.clone(),
        levels: step.steps.sizes.iter().zip(errors).map(level).collect(),
        halves: cells.halves(),
        step_halves: step.steps.clone().unrounded().halves,
        is_chosen,
        samples: cells.samples.clone(),
    };
    if moves(&step.steps.sizes) == Some(Sense::Rises) {
        column.levels.reverse();
        column.halves.reverse();
        column.step_halves.reverse();
        column
            .samples
            .iter_mut()
            .for_each(|samples| samples.numbers.reverse());
    }
    column
}

/// How a table was read, in a line.
fn reading(table: &RateTable) -> String {
    let quoted = |columns: &[Column]| {
        let names = columns.iter().map(|column| format!("`{}`", column.name));
        names.collect::<Vec<_>>().join(", ")
    };
    let mut reading = format!("step: `{}`", table.step);
    for (noun, columns) in [("errors", &table.columns), ("values", &table.values)] {
        if !columns.is_empty() {
            reading += &format!("; {noun}: {}", quoted(columns));
        }
    }
    if !table.left_out.is_empty() {
        let reasons = table
            .left_out
            .iter()
            .map(|one| format!("`{}` ({})", one.column, one.because));
        reading += &format!("; left out: {}", reasons.collect::<Vec<_>>().join(", "));
    }
    visible(&reading)
}

/// The text of a file, and its name in messages.
fn text_and_name(path: &Path) -> Result<(String, String), InputError> {
    const STANDARD_INPUT: &str = "standard input";
    if path == Path::new("-") {
        let text = input::read_from(STANDARD_INPUT, io::stdin().lock())?;
        return Ok((text, STANDARD_INPUT.to_owned()));
    }
    Ok((
        input::Document::text_of_file(path)?,
        path.display().to_string(),
    ))
}
