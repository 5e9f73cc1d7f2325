//! The account of a ladder: each column is the step, is judged, or is set aside for a reason that
//! can be checked. A column that falls is never set aside by its name.

use super::cell::Cell;
use super::fits::{Printed, Steps, fit};
use super::grid::{Cells, Sense, moves, named};
use super::ladders::is_flag;
use super::names::{
    Measure, is_degree, says_cost, says_count_or_cost, says_error, says_rates, says_solved,
};
use super::step::{NEAR, Step};
use super::{Choice, Doubt, LeftOut, Refused};
use crate::input::advice::{Argument, Text};

/// What becomes of the columns of a ladder.
#[derive(Default)]
pub(super) struct Account {
    /// Columns judged as errors, by number.
    pub(super) errors: Vec<usize>,
    /// Columns judged as values.
    pub(super) values: Vec<usize>,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) doubts: Vec<Doubt>,
}

/// A ladder with its step.
pub(super) struct Accounts<'t> {
    pub(super) columns: &'t [Cells],
    pub(super) step: &'t Step,
    pub(super) choice: &'t Choice,
    /// The columns that the caller names as errors, and as values.
    named_errors: Vec<usize>,
    values: Vec<usize>,
}

impl<'t> Accounts<'t> {
    /// # Errors
    /// A name that no column has.
    pub(super) fn new(
        columns: &'t [Cells],
        step: &'t Step,
        choice: &'t Choice,
    ) -> Result<Self, Refused> {
        let find = |argument| move |name: &String| named(columns, argument, name);
        let named_errors = choice.columns.iter().flatten().map(find(Argument::Columns));
        let values = choice.values.iter().map(find(Argument::Values));
        let named_errors: Vec<usize> = named_errors.collect::<Result<_, _>>()?;
        let values: Vec<usize> = values.collect::<Result<_, _>>()?;
        if let Some(twice) = values.iter().find(|k| named_errors.contains(k)) {
            let expected = Text::from("each column of ") + Argument::Columns.alone() + " and ";
            let expected = expected + Argument::Values.alone() + " once";
            let found = format!("`{}` twice", columns[*twice].name);
            return Err(Refused::new(expected, found));
        }
        Ok(Self {
            named_errors,
            values,
            columns,
            step,
            choice,
        })
    }

    /// Whether a column is judged where an order is claimed for all.
    pub(super) fn is_chosen(&self, column: usize) -> bool {
        let none = self.named_errors.is_empty() && self.values.is_empty();
        none || self.named_errors.contains(&column) || self.values.contains(&column)
    }

    /// Accounts for each column.
    ///
    /// # Errors
    /// Cells that begin like numbers and are none; nothing to judge.
    pub(super) fn account(&self) -> Result<Account, Refused> {
        let mut account = Account {
            values: self.values.clone(),
            ..Account::default()
        };
        for (k, column) in self.columns.iter().enumerate() {
            let is_claimed =
                self.named_errors.contains(&k) || self.choice.claimed.contains(&column.name);
            let is_empty =
                column.name.is_empty() && column.cells.iter().all(|cell| cell.text.is_empty());
            if Some(k) == self.step.column || self.values.contains(&k) || is_empty {
                continue;
            }
            if self.is_chosen(k) || is_claimed {
                self.check(column, &mut account.doubts)?;
            }
            match self.reason(column).filter(|_| !is_claimed) {
                Some(because) => account.set_aside(column, because),
                None => account.errors.push(k),
            }
        }
        self.set_rates_aside(&mut account);
        if account.errors.is_empty() && account.values.is_empty() {
            let names = account
                .left_out
                .iter()
                .map(|one| format!("`{}` ({})", one.column, one.because));
            let found = names.take(12).collect::<Vec<_>>().join(", ");
            return Err(Refused::new(
                "a column of errors",
                format!("none but {found}"),
            ));
        }
        Ok(account)
    }

    /// Refuses cells that begin like numbers; doubts flags that say that a level was not solved.
    fn check(&self, column: &Cells, doubts: &mut Vec<Doubt>) -> Result<(), Refused> {
        let has_digit = |cell: &&Cell| cell.text.contains(|c: char| c.is_ascii_digit());
        let are_lists = says_error(&column.key)
            && column.are_labels()
            && column
                .cells
                .iter()
                .any(|cell| cell.text != column.cells[0].text);
        let is_broken = |cell: &&Cell| cell.is_broken() || are_lists && has_digit(cell);
        let mut doubt = |because: &str| {
            doubts.push(Doubt::Column {
                column: column.name.clone(),
                because: because.to_owned(),
            });
        };
        if column.is_named_rates() {
            if column
                .cells
                .iter()
                .any(|cell| cell.number.is_none() && has_digit(&cell))
            {
                doubt("is named like rates, and has cells that are no numbers");
            }
        } else if let Some(cell) = column.cells.iter().find(is_broken) {
            let found = format!("`{}` in the column `{}`", cell.text, column.name);
            return Err(Refused::new("a number alone in each cell", found).at(cell.line));
        }
        let is_no = |cell: &Cell| ["false", "no", "0"].contains(&cell.text.to_lowercase().as_str());
        let differs = column
            .cells
            .iter()
            .any(|cell| cell.text != column.cells[0].text);
        if is_flag(column)
            && (differs || says_solved(&column.key) && column.cells.iter().any(is_no))
        {
            doubt("is not true at all levels");
        }
        Ok(())
    }

