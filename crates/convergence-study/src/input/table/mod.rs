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
mod digits;
mod fits;
mod forms;
mod frame;
mod grid;
mod ladders;
pub(crate) mod names;
mod step;
mod unnamed;

use std::fmt::{self, Display, Formatter};
use std::io;
use std::path::Path;

use serde::Deserialize;

use crate::input::advice::{Argument, ArgumentValue, Setting, Surface, Text};
use crate::input::{self, Complaint, InputError, Place};
use crate::judge::fit::Level;
use crate::text::number::counted;
use crate::text::visible::visible;
use account::{Account, Accounts};
use cell::is_number;
use grid::{Cells, Grid, Sense, moves};
use ladders::{Ladder, ladders};
use step::Step;

pub use digits::Column;
pub use frame::{FrameCell, FrameColumn};

/// A table of errors that was read.
///
/// ```
/// use convergence_study::{Choice, Claim, Floor, RateTable};
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

/// What speaks against a table that was read: nothing of it should pass.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Doubt {
    /// A line of the text says that the run has failed.
    FailedRun {
        /// Its number, from 1.
        line: usize,
        /// Its words.
        words: String,
    },
    /// Lines outside the tables look like rows, or name a column.
    Outside {
        /// The number of the first, from 1; 0 without lines.
        line: usize,
        /// Its words.
        words: String,
        /// How many there are.
        count: usize,
        /// The choice of the lines of the tables.
        offer: Option<Offer>,
    },
    /// Another table of the text cannot be read.
    Unread(Box<InputError>),
    /// A column that may hide an error.
    Column {
        /// Its name.
        column: String,
        /// What is wrong with it.
        because: String,
    },
}

impl Doubt {
    /// The choice that removes it, if there is one.
    pub fn offer(&self) -> Option<&Offer> {
        match self {
            Self::Outside { offer, .. } => offer.as_ref(),
            _ => None,
        }
    }
}

impl Display for Doubt {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::FailedRun { line, words } => {
                write!(f, "the run has failed: line {line} is `{}`", visible(words))
            }
            Self::Outside {
                line, words, count, ..
            } => {
                let place = if *line == 0 {
                    String::new()
                } else {
                    format!("line {line}, ")
                };
                let more = crate::text::lists::and_more(*count, 1);
                write!(f, "outside the tables: {place}`{}`{more}", visible(words))
            }
            Self::Unread(error) => write!(f, "a table is not read: {error}"),
            Self::Column { column, because } => write!(f, "`{}` {because}", visible(column)),
        }
    }
}

/// Lines of a text, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct LineRange {
    first: usize,
    last: usize,
}

impl LineRange {
    fn has(self, line: usize) -> bool {
        (self.first..=self.last).contains(&line)
    }
}

impl std::str::FromStr for LineRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once('-').unwrap_or((text, text));
        match (ends.0.trim().parse(), ends.1.trim().parse()) {
            (Ok(first), Ok(last)) if 0 < first && first <= last => Ok(Self { first, last }),
            _ => Err("expected the first and the last line, from 1, as in 3-9".to_owned()),
        }
    }
}

impl TryFrom<String> for LineRange {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl Display for LineRange {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.first, self.last)
    }
}

/// Which columns of a table to use; by default their names decide, and arithmetic.
///
/// A column is named as in the table, with or without its unit, or by its number from 1.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// The column of the step, or of the count or level that gives it.
    pub step: Option<String>,
    /// The columns of errors.
    pub columns: Option<Vec<String>>,
    /// Columns of values, which tend to a limit that is not zero.
    pub values: Vec<String>,
    /// Names for all columns, instead of those in the table.
    pub names: Option<Vec<String>>,
    /// The lines of the tables; all without one.
    pub lines: Vec<LineRange>,
    /// Columns with an order claimed by name: none of them can be the step, or be set aside.
    #[serde(skip)]
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
    /// Ratio R > 1 of the steps of consecutive levels: h = R^(-level).
    pub ratio: Option<f64>,
}

/// A choice that reads a table which was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Offer {
    /// The choice that was made, changed.
    pub choice: Choice,
    /// What tells it from other offers, or when it is right; may be empty.
    pub comment: &'static str,
}

/// A table with what tells it from others of a text.
struct NamedTable {
    name: String,
    table: RateTable,
}

