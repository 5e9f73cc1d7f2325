//! Answers in lines of `name = value`, the environment of a program, and defaults of its study.

use std::fs;

use super::Place;

/// A study of a program of awk, whose text can use `n`.
fn study(program: &str, more: &str, expect: &str) -> Place {
    let place = Place::new("ok", "");
    fs::write(place.folder.path().join("solver.awk"), program).unwrap();
    place.write_text(&format!(
        "[study]\nid = \"s\"\nclaim = \"c\"\ntier = \"quick\"\nkind = \"program\"\n\
         [program]\ncommand = [\"awk\", \"-v\", \"n={{n}}\", \"-f\", \"solver.awk\"]\n{more}\n\
         [refine]\nn = [4, 8, 16, 32, 64]\n{expect}"
    ));
    place
}

const MAX: &str = "[[expect]]\nerror = \"max error\"\norder = 2.0\n";

#[test]
fn lines_with_the_names_of_the_study_are_an_answer() {
    if !crate::awk_is_here() {
        return;
    }
    let lines = "BEGIN { for (k = 1; k < 9; k++) printf \"step %d: max error = %e\\n\", k, 1 / k;\n\
                 printf \" n = %d  max error =   %.8E\\n middle: %.12f\\n\", n, 1 / n^2, 2 + 1 / n^2;\n\
                 print \"done in 3 s\" }\n";
    let value = "[[expect]]\nvalue = \"middle\"\norder = 2.0\n";
    study(lines, "", &format!("{MAX}{value}")).study("").says(
        0,
        "max error 2.0000 (order 2); value middle 2.0000 (order 2); middle tends to 2.0000",
    );
    // The step that it prints is its step.
    let own = lines.replace(
        "print \"done",
        "printf \"h = %.15f\\n\", 1 / n^2; print \"done",
    );
    study(&own, "", &format!("{MAX}{value}"))
        .study("")
        .says(1, "2 of 2 rates too low: 1.0000");
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
            "expected a last line such as {\\\"errors\\\": {\\\"max error\\\": 0.001}}",
        ),
        (
            "printf \"max error = 1e-3\\n{\\\"errors\\\": 1e5 2}\\n\"",
            "is no JSON object",
        ),
        (
            "printf \"max error = 1e-3\\nh = 0\\n\"",
            "h is 0.0; expected a finite number > 0",
        ),
    ] {
        let (_, out, _) = study(&format!("BEGIN {{ {line} }}\n"), "", MAX)
            .study("")
            .parts();
        assert!(out.contains(&words.replace("\\\"", "\"")), "{line}: {out}");
    }
    for line in [
        // A level that has failed does not have the error of an earlier time step.
        "print \"max error = \" 1 / n^2; print \"max error = \" (n < 64 ? 1 / n^2 : \"FAILED\")",
        "print \"max error = \" 1 / n^2; if (n == 64) print \"max error =\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}}\"; if (n == 64) print \"max error = nan\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}}\"; if (n == 64) print \"{\\\"status\\\": \\\"failed\\\"}\"",
        "print \"{\\\"errors\\\": {\\\"max error\\\": \" 1 / n^2 \"}\" (n < 64 ? \"}\" : \", \\\"failed\\\": true}\")",
    ] {
        study(&format!("BEGIN {{ {line} }}\n"), "", MAX)
            .study("")
            .says(1, "4 of 5 cases completed; n = 64: awk: ");
    }
    let steps = "BEGIN { for (k = 1; k < 4; k++) print \"{\\\"errors\\\": {\\\"max error\\\": \" k / n^2 \"}}\" }\n";
    study(steps, "", MAX)
        .study("")
        .says(0, "each level printed 3 answers, of which the last counts");
    let two = format!("{MAX}[[expect]]\nerror = \"L2\"\norder = 2.0\n");
    study("BEGIN { print \"L2 = \" 1 / n^2 }\n", "", &two)
        .study("")
        .says(1, "its answer has no error `max error`; it has L2");
}

#[test]
fn a_program_has_the_variables_of_its_study() {
    if !crate::awk_is_here() {
        return;
    }
    let program = "BEGIN { print \"max error = \" ENVIRON[\"SCALE\"] / n^ENVIRON[\"ORDER\"] }\n";
    let env = "env = { SCALE = \"3\", ORDER = \"2\" }";
    study(program, env, MAX).study("").says(0, "4.688e-2");
    study(program, &env.replace("\"2\"", "\"1\""), MAX)
        .study("")
        .says(1, "");
}

#[test]
fn without_a_tolerance_it_is_that_of_rates() {
    if !crate::awk_is_here() {
        return;
    }
    let program = "BEGIN { print \"max error = \" 1 / n^1.8 }\n";
    study(program, "", MAX).study("").says(0, "2 ± 0.25");
    let narrow = format!("{MAX}tolerance = 0.1\n");
    study(program, "", &narrow).study("").says(1, "");
}

#[test]
fn a_reason_that_all_cases_share_is_there_once() {
    if !crate::awk_is_here() {
        return;
    }
    let place = study("BEGIN { exit 3 }\n", "", MAX);
    place.study("").says(
        1,
        "\nn = 4; n = 8; n = 16; n = 32; n = 64  awk ended with exit status 3\n",
    );
}

#[test]
fn a_floor_of_a_study_drops_levels_of_round_off_and_is_offered() {
    if !crate::awk_is_here() {
        return;
    }
    let program = "BEGIN { printf \"max error = %.8e\\n\", 1 / n^8 + 1e-14 }\n";
    let expect = MAX.replace("2.0", "8.0");
    let judged = |more: &str| study(program, more, &expect).study("");
    judged("").says(1, "round-off, if the solution is of size 1");
    judged("floor = 2.2e-12").says(0, "");
    judged("scale = 1e-6").says_not(1, "round-off, if");
}
