//! Which column is the step and which are errors: by their numbers, and by their names where the numbers leave it open.

use std::collections::HashSet;
use std::f64::consts::LN_2;

use super::names::{self, Word, reciprocal};
use super::number::{Number, halves, number};
use super::text::{Cell, Grid};
use super::{Column, RateTable};
use crate::input::{Complaint, InputError, shorten};
use crate::judge::verdict::Level;
use crate::text::names::{did_you_mean, nearest};
use crate::text::number::{counted, plain_text};

/// Which columns of a table are meant; by default their numbers decide.
///
/// A column is named as in the table, with or without its unit, or by its number from 1.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Choice {
    /// The column of the step, or of the count that it is computed from.
    pub step: Option<String>,
    /// The columns of errors.
    pub columns: Option<Vec<String>>,
    /// Columns of values, which tend to a limit that is not zero.
    pub values: Vec<String>,
    /// Names for all columns, in place of those in the table.
    pub names: Option<Vec<String>>,
    /// Columns of which an order is claimed by name: none of them is taken for the step.
    pub claimed: Vec<String>,
    /// Dimension D > 0 of what a count counts: h = count^(-1/D).
    pub dim: Option<f64>,
    /// The command that reads the table, for advice; empty for none.
    pub command: String,
}

/// Most names that a message lists.
const LISTED: usize = 12;
/// Largest relative difference of two ratios that are the same, by their digits.
const SAME: f64 = 1e-5;
/// How far numbers that tend to a limit are from each other at most, as a ratio.
const NEAR: f64 = 1.5;
/// Rates are looked for among as many columns on either side.
const NEIGHBOURS: usize = 40;

/// A grid and what is asked of it.
struct Reader<'g, 't> {
    grid: &'g Grid<'t>,
    file: &'g str,
    choice: &'g Choice,
    /// As messages show them.
    names: Vec<String>,
    words: Vec<Word>,
    /// Column by column.
    numbers: Vec<Vec<Option<Number>>>,
    /// Which columns `--columns`, `--values` and `--order` name.
    claimed: HashSet<usize>,
}

/// The column of the step, the step of each row, and the rows from coarse to fine.
struct Steps {
    column: usize,
    of: Vec<f64>,
    order: Vec<usize>,
}

