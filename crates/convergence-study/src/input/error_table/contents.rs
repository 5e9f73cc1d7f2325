//! What columns hold that nobody has chosen: an error, unless arithmetic that can be checked says
//! otherwise, or a name whose numbers cannot be those of an error that falls. Nothing is left out
//! because its numbers look wrong.

use super::columns::{Cells, DIMENSIONS, Derived, Holdings};
use super::families::Family;
use super::names::{self, Word};
use super::reader::{TableReader, reasons};
use super::stated::Derivation;
use super::step::Step;
use super::{Doubt, NotError};
use crate::input::InputError;
use crate::input::advice::{Argument, Text};
use crate::judge::verdict::{Level, Tendency};
use crate::text::number::plain_text;

/// Rates are searched for over the steps and this many columns of counts.
const COUNTS: usize = 3;
/// Largest relative difference between the ratios of the steps and of a count that has the rates.
const SAME_LADDER: f64 = 0.3;

/// What a column holds that nobody has chosen; if it is not an error, why.
enum Content {
    Error,
    /// Named like rates, but the rates of no column.
    Rates(String),
    /// A value or an error that no longer falls: numbers that tend to a limit.
    Limit(String),
    /// A count or an error that grows: whole numbers that grow.
    Growth,
    /// No error, as the numbers show.
    Checked(String),
    /// No error, by its name alone.
    Named(String),
}

impl Content {
    fn checked(because: impl Into<String>) -> Self {
        Self::Checked(because.into())
    }

    fn named(because: impl Into<String>) -> Self {
        Self::Named(because.into())
    }
}

/// Columns of unknown name that are errors or something else: only the user can tell.
#[derive(Default)]
struct Undecided {
    /// Numbers that tend to a limit.
    limits: Vec<usize>,
    /// Whole numbers that grow.
    counts: Vec<usize>,
}

impl Undecided {
    fn is_empty(&self) -> bool {
        self.limits.is_empty() && self.counts.is_empty()
    }
}