/// Why a table is not read.
#[derive(Debug, Clone)]
struct Refused {
    line: usize,
    expected: Text,
    found: String,
    offers: Vec<Offer>,
}

impl Refused {
    fn new(expected: impl Into<Text>, found: impl Into<String>) -> Self {
        Self {
            line: 0,
            expected: expected.into(),
            found: found.into(),
            offers: vec![],
        }
    }

    /// At this line, unless its own is known.
    fn at(mut self, line: usize) -> Self {
        self.line = if self.line == 0 { line } else { self.line };
        self
    }

    fn offering(mut self, offers: impl IntoIterator<Item = Offer>) -> Self {
        self.offers.extend(offers);
        self
    }

    /// The same with those offers alone that read the table, without a column in doubt.
    fn trying(mut self, read: impl Fn(&Choice) -> Result<Vec<RateTable>, Self>) -> Self {
        /// Most offers that are tried.
        const TRIED: usize = 6;
        self.offers.truncate(TRIED);
        self.offers.retain(|offer| {
            let tables = read(&offer.choice).unwrap_or_default();
            let mut doubts = tables.iter().flat_map(|table| &table.doubts);
            !tables.is_empty() && !doubts.any(|doubt| matches!(doubt, Doubt::Column { .. }))
        });
        self
    }

    fn error(self, file: &str) -> InputError {
        InputError {
            file: file.to_owned(),
            place: (self.line > 0).then_some(Place {
                line: self.line,
                column: 1,
            }),
            field: None,
            complaint: Box::new(Complaint::Table {
                expected: self.expected,
                found: self.found,
            }),
            offers: self.offers,
        }
    }
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
    let ladders = ladders(grid, columns)?;
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
fn table(ladder: Ladder, choice: &Choice) -> Result<RateTable, Refused> {
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
    let judged = |numbers: Vec<usize>| {
        let column = |k: &usize| column(&columns[*k], &step, accounts.is_chosen(*k));
        numbers.iter().map(column).collect::<Vec<_>>()
    };
    let mut table = RateTable {
        columns: judged(errors),
        values: judged(values),
        left_out: labels.chain(left_out).collect(),
        reading: String::new(),
        degree: ladder.degree,
        step: step.label,
        doubts,
    };
    let chosen = table.columns.iter().filter(|column| column.is_chosen);
    let jumps: Vec<Doubt> = chosen.filter_map(Column::jump).collect();
    table.doubts.extend(jumps);
    table.reading = reading(&table);
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
    };
    if moves(&step.steps.sizes) == Some(Sense::Rises) {
        column.levels.reverse();
        column.halves.reverse();
        column.step_halves.reverse();
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
    Ok((input::read_text(path)?, path.display().to_string()))
}

impl Choice {
    /// This choice, changed.
    ///
    /// * `comment`: when it is right; may be empty.
    fn offer(&self, comment: &'static str, change: impl FnOnce(&mut Self)) -> Offer {
        let mut choice = self.clone();
        change(&mut choice);
        Offer { choice, comment }
    }

    /// What is chosen about the reading.
    pub fn settings(&self) -> Vec<Setting> {
        let lines: Vec<String> = self.lines.iter().map(LineRange::to_string).collect();
        let values = [
            (
                Argument::Names,
                self.names.as_deref().and_then(ArgumentValue::names),
            ),
            (Argument::Step, self.step.clone().map(ArgumentValue::Name)),
            (Argument::Dim, self.dim.map(ArgumentValue::Number)),
            (Argument::Ratio, self.ratio.map(ArgumentValue::Number)),
            (
                Argument::Columns,
                self.columns.as_deref().and_then(ArgumentValue::names),
            ),
            (Argument::Values, ArgumentValue::names(&self.values)),
            (Argument::Lines, ArgumentValue::names(&lines)),
        ];
        let mut settings = vec![];
        for (argument, value) in values {
            settings.extend(value.map(|value| Setting { argument, value }));
        }
        settings
    }
}

impl Offer {
    /// The line of a message with the call and the comment; `None` if the surface has no such call.
    pub(crate) fn line(&self, surface: &dyn Surface) -> Option<String> {
        let call = surface.call(&self.choice.settings())?;
        Some(match self.comment {
            "" => format!("\n  {call}"),
            comment => format!("\n  {call}  # {comment}"),
        })
    }
}
