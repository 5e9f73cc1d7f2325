//! The account of a ladder: each column is the step, is judged, or is set aside for a reason that
//! can be checked. A column that falls is never set aside by its name.

use super::cell::Cell;
use super::fits::{Printed, Steps, printed};
use super::grid::{Cells, Sense, named};
use super::ladders::{Ladder, is_flag};
use super::names::{
    Measure, is_degree, says_cost, says_count_or_cost, says_error, says_error_alone, says_rates,
    says_solved,
};
use super::step::{Step, sizes};
use super::{Choice, Column, Doubt, LeftOut, RateTable, Refused};
use crate::input::advice::{Argument, Text};
use convergence_judge::fit::Level;

/// A ladder with its step, coarsest level first, and what becomes of its columns.
struct Account<'t> {
    columns: &'t [Cells],
    step: &'t Step,
    choice: &'t Choice,
    /// The columns that the caller names as errors, by number.
    named_errors: Vec<usize>,
    values: Vec<usize>,
    /// Columns judged as errors.
    errors: Vec<usize>,
    table: RateTable,
}

/// Accounts for each column of a ladder.
///
/// # Errors
/// A name that no column has; cells that begin like numbers and are none; nothing to judge.
pub(super) fn account(ladder: Ladder, step: &Step, choice: &Choice) -> Result<RateTable, Refused> {
    let Ladder { columns, table } = ladder;
    let named_errors = choice.columns.as_deref().unwrap_or(&[]);
    let account = Account {
        named_errors: all_named(&columns, Argument::Columns, named_errors)?,
        values: all_named(&columns, Argument::Values, &choice.values)?,
        errors: vec![],
        columns: &columns,
        step,
        choice,
        table,
    };
    account.run()
}

fn all_named(
    columns: &[Cells],
    argument: Argument,
    names: &[String],
) -> Result<Vec<usize>, Refused> {
    let numbers = names.iter().map(|name| named(columns, argument, name));
    numbers.collect()
}

