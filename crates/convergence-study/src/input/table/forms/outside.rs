//! Lines that belong to no table: a doubt if they look like a row, name a column, or say that the
//! run has failed.

use std::collections::{HashMap, HashSet};

use super::super::Doubt;
use super::super::cell::{first_is_number, is_failure, is_number, plain};
use super::super::failed_run::says_failure;
use super::super::names::{key, words};
use super::lines::{Lines, degree};
use super::{is_frame, pairs};
use crate::text::lists::and_more;

/// Most words of a name that is looked for in a line.
const LONGEST: usize = 5;
/// Most characters of a line that is quoted.
const QUOTED: usize = 80;

/// The lines outside tables that are a doubt: the first, and their number. One that begins with a
/// number just below a table is a row.
///
/// * `names`: of the columns of all tables.
pub(super) fn doubt<'n>(
    lines: &Lines<'_>,
    names: impl Iterator<Item = &'n String>,
) -> Option<Doubt> {
    let names: HashSet<String> = names.map(|name| spaced(&key(name))).collect();
    let mut series: HashMap<&str, usize> = HashMap::new();
    for pair in lines
        .unused()
        .filter_map(|(_, line)| pairs(bare(line)))
        .flatten()
    {
        *series.entry(pair.name).or_default() += 1;
    }
    let is_doubt =
        |(k, line): &(usize, &str)| goes_on(lines, *k) || is_doubt(line, &names, &series);
    let mut doubtful = lines.unused().filter(is_doubt);
    let (line, words) = doubtful.next()?;
    let more = and_more(1 + doubtful.count(), 1);
    let words = quoted(words);
    let because = format!("outside the tables: line {}, {words}{more}", line + 1);
    Some(Doubt::new(because))
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
fn quoted(line: &str) -> String {
    let words: String = line.trim().chars().take(QUOTED).collect();
    format!("`{words}`")
}

/// A line without the mark of an item of a list.
fn bare(line: &str) -> &str {
    line.trim_matches([' ', '-', '*'])
}

fn spaced(key: &str) -> String {
    words(key).collect::<Vec<_>>().join(" ")
}

/// Whether a line is a row that has lost its table: half of its words are numbers, it has a number
/// for a column, or for a name that comes again.
fn is_doubt(line: &str, names: &HashSet<String>, series: &HashMap<&str, usize>) -> bool {
    if is_frame(line) && !line.contains(|c: char| c.is_ascii_digit()) {
        return false;
    }
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
    if degree(line).is_some() && numbers < 2 || numbers + failures == 0 {
        return false;
    }
    let pairs = pairs(bare(line)).unwrap_or_default();
    let is_named = |name: &str| series[name] > 1 || names.contains(&spaced(&key(name)));
    // `Cycle 3` is a heading.
    let is_whole = |token: &&&str| token.bytes().all(|c| c.is_ascii_digit());
    let whole = tokens.iter().filter(is_whole).count();
    let is_heading = numbers + failures == 1 && whole == 1 && tokens.len() > 1;
    2 * (numbers + failures) >= tokens.len() && !is_heading
        || numbers > 0 && line.starts_with(['{', '['])
        || numbers > 0 && names_column(line, names)
        || pairs.iter().any(|pair| is_named(pair.name))
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