    /// Why a column is set aside by itself; `None` if it is judged. This is the whole list, but for
    /// rates.
    fn reason(&self, column: &Cells) -> Option<String> {
        let is = |holds: bool, because: &str| holds.then(|| because.to_owned());
        let is_whole = column.is_whole();
        let falls = self.sense(column) == Some(Sense::Falls);
        let counts = says_count_or_cost(&column.key);
        let known = counts || is_degree(&column.key) || column.family().is_some();
        let is_step = matches!(column.family(), Some((_, Measure::Step)));
        let words =
            is(is_flag(column), "true or false").or_else(|| is(column.are_labels(), "labels"));
        if words.is_some() || says_error(&column.key) {
            return words;
        }
        is(
            column.is_constant() && (is_whole && known || is_step && column.is_positive()),
            "a parameter",
        )
        .or_else(|| {
            let is_other = says_rates(&column.key) || is_degree(&column.key);
            is(!is_other && column.numbers_rows(), "numbers of the rows")
        })
        .or_else(|| is(self.is_other_family(column), "a step of the other family"))
        .or_else(|| self.second_name(column))
        .or_else(|| {
            is(
                is_whole && counts && !falls,
                "whole numbers that do not fall, under a name of a count, level or cost",
            )
        })
        .or_else(|| {
            is(
                says_cost(&column.key) && self.doubles(column),
                "a cost: at least doubles",
            )
        })
    }

    /// Numbers with the coarsest level first.
    fn coarse_first(&self, column: &Cells) -> Vec<f64> {
        let mut values = column.values().unwrap_or_default();
        if moves(&self.step.steps.sizes) == Some(Sense::Rises) {
            values.reverse();
        }
        values
    }

    /// How a column changes as the step falls.
    fn sense(&self, column: &Cells) -> Option<Sense> {
        moves(&self.coarse_first(column))
    }

    fn is_other_family(&self, column: &Cells) -> bool {
        let own = self.step.column.and_then(|k| self.columns[k].family());
        let (Some((own, _)), Some((other, measure))) = (own, column.family()) else {
            return false;
        };
        let falls = self.sense(column) == Some(Sense::Falls);
        let is_step = measure == Measure::Step || column.is_whole() && !falls;
        own != other && self.step.is_said && column.varies() && is_step
    }

    /// Another name of the ladder: steps in proportion, or a count that grows as the step falls.
    fn second_name(&self, column: &Cells) -> Option<String> {
        let (_, measure) = column.family().filter(|_| column.is_positive())?;
        if measure == Measure::Step && self.is_proportional(column) {
            return Some("in proportion to the step".to_owned());
        }
        let grows = column.is_whole() && self.sense(column) == Some(Sense::Rises);
        (measure == Measure::Count && grows)
            .then(|| "a count that grows as the step falls".to_owned())
    }

    /// Whether numbers are in proportion to the step, within their last places and 0.5 %.
    fn is_proportional(&self, column: &Cells) -> bool {
        let Steps { sizes, halves } = &self.step.steps;
        let values = column.values().unwrap_or_default();
        let own = column.halves();
        let share = |k: usize| own[k] / values[k] + (halves[k] / sizes[k]).min(0.005);
        (1..values.len()).all(|k| {
            let ratio = values[k - 1] / values[k] * sizes[k] / sizes[k - 1];
            (ratio - 1.0).abs() <= 0.005 + share(k - 1) + share(k)
        })
    }

    /// Whether the last number is at least twice the first.
    fn doubles(&self, column: &Cells) -> bool {
        let values = self.coarse_first(column);
        column.is_positive() && values[values.len() - 1] >= 2.0 * values[0]
    }

    /// Sets aside what equals the rates or the factors of an error; what is only named so is a
    /// doubt.
    fn set_rates_aside(&self, account: &mut Account) {
        let errors = account.errors.clone();
        let is_asked = |k: &usize| {
            self.named_errors.contains(k) || self.choice.claimed.contains(&self.columns[*k].name)
        };
        for k in errors.iter().copied().filter(|k| !is_asked(k)) {
            let column = &self.columns[k];
            let is_named = column.is_named_rates();
            let may_be = says_rates(&column.key)
                || !says_error(&column.key)
                    && column.cells.iter().any(|cell| cell.number.is_none());
            if !may_be {
                continue;
            }
            let near = errors
                .iter()
                .copied()
                .filter(|error| *error != k && error.abs_diff(k) <= NEAR);
            let mut judged = near
                .map(|error| &self.columns[error])
                .filter(|error| !error.is_named_rates() && error.family().is_none());
            let fitted = judged.find_map(|error| {
                let what = match fit(column, error, &self.step.steps)? {
                    Printed::Rates => "rates",
                    Printed::Factors => "factors",
                };
                Some(format!("the {what} of `{}`", error.name))
            });
            if fitted.is_none() && !is_named {
                continue;
            }
            if fitted.is_none() && self.is_chosen(k) {
                account.doubts.push(Doubt::Column {
                    column: column.name.clone(),
                    because: "is named like rates, and fits no error over the step".to_owned(),
                });
            }
            let because = fitted.unwrap_or_else(|| "named like rates".to_owned());
            account.errors.retain(|error| *error != k);
            account.set_aside(column, because);
        }
    }
}

impl Account {
    fn set_aside(&mut self, column: &Cells, because: String) {
        self.left_out.push(LeftOut {
            column: column.name.clone(),
            because,
        });
    }
}