/// What a column that nobody has chosen holds.
enum Kind {
    Error,
    /// The limit.
    Value(f64),
    /// No error, and why.
    Other(&'static str),
    /// Rates, of which column.
    Rates(usize),
    /// Perhaps an error that does not fall.
    Doubtful(&'static str),
}

/// Columns by what they hold.
#[derive(Default)]
struct Sorted {
    errors: Vec<usize>,
    values: Vec<usize>,
    limits: Vec<usize>,
    doubtful: Vec<usize>,
    others: Vec<(String, String)>,
}

/// Reads the step and the errors that are meant.
pub(super) fn read(grid: &Grid<'_>, file: &str, choice: &Choice) -> Result<RateTable, InputError> {
    let width = grid.rows.iter().map(|row| row.cells.len()).max().unwrap_or(0);
    let found: Vec<String> = grid.names.iter().map(|cell| names::shown(cell.text)).collect();
    let nameless = vec![String::new(); grid.misfit.unwrap_or(width)];
    let names = choice.names.clone().unwrap_or(if found.is_empty() { nameless } else { found });
    let has_comma = grid.decimal_comma && {
        let mut cells = grid.rows.iter().flat_map(|row| &row.cells);
        cells.any(|cell| cell.text.contains(',') && number(cell.text, true).is_some())
    };
    // `1.024` among decimal commas may be 1024.
    let value = |text: &str| number(text, grid.decimal_comma).filter(|_| !(has_comma && text.contains('.')));
    let of = |k: usize| grid.rows.iter().map(|row| value(row.cells.get(k)?.text)).collect();
    let words = names.iter().map(|name| Word::of(name)).collect();
    let shown = |(k, name): (usize, &String)| if name.is_empty() { format!("column {}", k + 1) } else { name.clone() };
    let shown: Vec<String> = names.iter().enumerate().map(shown).collect();
    let wanted = choice.columns.iter().flatten().chain(&choice.claimed).chain(&choice.values);
    let claimed = wanted.filter_map(|name| names::position(shown.iter().map(String::as_str), name)).collect();
    let numbers = (0..width).map(of).collect();
    let reader = Reader { grid, file, choice, names: shown, words, numbers, claimed };
    reader.check(width)?;
    reader.read()
}

impl Reader<'_, '_> {
    /// Refuses what is no table, and names that cannot be those of its columns.
    fn check(&self, width: usize) -> Result<(), InputError> {
        if width == 0 {
            let line = self.grid.text.lines().find(|line| !line.trim().is_empty());
            let found = line.map(|line| format!("no row of numbers, but `{}`", shorten(line.trim())));
            let expected = "a row of names, such as `h L2 H1`, then rows of numbers, such as `0.1 1.6e-3 4e-2`";
            return Err(self.error(line.map(|_| (1, 0)), expected, found.as_deref().unwrap_or("an empty table")));
        }
        if let Some(row) = self.grid.rows.iter().find(|row| row.cells.len() != self.names.len()) {
            let example = (1..).map(|k| format!("c{k}"));
            let is_even = self.grid.rows.iter().all(|row| row.cells.len() == width);
            let command = self.command(|choice| choice.names = Some(example.take(width).collect()));
            let found = counted(row.cells.len(), "cell") + if is_even { &command } else { "" };
            let at = (row.line, row.cells.first().map_or(0, |cell| cell.start));
            return Err(self.error(
                Some(at),
                &format!("{}, one for each name", counted(self.names.len(), "cell")),
                &found,
            ));
        }
        if let Some(k) = self.names.iter().position(|name| name.contains(char::is_control)) {
            let found = format!("`{}`", shorten(&self.names[k]));
            return Err(self.error(Some(self.above(k)), "a name without control characters", &found));
        }
        if width < 2 {
            return Err(self.error(Some(self.above(0)), "a column of steps and at least one of errors", "one column"));
        }
        Ok(())
    }

    fn read(&self) -> Result<RateTable, InputError> {
        let (column, how) = self.step()?;
        let dim = self.dim(column)?;
        let of =
            (0..self.grid.rows.len()).map(|row| self.step_at(row, column, dim)).collect::<Result<Vec<f64>, _>>()?;
        // The judge wants the coarsest level first.
        let mut order: Vec<usize> = (0..of.len()).collect();
        order.sort_by(|a, b| of[*b].total_cmp(&of[*a]));
        let steps = Steps { column, of, order };
        self.each_step_once(&steps)?;
        let Sorted { errors, values, others, .. } = self.sorted(&steps)?;
        let is_exact = self.regular(column).is_some() || dim.is_some();
        let step_halves = if is_exact { vec![0.0; steps.of.len()] } else { halves(&self.numbers[column]) };
        let read = |&k: &usize| {
            let halves = halves(&self.numbers[k]);
            let levels = steps.order.iter().map(|&row| Ok(Level { step: steps.of[row], error: self.must(row, k)? }));
            let ordered = |halves: &[f64]| steps.order.iter().map(|row| halves[*row]).collect();
            let levels = levels.collect::<Result<_, InputError>>()?;
            Ok(Column {
                name: self.names[k].clone(),
                levels,
                halves: ordered(&halves),
                step_halves: ordered(&step_halves),
            })
        };
        let mut seen = HashSet::new();
        if let Some(&twice) = errors.iter().chain(&values).find(|k| !seen.insert(&self.names[**k])) {
            let again = |(k, name): (usize, &String)| {
                if self.names[..k].contains(name) { format!("{name}_{}", k + 1) } else { name.clone() }
            };
            let numbered = self.names.iter().enumerate().map(|name| again(name).replace(',', ";")).collect();
            let command = self.command(|choice| choice.names = Some(numbered));
            let found = format!("`{}` a second time{command}", shorten(&self.names[twice]));
            return Err(self.error(Some(self.above(twice)), "each name once", &found));
        }
        let step = self.label(column, dim);
        let quoted = |columns: &[usize]| listed(columns.iter().map(|k| format!("`{}`", self.names[*k])));
        let part = |what: &str, list: String| if list.is_empty() { list } else { format!("; {what}: {list}") };
        let left_out = listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")));
        let parts = [("errors", quoted(&errors)), ("values", quoted(&values)), ("left out", left_out)];
        let reading = format!("step: `{step}`{how}") + &parts.map(|(what, list)| part(what, list)).concat();
        let columns = errors.iter().map(read).collect::<Result<_, InputError>>()?;
        let values = values.iter().map(read).collect::<Result<_, InputError>>()?;
        Ok(RateTable { step, columns, values, not_errors: others, reading, is_guessed: !how.is_empty() })
    }

    /// * `place`: the line, and a byte of it.
    fn error(&self, place: Option<(usize, usize)>, expected: &str, found: &str) -> InputError {
        let reason = format!("expected {expected}, found {found}");
        let place = place.map(|(line, byte)| self.grid.place(line, byte));
        InputError {
            file: self.file.to_owned(),
            place,
            field: None,
            complaint: Box::new(Complaint::Invalid { reason }),
        }
    }

    /// The place of a name.
    fn above(&self, column: usize) -> (usize, usize) {
        (self.grid.line.max(1), self.grid.names.get(column).map_or(0, |cell| cell.start))
    }

    /// A complaint about the row of names.
    fn refuse(&self, expected: &str, found: &str) -> InputError {
        self.error(Some(self.above(0)), expected, found)
    }

    fn at(&self, row: usize, column: usize, expected: &str) -> InputError {
        let Cell { start, text } = self.grid.rows[row].cells[column];
        let place = Some((self.grid.rows[row].line, start));
        let field = Some(self.names[column].clone());
        InputError { field, ..self.error(place, expected, &format!("`{}`", shorten(text))) }
    }

    /// The command with a choice that was changed, on a line of its own; empty where no command is known.
    fn command(&self, change: impl FnOnce(&mut Choice)) -> String {
        let mut choice = self.choice.clone();
        change(&mut choice);
        if choice.command.is_empty() {
            return String::new();
        }
        let is_plain = |c: char| c.is_alphanumeric() || "_-+.,/^:=@%".contains(c);
        let quoted =
            |text: String| if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) };
        let list = |list: Vec<String>| Some(list.join(",")).filter(|list| !list.is_empty());
        let dim = choice.dim.map(|dim| dim.to_string());
        let (names, columns) = (choice.names.and_then(list), choice.columns.and_then(list));
        let values = list(choice.values);
        let options = [("names", names), ("step", choice.step), ("dim", dim), ("columns", columns), ("values", values)];
        let option = |(name, value): (&str, Option<String>)| {
            value.map_or(String::new(), |value| format!(" --{name} {}", quoted(value)))
        };
        format!("\n  {}{}", choice.command, options.map(option).concat())
    }

