//! Which column is the step, or the count or level that it is computed from.

use super::Offer;
use super::columns::{Cells, DIMENSIONS, sign};
use super::families::is_edge;
use super::grid::Turned;
use super::names::{self, Word, reciprocal};
use super::reader::{HALVED_ROWS, NEIGHBOURS, TableReader, listed};
use super::stated::Stated;
use crate::input::InputError;
use crate::input::advice::{Argument, Text};
use crate::text::number::plain_text;

/// The step of a table.
pub(super) struct Step {
    pub(super) column: usize,
    pub(super) measure: Measure,
    /// Its name, `cells^(-1/2)` or `2^(-level)`.
    pub(super) label: String,
    /// How it was found, if its name does not say so.
    pub(super) how: String,
    /// Whether the user or printed rates have chosen it among others.
    pub(super) is_chosen: bool,
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

/// A column that is the step, or gives it.
pub(super) struct StepColumn {
    pub(super) column: usize,
    /// How it was identified, if its name does not say so.
    pub(super) how: String,
    /// Whether the user or printed rates have chosen it among others.
    pub(super) is_chosen: bool,
}

impl StepColumn {
    /// A column that needs no explanation.
    fn certain(column: usize) -> Self {
        Self::found(column, String::new())
    }

    fn found(column: usize, how: String) -> Self {
        Self {
            column,
            how,
            is_chosen: false,
        }
    }
}

/// A column with a constant ratio of its numbers.
struct RegularColumn {
    column: usize,
    ratio: f64,
}

/// What the column of the step holds, and how that was found if no option says so.
struct Measured {
    measure: Measure,
    how: String,
}

impl Measured {
    fn by_option(measure: Measure) -> Self {
        Self {
            measure,
            how: String::new(),
        }
    }

