//! Convergence rates of any code: tables of steps and errors, of which every number is accounted
//! for, judged by the rule of [`verdict`](convergence_judge::verdict).
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
mod document;
mod doubt;
pub(crate) mod failed_run;
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

use std::collections::HashMap;
use std::fmt;

use serde::Serialize;

pub use crate::column::Column;
use crate::input::InputError;
use crate::input::advice::{Argument, Text};
use crate::text::number::counted;
use crate::text::visible::visible;
use account::account;
use cell::is_number;
use grid::{Cells, Grid, Sense, moves};
use ladders::{Ladder, ladders};
use names::error_of_rates;
use refused::Refused;
use unnamed::Heading;

pub(crate) use choice::Offer;
pub use choice::{Choice, LineRange};
pub(crate) use doubt::Doubt;
pub use frame::{FrameCell, FrameColumn};

/// A table of errors that was read.
///
/// ```
/// use convergence_study::rates::{Choice, RateTable};
/// use convergence_study::{Claim, Floor};
///
/// let text = "h, L2, rate\n0.1, 1.01e-3, -\n0.05, 2.51e-4, 2.01\n0.025, 6.26e-5, 2.00\n";
/// let table = RateTable::parse_all_with(text, "errors.csv", &Choice::default())?.remove(0);
/// let column = table.column("L2").expect("its name");
/// let rate = column.judge(&Claim::new(2.0, 0.25), Floor::NONE);
/// assert!(rate.verdict.is_pass(), "{}", rate.reason);
/// assert_eq!(table.left_out[0].because, "the rates of `L2`");
/// # Ok::<(), convergence_study::InputError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct RateTable {
    /// What tells it from other tables of a text; empty for an only one.
    pub name: String,
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
    pub(crate) doubts: Vec<Doubt>,
}

/// A column that was set aside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Its name.
    pub column: String,
    /// The reason.
    pub because: String,
}