impl Account<'_> {
    fn run(mut self) -> Result<RateTable, Refused> {
        let mut values = self.values.iter();
        if let Some(twice) = values.find(|k| self.named_errors.contains(k)) {
            let expected = Text::from("each column of ") + Argument::Columns.alone() + " and ";
            let expected = expected + Argument::Values.alone() + " once";
            let found = format!("`{}` twice", self.columns[*twice].name);
            return Err(Refused::new(expected, found));
        }
        if let Some(step) = self.step.column.filter(|k| self.named_errors.contains(k)) {
            let expected = Argument::Columns.alone() + " without the step";
            let found = format!("`{}`", self.columns[step].name);
            return Err(Refused::new(expected, found));
        }
        for (k, column) in self.columns.iter().enumerate() {
            let is_nothing = |cell: &Cell| column.name.is_empty() && cell.text.is_empty();
            let is_known = Some(k) == self.step.column || self.values.contains(&k);
            if is_known || column.cells.iter().all(is_nothing) {
                continue;
            }
            let is_asked = self.is_asked(k);
            if is_asked || self.is_chosen(k) {
                self.check(column)?;
            }
            match self.reason(column).filter(|_| !is_asked) {
                Some(because) => self.set_aside(column, because),
                None if is_asked || self.is_chosen(k) => {
                    refuse_grids(column)?;
                    self.errors.push(k);
                }
                None => self.errors.push(k),
            }
        }
        self.set_rates_aside();
        if self.errors.is_empty() && self.values.is_empty() {
            let left_out = self.table.left_out.iter().take(12);
            let left_out: Vec<String> = left_out.map(LeftOut::to_string).collect();
            let found = match &left_out[..] {
                [] => format!("`{}` alone", self.step.label),
                _ => format!("none but {}", left_out.join(", ")),
            };
            return Err(Refused::new("a column of errors", found));
        }
        let columns: Vec<Column> = self.errors.iter().map(|k| self.judged(*k)).collect();
        let chosen = columns.iter().filter(|column| column.is_chosen);
        self.table.doubts.extend(chosen.filter_map(Doubt::of_jump));
        Ok(RateTable {
            step: self.step.label.clone(),
            values: self.values.iter().map(|k| self.judged(*k)).collect(),
            columns,
            ..self.table
        })
    }

    /// A column as it is judged.
    fn judged(&self, k: usize) -> Column {
        let cells = &self.columns[k];
        let Steps { sizes, halves } = &self.step.steps;
        let errors = cells.cells.iter().map(Cell::value);
        let levels = sizes.iter().zip(errors).map(|(step, error)| Level {
            step: *step,
            error: error.unwrap_or(f64::NAN),
        });
        Column {
            halves: cells.halves.clone(),
            step_halves: if self.step.steps.are_regular() {
                vec![0.0; halves.len()]
            } else {
                halves.clone()
            },
            is_chosen: self.is_chosen(k),
            samples: cells.samples.clone(),
            ..Column::exact(&cells.name, levels.collect())
        }
    }

    /// Whether a column is judged where an order is claimed for all.
    fn is_chosen(&self, column: usize) -> bool {
        let none = self.named_errors.is_empty() && self.values.is_empty();
        none || self.named_errors.contains(&column) || self.values.contains(&column)
    }

    /// Whether the caller names a column as an error: it is never set aside.
    fn is_asked(&self, column: usize) -> bool {
        let is_claimed = self.choice.claimed.contains(&self.columns[column].name);
        is_claimed || self.named_errors.contains(&column)
    }

    fn doubt(&mut self, column: &Cells, because: &str) {
        let doubt = Doubt::of_column(&column.name, because);
        self.table.doubts.push(doubt);
    }

    fn set_aside(&mut self, column: &Cells, because: impl Into<String>) {
        self.table.left_out.push(LeftOut::new(column, because));
    }

    /// Refuses cells that begin like numbers; doubts flags that say that a level was not solved.
    fn check(&mut self, column: &Cells) -> Result<(), Refused> {
        let mut cells = column.cells.iter();
        let has_digit = |cell: &Cell| cell.text.contains(|c: char| c.is_ascii_digit());
        let are_lists = says_error(&column.key) && column.are_labels() && column.differs();
        let is_broken = |cell: &&Cell| cell.is_broken() || are_lists && has_digit(cell);
        if column.is_named_rates() {
            if cells.any(|cell| cell.number.is_none() && has_digit(cell)) {
                let because = "is named like rates, and has cells that are no numbers";
                self.doubt(column, because);
            }
        } else if let Some(cell) = cells.find(is_broken) {
            return Err(no_number(column, cell));
        } else if says_error_alone(&column.key) && column.are_labels() && !column.names_errors() {
            self.doubt(column, "is named like an error, and has words alone");
        }
        let is_no = |cell: &Cell| ["false", "no", "0"].contains(&cell.text.to_lowercase().as_str());
        let is_unsolved = says_solved(&column.key) && column.cells.iter().any(is_no);
        if is_flag(column) && (column.differs() || is_unsolved) {
            self.doubt(column, "is not true at all levels");
        }
        Ok(())
    }

    /// Why a column is set aside by itself; `None` if it is judged. This is the whole list, but for
    /// rates.
    fn reason(&self, column: &Cells) -> Option<&'static str> {
        let key = &column.key;
        let measure = column.family().map(|(_, measure)| measure);
        let is_step = measure == Some(Measure::Step);
        let is_whole = column.is_whole();
        let is_positive = column.is_positive();
        let falls = column.sense() == Some(Sense::Falls);
        let grows = is_whole && column.sense() == Some(Sense::Rises);
        let counts = says_count_or_cost(key);
        let is_known = is_whole && (counts || is_degree(key) || measure.is_some());
        let may_number_rows = !says_rates(key) && !is_degree(key);
        let words = [
            (is_flag(column), "true or false"),
            (column.are_labels(), "labels"),
        ];
        let numbers = [
            (
                column.is_constant() && (is_known || is_step && is_positive),
                "a parameter",
            ),
            (
                may_number_rows && column.numbers_rows,
                "numbers of the rows",
            ),
            (
                self.is_other_family(column) && (is_step || is_whole && !falls),
                "a step of the other family",
            ),
            (
                is_step && is_positive && self.is_proportional(column),
                "in proportion to the step",
            ),
            (
                measure == Some(Measure::Count) && is_positive && grows,
                "a count that grows as the step falls",
            ),
            (
                is_whole && counts && !falls,
                "whole numbers that do not fall, under a name of a count, level or cost",
            ),
            (
                says_cost(key) && is_positive && doubles(column),
                "a cost: at least doubles",
            ),
        ];
        let numbers = numbers.into_iter().filter(|_| !says_error(key));
        let mut holding = words.into_iter().chain(numbers).filter(|(holds, _)| *holds);
        holding.next().map(|(_, because)| because)
    }

    /// Whether a column steps through time and the step through space, or the other way round, and
    /// one of them is said to be meant.
    fn is_other_family(&self, column: &Cells) -> bool {
        let step = self.step.column.map(|k| &self.columns[k]);
        let families = step.and_then(Cells::family).zip(column.family());
        let are_two = families.is_some_and(|((own, _), (other, _))| own != other);
        are_two && self.step.is_said && column.varies()
    }

    /// Whether numbers are in proportion to the step, within their last places and 0.5 %.
    fn is_proportional(&self, column: &Cells) -> bool {
        let own = sizes(column, None);
        let steps = &self.step.steps;
        let share = |k: usize| own.halves[k] / own.sizes[k] + steps.share(k);
        let mut ratios = own.ratios().zip(steps.ratios()).enumerate();
        ratios.all(|(k, (own, step))| (step / own - 1.0).abs() <= 0.005 + share(k) + share(k + 1))
    }

    /// Sets aside what equals the rates or the factors of an error; what is only named so is a
    /// doubt.
    fn set_rates_aside(&mut self) {
        let errors = self.errors.clone();
        for k in errors
            .iter()
            .copied()
            .filter(|k| !self.is_asked(*k))
            .collect::<Vec<_>>()
        {
            let column = &self.columns[k];
            let has_gaps = column.cells.iter().any(|cell| cell.number.is_none());
            if !says_rates(&column.key) && (says_error(&column.key) || !has_gaps) {
                continue;
            }
            let may_be_error = |error: usize| {
                errors.binary_search(&error).is_ok() && self.columns[error].family().is_none()
            };
            let found = printed(self.columns, k, may_be_error, &self.step.steps).next();
            let because = match found {
                Some((Printed::Rates, error)) => format!("the rates of `{}`", error.name),
                Some((Printed::Factors, error)) => format!("the factors of `{}`", error.name),
                None if column.is_named_rates() => "named like rates".to_owned(),
                None => continue,
            };
            if found.is_none() && self.is_chosen(k) {
                self.doubt(
                    column,
                    "is named like rates, and fits no error over the step",
                );
            }
            self.errors.retain(|error| *error != k);
            self.set_aside(column, because);
        }
    }
}

/// Refuses cells such as `4×10` in a column of errors.
fn refuse_grids(column: &Cells) -> Result<(), Refused> {
    match column.cells.iter().find(|cell| cell.is_grid()) {
        Some(cell) => Err(no_number(column, cell)),
        None => Ok(()),
    }
}

/// The refusal of a cell that holds more, or less, than a number.
fn no_number(column: &Cells, cell: &Cell) -> Refused {
    let found = format!("`{}` in the column `{}`", cell.text, column.name);
    Refused::new("a number alone in each cell", found).at(cell.line)
}

/// Whether the last number is at least twice the first.
fn doubles(column: &Cells) -> bool {
    let ends = column.numbers.first().zip(column.numbers.last());
    ends.is_some_and(|(first, last)| *last >= 2.0 * first)
}
