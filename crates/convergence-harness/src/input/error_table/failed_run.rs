//! Lines that say that a run has failed. What stands between its rows may look like a table that
//! passes.

use super::Doubt;
use super::number::number;

/// First words of such a line, as systems, languages and solvers print them.
const BEGINNINGS: [&str; 32] = [
    "Traceback (",
    "ERROR:",
    "ERROR -",
    "Error:",
    "error:",
    "[ERROR]",
    "Segmentation fault",
    "Segmentation Violation",
    "segmentation fault",
    "Killed",
    "killed",
    "diverged",
    "DIVERGED",
    "Diverged",
    "Aborted",
    "Abort",
    "FATAL",
    "Fatal",
    "fatal",
    "panic:",
    "thread '",
    "terminate called",
    "Floating point exception",
    "Floating-point exception",
    "Bus error",
    "forrtl: severe",
    "Program received signal",
    "MPI_ABORT",
    "slurmstepd: error",
    "srun: error",
    "Exception in thread",
    "CANCELLED",
];
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
    let mut beginnings = BEGINNINGS.iter();
    let Some(beginning) = beginnings.find(|beginning| line.starts_with(**beginning)) else {
        return false;
    };
    let rest = &line[beginning.len()..];
    let mut words = rest.split_whitespace();
    let names_a_number = words.clone().next().is_some_and(is_number);
    let numbers = words.clone().filter(|word| is_number(word)).count();
    let is_row = line.contains(['|', '&', '\t']) || numbers > 1;
    let goes_on = rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')
        || rest.trim_start().starts_with('=');
    let is_word = !goes_on || beginning.ends_with(['(', '\'']);
    // `Error:` alone is a heading.
    let is_heading = line.ends_with(':') && words.next().is_none() && line.starts_with(['E', 'e']);
    is_word && !names_a_number && !is_row && !is_heading
}

fn is_number(word: &str) -> bool {
    number(word.trim_end_matches([',', ';']), true).is_some()
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
        ] {
            assert_eq!(line(other), None, "{other}");
        }
    }
}