impl LeftOut {
    fn new(column: &Cells, because: impl Into<String>) -> Self {
        Self {
            column: column.name.clone(),
            because: because.into(),
        }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` ({})", self.column, self.because)
    }
}

impl RateTable {
    /// Reads all tables of `text`; messages name `file_name`.
    ///
    /// # Errors
    /// [`InputError`] with its line, about the first table, if none can be read, also for a choice
    /// of missing columns; otherwise a table that cannot be read is a doubt of the first that can.
    pub fn parse_all_with(
        text: &str,
        file_name: &str,
        choice: &Choice,
    ) -> Result<Vec<Self>, InputError> {
        let text = text
            .trim_start_matches('\u{feff}')
            .replace("\r\n", "\n")
            .replace('\r', "\n");
        let mut tables = refused::with_offers(
            |choice| document::tables(&text, file_name, choice),
            choice,
            file_name,
        )?;
        let cut_off = document::cut_off(&text, choice, &tables);
        tables[0].doubts.extend(cut_off);
        let is_alone = tables.len() == 1;
        for (table, number) in tables.iter_mut().zip(1..) {
            if is_alone {
                table.name.clear();
            } else if table.name.is_empty() {
                table.name = format!("table {number}");
            }
        }
        Ok(tables)
    }

    /// Its errors, then its values.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Column> + Clone {
        self.columns.iter().chain(&self.values)
    }

    /// The first of the reasons why none of its columns should pass.
    pub fn first_doubt(&self) -> Option<String> {
        self.doubts.first().map(Doubt::to_string)
    }

    /// The column of errors of this name, with or without its unit.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let names = self.columns.iter().map(|column| column.name.as_str());
        self.columns.get(names::position(names, name)?)
    }
}

/// The names that the caller gives to all columns, if any.
///
/// # Errors
/// As many names as columns are expected.
fn names_given(choice: &Choice, columns: usize) -> Result<Option<Vec<String>>, Refused> {
    match &choice.names {
        Some(names) if names.len() != columns => {
            let expected = Argument::Names.alone() + format!(": {}", counted(columns, "name"));
            Err(Refused::new(expected, names.len().to_string()))
        }
        names => Ok(names.clone()),
    }
}

fn tables_of_grid(grid: &Grid, choice: &Choice) -> Result<Vec<RateTable>, Refused> {
    let headings = match names_given(choice, grid.rows[0].len())? {
        Some(names) => names.into_iter().map(Heading::Name).collect(),
        None => unnamed::headings(grid, choice.dim)?,
    };
    let names = headings.iter().filter_map(Heading::name);
    if names.filter(|name| has_step(name)).count() > 1 {
        let found = "steps in the names of columns";
        return Err(Refused::new("one row a level: transpose the table", found));
    }
    for three in headings.windows(3) {
        if let Some(name) = three[0].name()
            && three.iter().all(|heading| *heading == three[0])
        {
            let found = format!("`{name}` three times side by side");
            let expected = Text::from("each name once, or ") + Argument::Names.with_placeholder();
            return Err(Refused::new(expected, found));
        }
    }
    let mut columns = grid.columns(&unique_names(&headings));
    for (column, heading) in headings.iter().enumerate() {
        columns[column].rates_of = match heading {
            Heading::Name(name) => error_of_rates(name),
            Heading::RatesOf(error) => Some(columns[*error].name.clone()),
        };
    }
    tables_of_columns(grid, &columns, choice)
}

/// Whether the name of a column ends with a step, such as `h = 0.1`.
fn has_step(name: &str) -> bool {
    let step = name.rsplit_once('=');
    step.is_some_and(|(_, step)| is_number(step.trim()))
}

/// A name for each column, with its number where two have the same.
fn unique_names(headings: &[Heading]) -> Vec<String> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for name in headings.iter().filter_map(Heading::name) {
        *counts.entry(name).or_default() += usize::from(!name.is_empty());
    }
    let mut names: Vec<String> = vec![];
    for (column, heading) in headings.iter().enumerate() {
        names.push(match heading {
            Heading::Name(name) if counts[name.as_str()] > 1 => {
                format!("{name} (column {})", column + 1)
            }
            Heading::Name(name) => name.clone(),
            Heading::RatesOf(error) => format!("rate of {}", names[*error]),
        });
    }
    names
}

/// The tables of the columns of a grid: one for each ladder.
fn tables_of_columns(
    grid: &Grid,
    columns: &[Cells],
    choice: &Choice,
) -> Result<Vec<RateTable>, Refused> {
    let ladders = ladders(grid, columns, choice)?.into_iter();
    ladders.map(|ladder| table(ladder, choice)).collect()
}

/// The table of a ladder.
fn table(mut ladder: Ladder, choice: &Choice) -> Result<RateTable, Refused> {
    let samples = match choice.samples {
        Some(of) => samples::sample(&mut ladder, of, choice)?,
        None => String::new(),
    };
    let mut step = step::step(&ladder.columns, choice)?;
    if moves(&step.steps.sizes) == Some(Sense::Rises) {
        step.steps.sizes.reverse();
        step.steps.halves.reverse();
        ladder.columns.iter_mut().for_each(Cells::reverse);
    }
    let table = account(ladder, &step, choice)?;
    Ok(RateTable {
        reading: visible(&(reading(&table) + &samples)),
        ..table
    })
}

/// How a table was read, in a line.
fn reading(table: &RateTable) -> String {
    let quoted = |column: &Column| format!("`{}`", column.name);
    let lists: [(&str, Vec<String>); 3] = [
        ("errors", table.columns.iter().map(quoted).collect()),
        ("values", table.values.iter().map(quoted).collect()),
        (
            "left out",
            table.left_out.iter().map(LeftOut::to_string).collect(),
        ),
    ];
    let mut reading = format!("step: `{}`", table.step);
    for (noun, names) in lists {
        if !names.is_empty() {
            reading += &format!("; {noun}: {}", names.join(", "));
        }
    }
    reading
}
