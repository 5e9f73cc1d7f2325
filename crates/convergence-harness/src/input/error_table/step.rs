//! Which column is the step, or the count or level that it is computed from.

use super::columns::Cells;
use super::names::{Word, reciprocal};
use super::reader::{NEIGHBOURS, Offer, Refusal, TableReader, listed};
use crate::text::number::plain_text;

/// The step of a table.
pub(super) struct Step {
    pub(super) column: usize,
    pub(super) measure: Measure,
    /// Its name, `cells^(-1/2)` or `2^(-level)`.
    pub(super) label: String,
    /// How it was found, if its name does not say so.
    pub(super) how: String,
}

/// What the column of the step holds.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Measure {
    /// The step h.
    Step,
    /// A count in D dimensions: h = count^(-1/D).
    Count(f64),
    /// The number of a level, with the ratio R of steps: h = R^(-level).
    Level(f64),
}

impl Measure {
    /// The step of a number of the column; the numbers expected if it is none of them.
    pub(super) fn step(self, value: f64) -> Result<f64, &'static str> {
        let is_positive = value > 0.0 && value.is_finite();
        match self {
            Self::Step if is_positive => Ok(value),
            Self::Step => Err("a step, a finite number > 0"),
            Self::Count(dim) if is_positive => Ok(value.powf(-1.0 / dim)),
            Self::Count(_) => Err("a count, a finite number > 0"),
            Self::Level(ratio) if value >= 0.0 && value.fract() == 0.0 => Ok(ratio.powf(-value)),
            Self::Level(_) => Err("a level, a whole number from 0"),
        }
    }
}

