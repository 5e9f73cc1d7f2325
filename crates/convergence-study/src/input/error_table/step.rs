//! Which column is the step, and of how many dimensions a count is.

use super::columns::{Reader, listed};
use super::words::{Meaning, argument, may_count, reciprocal};
use crate::input::InputError;

/// Largest relative difference of steps in two directions of one mesh, up to their ratio: what rounding to six digits leaves.
const PROPORTIONAL: f64 = 1e-5;

impl Reader<'_, '_> {
    /// The column of the step: the one asked for, named like a step, or like a count, or else the first; and what there is to say of it.
    pub(super) fn step(&self) -> Result<(usize, Option<String>), InputError> {
        if let Some(wanted) = &self.choice.step {
            return Ok((self.find(wanted, "--step")?, None));
        }
        let of = |wanted: &dyn Fn(Meaning) -> bool| -> Vec<usize> {
            let fits = |k: &usize| wanted(self.meanings[*k]) && !self.is_constant(*k) && !self.is_claimed(*k);
            (0..self.meanings.len()).filter(fits).collect()
        };
        let steps = of(&|meaning| meaning == Meaning::Step);
        match steps[..] {
            [only] => return self.not_counting(only, may_count(self.name(only))).map(|step| (step, None)),
            [] => {}
            [first, ..] if self.are_directions(&steps) => {
                let others: Vec<String> = steps[1..].iter().map(|k| format!("`{}`", self.name(*k))).collect();
                let note = format!("step: `{}`; in proportion to it: {}", self.name(first), listed(&others));
                return Ok((first, Some(note)));
            }
            _ => {
                let names: Vec<String> = steps.iter().map(|k| self.name(*k).to_owned()).collect();
                return Err(self.refuse("one column of steps, or --step COLUMN", &listed(&names)));
            }
        }
        let rank = |k: &usize| match self.meanings[*k] {
            Meaning::Count(rank) => rank,
            _ => u8::MAX,
        };
        if let Some(count) = of(&|meaning| matches!(meaning, Meaning::Count(_))).into_iter().min_by_key(rank) {
            return Ok((count, None));
        }
        // The place of a column says no more than that the step comes first.
        if self.meanings[0] != Meaning::Unknown || self.is_constant(0) || self.is_claimed(0) {
            return Err(self.without_step());
        }
        let note = format!("step: `{}`, the first column", self.name(0));
        self.not_counting(0, true).map(|step| (step, Some(note)))
    }

    fn without_step(&self) -> InputError {
        let described = |k: usize| {
            let name =
                if self.name(k).is_empty() { format!("column {}", k + 1) } else { format!("`{}`", self.name(k)) };
            match self.meanings[k] {
                Meaning::Index => name + " (the number of the row)",
                Meaning::Step if self.is_constant(k) => name + " (the same in each row)",
                Meaning::Logarithm => name + " (give the values, not their logarithms)",
                _ => name,
            }
        };
        let found: Vec<String> = (0..self.meanings.len()).map(described).collect();
        self.refuse("a column of steps: add `h`, or name it with --step", &listed(&found))
    }

    /// A column, unless its numbers are those of a count.
    ///
    /// * `may_count`: whether its name leaves that open.
    fn not_counting(&self, column: usize, may_count: bool) -> Result<usize, InputError> {
        if may_count && self.choice.dim.is_none() && self.counts(column) {
            let found = format!("`{}` with whole numbers, which counts have", self.name(column));
            return Err(self.refuse("a column of steps; --step COLUMN says which, --dim D that it counts", &found));
        }
        Ok(column)
    }

    /// Whether columns are the steps of one mesh in several directions: `dx` and `dy`, in proportion.
    fn are_directions(&self, columns: &[usize]) -> bool {
        let is_direction =
            |k: &usize| self.name(*k).starts_with(['d', 'h', 'Δ', 'δ']) && self.name(*k).ends_with(['x', 'y', 'z']);
        let ratio = |k: usize, row: usize| Some(self.number(row, k)? / self.number(row, columns[0])?);
        let in_proportion = |k: &usize| {
            let first = ratio(*k, 0).unwrap_or(f64::NAN);
            (0..self.grid.rows.len())
                .all(|row| ratio(*k, row).is_some_and(|ratio| (ratio / first - 1.0).abs() < PROPORTIONAL))
        };
        columns.iter().all(|k| is_direction(k) && in_proportion(k))
    }

    /// Whether all rows have the same in a column.
    pub(super) fn is_constant(&self, column: usize) -> bool {
        let mut cells = self.grid.rows.iter().map(|row| row.cells[column].text);
        self.grid.rows.len() > 1 && cells.next().is_some_and(|first| cells.all(|cell| cell == first))
    }

    /// Whether all numbers are whole and some are not small.
    pub(super) fn counts(&self, column: usize) -> bool {
        let value = |row| self.number(row, column);
        let rows = || 0..self.grid.rows.len();
        rows().all(|row| value(row).is_some_and(|value| value >= 1.0 && value.fract() == 0.0))
            && rows().any(|row| value(row).is_some_and(|value| value > 1.0))
    }

    /// The dimension for a column that counts; `None` for a step.
    pub(super) fn dim(&self, step: usize) -> Result<Option<f64>, InputError> {
        let (name, meaning) = (self.name(step), self.meanings[step]);
        if meaning == Meaning::Logarithm {
            return Err(self.refuse("the values, not their logarithms", &format!("`{name}`")));
        }
        let is_count = matches!(meaning, Meaning::Count(_));
        let inverse = reciprocal(name).is_some();
        match self.choice.dim {
            Some(dim) if is_count && inverse && dim != 1.0 => {
                Err(self.refuse("no --dim but 1", &format!("`{name}`, which is known to be of one dimension")))
            }
            Some(dim) if is_count || meaning != Meaning::Step || self.counts(step) => Ok(Some(dim)),
            Some(_) => Err(self.refuse("no --dim, which is for counts such as `cells`", &format!("the step `{name}`"))),
            // Steps in time have one dimension, and so has 1/h.
            None if is_count
                && (matches!(name.to_lowercase().as_str(), "steps" | "timesteps" | "time steps" | "nt") || inverse) =>
            {
                Ok(Some(1.0))
            }
            None if is_count => {
                let expected =
                    format!("--dim D for h = {name}^(-1/D), with D = 1 for cells along an edge, or --step COLUMN");
                Err(self.refuse(&expected, &format!("the count `{name}` and no step")))
            }
            None => Ok(None),
        }
    }

    /// What the step is, in a name.
    pub(super) fn label(&self, step: usize, dim: Option<f64>) -> String {
        let name = self.name(step);
        match dim {
            Some(1.0) => reciprocal(name).map_or_else(|| format!("1/{name}"), str::to_owned),
            Some(dim) => format!("{name}^(-1/{dim})"),
            None => name.to_owned(),
        }
    }

    /// Whether a column is the logarithm of another one.
    pub(super) fn repeats_logarithm(&self, column: usize) -> bool {
        argument(self.name(column)).is_some_and(|of| self.names.iter().any(|name| name.eq_ignore_ascii_case(of)))
    }
}
