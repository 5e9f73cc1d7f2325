//! Which columns are errors, values and rates: decided by their numbers, and by their names if the
//! numbers do not decide.

use std::collections::HashSet;
use std::hash::Hash;

use super::columns::{Cells, Derived, Trend};
use super::names::Word;
use super::pairs::RawTable;
use super::reader::{NEIGHBOURS, Refusal, TableReader, listed};
use super::step::{Measure, Step};
use super::{Choice, Column, RateTable, names, text};
use crate::input::{Complaint, InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::number::plain_text;

/// What an unchosen column holds; if it is not an error, why.
enum Holds {
    Error,
    Value(String),
    Other(String),
    /// Possibly an error that does not fall.
    Doubtful(String),
}

/// The first key whose name an earlier key has. Tables may have many thousand columns: no name is
/// compared with all others.
fn repeated<K: Copy, N: Eq + Hash>(
    mut keys: impl Iterator<Item = K>,
    name: impl Fn(K) -> N,
) -> Option<K> {
    let mut seen = HashSet::new();
    keys.find(|key| !seen.insert(name(*key)))
}

/// Reads the step and the chosen errors. A refusal has the commands that read the table and find
/// its claimed columns.
pub(super) fn read(text: &str, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let table = text::read(text);
    let reads = |choice: &Choice| {
        let read = attempt(text, file, choice, &table).ok();
        let has = |read: &RateTable, name: &str| {
            let names = read
                .columns
                .iter()
                .chain(&read.values)
                .map(|column| column.name.as_str());
            names::position(names, name).is_some()
        };
        read.is_some_and(|read| choice.claimed.iter().all(|name| has(&read, name)))
    };
    attempt(text, file, choice, &table).map_err(|Refusal { error, offers }| {
        let offers = offers
            .iter()
            .filter(|offer| !offer.choice.command.is_empty() && reads(&offer.choice));
        let comment = |comment: &str| {
            if comment.is_empty() {
                String::new()
            } else {
                format!("  # {comment}")
            }
        };
        let commands: String = offers
            .map(|offer| format!("\n  {}{}", offer.choice.line(), comment(offer.comment)))
            .collect();
        if commands.is_empty() {
            return error;
        }
        let reason = error.complaint.to_string() + &commands;
        InputError {
            complaint: Box::new(Complaint::Invalid { reason }),
            ..error
        }
    })
}

/// The k-th column over the steps.
///
/// * `step_halves`: half the last digit of each step as printed; 0 where it is known exactly.
fn column(
    reader: &TableReader<'_>,
    k: usize,
    steps: &[f64],
    step_halves: &[f64],
) -> Result<Column, InputError> {
    let Cells { name, halves, .. } = &reader.columns[k];
    let level = |(row, step): (usize, &f64)| {
        Ok(Level {
            step: *step,
            error: reader.must(row, k)?,
        })
    };
    let levels = steps.iter().enumerate().map(level);
    Ok(Column {
        name: name.clone(),
        levels: levels.collect::<Result<_, InputError>>()?,
        halves: halves.clone(),
        step_halves: step_halves.to_vec(),
    })
}

/// Reads a table with one choice.
fn attempt(
    text: &str,
    file: &str,
    choice: &Choice,
    table: &RawTable<'_>,
) -> Result<RateTable, Refusal> {
    let mut reader = TableReader::new(text, file, choice, table)?;
    let step = reader.step()?;
    let steps = reader.sort(&step)?;
    let [errors, values] = reader.chosen(step.column)?;
    let (errors, others) = match choice.columns {
        Some(_) => (errors, vec![]),
        None => (
            reader.found(&step, &steps, &values)?,
            std::mem::take(&mut reader.left_out),
        ),
    };
    if let Some(&twice) = repeated(errors.iter().chain(&values), |k| &reader.columns[*k].name) {
        return Err(reader.twice(twice));
    }
    let is_exact = step.measure != Measure::Step || reader.columns[step.column].regular().is_some();
    let step_halves = if is_exact {
        vec![0.0; steps.len()]
    } else {
        reader.columns[step.column].halves.clone()
    };
    let column = |&k: &usize| column(&reader, k, &steps, &step_halves);
    let parts = [
        ("errors", reader.quoted(&errors)),
        ("values", reader.quoted(&values)),
        ("left out", reasons(&others)),
    ];
    let parts = parts
        .iter()
        .filter(|(_, list)| !list.is_empty())
        .map(|(what, list)| format!("; {what}: {list}"));
    Ok(RateTable {
        reading: format!(
            "step: `{}`{}{}",
            step.label,
            step.how,
            parts.collect::<String>()
        ),
        columns: errors
            .iter()
            .map(column)
            .collect::<Result<_, InputError>>()?,
        values: values
            .iter()
            .map(column)
            .collect::<Result<_, InputError>>()?,
        not_errors: others,
        is_guessed: !step.how.is_empty(),
        step: step.label,
    })
}

/// Columns that are not errors, each with the reason.
fn reasons(others: &[(String, String)]) -> String {
    listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")))
}

impl TableReader<'_> {
    /// The step of each row; sorts the rows by step, coarsest level first, as the judge requires.
    fn sort(
        &mut self,
        Step {
            column, measure, ..
        }: &Step,
    ) -> Result<Vec<f64>, InputError> {
        let cells = &self.columns[*column];
        let step = |row: usize| {
            measure.step(self.must(row, *column)?).map_err(|expected| {
                let found = format!("`{}`", shorten(cells.texts[row]));
                self.error(cells.texts[row], Some(&cells.name), expected, &found)
            })
        };
        let steps = (0..cells.texts.len())
            .map(step)
            .collect::<Result<Vec<f64>, _>>()?;
        let mut order: Vec<usize> = (0..steps.len()).collect();
        order.sort_by(|a, b| steps[*b].total_cmp(&steps[*a]));
        if let Some(two) = order.windows(2).find(|two| steps[two[0]] == steps[two[1]]) {
            let [before, cell] = [two[0], two[1]].map(|row| cells.texts[row]);
            let [first, second] =
                [before, cell].map(|cell| self.text[..self.offset(cell)].matches('\n').count() + 1);
            let found = format!("`{}` = {cell} in lines {first} and {second}", cells.name);
            return Err(self.error(
                cell,
                None,
                "each step once: give one table at a time",
                &found,
            ));
        }
        self.columns.iter_mut().for_each(|cells| cells.sort(&order));
        Ok(order.iter().map(|row| steps[*row]).collect())
    }

    /// The columns chosen as errors and as values.
    fn chosen(&self, step: usize) -> Result<[Vec<usize>; 2], InputError> {
        let find = |wanted: &[String], option: &str| {
            wanted
                .iter()
                .map(|name| self.find(name, option))
                .collect::<Result<Vec<usize>, _>>()
        };
        let values = find(&self.choice.values, "--values")?;
        let errors = find(
            self.choice.columns.as_deref().unwrap_or_default(),
            "--columns",
        )?;
        let mut seen = HashSet::from([step]);
        for k in errors.iter().chain(&values) {
            let (expected, what) = match self.columns[*k].word {
                _ if *k == step => ("errors for --columns", "the step "),
                _ if !seen.insert(*k) => ("each column of --columns and --values once", "twice "),
                Word::Logarithm => ("the values, not their logarithms", ""),
                _ => continue,
            };
            return Err(self.refuse(expected, &format!("{what}`{}`", self.columns[*k].name)));
        }
        Ok([errors, values])
    }

    /// The columns of errors; the others are left out, each with the reason. Refuses to judge
    /// without errors, or if a column may be an error but does not fall and no name says which
    /// columns are errors.
    fn found(
        &mut self,
        step: &Step,
        steps: &[f64],
        values: &[usize],
    ) -> Result<Vec<usize>, Refusal> {
        let mut errors = vec![];
        let mut limits = vec![];
        let mut doubtful = vec![];
        for k in (0..self.columns.len()).filter(|k| *k != step.column && !values.contains(k)) {
            let (columns, why) = match self.holds(k, step.column, steps)? {
                Holds::Error => (&mut errors, None),
                Holds::Value(why) => (&mut limits, Some(why)),
                Holds::Doubtful(why) => (&mut doubtful, Some(why)),
                Holds::Other(why) => (&mut vec![], Some(why)),
            };
            columns.push(k);
            self.left_out
                .extend(why.map(|why| (self.columns[k].name.clone(), why)));
        }
        let others = &self.left_out;
        let with_columns =
            |columns: &[usize]| self.offer(|choice| choice.columns = Some(self.names(columns)));
        let is_sure =
            |k: &usize| self.columns[*k].word == Word::Error || self.columns[*k].is_claimed;
        match doubtful.first() {
            _ if errors.is_empty() && values.is_empty() => {
                let is_open =
                    |column: &Cells<'_>| column.word.noun().is_none() && !column.is_number[0];
                if let Some(k) = self.columns.iter().position(is_open) {
                    self.must(0, k)?;
                }
                let offer = match doubtful.first() {
                    _ if !limits.is_empty() => {
                        Some(self.offer(|choice| choice.values = self.names(&limits)))
                    }
                    Some(first) => Some(with_columns(&[*first])),
                    None => None,
                };
                let refusal =
                    self.refuse("a column of errors, or --columns LIST", &reasons(others));
                Err(Refusal::from(refusal).offering(offer))
            }
            Some(first) if values.is_empty() && !errors.iter().any(is_sure) => {
                let name = &self.columns[*first].name;
                let why = others
                    .iter()
                    .find(|(other, _)| other == name)
                    .map_or("", |(_, why)| why);
                let found = format!("`{name}`, which is {why}");
                let refusal = self.refuse("--columns LIST to say which columns are errors", &found);
                let all = [errors.as_slice(), &doubtful].concat();
                Err(Refusal::from(refusal).offering([with_columns(&errors), with_columns(&all)]))
            }
            _ => Ok(errors),
        }
    }

    /// What a column holds, by its numbers and then by its name.
    fn holds(&self, k: usize, step: usize, steps: &[f64]) -> Result<Holds, InputError> {
        let column = &self.columns[k];
        let numbers = column
            .is_number
            .iter()
            .filter(|is_number| **is_number)
            .count();
        let other = |why: &str| Ok(Holds::Other(why.to_owned()));
        // Errors before it, the nearest first, and those after it.
        let near = (k.saturating_sub(NEIGHBOURS)..k)
            .rev()
            .chain(k + 1..(k + NEIGHBOURS).min(self.columns.len()));
        let mut near = near
            .filter(|near| *near != step)
            .map(|near| &self.columns[near]);
        let derived = near.find_map(|error| Some((error, column.derived_from(error, steps)?)));
        match (derived, column.word.noun()) {
            _ if column.is_claimed => Ok(Holds::Error),
            _ if numbers == 0 => other("no number"),
            _ if column.is_index => other("the number of the row"),
            // Errors that are halved have the rate 1 and the factor 2.
            (Some((error, Derived::Factors)), _) if column.word == Word::Rate => other(&format!(
                "factors by which `{}` falls, not its rates",
                error.name
            )),
            (Some((error, Derived::Factors)), _) => {
                other(&format!("the factors by which `{}` falls", error.name))
            }
            (_, Some(_)) if column.is_constant() => other("the same in each row"),
            (Some((error, _)), _) => other(&format!("the rates of `{}`", error.name)),
            _ if column.word == Word::Rate && column.is_steep() => Ok(Holds::Error),
            (None, Some(noun)) => other(noun),
            _ if numbers < steps.len() => match column.word {
                Word::Unknown if !column.is_number[0] && numbers + 1 == steps.len() => {
                    other("no number on the coarsest level")
                }
                Word::Unknown if 2 * numbers < steps.len() => other("words"),
                _ => {
                    (0..steps.len()).try_for_each(|row| self.must(row, k).map(|_| ()))?;
                    Ok(Holds::Error)
                }
            },
            _ if column.word == Word::Error
                || numbers < 3
                || column.values.iter().any(|value| value.is_nan()) =>
            {
                Ok(Holds::Error)
            }
            _ => Ok(match column.trend(&self.columns[step]) {
                Trend::Falls => Holds::Error,
                Trend::Grows => Holds::Other("whole numbers that do not fall".to_owned()),
                Trend::Limit(limit) => Holds::Value(format!(
                    "tends to {}: a value, not an error",
                    plain_text(limit)
                )),
                Trend::Doubtful(why) => Holds::Doubtful(why.to_owned()),
            }),
        }
    }

    fn twice(&self, column: usize) -> Refusal {
        let mut seen = HashSet::new();
        let numbered = self
            .columns
            .iter()
            .enumerate()
            .map(|(k, Cells { name, .. })| {
                if seen.insert(name) {
                    name.clone()
                } else {
                    format!("{name}_{}", k + 1)
                }
                .replace(',', ";")
            });
        let offer = self.offer(|choice| choice.names = Some(numbered.collect()));
        let found = format!("`{}` a second time", shorten(&self.columns[column].name));
        Refusal::from(self.error(self.head(column), None, "each name once", &found))
            .offering([offer])
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::hash::Hasher;

    use super::*;

    /// A name that counts how often it is compared.
    struct Counted<'c>(usize, &'c Cell<usize>);

    impl PartialEq for Counted<'_> {
        fn eq(&self, other: &Self) -> bool {
            self.1.set(self.1.get() + 1);
            self.0 == other.0
        }
    }

    impl Eq for Counted<'_> {}

    impl Hash for Counted<'_> {
        fn hash<H: Hasher>(&self, state: &mut H) {
            self.0.hash(state);
        }
    }

    #[test]
    fn a_name_is_not_compared_with_all_others() {
        let compared = Cell::new(0);
        let name = |k| Counted(k, &compared);
        assert_eq!(repeated([3, 1, 3, 1].into_iter(), name), Some(3));
        assert_eq!(repeated(0..20_000, name), None);
        // Each with all others: 2e8.
        assert!(compared.get() < 20_000, "{} comparisons", compared.get());
    }
}
