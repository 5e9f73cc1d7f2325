//! Lines that say that a run has failed. What stands between its rows may look like a table that
//! passes.

use super::Doubt;
use super::names;
use super::number::number;

/// First words of such a line, as systems, languages and solvers print them.
const BEGINNINGS: [&str; 33] = [
    "Traceback",
    "ERROR:",
    "ERROR -",
    "ERROR ***",
    "Error:",
    "error:",
    "[ERROR]",
    "PETSC ERROR",
    "Killed",
    "killed",
    "Terminated",
    "diverged",
    "DIVERGED",
    "Diverged",
    "Aborted",
    "Abort",
    "ABORT",
    "FATAL",
    "Fatal",
    "fatal",
    "panic:",
    "panicked at",
    "AssertionError",
    "MemoryError",
    "KeyboardInterrupt",
    "thread '",
    "terminate called",
    "forrtl: severe",
    "Program received signal",
    "MPI_ABORT",
    "slurmstepd: error",
    "srun: error",
    "CANCELLED",
];
/// Words anywhere in such a line, in small letters.
const PHRASES: [&str; 42] = [
    "*** error",
    "aborted",
    "aborting",
    "an error occurred",
    "bad_alloc",
    "bad termination",
    "blew up",
    "blow-up",
    "bus error",
    "core dumped",
    "crashed",
    "did not converge",
    "divergence detected",
    "diverged_",
    "due to time limit",
    "error stop",
    "error termination",
    "exceeded max",
    "exception in thread",
    "stack dump:",
    "failed to",
    "fatal error",
    "floating point exception",
    "floating-point exception",
    "has diverged",
    "is nan",
    "job failed",
    "loaderror",
    "maximum number of iterations",
    "nan detected",
    "nan residual",
    "no convergence",
    "not converged",
    "oom-kill",
    "out of memory",
    "run failed",
    "segmentation fault",
    "segmentation violation",
    "sigsegv",
    "solution diverged",
    "solver diverged",
    "solver failed",
];
/// Words that a number may follow: how a program ended.
const EXITS: [&str; 3] = ["exit code 1", "exited on signal", "non-zero status"];
/// Most characters of a line that is quoted.
const QUOTED: usize = 80;

/// The first line that says that the run has failed: no name of a number, as `Error: 1e-3`, and no
/// heading, as `L2 ERROR OF THE VELOCITY`.
pub(super) fn line(text: &str) -> Option<Doubt> {
    let mut lines = text.lines().enumerate();
    let (k, line) = lines.find(|(_, line)| is_failure(line.trim()))?;
    Some(Doubt::FailedRun {
        line: k + 1,
        words: line.trim().chars().take(QUOTED).collect(),
    })
}

fn is_failure(line: &str) -> bool {
    let words = without_prefix(line);
    let lower = line.to_lowercase();
    if EXITS.iter().any(|exit| lower.contains(exit)) {
        return true;
    }
    let mut beginnings = BEGINNINGS.iter();
    let beginning = beginnings.find(|beginning| words.starts_with(**beginning));
    let mut phrases = PHRASES.iter();
    let phrase = phrases.find_map(|phrase| Some(lower.find(phrase)? + phrase.len()));
    let rest = match (beginning, phrase) {
        (Some(beginning), _) => &words[beginning.len()..],
        (None, Some(end)) => lower.get(end..).unwrap_or_default(),
        (None, None) => return is_exception(words) || is_lone_word(words),
    };
    let goes_on = phrase.is_none()
        && !beginning.is_some_and(|beginning| beginning.ends_with(['(', '\'']))
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
    !goes_on && !is_heading && !is_name && !is_row
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
    let name = words.split_once(':').map_or("", |(name, _)| name);
    ["Error", "Exception"]
        .iter()
        .any(|end| name.len() > end.len() && name.ends_with(end))
        && name.starts_with(char::is_uppercase)
        && !name.contains(char::is_whitespace)
        && words.len() > name.len() + 1
        && !first_is_number(&words[name.len() + 1..])
}

/// Whether a line is `failed` alone, or the like; `Error` alone is a heading.
fn is_lone_word(words: &str) -> bool {
    let is_word = words.chars().all(char::is_alphabetic) && !words.eq_ignore_ascii_case("error");
    is_word && names::is_failure(words)
}

fn first_is_number(text: &str) -> bool {
    text.split_whitespace().next().is_some_and(is_number)
}

fn is_number(word: &str) -> bool {
    let number = number(word.trim_end_matches([',', ';']), true);
    number.is_some_and(|number| number.value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::{Doubt, line};

    #[test]
    fn a_line_of_a_failed_run_is_told_from_names_and_headings() {
        for failed in [
            "Traceback (most recent call last):",
            "ERROR: run crashed",
            "Segmentation fault (core dumped)",
            "Killed",
            "diverged at t = 0.1",
            "[ERROR] no convergence",
            "[0]PETSC ERROR: Signal received",
            "--> FOAM FATAL ERROR:",
            "12:00:01 ERROR: stopped",
            "*** ERROR ***",
            "RuntimeError: singular matrix",
            "Linear solve did not converge due to DIVERGED_ITS iterations 10000",
            "failed",
            "FATAL: nan detected",
            "Traceback  most recent call last :",
            "mpirun noticed that rank 0 exited on signal 9",
            "Residual is NaN",
            "./run.sh: line 3: 812 Segmentation fault  ./solve",
        ] {
            let text = format!("h L2\n0.1 1\n{failed}\n");
            let words = failed.to_owned();
            assert_eq!(line(&text), Some(Doubt::FailedRun { line: 3, words }));
        }
        for other in [
            "L2 ERROR OF THE VELOCITY",
            "Error: 1.2e-3",
            "error: 1e-3, rate: 2",
            "Error:",
            "errors over the steps",
            "diverged = 0",
            "Error norms of all levels",
            "0.1 diverged",
            "MaxError: 1e-3",
            "levels not converged: 0",
            "maximum number of iterations 100",
            "Linear solve converged due to CONVERGED_RTOL iterations 12",
        ] {
            assert_eq!(line(other), None, "{other}");
        }
    }
}
