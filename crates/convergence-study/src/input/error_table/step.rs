//! Which column is the step, or the count that it is computed from.

use super::columns::Cells;
use super::names::{Word, reciprocal};
use super::reader::{NEIGHBOURS, TableReader, listed};
use crate::input::InputError;
use crate::text::number::plain_text;

/// The step of a table.
pub(super) struct Step {
    pub(super) column: usize,
    /// The dimension, if the column counts.
    pub(super) dim: Option<f64>,
    /// Its name, or `cells^(-1/2)`.
    pub(super) label: String,
    /// How it was found, if its name does not say so.
    pub(super) how: String,
}

impl TableReader<'_> {
    pub(super) fn step(&self) -> Result<Step, InputError> {
        let (column, how) = match &self.choice.step {
            Some(wanted) => (self.find(wanted, "--step")?, String::new()),
            None => self.natural_step()?,
        };
        let (dim, name) = (self.dim(column)?, &self.columns[column].name);
        let label = match dim {
            Some(1.0) => reciprocal(name).map_or_else(|| format!("1/{name}"), str::to_owned),
            Some(dim) => format!("{name}^(-1/{dim})"),
            None => name.to_owned(),
        };
        Ok(Step { column, dim, label, how })
    }

    /// The step by its name, else the count closest to it, else the column that falls by regular ratios.
    fn natural_step(&self) -> Result<(usize, String), InputError> {
        let of = |wanted: fn(Word) -> bool| -> Vec<usize> {
            let is_free = |column: &Cells<'_>| wanted(column.word) && !column.is_claimed && !column.is_constant();
            (0..self.columns.len()).filter(|k| is_free(&self.columns[*k])).collect()
        };
        let steps = of(|word| word == Word::Step);
        if let [first, others @ ..] = &steps[..] {
            if let Some(other) = others.iter().find(|k| !self.columns[*first].is_in_proportion(&self.columns[**k])) {
                let found = self.names(&steps).join(", ") + &self.with_step(*first) + &self.with_step(*other);
                return Err(self.refuse("one column of steps, or --step COLUMN", &found));
            }
            let alike = format!(", in proportion to {}", self.quoted(others));
            return Ok((*first, if others.is_empty() { String::new() } else { alike }));
        }
        let rank = |k: &usize| if let Word::Count(rank) = self.columns[*k].word { rank } else { usize::MAX };
        if let Some(count) = of(|word| matches!(word, Word::Count(_))).into_iter().min_by_key(rank) {
            return Ok((count, String::new()));
        }
        // The only column of unknown name that falls by regular ratios; of several the first, unless another has a
        // smaller ratio.
        let first = self.columns.iter().position(|column| !column.is_index);
        let unknown = of(|word| word == Word::Unknown);
        let regular: Vec<_> = unknown.iter().filter_map(|k| Some((*k, self.columns[*k].regular()?))).collect();
        if let [(k, ratio), others @ ..] = &regular[..]
            && (others.is_empty() || Some(*k) == first && others.iter().all(|(_, other)| other >= ratio))
        {
            // A count beside its own step: `4 0.25`.
            let inverse = |other: &&(usize, f64)| self.columns[*k].is_inverse(&self.columns[other.0]);
            let k = others.iter().find(inverse).map_or(*k, |(other, _)| *other);
            return Ok((k, format!(", by its ratio {}", plain_text((1e4 * ratio).round() / 1e4))));
        }
        let described = |column: &Cells<'_>| {
            let why = match column.word {
                _ if column.is_index => " (the number of the row)",
                Word::Logarithm => " (give the values, not their logarithms)",
                Word::Step => " (the same in each row)",
                _ => "",
            };
            format!("`{}`{why}", column.name)
        };
        let command = first.filter(|k| unknown.contains(k) && !self.columns[*k].is_number.contains(&false));
        let found = listed(self.columns.iter().map(described)) + &command.map_or(String::new(), |k| self.with_step(k));
        Err(self.refuse("a column of steps: add `h`, or name it with --step", &found))
    }

    /// The command with a column as the step.
    fn with_step(&self, column: usize) -> String {
        let name = self.columns[column].name.trim_start_matches("column ").to_owned();
        let dim = self.choice.dim.or(self.is_count(column).then_some(1.0));
        self.choice.command(|choice| (choice.step, choice.dim) = (Some(name), dim))
    }

    /// The dimension for a column that counts; `None` for a step.
    fn dim(&self, step: usize) -> Result<Option<f64>, InputError> {
        let Cells { name, word, .. } = &self.columns[step];
        let is_edge = reciprocal(name).is_some() || name.to_lowercase().ends_with("steps") || name == "nt";
        let is_count = self.is_count(step);
        let with = |dim: Option<f64>| self.choice.command(|choice| choice.dim = dim);
        let (expected, found) = match self.choice.dim {
            _ if *word == Word::Logarithm => ("the values, not their logarithms", format!("`{name}`")),
            Some(dim) if is_count && is_edge && dim != 1.0 => {
                ("no --dim but 1", format!("`{name}`, which is known to be of one dimension{}", with(None)))
            }
            Some(_) if !is_count && *word != Word::Unknown => {
                ("no --dim, which is for counts such as `cells`", format!("the step `{name}`{}", with(None)))
            }
            None if is_count && is_edge && matches!(word, Word::Count(_)) => return Ok(Some(1.0)),
            None if is_count => {
                let [edge, plane, space] = [1.0, 2.0, 3.0].map(|dim| with(Some(dim)));
                let commands = match word {
                    Word::Step => edge,
                    _ if edge.is_empty() => edge,
                    _ => format!("{edge}  # along an edge{plane}  # all, in the plane{space}  # all, in space"),
                };
                let expected =
                    format!("--dim D for h = {name}^(-1/D), with D = 1 for cells along an edge, or --step COLUMN");
                return Err(self.refuse(&expected, &format!("the count `{name}` and no step{commands}")));
            }
            dim => return Ok(dim),
        };
        Err(self.refuse(expected, &found))
    }

    /// Whether a column counts: by its name, or because it has whole numbers that grow while errors fall.
    fn is_count(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        // The number of columns that fall with it, minus those that grow or, like it, are undecided.
        let alike = |other: &Cells<'_>| match other.is_whole() || other.values.iter().any(|value| !(*value > 0.0)) {
            true => -1.0,
            false => cells.together(other).signum(),
        };
        let near = (0..self.columns.len().min(NEIGHBOURS)).filter(|k| *k != column).map(|k| &self.columns[k]);
        let together = near.filter(|other| !other.is_number.contains(&false)).map(alike).sum::<f64>();
        match cells.word {
            Word::Count(_) => true,
            _ if !cells.is_whole() || cells.values.iter().all(|value| *value == 1.0) => false,
            Word::Step => together < 1.0,
            _ => together <= 1.0,
        }
    }
}
