//! Answers of a program: which line counts, and what is none.

use std::fs;
use std::process::Command;

use convergence_study_tests::{Ended, transcript::place};

use super::{HARNESS, texts};

/// The study of the transcript with this program of awk, which can use `n`.
fn answered(program: &str) -> Ended {
    let place = place(include_str!("../transcripts/answers.md"));
    let program = format!("BEGIN {{ {program} }}\n");
    fs::write(place.path().join("solver.awk"), program).unwrap();
    let mut study = Command::new(HARNESS);
    texts(study.args(["study", "s.toml"]).current_dir(&place))
}

#[test]
fn an_object_wins_and_what_is_no_number_is_refused() {
    if !crate::awk_is_here() {
        return;
    }
    for (line, words) in [
        (
            "printf \"{\\\"errors\\\": {\\\"max error\\\": %e}}\\nmax error = 7\\n\", 1 / n^2",
            "max error 2.0000 (order 2)",
        ),
        (
            "print \"max error = NaN\"",
            "awk: `max error` is `NaN`; expected a finite number",
        ),
        (
            "print \"max error = ****\"",
            "awk: `max error` is `****`; expected a finite number",
        ),
        (
            "print \"maximal error = 1e-3\"",
            "awk answered nothing: found `maximal error`; the study has `max error`",
        ),
        (
            "print \"max error 1e-3\"",
            "expected a last line such as {\"errors\": {\"max error\": 1.5e-3}}",
        ),
        (
            "printf \"max error = 1e-3\\n{\\\"errors\\\": 1e5 2}\\n\"",
            "is no answer: invalid type",
        ),
        (
            "printf \"max error = 1e-3\\nh = 0\\n\"",
            "h is 0.0; expected a finite number > 0",
        ),
    ] {
        let out = answered(line).stdout;
        assert!(out.contains(words), "{line}: {out}");
    }
    for line in [
        // A level that has failed does not have the error of an earlier time step.
        "print \"max error = \" 1 / n^2; print \"max error = \" (n < 64 ? 1 / n^2 : \"FAILED\")",
        "print \"max error = \" 1 / n^2; if (n == 64) print \"max error =\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}}\"; if (n == 64) print \"max error = nan\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}}\"; if (n == 64) print \"{\\\"status\\\": \\\"failed\\\"}\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}\" (n < 64 ? \"}\" : \", \\\"failed\\\": true}\")",
    ] {
        answered(line).says(1, "4 of 5 cases completed; n = 64: awk");
    }
}
