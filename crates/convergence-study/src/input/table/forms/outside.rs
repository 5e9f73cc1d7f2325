//! Lines that belong to no table: a doubt if they look like a row, name a column, or say that the
//! run has failed.

use std::collections::{HashMap, HashSet};

use super::super::Doubt;
use super::super::cell::{is_failure, is_number, plain};
use super::super::names::{key, words};
use super::lines::{Lines, degree};
use super::{is_frame, pairs};
use crate::text::lists::and_more;

/// Most words of a name that is looked for in a line.
const LONGEST: usize = 5;
/// Most characters of a line that is quoted.
const QUOTED: usize = 80;

/// First words of a line of a failed run, as systems, languages and solvers print them.
const BEGINNINGS: &str = "Traceback|ERROR:|ERROR -|ERROR ***|Error:|error:|[ERROR]|PETSC ERROR|Killed|killed|Terminated|diverged|DIVERGED|Diverged|Aborted|Abort|ABORT|FATAL|Fatal|fatal|panic:|panicked at|AssertionError|MemoryError|KeyboardInterrupt|Error using|Exception on processing|make: ***|zsh: killed|thread '|terminate called|forrtl: severe|Program received signal|MPI_ABORT|slurmstepd: error|srun: error|CANCELLED";
/// Words anywhere in such a line, in small letters.
const PHRASES: &str = "*** error|aborted|aborting|an error occurred|assertion `|assertion failed|bad_alloc|bad termination|blew up|blow-up|bus error|core dumped|crashed|did not converge|did not reach|divergence detected|diverged_|double free|due to time limit|error stop|error termination|exceeded max|exception in thread|stack dump:|failed to|fatal error|floating point exception|floating-point exception|fortran runtime error|has diverged|illegal instruction|is nan|iterations exceeded|iterations reached|job failed|loaderror|maximum number of iterations|nan detected|nan residual|no convergence|not converged|oom-kill|out of memory|run failed|segmentation fault|segmentation violation|sigsegv|singular to working precision|solution diverged|solve failed|solver diverged|solver failed|timed out|unable to meet integration tolerances";
/// Words that a number may follow: how a program ended.
const EXITS: [&str; 4] = [
    "exit code 1",
    "exit status 1",
    "exited on signal",
    "non-zero status",
];

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

/// The first line that says that the run has failed: no name of a number, as `Error: 1e-3`, and no
/// heading, as `L2 ERROR OF THE VELOCITY`.
pub(super) fn failed_run(text: &str) -> Option<Doubt> {
    let mut lines = text.lines().zip(1..);
    let (line, number) = lines.find(|(line, _)| says_failure(line.trim()))?;
    let because = format!("the run has failed: line {number} is {}", quoted(line));
    Some(Doubt::new(because))
}

fn says_failure(line: &str) -> bool {
    let words = without_prefix(line);
    let lower = line.to_lowercase();
    if EXITS.iter().any(|exit| lower.contains(exit)) {
        return true;
    }
    let beginning = BEGINNINGS.split('|').find(|start| words.starts_with(start));
    let phrase = PHRASES.split('|').find_map(|phrase| {
        let (before, behind) = lower.split_once(phrase)?;
        (!is_denied(before)).then_some(behind)
    });
    let rest = match (beginning, phrase) {
        (Some(beginning), _) => &words[beginning.len()..],
        (None, Some(behind)) => behind,
        (None, None) => return is_exception(words) || is_lone_word(words),
    };
    let goes_on = phrase.is_none()
        && !beginning.is_some_and(|beginning| beginning.ends_with('\''))
        && rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let value = rest.trim_start();
    // `Error:` alone is a heading, `diverged = 0` a name with its number.
    let is_heading = words.ends_with(':') && value.is_empty() && words.starts_with(['E', 'e']);
    let is_name = value.starts_with('=') || first_is_number(value.trim_start_matches([':', ' ']));
    let numbers = rest
        .split_whitespace()
        .filter(|word| is_number(word))
        .count();
    let is_row = line.contains(['|', '&', '\t']) || numbers > 1;
    !goes_on && !is_heading && !is_name && !is_row && !is_note_of_rounding(line)
}

/// Whether the words before a phrase deny it: `no fatal errors`. A 0 within a line may number a
/// level: `level 0 did not converge`.
fn is_denied(before: &str) -> bool {
    let denial = before.trim();
    denial == "0" || ["no", "without"].contains(&denial.rsplit(' ').next().unwrap_or_default())
}

/// Whether a line is the note with which gfortran ends a run of which numbers were rounded, to zero
/// at worst.
fn is_note_of_rounding(line: &str) -> bool {
    const FLAGS: [&str; 3] = ["IEEE_UNDERFLOW_FLAG", "IEEE_DENORMAL", "IEEE_INEXACT_FLAG"];
    let flags = line.split_once("exceptions are signalling:");
    flags.is_some_and(|(_, flags)| flags.split_whitespace().all(|flag| FLAGS.contains(&flag)))
}

/// A line without the rank, time and stars in front: `[0]PETSC ERROR`, `12:00:01 ERROR: ...`.
fn without_prefix(line: &str) -> &str {
    let is_prefix = |word: &str| !word.contains(char::is_alphabetic) && !is_number(word);
    let mut words = line;
    while let Some((first, rest)) = words.split_once([' ', ']'])
        && is_prefix(first)
    {
        words = rest.trim_start();
    }
    words
}

/// Whether a line is `RuntimeError: ...` or the like.
fn is_exception(words: &str) -> bool {
    let Some((name, behind)) = words.split_once(':') else {
        return false;
    };
    let is_class = |end: &str| name.len() > end.len() && name.ends_with(end);
    let class = name.rsplit('.').next().unwrap_or_default();
    ["Error", "Exception"].into_iter().any(is_class)
        && class.starts_with(char::is_uppercase)
        && !name.contains(char::is_whitespace)
        && !behind.is_empty()
        && !first_is_number(behind)
}

/// Whether a line is `failed` alone, or the like.
fn is_lone_word(words: &str) -> bool {
    words.chars().all(char::is_alphabetic) && !words.is_empty() && is_failure(words)
}

fn first_is_number(text: &str) -> bool {
    let first = text.split_whitespace().next();
    first.is_some_and(|word| is_number(word.trim_end_matches([',', ';'])))
}

#[cfg(test)]
mod tests {
    use super::{Doubt, failed_run};

    #[test]
    fn a_line_of_a_failed_run_is_told_from_names_and_headings() {
        for failed in include_str!("outside/failed_runs.txt").lines() {
            let text = format!("h L2\n0.1 1\n{failed}\n");
            let because = format!("the run has failed: line 3 is `{failed}`");
            assert_eq!(failed_run(&text), Some(Doubt::new(because)));
        }
        for other in include_str!("outside/other_lines.txt").lines() {
            assert_eq!(failed_run(other), None, "{other}");
        }
    }
}
