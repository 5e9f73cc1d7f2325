//! Tables that exist, and the files that they were made from.

use std::fs;

use super::{Place, project_of};

const ERRORS: &str = "h,L2,H1,drag\n0.4,1.6000e-1,4.0000e-1,3.16000000\n0.2,4.0000e-2,2.0000e-1,3.04000000\n\
                      0.1,1.0000e-2,1.0000e-1,3.01000000\n0.05,2.5000e-3,5.0000e-2,3.00250000\n";

/// A study of a table, with this behind the names of its files.
fn place(table: &str, more: &str) -> Place {
    let place = Place::new("ok", "");
    place.write_text(&format!(
        "[study]\nid = \"s\"\nclaim = \"second order\"\ntier = \"quick\"\nkind = \"table\"\n\
         [table]\nfile = \"errors.csv\"\ninputs = [\"solver.f90\"]\n{more}"
    ));
    let folder = place.folder.path();
    fs::write(folder.join("errors.csv"), table).unwrap();
    fs::write(folder.join("solver.f90"), "end program\n").unwrap();
    place
}

const BOTH: &str = "[[expect]]\nerror = \"L2\"\norder = 2.0\n[[expect]]\nerror = \"H1\"\norder = \">= 1\"\n\
                    [[expect]]\nvalue = \"drag\"\norder = 2.0\n";

#[test]
fn a_table_is_judged_as_rates_does() {
    let ran = place(ERRORS, BOTH).study("");
    ran.says(0, "L2 2.0000 (order 2); H1 1.0000 (order 1); drag");
    ran.says(0, "step: `h`; errors: `L2`, `H1`; values: `drag`");
    for (from, to) in [("order = 2.0", "order = 3.0"), (">= 1", ">= 1.5")] {
        place(ERRORS, &BOTH.replacen(from, to, 1))
            .study("")
            .begins(1, "s: fail");
    }
    // A failed level, and what looks like a failed run.
    let failed = ERRORS.replace("1.0000e-2", "nan");
    place(&failed, BOTH).study("").begins(1, "s: fail");
    let doubted = format!("{ERRORS}\nTraceback (most recent call last):\n");
    place(&doubted, BOTH).study("").begins(1, "s: inconclusive");
    // What cannot be read.
    place("no numbers\n", BOTH)
        .study("")
        .says(1, "the table has not been read");
}

#[test]
fn settings_of_the_reader_and_several_tables_are_those_of_rates() {
    let counts = "n,L2\n4,1.6000e-1\n8,4.0000e-2\n16,1.0000e-2\n32,2.5000e-3\n";
    let claim = "[[expect]]\nerror = \"L2\"\norder = 2.0\n";
    place(counts, &format!("dim = 1\n{claim}"))
        .study("")
        .says(0, "");
    place(counts, claim).study("").says(1, "--dim");
    let two = format!("Degree 1\n{ERRORS}\nDegree 2\n{ERRORS}");
    let ran = place(&two, claim).study("");
    ran.says(0, "Degree 1: L2 2.00");
    ran.says(0, "Degree 2: L2 2.00");
    let wrong = "[[expect]]\nerror = \"L3\"\norder = 2.0\n";
    place(ERRORS, wrong)
        .study("")
        .says(1, "expected a column of errors: L2, H1");
}

#[test]
fn its_numbers_are_guarded_and_inputs_that_are_newer_are_inconclusive() {
    let place = project_of(place(ERRORS, BOTH));
    let studies = place.folder.path().join("studies");
    let write = |name: &str, text: &str| fs::write(studies.join(name), text).unwrap();
    write("errors.csv", ERRORS);
    write("solver.f90", "end program\n");
    let verify = |more: &str| place.verify(more);
    verify("--bless").says(0, "");
    verify("").says(0, "");
    let baseline = fs::read_to_string(studies.join("baseline.json")).unwrap();
    for name in [
        "error L2, h = 0.05",
        "rate L2",
        "value drag, h = 0.05",
        "errors.csv",
    ] {
        assert!(baseline.contains(name), "{name}: {baseline}");
    }
    // The source has changed, the table has not.
    write("solver.f90", "! another version\nend program\n");
    let ran = verify("");
    ran.begins(1, "inconclusive in ");
    ran.says(1, "sources are newer than the table: solver.f90 changed");
    ran.says_not(1, "\nfail: ");
    // It is no blessing by the way.
    verify("--bless").says(1, "not blessed: less would be guarded");
    // A new table that says the same.
    write("errors.csv", &ERRORS.replace("1.0000e-2", "1.00000e-2"));
    verify("").says(0, "");
    // A number that moves fails.
    write("errors.csv", &ERRORS.replace("2.5000e-3", "2.5010e-3"));
    verify("").says(1, "error L2, h = 0.05 moved");
    write("errors.csv", ERRORS);
    verify("--bless --loosened").says(0, "");
    verify("").says(0, "");
    // Hashes that somebody deletes are missed.
    let baseline = fs::read_to_string(studies.join("baseline.json")).unwrap();
    let lines = baseline
        .lines()
        .filter(|line| !line.contains("\"sources\""));
    write("baseline.json", &lines.collect::<Vec<_>>().join("\n"));
    verify("").says(1, "was deleted from the baseline");
}

#[test]
fn what_a_file_may_get_wrong_is_named() {
    for (from, to, message) in [
        (
            "[\"solver.f90\"]",
            "[]",
            "table.inputs: found the list []; expected at least one file",
        ),
        (
            "solver.f90",
            "gone.f90",
            "table.inputs[0]: found the text \"gone.f90\", but ",
        ),
        (
            "errors.csv",
            "gone.csv",
            "table.file: found the text \"gone.csv\", but ",
        ),
        (
            "errors.csv",
            ".",
            "table.file: found the text \".\", which is no file",
        ),
        (
            "[[expect]]\nerror = \"L2\"",
            "samples = \"mean\"\n[[expect]]\nvalue = \"L2\"",
            "table.samples: found the text \"mean\"; expected samples without floor, ratio and values",
        ),
        (
            "[[expect]]\nerror = \"L2\"",
            "[[expect]]",
            "expect[0].error: missing; expected",
        ),
        (
            "value = \"drag\"\norder = 2.0",
            "value = \"drag\"\norder = \">= 2\"",
            "expected an order alone",
        ),
        (
            "inputs",
            "ratio = 1\ninputs",
            "table.ratio: found 1; expected a finite number > 1",
        ),
        (
            "inputs",
            "lines = [\"x\"]\ninputs",
            "table.lines[0]: found the text \"x\"; expected the first",
        ),
        (
            "inputs",
            "tolerance = 0.5\ninputs",
            "table.tolerance: found 0.5; expected a finite number",
        ),
    ] {
        let place = place(ERRORS, BOTH);
        let text = place.text();
        assert!(text.contains(from), "{from}");
        place.study_of(&text.replacen(from, to, 1)).refuses(message);
    }
}
