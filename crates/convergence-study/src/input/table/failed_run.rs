//! Lines that say that a run has failed, as systems, languages and solvers print them: `Killed`,
//! `Traceback (most recent call last):`, `RuntimeError: singular matrix`.

use super::cell::{first_is_number, is_failure, is_number};

/// First words of a line of a failed run, as systems, languages and solvers print them.
const BEGINNINGS: &str = "Traceback|ERROR:|ERROR -|ERROR ***|Error:|error:|[ERROR]|PETSC ERROR|Killed|killed|Terminated|diverged|DIVERGED|Diverged|Aborted|Abort|ABORT|FATAL|Fatal|fatal|panic:|panicked at|AssertionError|MemoryError|KeyboardInterrupt|Error using|Exception on processing|make: ***|zsh: killed|thread '|terminate called|forrtl: severe|Program received signal|MPI_ABORT|slurmstepd: error|srun: error|CANCELLED";
/// Words anywhere in such a line, in small letters.
const PHRASES: &str = "*** error|aborted|aborting|an error occurred|assertion `|assertion failed|bad_alloc|bad termination|blew up|blow-up|bus error|core dumped|crashed|did not converge|did not reach|divergence detected|diverged_|double free|due to time limit|error stop|error termination|exceeded max|exception in thread|stack dump:|failed to|fatal error|floating point exception|floating-point exception|fortran runtime error|has diverged|illegal instruction|is nan|iterations exceeded|iterations reached|job failed|loaderror|maximum number of iterations|nan detected|nan encountered|nan residual|no convergence|not converged|oom-kill|out of memory|run failed|segmentation fault|segmentation violation|sigsegv|singular to working precision|solution diverged|solve failed|solver diverged|solver failed|timed out|unable to meet integration tolerances";
/// Words that a number may follow: how a program ended.
const EXITS: [&str; 4] = [
    "exit code 1",
    "exit status 1",
    "exited on signal",
    "non-zero status",
];

/// Whether a line says that the run has failed: it is no name of a number, as `Error: 1e-3`, and no
/// heading, as `L2 ERROR OF THE VELOCITY`.
pub(crate) fn says_failure(line: &str) -> bool {
    let line = line.trim();
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
    // A shell says `Terminated` alone.
    let ends_well = beginning == Some("Terminated") && value.starts_with(char::is_alphabetic);
    let numbers = rest
        .split_whitespace()
        .filter(|word| is_number(word))
        .count();
    let is_row = line.contains(['|', '&', '\t']) || numbers > 1;
    let is_none = is_name || is_answered_in_the_negative(rest) || is_count_of(rest);
    !goes_on && !is_heading && !is_none && !ends_well && !is_row && !is_note_of_rounding(line)
}

/// Whether a phrase is a question with its answer: `NaN detected: False`.
fn is_answered_in_the_negative(rest: &str) -> bool {
    const ANSWERS: [&str; 5] = ["no", "none", "never", "false", "ok"];
    let answer = rest.rsplit([':', '=']).next().unwrap_or_default();
    answer.len() < rest.len() && ANSWERS.contains(&answer.trim().to_lowercase().as_str())
}

/// Whether a phrase is the first word of what is counted: `killed particles: 12`.
fn is_count_of(rest: &str) -> bool {
    const PLACES: [&str; 7] = ["after", "at", "because", "by", "due", "in", "on"];
    let Some((name, count)) = rest.split_once([':', '=']) else {
        return false;
    };
    let mut words = name.split_whitespace();
    let is_name = rest.starts_with(' ') && words.all(|word| !PLACES.contains(&word));
    is_name && !name.trim().is_empty() && is_number(count.trim())
}

/// Whether the words before a phrase deny it: `no fatal errors`. A 0 within a line may number a
/// level: `level 0 did not converge`.
fn is_denied(before: &str) -> bool {
    let denial = before.trim();
    let is_none = denial == "0" || denial.ends_with(", 0");
    is_none || ["no", "without"].contains(&denial.rsplit(' ').next().unwrap_or_default())
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

#[cfg(test)]
mod tests {
    use super::says_failure;

    #[test]
    fn a_line_of_a_failed_run_is_told_from_names_and_headings() {
        for failed in include_str!("failed_run/lines.txt").lines() {
            assert!(says_failure(failed), "{failed}");
        }
        for other in include_str!("failed_run/other_lines.txt").lines() {
            assert!(!says_failure(other), "{other}");
        }
    }
}
