//! Questions to another program: points for its standard input, values from its standard output.

use std::fmt::Write as _;

use crate::fit::largest;
use crate::language::names::did_you_mean;
use crate::problem::InputError;

/// A quantity as the other program computes it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ForeignQuantity {
    pub(crate) name: String,
    pub(crate) values: Vec<f64>,
    /// One unit of the last digit that is printed, for each value; 0 if all digits are.
    pub(crate) units: Vec<f64>,
}

/// Points as lines under a line of names.
pub(crate) fn question(names: &[String], points: &[Vec<f64>]) -> String {
    let mut text = names.join(" ") + "\n";
    for point in points {
        for (place, x) in point.iter().enumerate() {
            let separator = if place > 0 { " " } else { "" };
            let _ = write!(text, "{separator}{x:.16e}");
        }
        text.push('\n');
    }
    text
}

/// The parts of a line.
fn cells(line: &str) -> Vec<String> {
    line.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|cell| !cell.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The names of the columns of an answer; in words what is wrong with its first line.
fn names(head: Option<Vec<String>>, known: &[String]) -> Result<Vec<String>, String> {
    let Some(head) = head else {
        if known.len() == 1 {
            return Ok(known.to_vec());
        }
        let known = known.join(" ");
        return Err(format!("expected a first line of names, some of {known}"));
    };
    if let Some(name) = head.iter().find(|name| !known.contains(name)) {
        let near = did_you_mean(name, known.iter().map(String::as_str));
        let known = known.join(" ");
        return Err(format!(
            "unknown name `{name}`{near}; expected some of {known}"
        ));
    }
    let mut again = (1..head.len()).filter(|k| head[..*k].contains(&head[*k]));
    match again.next() {
        Some(k) => Err(format!(
            "expected each name once, found `{}` twice",
            head[k]
        )),
        None => Ok(head),
    }
}

/// Reads an answer about so many points.
///
/// * `known`: the names of the components; a line of names is needed if there are several.
/// * `is_value`: which numbers are accepted.
///
/// # Errors
/// A missing line, a number that is none, an unknown name: with the line.
pub(crate) fn read(
    text: &str,
    command: &str,
    known: &[String],
    points: usize,
    is_value: fn(f64) -> bool,
) -> Result<Vec<ForeignQuantity>, InputError> {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|line| !line.1.trim().is_empty())
        .peekable();
    let first = lines.peek().map(|line| cells(line.1)).unwrap_or_default();
    let is_head = first.iter().any(|cell| cell.parse::<f64>().is_err());
    let names = names(is_head.then_some(first), known);
    let head_line = if is_head { lines.next() } else { None };
    let head_line = head_line.map_or(1, |line| line.0 + 1);
    let names = names.map_err(|problem| InputError::at_line(command, head_line, problem))?;
    let mut columns: Vec<Vec<String>> = vec![vec![]; names.len()];
    let mut last = 0;
    for (line, row) in lines {
        last = line + 1;
        let row = cells(row);
        if row.len() != names.len() {
            let problem = format!("expected {} numbers, found {}", names.len(), row.len());
            return Err(InputError::at_line(command, last, problem));
        }
        for (column, cell) in columns.iter_mut().zip(row) {
            if !cell.parse::<f64>().is_ok_and(is_value) {
                let problem = format!("expected a finite number, found `{cell}`");
                return Err(InputError::at_line(command, last, problem));
            }
            column.push(cell);
        }
    }
    let found = columns.first().map_or(0, Vec::len);
    if found != points {
        let problem = format!("expected {points} lines of numbers, found {found}");
        return Err(InputError::at_line(command, last + 1, problem));
    }
    let answers = names.into_iter().zip(columns);
    let answers = answers.map(|(name, cells)| {
        let quantity = ForeignQuantity {
            values: cells.iter().filter_map(|cell| cell.parse().ok()).collect(),
            units: units(&cells),
            name,
        };
        if quantity.is_coarse() {
            let name = &quantity.name;
            let problem = format!(
                "`{name}`: expected numbers of at least three digits, found fewer: too few to tell"
            );
            return Err(InputError::at_line(command, head_line, problem));
        }
        Ok(quantity)
    });
    answers.collect()
}

impl ForeignQuantity {
    /// Whether a unit of the last place is more than a hundredth of the largest value: a wrong
    /// source would pass as one that is rounded.
    fn is_coarse(&self) -> bool {
        largest(&self.units) > 0.01 * largest(&self.values)
    }
}

/// The digits of a printed number: how many are significant, and how many follow the point.
struct Digits {
    significant: i32,
    decimals: i32,
    has_exponent: bool,
}

fn digits(cell: &str) -> Digits {
    let (mantissa, exponent) = match cell.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, Some(exponent)),
        None => (cell, None),
    };
    let all: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    Digits {
        significant: all.trim_start_matches('0').len() as i32,
        decimals: mantissa
            .split_once('.')
            .map_or(0, |parts| parts.1.len() as i32),
        has_exponent: exponent.is_some(),
    }
}

/// A column with fewer different values is not evidence of rounded printing.
const LEAST_VALUES: usize = 10;

/// Numbers with more digits are printed in full.
const MOST_DIGITS: i32 = 14;

/// One unit of the last printed digit of each number of a column.
///
/// Programs print a fixed number of decimals, or a number of significant digits without trailing
/// zeros: the largest number of digits in the column is how exactly it is printed.
fn units(cells: &[String]) -> Vec<f64> {
    let all: Vec<Digits> = cells.iter().map(|cell| digits(cell)).collect();
    let significant = all
        .iter()
        .map(|digits| digits.significant)
        .max()
        .unwrap_or(0);
    let different: std::collections::BTreeSet<&String> = cells.iter().collect();
    let is_whole = all
        .iter()
        .all(|digits| digits.decimals == 0 && !digits.has_exponent);
    if significant > MOST_DIGITS || different.len() < LEAST_VALUES || is_whole {
        return vec![0.0; cells.len()];
    }
    let first = all.first().map_or(0, |digits| digits.decimals);
    let is_fixed = all
        .iter()
        .all(|digits| digits.decimals == first && !digits.has_exponent);
    let cells = cells.iter();
    cells
        .map(|cell| {
            if is_fixed {
                10_f64.powi(-first)
            } else {
                unit_of_significant(cell, significant)
            }
        })
        .collect()
}

/// One unit of the last of so many significant digits.
fn unit_of_significant(cell: &str, significant: i32) -> f64 {
    let value = cell.parse::<f64>().unwrap_or(0.0).abs();
    if value == 0.0 {
        return 0.0;
    }
    10_f64.powi(value.log10().floor() as i32 - significant + 1)
}