    fn named(&self, columns: &[usize]) -> Vec<String> {
        columns.iter().map(|k| self.names[*k].clone()).collect()
    }

    fn value(&self, row: usize, column: usize) -> Option<f64> {
        self.numbers[column][row].map(|number| number.value)
    }

    /// All numbers of a column, if it has no other cells.
    fn values(&self, column: usize) -> Option<Vec<f64>> {
        self.numbers[column].iter().map(|number| number.map(|number| number.value)).collect()
    }

    fn must(&self, row: usize, column: usize) -> Result<f64, InputError> {
        self.value(row, column).ok_or_else(|| {
            let text = self.grid.rows[row].cells[column].text;
            let expected = match text {
                _ if text.len() > 1 && text.chars().all(|c| c == '*') => {
                    "a number; Fortran writes stars where the field is too narrow"
                }
                _ if text.contains(',') && self.grid.decimal_comma => {
                    "a number; its comma may be that of decimals or of thousands"
                }
                _ if number(text, true).is_some() => {
                    "a number; its point may be that of decimals or of thousands, for others have decimal commas"
                }
                _ => "a number",
            };
            self.at(row, column, expected)
        })
    }

    /// The column of that name, or of that number from 1.
    fn find(&self, wanted: &str, option: &str) -> Result<usize, InputError> {
        let names = || self.names.iter().map(String::as_str);
        let numbered = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|column| *column < self.names.len());
        names::position(names(), wanted).or_else(numbered).ok_or_else(|| {
            let suggestion = nearest(wanted, names().take(LISTED)).map(str::to_owned);
            let found = format!("`{}`{}", shorten(wanted), did_you_mean(&suggestion));
            self.refuse(&format!("a column for {option}: {}", listed(names().map(str::to_owned))), &found)
        })
    }

    /// The column of the step, and how it was found where its name does not say so.
    fn step(&self) -> Result<(usize, String), InputError> {
        if let Some(wanted) = &self.choice.step {
            return Ok((self.find(wanted, "--step")?, String::new()));
        }
        let free = |k: &usize| !self.claimed.contains(k) && !self.is_constant(*k);
        let of = |wanted: &dyn Fn(Word) -> bool| {
            (0..self.names.len()).filter(|k| wanted(self.words[*k]) && free(k)).collect::<Vec<_>>()
        };
        let steps = of(&|word| word == Word::Step);
        if let Some((&first, others)) = steps.split_first() {
            if let Some(other) = others.iter().find(|k| !self.is_in_proportion(first, **k)) {
                let commands = self.with_step(first) + &self.with_step(*other);
                return Err(
                    self.refuse("one column of steps, or --step COLUMN", &(self.named(&steps).join(", ") + &commands))
                );
            }
            let alike = listed(others.iter().map(|k| format!("`{}`", self.names[*k])));
            return Ok((first, if alike.is_empty() { alike } else { format!(", in proportion to {alike}") }));
        }
        let rank = |k: &usize| if let Word::Count(rank) = self.words[*k] { rank } else { u8::MAX };
        if let Some(count) = of(&|word| matches!(word, Word::Count(_))).into_iter().min_by_key(rank) {
            return Ok((count, String::new()));
        }
        // The only column of unknown name that falls by regular ratios; of several the first, unless another has a
        // smaller ratio.
        let first = (0..self.names.len()).find(|k| !self.is_index(*k));
        let unknown = of(&|word| word == Word::Unknown).into_iter();
        let regular: Vec<(usize, f64)> = unknown.filter_map(|k| Some((k, self.regular(k)?))).collect();
        if let Some((&(k, ratio), others)) = regular.split_first()
            && (others.is_empty() || Some(k) == first)
            && others.iter().all(|(_, other)| *other >= ratio)
        {
            return Ok((k, format!(", by its ratio {}", plain_text((1e4 * ratio).round() / 1e4))));
        }
        let described = |k: usize| match self.words[k] {
            _ if self.is_index(k) => format!("`{}` (the number of the row)", self.names[k]),
            Word::Logarithm => format!("`{}` (give the values, not their logarithms)", self.names[k]),
            Word::Step => format!("`{}` (the same in each row)", self.names[k]),
            _ => format!("`{}`", self.names[k]),
        };
        let may_be = |k: &usize| {
            free(k)
                && self.words[*k] == Word::Unknown
                && self.values(*k).is_some()
                && !self.names[*k].contains(['^', '²'])
        };
        let command = first.filter(may_be).map_or(String::new(), |k| self.with_step(k));
        let found = listed((0..self.names.len()).map(described));
        Err(self.refuse("a column of steps: add `h`, or name it with --step", &(found + &command)))
    }

    /// The command with a column for the step.
    fn with_step(&self, column: usize) -> String {
        let name = self.names[column].trim_start_matches("column ").to_owned();
        let dim = if self.is_count(column) { Some(1.0) } else { self.choice.dim };
        self.command(|choice| (choice.step, choice.dim) = (Some(name), dim))
    }

    /// The dimension for a column that counts; `None` for a step.
    fn dim(&self, step: usize) -> Result<Option<f64>, InputError> {
        let (name, word) = (&self.names[step], self.words[step]);
        let is_edge = reciprocal(name).is_some()
            || matches!(name.to_lowercase().as_str(), "steps" | "timesteps" | "time steps" | "nt");
        let is_count = self.is_count(step);
        let with = |dim: Option<f64>| self.command(|choice| choice.dim = dim);
        match self.choice.dim {
            _ if word == Word::Logarithm => Err(self.refuse("the values, not their logarithms", &format!("`{name}`"))),
            Some(dim) if is_count && is_edge && dim != 1.0 => Err(self
                .refuse("no --dim but 1", &format!("`{name}`, which is known to be of one dimension{}", with(None)))),
            Some(dim) if is_count || word == Word::Unknown => Ok(Some(dim)),
            Some(_) => Err(self
                .refuse("no --dim, which is for counts such as `cells`", &format!("the step `{name}`{}", with(None)))),
            None if !is_count => Ok(None),
            None if is_edge && matches!(word, Word::Count(_)) => Ok(Some(1.0)),
            None => {
                let mut commands = with(Some(1.0));
                if !matches!(word, Word::Count(1) | Word::Step) && !commands.is_empty() {
                    commands += &format!(
                        "  # along an edge{}  # all, in the plane{}  # all, in space",
                        with(Some(2.0)),
                        with(Some(3.0))
                    );
                }
                let expected =
                    format!("--dim D for h = {name}^(-1/D), with D = 1 for cells along an edge, or --step COLUMN");
                Err(self.refuse(&expected, &format!("the count `{name}` and no step{commands}")))
            }
        }
    }

    /// Whether a column counts: by its name, or because it has whole numbers that grow where errors fall.
    fn is_count(&self, column: usize) -> bool {
        let is_whole = |values: &[f64]| values.iter().all(|value| *value >= 1.0 && value.fract() == 0.0);
        let Some(values) = self.values(column) else { return false };
        // How many of the others fall where it falls, less those that grow.
        let alike = |k: usize| {
            let others = self
                .values(k)
                .filter(|others| k != column && !is_whole(others) && others.iter().all(|other| *other > 0.0));
            let signs = others.iter().flat_map(|others| values.windows(2).zip(others.windows(2)));
            signs.map(|(a, b)| (a[1] - a[0]).signum() * (b[1] - b[0]).signum()).sum::<f64>().signum()
        };
        let together = || {
            (0..self.names.len().min(NEIGHBOURS))
                .map(|k| if self.values(k).is_some() { alike(k) } else { 0.0 })
                .sum::<f64>()
        };
        match self.words[column] {
            Word::Count(_) => true,
            _ if !is_whole(&values) || values.iter().all(|value| *value == 1.0) => false,
            Word::Step => together() < 0.0,
            _ => together() <= 0.0,
        }
    }

    fn label(&self, step: usize, dim: Option<f64>) -> String {
        let name = &self.names[step];
        match dim {
            Some(1.0) => reciprocal(name).map_or_else(|| format!("1/{name}"), str::to_owned),
            Some(dim) => format!("{name}^(-1/{dim})"),
            None => name.to_owned(),
        }
    }

    /// The step of a row, a finite number > 0.
    fn step_at(&self, row: usize, column: usize, dim: Option<f64>) -> Result<f64, InputError> {
        let value = self.must(row, column)?;
        if !(value > 0.0 && value.is_finite()) {
            let what = if dim.is_some() { "a count" } else { "a step" };
            return Err(self.at(row, column, &format!("{what}, a finite number > 0")));
        }
        Ok(dim.map_or(value, |dim| value.powf(-1.0 / dim)))
    }

    fn each_step_once(&self, steps: &Steps) -> Result<(), InputError> {
        let Some(twice) = steps.order.windows(2).find(|two| steps.of[two[0]] == steps.of[two[1]]) else {
            return Ok(());
        };
        let rows = [twice[0], twice[1]].map(|row| &self.grid.rows[row]);
        let cell = rows[1].cells[steps.column];
        let found =
            format!("`{}` = {} in lines {} and {}", self.names[steps.column], cell.text, rows[0].line, rows[1].line);
        Err(self.error(Some((rows[1].line, cell.start)), "each step once: give one table at a time", &found))
    }

    fn is_constant(&self, column: usize) -> bool {
        let first = self.value(0, column);
        first.is_some()
            && self.numbers[column].len() > 1
            && self.numbers[column].iter().all(|number| number.map(|number| number.value) == first)
    }

    fn is_index(&self, column: usize) -> bool {
        let may_be = matches!(self.words[column], Word::Unknown | Word::Cost | Word::Count(1));
        may_be && self.grid.rows.len() > 1 && self.grid.counts_rows(column)
    }

    /// The least ratio by which a column falls or grows, if they all are the same or its numbers whole multiples or
    /// parts of one of them.
    fn regular(&self, column: usize) -> Option<f64> {
        let mut values = self.values(column)?;
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let half = halves(&self.numbers[column]).into_iter().fold(0.0, f64::max);
        let same = SAME.max(2.0 * half / least).min(0.02);
        let ratios: Vec<f64> = values.windows(2).map(|two| two[1] / two[0]).collect();
        let ratio = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let is_whole = |multiple: f64| (multiple / multiple.round() - 1.0).abs() < SAME;
        let is_regular = ratios.iter().all(|one| (one / ratio - 1.0).abs() < same)
            || values.iter().all(|value| is_whole(most / value))
            || values.iter().all(|value| is_whole(value / least));
        (ratios.len() > 1 && is_regular && ratio > 1.0 && ratio.is_finite() && least > 0.0).then_some(ratio)
    }

    /// Whether two columns are the steps of one mesh in several directions, or of space and time.
    fn is_in_proportion(&self, column: usize, other: usize) -> bool {
        let (Some(a), Some(b)) = (self.values(column), self.values(other)) else { return false };
        a.iter().zip(&b).all(|(x, y)| (x * b[0] / (y * a[0]) - 1.0).abs() < SAME)
    }

    /// The columns of errors, those of values, and the others, each with the reason.
    fn sorted(&self, steps: &Steps) -> Result<Sorted, InputError> {
        let chosen = |wanted: &[String], option: &str| {
            wanted.iter().map(|name| self.find(name, option)).collect::<Result<Vec<usize>, _>>()
        };
        let mut found = Sorted { values: chosen(&self.choice.values, "--values")?, ..Sorted::default() };
        let wanted = chosen(self.choice.columns.as_deref().unwrap_or_default(), "--columns")?;
        let mut seen = HashSet::from([steps.column]);
        for k in wanted.iter().chain(&found.values) {
            let complain =
                |expected: &str, found: &str| Err(self.refuse(expected, &format!("{found}`{}`", self.names[*k])));
            if *k == steps.column {
                return complain("errors for --columns", "the step ");
            } else if !seen.insert(*k) {
                return complain("each column of --columns and --values once", "twice ");
            } else if self.words[*k] == Word::Logarithm {
                return complain("the values, not their logarithms", "");
            }
        }
        if self.choice.columns.is_some() {
            return Ok(Sorted { errors: wanted, ..found });
        }
        found.others.clone_from(&self.grid.left_out);
        for k in (0..self.names.len()).filter(|k| !seen.contains(k)) {
            let why = match self.kind(k, steps)? {
                Kind::Error => {
                    found.errors.push(k);
                    continue;
                }
                Kind::Rates(error) => format!("the rates of `{}`", self.names[error]),
                Kind::Other(why) => why.to_owned(),
                Kind::Doubtful(why) => {
                    found.doubtful.push(k);
                    why.to_owned()
                }
                Kind::Value(limit) => {
                    found.limits.push(k);
                    format!("tends to {}: a value, not an error", plain_text(limit))
                }
            };
            found.others.push((self.names[k].clone(), why));
        }
        self.doubts(&found).map_or(Ok(found), Err)
    }

    /// What forbids to judge: no error, or a column that may be one and does not fall, where no name says which are
    /// errors.
    fn doubts(&self, found: &Sorted) -> Option<InputError> {
        let Sorted { errors, values, limits, doubtful, others } = found;
        let columns = |columns: &[usize]| self.command(|choice| choice.columns = Some(self.named(columns)));
        if errors.is_empty() && values.is_empty() {
            let is_open =
                |k: &usize| matches!(self.words[*k], Word::Unknown | Word::Error) && self.value(0, *k).is_none();
            if let Some(k) = (0..self.names.len()).find(is_open) {
                return self.must(0, k).err();
            }
            let command = match (&limits[..], &doubtful[..]) {
                ([], []) => String::new(),
                ([], [first, ..]) => columns(&[*first]),
                (limits, _) => self.command(|choice| choice.values = self.named(limits)),
            };
            let quoted = listed(others.iter().map(|(name, why)| format!("`{name}` ({why})")));
            return Some(self.refuse("a column of errors, or --columns LIST", &(quoted + &command)));
        }
        let is_named =
            errors.iter().any(|k| self.words[*k] == Word::Error || self.claimed.contains(k)) || !values.is_empty();
        let name = &self.names[*doubtful.first().filter(|_| !is_named)?];
        let why = others.iter().find(|(other, _)| other == name).map_or("", |(_, why)| why);
        let commands = columns(errors) + &columns(&[errors.as_slice(), doubtful].concat());
        Some(
            self.refuse(
                "--columns LIST to say which columns are errors",
                &format!("`{name}`, which is {why}{commands}"),
            ),
        )
    }

    /// What a column holds, by its numbers, coarsest level first, and then by its name.
    fn kind(&self, k: usize, steps: &Steps) -> Result<Kind, InputError> {
        let word = self.words[k];
        let numbers: Vec<Option<f64>> = steps.order.iter().map(|row| self.value(*row, k)).collect();
        let there: Vec<f64> = numbers.iter().flatten().copied().collect();
        let is_known = match word {
            _ if self.claimed.contains(&k) => Some(Kind::Error),
            _ if there.is_empty() => Some(Kind::Other("no number")),
            _ if self.is_index(k) => Some(Kind::Other("the number of the row")),
            _ if self.is_constant(k) && !matches!(word, Word::Error | Word::Unknown) => {
                Some(Kind::Other("the same in each row"))
            }
            _ => self.rates_of(k, steps).map(Kind::Rates),
        };
        let by_name = || match word {
            Word::Logarithm => Some(Kind::Other("a logarithm")),
            Word::Step => Some(Kind::Other("a step")),
            Word::Count(_) => Some(Kind::Other("a count")),
            Word::Cost => Some(Kind::Other("a cost")),
            Word::Rate => Some(Kind::Other("a rate")),
            Word::Unknown if numbers[0].is_none() && there.len() + 1 == numbers.len() => {
                Some(Kind::Other("no number on the coarsest level"))
            }
            _ => None,
        };
        if let Some(kind) = is_known.or_else(by_name) {
            return Ok(kind);
        }
        if let Some(missing) = numbers.iter().position(Option::is_none) {
            let is_text = 2 * there.len() < numbers.len() && word != Word::Error;
            return if is_text {
                Ok(Kind::Other("words"))
            } else {
                self.must(steps.order[missing], k).map(|_| Kind::Error)
            };
        }
        let (first, last) = (there[0], there[there.len() - 1]);
        let falls = 2 * there.windows(2).filter(|two| two[1] < two[0]).count() >= there.len() - 1 && last < first;
        let is_short = there.len() < 3 || there.iter().any(|value| value.is_nan());
        let is_whole = there.iter().all(|value| value.fract() == 0.0);
        Ok(match word {
            Word::Error => Kind::Error,
            Word::MaybeRate => {
                if falls && last <= 0.6 * first {
                    Kind::Error
                } else {
                    Kind::Other("a rate")
                }
            }
            _ if is_short => Kind::Error,
            _ if self.is_constant(k) => Kind::Doubtful("the same in each row"),
            _ if is_whole && !falls => Kind::Doubtful("whole numbers that do not fall"),
            _ if self.is_in_proportion(steps.column, k) => Kind::Doubtful("in proportion to the step"),
            _ => match limit(&there).filter(|_| !is_whole) {
                Some(limit) => Kind::Value(limit),
                None if falls => Kind::Error,
                None => Kind::Doubtful("growing or standing still where the step falls"),
            },
        })
    }

    /// The error whose rates or reductions a column has, to its digits, on the finer or on the coarser level of each
    /// two.
    fn rates_of(&self, column: usize, steps: &Steps) -> Option<usize> {
        let (order, last) = (&steps.order, steps.order.len() - 1);
        if last < 2 {
            return None;
        }
        let half = 1.2 * halves(&self.numbers[column]).into_iter().fold(0.0, f64::max);
        let matches = |error: usize, shift: usize, measure: usize| {
            let halves = halves(&self.numbers[error]);
            let same = |k: usize| {
                let [coarse, fine] = [order[k], order[k + 1]];
                let (above, below) = (self.value(coarse, error)?, self.value(fine, error)?);
                let doubt = halves[coarse] / above + halves[fine] / below;
                let unit = [(steps.of[coarse] / steps.of[fine]).ln(), LN_2][measure % 2];
                let logarithm = (above / below).ln();
                let (value, doubt) =
                    if measure < 2 { (logarithm / unit, doubt / unit) } else { (above / below, doubt * above / below) };
                Some(
                    (self.value(order[k + shift], column)? - value).abs()
                        <= (half + doubt).min(0.25) + SAME * value.abs(),
                )
            };
            (0..last).all(|k| same(k) == Some(true))
        };
        let falls = |k: &usize| {
            self.values(*k).is_some_and(|values| {
                values.iter().all(|value| *value > 0.0) && values[order[last]] < 0.7 * values[order[0]]
            })
        };
        // Three rates are proof enough; two need a name, or an end without one.
        let is_end =
            |row: usize| self.value(row, column).is_none_or(|value| !value.is_finite() || value == 0.0 || value == 1.0);
        let may = |shift: &usize| {
            last > 2 || self.words[column].is_rate() || is_end(order[if *shift == 1 { 0 } else { last }])
        };
        // Those before it, the nearest first, and those behind.
        let before = (column.saturating_sub(NEIGHBOURS)..column).rev();
        let near = before.chain(column + 1..(column + NEIGHBOURS).min(self.names.len()));
        let mut errors = near.filter(|k| *k != steps.column && falls(k));
        errors.find(|error| {
            [1, 0].into_iter().filter(may).any(|shift| (0..3).any(|measure| matches(*error, shift, measure)))
        })
    }
}

/// What numbers tend to, where it is near the last of them and not zero.
pub fn limit(numbers: &[f64]) -> Option<f64> {
    let [.., a, b, c] = *numbers else { return None };
    let shrinks = (c - b) / (b - a);
    let limit = if shrinks.abs() < 0.95 { c + (c - b) * shrinks / (1.0 - shrinks) } else { c };
    let sizes = || numbers.iter().map(|value| value.abs());
    let is_near = sizes().fold(0.0, f64::max) < NEAR * sizes().fold(f64::INFINITY, f64::min) && b != c;
    let settles = b != a && shrinks.abs() < 0.95 && limit / c > 0.7;
    (numbers.iter().all(|value| value * c > 0.0) && (settles || is_near) && limit.is_finite()).then_some(limit)
}

/// Names in a message, not too many of them.
fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.take(LISTED + 1).collect();
    names[..names.len().min(LISTED)].join(", ") + if names.len() > LISTED { ", ..." } else { "" }
}