impl TableReader<'_> {
    pub(super) fn step(&self) -> Result<Step, Refusal> {
        let (column, how) = match &self.choice.step {
            Some(wanted) => (self.find(wanted, "--step")?, String::new()),
            None if self.choice.ratio.is_some() => (self.levels()?, String::new()),
            None => self.natural_step()?,
        };
        let (measure, by_rates) = self.measure(column)?;
        let how = how + &by_rates;
        let name = &self.columns[column].name;
        let label = match measure {
            Measure::Step => name.to_owned(),
            Measure::Count(1.0) => {
                reciprocal(name).map_or_else(|| format!("1/{name}"), str::to_owned)
            }
            Measure::Count(dim) => format!("{name}^(-1/{dim})"),
            Measure::Level(ratio) => format!("{ratio}^(-{name})"),
        };
        Ok(Step {
            column,
            measure,
            label,
            how,
        })
    }

    /// The column that numbers the levels: one named so rather than any that counts the rows, or the
    /// rows themselves where no column is a step.
    fn levels(&self) -> Result<usize, Refusal> {
        if let Some(rows) = self.rows
            && (self.columns.len() == 2 || self.natural_step().is_err())
        {
            return Ok(rows);
        }
        let counts = |is_named: bool| {
            self.columns
                .iter()
                .position(|column| column.is_index && (column.word == Word::Cost || !is_named))
        };
        counts(true).or_else(|| counts(false)).ok_or_else(|| {
            let printed = self.columns[..self.rows.unwrap_or(self.columns.len())].iter();
            let found = listed(printed.map(|column| format!("`{}`", column.name)));
            let expected = "a column of levels 0, 1, 2, ... for --ratio, or --step COLUMN";
            Refusal::from(self.refuse(expected, &found))
                .offering([self.offer(|choice| choice.ratio = None)])
        })
    }

    /// The columns that may be the step, by what their names say.
    fn free(&self, wanted: impl Fn(usize, Word) -> bool) -> Vec<usize> {
        let is_free = |column: &Cells<'_>| !column.is_claimed && !column.is_constant();
        let columns = self.columns.iter().enumerate();
        columns
            .filter(|(k, column)| is_free(column) && wanted(*k, column.word))
            .map(|(k, _)| k)
            .collect()
    }

    /// The level whose ratio the rates of the table decide.
    fn level_with_rates(&self) -> Option<usize> {
        let is_level = |column: &Cells<'_>| column.is_index && column.word == Word::Cost;
        let level = self.columns.iter().position(is_level)?;
        self.stated_ratio(level).map(|_| level)
    }

    /// The step by its name, else the count closest to it, else the column that falls by regular
    /// ratios.
    fn natural_step(&self) -> Result<(usize, String), Refusal> {
        let steps = self.free(|k, word| word == Word::Step || self.is_misnamed(k));
        if let [first, others @ ..] = &steps[..] {
            if let Some(other) = others
                .iter()
                .find(|k| !self.columns[*first].is_in_proportion(&self.columns[**k]))
            {
                let refusal = self.refuse(
                    "one column of steps, or --step COLUMN",
                    &self.names(&steps).join(", "),
                );
                return Err(
                    Refusal::from(refusal).offering([*first, *other].map(|k| self.with_step(k)))
                );
            }
            let alike = format!(", in proportion to {}", self.quoted(others));
            return Ok((
                *first,
                if others.is_empty() {
                    String::new()
                } else {
                    alike
                },
            ));
        }
        let rank = |k: &usize| {
            if let Word::Count(rank) = self.columns[*k].word {
                rank
            } else {
                usize::MAX
            }
        };
        let counts = self.free(|_, word| matches!(word, Word::Count(_)));
        match counts.into_iter().min_by_key(rank) {
            Some(count) if self.choice.dim.is_none() && self.falls_like_a_step(count) => {
                let name = &self.columns[count].name;
                let found =
                    format!("`{name}`, which has the name of a count and falls with the errors");
                let refusal = self.refuse(
                    &format!("--step COLUMN, or --dim D for h = {name}^(-1/D)"),
                    &found,
                );
                let edge = self.offer(|choice| choice.dim = Some(1.0));
                Err(Refusal::from(refusal).offering([self.with_step(count), edge]))
            }
            Some(count) => Ok((count, String::new())),
            None => self.regular_step(),
        }
    }

    /// The only column of unknown name that falls by regular ratios; of several the first, unless
    /// another has a smaller ratio.
    fn regular_step(&self) -> Result<(usize, String), Refusal> {
        let first = self.columns.iter().position(|column| !column.is_index);
        let unknown = self.free(|k, word| word == Word::Unknown && !self.columns[k].is_index);
        let regular: Vec<_> = unknown
            .iter()
            .filter_map(|k| Some((*k, self.columns[*k].regular()?)))
            .collect();
        if let [(k, ratio), others @ ..] = &regular[..]
            && (others.is_empty()
                || Some(*k) == first && others.iter().all(|(_, other)| other >= ratio))
        {
            // A count beside its own step: `4 0.25`.
            let inverse =
                |other: &&(usize, f64)| self.columns[*k].is_inverse(&self.columns[other.0]);
            let k = others.iter().find(inverse).map_or(*k, |(other, _)| *other);
            return Ok((
                k,
                format!(", by its ratio {}", plain_text((1e4 * ratio).round() / 1e4)),
            ));
        }
        if let Some(level) = self.level_with_rates() {
            return Ok((level, String::new()));
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
        let is_level = |column: &Cells<'_>| column.is_index && column.word == Word::Cost;
        let halved = Offer {
            comment: "if each level halves the step",
            ..self.offer(|choice| choice.ratio = Some(2.0))
        };
        let named = first
            .filter(|k| unknown.contains(k))
            .map(|k| self.with_step(k));
        let halved = self.columns.iter().any(is_level).then_some(halved);
        let found = listed(self.columns.iter().map(described));
        let refusal = self.refuse("a column of steps: add `h`, or name it with --step", &found);
        let by_rows = Offer {
            comment: "if each row halves the step",
            ..self.offer(|choice| choice.ratio = Some(2.0))
        };
        let is_power = |column: &Cells<'_>| {
            let base = column.name.split_once('^');
            base.is_some_and(|(base, _)| Word::of(base) == Word::Step)
        };
        let is_error = |column: &Cells<'_>| column.word == Word::Error && column.is_steep();
        let by_rows = (named.is_none() && halved.is_none())
            .then_some(by_rows)
            .filter(|_| self.columns.iter().any(is_error) && !self.columns.iter().any(is_power));
        Err(Refusal::from(refusal).offering(named.into_iter().chain(halved).chain(by_rows)))
    }

    /// The command with a column as the step.
    fn with_step(&self, column: usize) -> Offer {
        let name = self.columns[column]
            .name
            .trim_start_matches("column ")
            .to_owned();
        let dim = self.choice.dim.or(self.is_count(column).then_some(1.0));
        self.offer(|choice| (choice.step, choice.dim) = (Some(name), dim))
    }

    /// What the column of the step holds, and the rates that say so where no option does.
    fn measure(&self, step: usize) -> Result<(Measure, String), Refusal> {
        let Cells { name, word, .. } = &self.columns[step];
        let is_edge =
            reciprocal(name).is_some() || name.to_lowercase().ends_with("steps") || name == "nt";
        let is_count = self.is_count(step);
        let (expected, found) = match (self.choice.dim, self.choice.ratio) {
            _ if *word == Word::Logarithm => {
                ("the values, not their logarithms", format!("`{name}`"))
            }
            (Some(_), Some(_)) => ("one of --dim and --ratio", "both".to_owned()),
            (None, Some(ratio)) => return Ok((Measure::Level(ratio), String::new())),
            (Some(dim), None) if is_count && is_edge && dim != 1.0 => (
                "no --dim but 1",
                format!("`{name}`, which is known to be of one dimension"),
            ),
            (Some(_), None) if !is_count && *word != Word::Unknown => (
                "no --dim, which is for counts such as `cells`",
                format!("the step `{name}`"),
            ),
            (None, None) if is_count && is_edge && matches!(word, Word::Count(_)) => {
                return Ok((Measure::Count(1.0), String::new()));
            }
            (None, None) if is_count => {
                let stated = self
                    .stated_dimension(step)
                    .ok_or_else(|| self.without_dimension(step))?;
                let how = format!(", as the rates of `{}` say", stated.error);
                return Ok((Measure::Count(stated.number), how));
            }
            (None, None) if self.level_with_rates() == Some(step) => {
                let stated = self
                    .stated_ratio(step)
                    .ok_or_else(|| self.without_dimension(step))?;
                let how = format!(", as the rates of `{}` say", stated.error);
                return Ok((Measure::Level(stated.number), how));
            }
            (dim, None) => {
                let measure = dim.map_or(Measure::Step, Measure::Count);
                return Ok((measure, String::new()));
            }
        };
        Err(Refusal::from(self.refuse(expected, &found))
            .offering([self.offer(|choice| choice.dim = None)]))
    }

    /// The refusal of a count without its dimension: regular columns, which may be the step, are
    /// offered first.
    fn without_dimension(&self, count: usize) -> Refusal {
        let Cells { name, word, .. } = &self.columns[count];
        let is_step =
            |k: &usize| *k != count && self.columns[*k].regular().is_some() && !self.is_count(*k);
        let steps = self
            .free(|_, word| word == Word::Unknown)
            .into_iter()
            .filter(is_step);
        let comments: &[&str] = if *word == Word::Step {
            &[""]
        } else {
            &["along an edge", "all, in the plane", "all, in space"]
        };
        let dims = comments.iter().zip([1.0, 2.0, 3.0]);
        let dims = dims.map(|(comment, dim)| Offer {
            comment,
            ..self.offer(|choice| choice.dim = Some(dim))
        });
        let expected = format!(
            "--dim D for h = {name}^(-1/D), with D = 1 for cells along an edge, or --step COLUMN"
        );
        let refusal = self.refuse(&expected, &format!("the count `{name}` and no step"));
        Refusal::from(refusal).offering(steps.map(|k| self.with_step(k)).chain(dims))
    }

    /// Whether a column counts: by its name, or because it has whole numbers that grow while errors
    /// fall.
    fn is_count(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        // The number of columns that fall with it, minus those that grow or, like it, are
        // undecided.
        let alike = |other: &Cells<'_>| match other.is_whole()
            || other.values.iter().any(|value| !(*value > 0.0))
        {
            true => -1.0,
            false => cells.together(other).signum(),
        };
        let near = self
            .near(column)
            .filter(|other| !other.is_number.contains(&false));
        let together = || near.map(alike).sum::<f64>();
        match cells.word {
            Word::Count(_) if self.choice.dim.is_some() => !self.is_misnamed(column),
            Word::Count(_) => !self.is_misnamed(column) && !self.falls_like_a_step(column),
            _ if !cells.is_whole() || cells.values.iter().all(|value| *value == 1.0) => false,
            Word::Step => together() < 1.0,
            _ => together() <= 1.0,
        }
    }

    /// Whether a column has the name of a count and numbers of a step: they fall with the errors,
    /// or are below 1, and are not whole. (Thousands of unknowns may be below 1, but grow.)
    fn is_misnamed(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        if !matches!(cells.word, Word::Count(_)) || cells.is_whole() {
            return false;
        }
        let with_errors = self.with_errors(column);
        with_errors > 0.0 || with_errors == 0.0 && cells.values.iter().any(|value| *value < 1.0)
    }

    /// Whether a column has the name of a count and whole numbers that fall with the errors. If
    /// they are a count after all, the errors grow: only the user can tell.
    fn falls_like_a_step(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        matches!(cells.word, Word::Count(_)) && cells.is_whole() && self.with_errors(column) > 0.0
    }

    /// The number of columns of errors, by name or else of unknown name, that fall with a column,
    /// minus those that do not.
    fn with_errors(&self, column: usize) -> f64 {
        let cells = &self.columns[column];
        let is_error =
            |word: Word| move |other: &&Cells<'_>| other.word == word && !other.is_whole();
        let signs = |word: Word| -> Vec<f64> {
            let others = self.near(column).filter(is_error(word));
            let others = others.filter(|other| other.values.iter().all(|value| *value > 0.0));
            others.map(|other| cells.together(other).signum()).collect()
        };
        let named = signs(Word::Error);
        if named.is_empty() {
            signs(Word::Unknown)
        } else {
            named
        }
        .iter()
        .sum()
    }

    /// The columns that are searched for errors of a step, without the step.
    fn near(&self, column: usize) -> impl Iterator<Item = &Cells<'_>> {
        let near = self.columns.iter().take(NEIGHBOURS).enumerate();
        near.filter(move |(k, _)| *k != column)
            .map(|(_, cells)| cells)
    }
}