impl TableReader<'_> {
    /// The levels that a column of states says not to be solved. No error of such a level counts.
    pub(super) fn find_states(&mut self, step: usize, errors: &[usize], values: &[usize]) {
        let is_chosen = |k: &usize| *k == step || errors.contains(k) || values.contains(k);
        let others: Vec<usize> = (0..self.columns.len()).filter(|k| !is_chosen(k)).collect();
        for cells in others.into_iter().map(|k| &self.columns[k]) {
            let is_state = cells.word == Word::State && !cells.is_claimed;
            let solved = !names::is_failure_name(&cells.name);
            for (row, is_solved) in self.is_solved.iter_mut().enumerate() {
                let by_word = names::state(cells.texts[row]) == Some(!solved);
                let flag = if solved { 0.0 } else { 1.0 };
                // The reasons of PETSc are negative where a solver has failed.
                let by_number = is_state
                    && (cells.is_flag() && cells.values[row] == flag || cells.values[row] < 0.0);
                if (cells.holdings() == Holdings::States || is_state) && by_word || by_number {
                    *is_solved = false;
                }
            }
        }
    }

    /// The columns of errors; the others are left out, each with the reason. Refuses to judge
    /// without errors, or if a column may be something else by its numbers. Nothing is left out
    /// because it does not fall: a lost order looks like that.
    pub(super) fn error_columns(
        &mut self,
        step: &Step,
        steps: &[f64],
        values: &[usize],
    ) -> Result<Vec<usize>, InputError> {
        let mut errors = vec![];
        let mut undecided = Undecided::default();
        for k in (0..self.columns.len()).filter(|k| *k != step.column && !values.contains(k)) {
            match self.content(k, step, steps)? {
                Content::Error => errors.push(k),
                Content::Rates(because) => {
                    self.doubts.push(Doubt::Rates {
                        rates: self.columns[k].name.clone(),
                        step: step.label.clone(),
                    });
                    self.leave_out(k, &because, false);
                }
                Content::Limit(because) => {
                    undecided.limits.push(k);
                    self.leave_out(k, &because, false);
                }
                Content::Growth => {
                    undecided.counts.push(k);
                    self.leave_out(k, "whole numbers that grow", false);
                }
                Content::Checked(because) => self.leave_out(k, &because, true),
                Content::Named(because) => self.leave_out(k, &because, false),
            }
        }
        if errors.is_empty() && values.is_empty() {
            return Err(self.refuse_without_errors(&undecided.limits)?);
        }
        if undecided.is_empty() {
            return Ok(errors);
        }
        Err(self.refuse_undecided(&errors, values, &undecided))
    }

    fn leave_out(&mut self, k: usize, because: &str, is_checked: bool) {
        self.left_out.push(NotError {
            column: self.columns[k].name.clone(),
            because: because.to_owned(),
            is_checked,
        });
    }

    /// The refusal of a table without errors and without chosen values: it offers the columns with
    /// a limit as values.
    fn refuse_without_errors(&self, limits: &[usize]) -> Result<InputError, InputError> {
        let mut columns = self.columns.iter();
        let unknown =
            columns.position(|column| column.word.noun().is_none() && !column.is_number(0));
        if let Some(k) = unknown {
            self.must(0, k)?;
        }
        // What stands behind a sentence may be anything.
        let is_named = |k: &&usize| !names::is_sentence(&self.columns[**k].name);
        let limits: Vec<usize> = limits.iter().filter(is_named).copied().collect();
        let as_values = self
            .choice
            .offer("", |choice| choice.values = self.names(&limits));
        let offer = (!limits.is_empty()).then_some(as_values);
        let expected = Text::from("a column of errors, or ") + Argument::Columns.with_placeholder();
        Ok(self
            .refuse(expected, &reasons(&self.left_out))
            .offering(offer))
    }

    /// The refusal of columns that may be values, or counts, or errors that are lost: only the user
    /// can tell. Left out, a lost order would pass.
    fn refuse_undecided(
        &self,
        errors: &[usize],
        values: &[usize],
        Undecided { limits, counts }: &Undecided,
    ) -> InputError {
        let found = match limits.first() {
            Some(limit) => format!(
                "{}, which tends to a limit: a value, or an error that no longer falls",
                self.quoted(&[*limit])
            ),
            None => format!(
                "{}, whole numbers that grow: a count, or an error that grows",
                self.quoted(&counts[..1])
            ),
        };
        let expected = Argument::Values.with_placeholder()
            + " or "
            + Argument::Columns.with_placeholder()
            + " to say what each column holds";
        let comment = match (limits.len(), counts.len()) {
            (1.., 1..) => "if they are values and counts",
            (1.., _) => "if it is a value",
            _ => "if it is a count",
        };
        let as_others = self.choice.offer(comment, |choice| {
            choice.values = self.names(&[values, limits].concat());
            if !counts.is_empty() && !errors.is_empty() {
                choice.columns = Some(self.names(errors));
            }
        });
        let all = [errors, limits, counts].concat();
        let as_errors = self.choice.offer("if it is an error", |choice| {
            choice.columns = Some(self.names(&all));
        });
        self.refuse(expected, &found)
            .offering([as_others, as_errors])
    }

    /// What a column holds, by what its cells are, by the rates that it may print, and by its name.
    fn content(&self, k: usize, step: &Step, steps: &[f64]) -> Result<Content, InputError> {
        let column = &self.columns[k];
        if column.is_claimed {
            return Ok(Content::Error);
        }
        match column.holdings() {
            Holdings::Nothing => return Ok(Content::named("no number")),
            Holdings::States => return Ok(Content::checked("states")),
            Holdings::Words if names::is_group(&column.name) => {
                return Ok(Content::checked("words"));
            }
            Holdings::Words => return Ok(Content::named("words")),
            Holdings::Numbers | Holdings::NumbersAndWords => {}
        }
        if column.is_index && (self.is_reversed || !column.falls()) {
            return Ok(Content::checked("the number of the row"));
        }
        if let Some(derived) = self.derived(k, step.column, steps) {
            return Ok(derived);
        }
        if column.is_constant() && column.is_without_point() && column.may_be_parameter() {
            return Ok(
                if names::is_group(&column.name) && column.word != Word::Rate {
                    Content::checked("the same in each row")
                } else {
                    Content::named("the same in each row")
                },
            );
        }
        self.content_by_name(k, step, steps)
    }

    /// What a column holds by its name, where its numbers agree.
    fn content_by_name(&self, k: usize, step: &Step, steps: &[f64]) -> Result<Content, InputError> {
        let column = &self.columns[k];
        let Some(noun) = column.word.noun() else {
            return Ok(match column.word {
                Word::Error => Content::Error,
                _ => Self::unknown(column, steps),
            });
        };
        let is_set_aside = match column.word {
            Word::Logarithm if self.is_logarithm(column, k) => return Ok(Content::checked(noun)),
            Word::Logarithm => return Err(self.refuse_logarithm(column)),
            Word::Rate if column.is_steep() => return Ok(Content::Error),
            Word::Rate => {
                let last = column.values.iter().rev().find(|v| v.is_finite());
                return Ok(last.map_or_else(
                    || Content::named(noun),
                    |last| {
                        let last = plain_text(*last);
                        Content::Rates(format!("{noun}, but of no column: {last}"))
                    },
                ));
            }
            // A pressure may be named like a degree.
            Word::Group if !column.is_constant() => return Ok(Content::Error),
            Word::Step | Word::Count(_) if self.is_other_step(column, step) => true,
            Word::Step if column.is_in_proportion(&self.columns[step.column]) => {
                return Ok(Content::checked(noun));
            }
            Word::Step if column.is_constant() => {
                return Ok(Content::named("the same in each row"));
            }
            Word::Count(_) if column.is_count_over(steps) => return Ok(Content::checked(noun)),
            Word::Value => return Ok(self.value(k, steps)),
            Word::Cost if column.is_cost() => true,
            Word::Count(_) | Word::Cost | Word::State => {
                column.is_without_point() && !column.falls()
            }
            _ => false,
        };
        Ok(match is_set_aside {
            true => Content::named(noun),
            // No column is undecided where orders are claimed by name.
            false if !self.choice.claimed.is_empty() => Content::Error,
            false => Self::unknown(column, steps),
        })
    }

    /// Whether a column is a step of the family that was not chosen: in time beside one in space.
    fn is_other_step(&self, column: &Cells<'_>, step: &Step) -> bool {
        let own = Family::of(column);
        let chosen = Family::of(&self.columns[step.column]);
        step.is_chosen && own.is_some() && chosen.is_some() && own != chosen
    }

    /// What a column holds that is named like a value, or like what a value tends to.
    fn value(&self, k: usize, steps: &[f64]) -> Content {
        let column = &self.columns[k];
        let named = |word: Word| self.columns.iter().filter(move |one| one.word == word);
        for error in named(Word::Error) {
            let other = named(Word::Value).find(|other| column.is_off_by(other, error));
            if other.is_some() || column.is_off_a_constant_by(error) {
                return Content::checked(format!("a value, whose error is `{}`", error.name));
            }
        }
        match self.choice.claimed.is_empty() {
            true => Self::unknown(column, steps),
            false => Content::Error,
        }
    }

    /// Whether a column has the logarithms of another, to its digits.
    fn is_logarithm(&self, column: &Cells<'_>, k: usize) -> bool {
        let others = self.columns.iter().enumerate();
        let mut others = others
            .filter(|(other, _)| *other != k)
            .map(|(_, cells)| cells);
        others.any(|other| column.is_logarithm_of(other))
    }

    /// What a column holds whose name does not say it.
    fn unknown(column: &Cells<'_>, steps: &[f64]) -> Content {
        if column.counts_meshes(steps) {
            return Content::checked("a count");
        }
        let levels = steps.iter().zip(&column.values);
        let levels = levels.map(|(step, value)| Level {
            step: *step,
            error: *value,
        });
        let levels: Vec<Level> = levels.filter(|level| level.error.is_finite()).collect();
        let is_whole = levels.iter().all(|level| level.error.fract() == 0.0);
        let grows = levels.windows(2).all(|two| two[0].error < two[1].error);
        if is_whole && grows && levels.len() > 1 {
            return Content::Growth;
        }
        // What stands still is an error that has lost its order.
        let finest = levels.windows(2).next_back();
        let moves = finest.is_some_and(|two| two[0].error != two[1].error);
        let limit = Tendency::limit(&levels).filter(|_| moves && !is_whole);
        limit.map_or(Content::Error, |limit| {
            Content::Limit(format!(
                "tends to {}: a value, not an error",
                plain_text(limit)
            ))
        })
    }

    /// The rates or factors of another column, if a column has them: over the steps, or over any of
    /// the counts.
    fn derived(&self, k: usize, step: usize, steps: &[f64]) -> Option<Content> {
        let column = &self.columns[k];
        if column.word != Word::Rate && names::is_error(&column.name) {
            return None;
        }
        let over_counts = self.columns.iter().enumerate().filter(|(count, cells)| {
            *count != k
                && *count != step
                && matches!(cells.word, Word::Count(_))
                && cells.is_count_over(steps)
        });
        let over_counts = over_counts.take(COUNTS).flat_map(|(_, cells)| {
            DIMENSIONS.map(|dim| {
                let counts = cells.values.iter();
                counts.map(|count| count.powf(-1.0 / dim)).collect()
            })
        });
        // Rates over another ladder than the steps say nothing about them.
        let over_counts = over_counts.filter(|other: &Vec<f64>| are_one_ladder(other, steps));
        let mut all_steps = [steps.to_vec()].into_iter().chain(over_counts);
        let Derivation { error, derived } =
            all_steps.find_map(|steps: Vec<f64>| self.derivation(k, step, &steps))?;
        let error = &self.columns[error];
        Some(match derived {
            // Errors that are halved have the rate 1 and the factor 2.
            Derived::Factors if column.word == Word::Rate => Content::checked(format!(
                "factors by which `{}` falls, not its rates",
                error.name
            )),
            Derived::Factors => {
                Content::checked(format!("the factors by which `{}` falls", error.name))
            }
            _ if column.word.noun().is_some() && column.is_constant() => {
                Content::checked("the same in each row")
            }
            _ => Content::checked(format!("the rates of `{}`", error.name)),
        })
    }
}

/// Whether steps fall by nearly the same factors as others.
fn are_one_ladder(own: &[f64], others: &[f64]) -> bool {
    let mut pairs = own.windows(2).zip(others.windows(2));
    pairs.all(|(a, b)| ((a[0] / a[1]).ln() / (b[0] / b[1]).ln() - 1.0).abs() < SAME_LADDER)
}
