//! Lines that belong to no table: a doubt if they look like a row, name a column, or say that the
//! run has failed.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Display, Formatter};

use super::super::Doubt;
use super::super::cell::{first_is_number, is_failure, is_number, plain};
use super::super::failed_run::says_failure;
use super::super::names::{family, key, says_error, words};
use super::lines::{Lines, degree};
use super::{is_frame, pairs};

/// Most words of a name that is looked for in a line.
const LONGEST: usize = 5;
/// Most characters of a line that is quoted.
const QUOTED: usize = 80;

/// A line outside the tables that may belong to one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in super::super) struct Stray {
    /// From 1.
    number: usize,
    text: String,
    /// Whether it looks like a row, whatever the names of the columns.
    is_row: bool,
}

impl Stray {
    /// Whether it is the line of this number.
    pub(in super::super) fn is_at(&self, number: usize) -> bool {
        self.number == number
    }

    /// Whether it looks like a level: a row, or a number for a column.
    ///
    /// * `names`: the keys of the columns that are a step, an error or a value.
    pub(in super::super) fn is_level(&self, names: &HashSet<String>) -> bool {
        let mut pairs = pairs(bare(&self.text)).unwrap_or_default().into_iter();
        self.is_row
            || names_column(&self.text, names)
            || pairs.any(|pair| names.contains(&spaced_key(pair.name)))
    }
}

impl Display for Stray {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, {}", self.number, quoted(&self.text))
    }
}

/// The lines outside tables that are a doubt. One that begins with a number just below a table is a
/// row.
///
/// * `names`: of the columns of all tables.
pub(super) fn strays<'n>(lines: &Lines<'_>, names: impl Iterator<Item = &'n String>) -> Vec<Stray> {
    let names: HashSet<String> = names.map(|name| spaced_key(name)).collect();
    let mut series: HashMap<&str, usize> = HashMap::new();
    for pair in lines
        .unused()
        .filter_map(|(_, line)| pairs(bare(line)))
        .flatten()
    {
        *series.entry(pair.name).or_default() += 1;
    }
    let stray = |(k, line): (usize, &str)| {
        let goes_on = goes_on(lines, k);
        (goes_on || is_doubt(line, &names, &series)).then(|| Stray {
            number: k + 1,
            text: line.to_owned(),
            is_row: goes_on || is_row(line),
        })
    };
    lines.unused().filter_map(stray).collect()
}

/// Whether a line of numbers follows a table, with no more than a frame between them.
fn goes_on(lines: &Lines<'_>, line: usize) -> bool {
    if !first_is_number(lines.text[line]) {
        return false;
    }
    let mut above = (0..line).rev();
    above
        .find(|k| lines.text[*k].is_empty() || !is_frame(lines.text[*k]))
        .is_some_and(|above| lines.used[above])
}

/// The beginning of a line.
pub(in super::super) fn quoted(line: &str) -> String {
    let words: String = line.trim().chars().take(QUOTED).collect();
    format!("`{words}`")
}

/// A line without the mark of an item of a list.
fn bare(line: &str) -> &str {
    line.trim_matches([' ', '-', '*'])
}

/// The key of a name, with one blank between words.
pub(in super::super) fn spaced_key(name: &str) -> String {
    words(&key(name)).collect::<Vec<_>>().join(" ")
}

/// The words of a line, of which some are numbers.
struct Tokens {
    count: usize,
    /// Numbers, and words of failure.
    values: usize,
    numbers: usize,
    /// Whether it is a heading such as `Cycle 3`.
    is_heading: bool,
}

impl Tokens {
    fn of(line: &str) -> Self {
        let tokens = line.split(|c: char| c.is_whitespace() || "|&,;=:".contains(c));
        let tokens = tokens.map(|token| {
            token.trim_matches([
                '(', ')', '[', ']', '*', '`', '~', '<', '>', '{', '}', '"', '\'',
            ])
        });
        let tokens: Vec<&str> = tokens
            .filter(|token| !is_blank(token) && !token.contains("://"))
            .collect();
        let numbers = tokens.iter().filter(|token| is_number(token)).count();
        let failures = tokens.iter().filter(|token| is_failure(token)).count();
        let is_whole = |token: &&&str| token.bytes().all(|c| c.is_ascii_digit());
        let whole = tokens.iter().filter(is_whole).count();
        Self {
            count: tokens.len(),
            values: numbers + failures,
            numbers,
            is_heading: numbers + failures == 1 && whole == 1 && tokens.len() > 1,
        }
    }

    /// Whether half of the words are numbers.
    fn are_numbers(&self) -> bool {
        2 * self.values >= self.count && !self.is_heading
    }
}

/// Whether a line is a row that has lost its table: half of its words are numbers, it has a number
/// for a column, or for a name that comes again.
fn is_doubt(line: &str, names: &HashSet<String>, series: &HashMap<&str, usize>) -> bool {
    if is_frame(line) && !line.contains(|c: char| c.is_ascii_digit()) {
        return false;
    }
    let tokens = Tokens::of(line);
    if degree(line).is_some() && tokens.numbers < 2 || tokens.values == 0 {
        return false;
    }
    let pairs = pairs(bare(line)).unwrap_or_default();
    let is_named = |name: &str| series[name] > 1 || names.contains(&spaced_key(name));
    tokens.are_numbers()
        || tokens.numbers > 0 && line.starts_with(['{', '['])
        || tokens.numbers > 0 && names_column(line, names)
        || pairs.iter().any(|pair| is_named(pair.name))
}

/// Whether a line has numbers for a step and an error: half of its words are numbers, two at least,
/// or their names say so.
fn is_row(line: &str) -> bool {
    let Some(pairs) = pairs(bare(line)) else {
        let tokens = Tokens::of(line);
        return tokens.are_numbers() && tokens.values > 1;
    };
    let keys: Vec<String> = pairs.iter().map(|pair| key(pair.name)).collect();
    keys.iter().any(|key| family(key).is_some()) && keys.iter().any(|key| says_error(key))
}

fn is_blank(token: &str) -> bool {
    token.chars().all(|c| "-–—\\#%".contains(c))
}

/// Whether a line has the name of a column among its words.
fn names_column(line: &str, names: &HashSet<String>) -> bool {
    let line = plain(line).to_lowercase();
    let words: Vec<&str> = words(&line).collect();
    let is_name = |start: usize, count: usize| {
        let phrase = words.get(start..start + count);
        phrase.is_some_and(|phrase| names.contains(&phrase.join(" ")))
    };
    (0..words.len()).any(|start| (1..=LONGEST).any(|count| is_name(start, count)))
}

/// The first line that says that the run has failed.
pub(super) fn failed_run(text: &str) -> Option<Doubt> {
    let mut lines = text.lines().zip(1..);
    let (line, number) = lines.find(|(line, _)| says_failure(line))?;
    let because = format!("the run has failed: line {number} is {}", quoted(line));
    Some(Doubt::new(because))
}