    fn by_rates(measure: Measure, error: &str) -> Self {
        Self {
            measure,
            how: format!(", as the rates of `{error}` say"),
        }
    }
}

impl TableReader<'_> {
    /// The step: the column chosen for it, the levels, or the column that its name or its numbers
    /// identify.
    pub(super) fn step(&self) -> Result<Step, InputError> {
        let StepColumn {
            column,
            how,
            is_chosen,
        } = match &self.choice.step {
            Some(wanted) => StepColumn {
                is_chosen: true,
                ..StepColumn::certain(self.find(wanted, Argument::Step)?)
            },
            None if self.ratio.is_some() => StepColumn::certain(self.levels()?),
            None => self.natural_step()?,
        };
        let Measured { measure, how: more } = self.measure(column)?;
        let how = how + &more + &self.adaptive(column, measure);
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
            is_chosen,
        })
    }

    /// What is said of counts of meshes that are refined in some places only.
    fn adaptive(&self, column: usize, measure: Measure) -> String {
        /// How much such counts grow from level to level.
        const GROWTH: std::ops::RangeInclusive<f64> = 1.8..=2.7;
        /// Largest difference between the factors of uniform refinement along an edge.
        const UNIFORM: f64 = 0.3;
        let mut counts = self.columns[column].values.clone();
        counts.sort_by(f64::total_cmp);
        let factors: Vec<f64> = counts.windows(2).map(|two| two[1] / two[0]).collect();
        let least = factors.iter().copied().fold(f64::INFINITY, f64::min);
        let most = factors.iter().copied().fold(0.0, f64::max);
        let is_adaptive = match measure {
            Measure::Count(1.0) => most - least > UNIFORM,
            Measure::Count(_) => true,
            Measure::Step | Measure::Level(_) => false,
        };
        if is_adaptive && GROWTH.contains(&least) && GROWTH.contains(&most) {
            let [least, most] = [least, most].map(|factor| (10.0 * factor).round() / 10.0);
            let range = if least < most {
                format!("{least} to {most}")
            } else {
                least.to_string()
            };
            format!(", whose counts grow by {range}, as along an edge or on adaptive meshes")
        } else {
            String::new()
        }
    }

    /// The column that numbers the levels: one named so rather than any that counts the rows, or the
    /// rows themselves where no column is a step.
    fn levels(&self) -> Result<usize, InputError> {
        let Some(rows) = self.rows else {
            let named = self.columns.iter().position(is_named_level);
            let index = self.columns.iter().position(|column| column.is_index);
            return Ok(named.or(index).unwrap_or(0));
        };
        let is_turned = self.turned.is_some();
        if self.columns.len() == 2 || is_turned || self.natural_step().is_err() {
            return Ok(rows);
        }
        let printed = self.columns[..rows].iter();
        let names = listed(printed.map(|column| format!("`{}`", column.name)));
        let expected = Text::from("a column of levels 0, 1, 2, ... for ")
            + Argument::Ratio.alone()
            + ", or "
            + Argument::Step.with_placeholder();
        let without_ratio = self.choice.offer("", |choice| choice.ratio = None);
        Err(self.refuse(expected, &names).offering([without_ratio]))
    }

    /// The columns that may be the step, of those that `accepts` selects by number and name.
    pub(super) fn candidates(&self, accepts: impl Fn(usize, Word) -> bool) -> Vec<usize> {
        let columns = self.columns.iter().enumerate();
        columns
            .filter(|(_, column)| !column.is_claimed && !column.is_constant())
            .filter(|(k, column)| accepts(*k, column.word))
            .map(|(k, _)| k)
            .collect()
    }

    /// The level whose ratio the rates of the table decide.
    fn level_with_rates(&self) -> Option<usize> {
        let level = self.columns.iter().position(is_named_level)?;
        self.stated_ratio(level).map(|_| level)
    }

    /// The step by its name, else the count closest to it, else the column that falls by regular
    /// ratios.
    fn natural_step(&self) -> Result<StepColumn, InputError> {
        if self.turned == Some(Turned::Stepped) {
            return Ok(StepColumn::certain(0));
        }
        if let Some(step) = self.step_of_families()? {
            return Ok(step);
        }
        let steps = self.candidates(|_, word| word == Word::Step);
        if let [first, others @ ..] = &steps[..] {
            if let Some(other) = others
                .iter()
                .find(|k| !self.columns[*first].is_in_proportion(&self.columns[**k]))
            {
                let expected =
                    Text::from("one column of steps, or ") + Argument::Step.with_placeholder();
                let refusal = self.refuse(expected, &listed(self.names(&steps).into_iter()));
                let offers = [*first, *other].map(|k| self.with_step_of_errors(k));
                return Err(refusal.offering(offers));
            }
            let how = if others.is_empty() {
                String::new()
            } else {
                format!(", in proportion to {}", self.quoted(others))
            };
            return Ok(StepColumn::found(*first, how));
        }
        let counts = self.candidates(|_, word| matches!(word, Word::Count(_)));
        let Some(count) = counts.into_iter().min_by_key(|k| self.rank(*k)) else {
            return self.regular_step();
        };
        if self.choice.dim.is_some() || !self.falls_like_a_step(count) {
            return Ok(StepColumn::certain(count));
        }
        let name = &self.columns[count].name;
        let found = format!("`{name}`, which has the name of a count and falls with the errors");
        let expected = Argument::Step.with_placeholder()
            + ", or "
            + Argument::Dim.with_placeholder()
            + format!(" for h = {name}^(-1/D)");
        let offers = [self.with_step(count), self.with_dim(1.0, "")];
        Err(self.refuse(expected, &found).offering(offers))
    }

    /// The rank of a column of counts among those that may give the step.
    fn rank(&self, column: usize) -> usize {
        match self.columns[column].word {
            Word::Count(rank) => rank,
            _ => usize::MAX,
        }
    }

    /// The only column of unknown name that falls by regular ratios; of several the first, unless
    /// another has a smaller ratio.
    fn regular_step(&self) -> Result<StepColumn, InputError> {
        let first = self.columns.iter().position(|column| !column.is_index);
        // The columns of a turned table are variables, of which none is a step.
        let unknown = self.candidates(|k, word| {
            word == Word::Unknown && !self.columns[k].is_index && self.turned.is_none()
        });
        let regular: Vec<RegularColumn> = unknown
            .iter()
            .filter_map(|k| {
                let ratio = self.columns[*k].regular()?;
                Some(RegularColumn { column: *k, ratio })
            })
            .collect();
        if let [RegularColumn { column, ratio }, others @ ..] = &regular[..]
            && (others.is_empty()
                || Some(*column) == first && others.iter().all(|other| other.ratio >= *ratio))
        {
            let how = format!(", by its ratio {}", plain_text((1e4 * ratio).round() / 1e4));
            return Ok(StepColumn::found(*column, how));
        }
        if let Some(level) = self.level_with_rates() {
            return Ok(StepColumn::certain(level));
        }
        let names = listed(self.columns.iter().map(name_with_reason));
        let expected =
            Text::from("a column of steps: add `h`, or name it with ") + Argument::Step.alone();
        let first = first.filter(|k| unknown.contains(k));
        let offer = match first {
            _ if self.columns.iter().any(is_named_level) => {
                let first = first.map(|k| self.with_step(k));
                let levels = self.choice.halved("if each level halves the step");
                return Err(self
                    .refuse(expected, &names)
                    .offering(first.into_iter().chain([levels])));
            }
            Some(first) => Some(self.with_step(first)),
            None => self
                .may_halve_rows()
                .then(|| self.choice.halved(HALVED_ROWS)),
        };
        Err(self.refuse(expected, &names).offering(offer))
    }

    /// Whether each row may halve a step that the table does not have: errors fall, and no column
    /// has other steps or orders.
    fn may_halve_rows(&self) -> bool {
        let falls = |column: &Cells<'_>| {
            (column.word == Word::Error || self.turned.is_some()) && column.is_steep()
        };
        self.columns.iter().any(falls)
            && !self.columns.iter().any(has_power_of_step)
            && !self.columns.iter().any(counts_orders)
    }

    /// The command with a column as the step.
    pub(super) fn with_step(&self, column: usize) -> Offer {
        let name = self.columns[column]
            .name
            .trim_start_matches("column ")
            .to_owned();
        let dim = self.choice.dim.or(self.is_count(column).then_some(1.0));
        self.choice
            .offer("", |choice| (choice.step, choice.dim) = (Some(name), dim))
    }

    /// The command with a column as the step, and those named like errors: another step of the same
    /// mesh may be an error.
    fn with_step_of_errors(&self, column: usize) -> Offer {
        let mut offer = self.with_step(column);
        let columns = 0..self.columns.len();
        let errors: Vec<usize> = columns
            .filter(|k| self.columns[*k].word == Word::Error)
            .collect();
        let is_free = self.choice.claimed.is_empty() && self.choice.columns.is_none();
        if is_free && !errors.is_empty() {
            offer.choice.columns = Some(self.names(&errors));
        }
        offer
    }

    /// The choice of this dimension.
    fn with_dim(&self, dim: f64, comment: &'static str) -> Offer {
        self.choice.offer(comment, |choice| choice.dim = Some(dim))
    }

    /// What the column of the step holds.
    fn measure(&self, step: usize) -> Result<Measured, InputError> {
        let Cells { name, word, .. } = &self.columns[step];
        let is_edge = is_edge(name);
        let is_count = self.is_count(step);
        let quoted = format!("`{name}`");
        if *word == Word::Logarithm {
            return Err(self.without_dim("the values, not their logarithms", &quoted));
        }
        match (self.choice.dim, self.ratio) {
            (Some(_), Some(_)) => {
                let both = Argument::Dim.alone() + " and " + Argument::Ratio.alone();
                Err(self.without_dim(Text::from("one of ") + both, "both"))
            }
            (None, Some(ratio)) => Ok(Measured {
                how: match self.choice.ratio {
                    Some(_) => String::new(),
                    None => ", as the rates between the errors say".to_owned(),
                },
                measure: Measure::Level(ratio),
            }),
            (Some(dim), None) if is_count && is_edge && dim != 1.0 => {
                let expected = Text::from("no ") + Argument::Dim.alone() + " but 1";
                let found = format!("{quoted}, which is known to be of one dimension");
                Err(self.without_dim(expected, &found))
            }
            (Some(_), None) if !is_count && *word != Word::Unknown => {
                let which = ", which is for counts such as `cells`";
                let expected = Text::from("no ") + Argument::Dim.alone() + which;
                Err(self.without_dim(expected, &format!("the step {quoted}")))
            }
            (Some(dim), None) => Ok(Measured::by_option(Measure::Count(dim))),
            (None, None) if is_count && is_edge && matches!(word, Word::Count(_)) => {
                Ok(Measured::by_option(Measure::Count(1.0)))
            }
            (None, None) if is_count => match self.stated_dimension(step) {
                Some(Stated { number, error }) => {
                    Ok(Measured::by_rates(Measure::Count(number), error))
                }
                None => Err(self.without_dimension(step)),
            },
            (None, None) => Ok(match self.stated_ratio(step) {
                Some(Stated { number, error }) if is_named_level(&self.columns[step]) => {
                    Measured::by_rates(Measure::Level(number), error)
                }
                _ => Measured::by_option(Measure::Step),
            }),
        }
    }

    /// A refusal that offers the choice without a dimension.
    fn without_dim(&self, expected: impl Into<Text>, found: &str) -> InputError {
        let offer = self.choice.offer("", |choice| choice.dim = None);
        self.refuse(expected, found).offering([offer])
    }

    /// The refusal of a count without its dimension: regular columns, which may be the step, are
    /// offered first.
    fn without_dimension(&self, count: usize) -> InputError {
        let Cells { name, word, .. } = &self.columns[count];
        let steps = self
            .candidates(|_, word| word == Word::Unknown)
            .into_iter()
            .filter(|k| *k != count && self.columns[*k].regular().is_some() && !self.is_count(*k));
        let comments: &[&str] = if *word == Word::Step {
            &[""]
        } else {
            &["along an edge", "all, in the plane", "all, in space"]
        };
        let dims = comments.iter().zip(DIMENSIONS);
        let dims = dims.map(|(comment, dim)| self.with_dim(dim, comment));
        let expected = Argument::Dim.with_placeholder()
            + format!(" for h = {name}^(-1/D), with D = 1 for cells along an edge, or ")
            + Argument::Step.with_placeholder();
        self.refuse(expected, &format!("the count `{name}` and no step"))
            .offering(steps.map(|k| self.with_step(k)).chain(dims))
    }

    /// Whether a column counts: by its name, or because it has whole numbers that grow while errors
    /// fall.
    fn is_count(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        if let Word::Count(_) = cells.word {
            return self.choice.dim.is_some() || !self.falls_like_a_step(column);
        }
        if !cells.is_whole() || cells.values.iter().all(|value| *value == 1.0) {
            return false;
        }
        let with_errors = self.with_errors(column);
        with_errors < 1.0 || cells.word != Word::Step && with_errors == 1.0
    }

    /// Whether a column has the name of a count and numbers that fall with the errors. If they are a
    /// count after all, the errors grow: only the user can tell.
    fn falls_like_a_step(&self, column: usize) -> bool {
        let cells = &self.columns[column];
        matches!(cells.word, Word::Count(_)) && self.with_errors(column) > 0.0
    }

    /// The number of columns of positive errors, by name or else of unknown name, that fall with a
    /// column, minus those that grow.
    fn with_errors(&self, column: usize) -> f64 {
        let cells = &self.columns[column];
        let near = self.columns.iter().take(NEIGHBOURS).enumerate();
        let others = near.filter(|(k, other)| *k != column && !other.is_whole());
        let others: Vec<&Cells<'_>> = others
            .filter(|(_, other)| other.values.iter().all(|value| *value > 0.0))
            .map(|(_, other)| other)
            .collect();
        let has_errors = others.iter().any(|other| other.word == Word::Error);
        let word = if has_errors {
            Word::Error
        } else {
            Word::Unknown
        };
        let errors = others.iter().filter(|other| other.word == word);
        errors.map(|other| sign(cells.together(other))).sum()
    }
}

/// Whether a column numbers the rows and has the name of a level.
fn is_named_level(column: &Cells<'_>) -> bool {
    column.is_index && column.word == Word::Cost
}

/// Whether a column is named after a power of the step: `h^2`.
fn has_power_of_step(column: &Cells<'_>) -> bool {
    let power = column.name.split_once('^');
    power.is_some_and(|(base, _)| Word::of(base) == Word::Step)
}

/// Whether a column has the orders of several methods, which are no levels: 2, 4, 6, 8.
fn counts_orders(column: &Cells<'_>) -> bool {
    let is_order = column.word == Word::Rate || names::is_group(&column.name);
    is_order && column.is_whole() && column.values.is_sorted_by(|a, b| a < b)
}

/// The name of a column in a message, with the reason why it is not the step.
fn name_with_reason(column: &Cells<'_>) -> String {
    let reason = match column.word {
        _ if counts_orders(column) => " (orders of methods, no steps)",
        _ if column.is_index => " (the number of the row)",
        Word::Logarithm => " (give the values, not their logarithms)",
        Word::Step => " (the same in each row)",
        _ => "",
    };
    format!("`{}`{reason}", column.name)
}
