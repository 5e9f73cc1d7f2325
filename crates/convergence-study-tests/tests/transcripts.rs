//! What `powers` prints, as documents show it.

use std::fs;
use std::panic::catch_unwind;

use convergence_study_tests::transcript;
use foreign_tools::{GIT, MKFIFO, PYTHON, SHELL, TOUCH};

const POWERS: &str = env!("CARGO_BIN_EXE_powers");

/// Follows the transcripts of these names.
#[track_caller]
fn follow(names: &[&str]) {
    for name in names {
        let path = format!("{}/tests/transcripts/{name}.md", env!("CARGO_MANIFEST_DIR"));
        transcript::follow(&fs::read_to_string(path).expect(name), POWERS);
    }
}

#[test]
fn manufacture_is_as_its_transcript_shows() {
    follow(&["manufacture"]);
}

#[test]
fn rates_is_as_its_transcripts_show() {
    follow(&["rates", "outside", "refused", "said", "tables"]);
}

#[test]
fn verify_is_as_its_transcript_shows() {
    follow(&["verify", "select"]);
}

#[cfg(unix)]
#[test]
fn places_that_are_no_plain_files_are_as_their_transcript_shows() {
    if foreign_tools::are_here(&[MKFIFO, TOUCH]) {
        follow(&["places"]);
    }
}

#[cfg(unix)]
#[test]
fn programs_are_judged_as_their_transcripts_show() {
    if foreign_tools::are_here(&[SHELL, TOUCH]) {
        follow(&["programs", "samples", "table", "taylor"]);
    }
}

#[test]
fn new_studies_are_as_their_transcripts_show() {
    if crate::awk_is_here() {
        follow(&["new"]);
    }
    if foreign_tools::are_here(&[GIT, PYTHON]) {
        follow(&["new-python"]);
    }
}

#[cfg(unix)]
#[test]
fn answers_of_programs_and_lost_orders_are_as_their_transcripts_show() {
    if crate::awk_is_here() {
        follow(&["answers", "kept", "where"]);
    }
}

/// A table of second order, and what is wrong about it.
#[test]
fn a_transcript_that_is_wrong_is_found() {
    let table = "# t\n```text t\nh e\n4 16\n2 4\n1 1\n```\n## It is judged\n```console\n";
    let is_found = |shown: &str| {
        let document = format!("{table}{shown}\n```\n");
        catch_unwind(|| transcript::follow(&document, POWERS)).is_err()
    };
    let right = "$ powers rates t --order 1\n? 1\nstep: `h`[..]\n...\ne: fail: 2.0[..]: too high\n...\nfail: 0 of[..]";
    assert!(!is_found(right));
    for (old, wrong) in [
        ("? 1\n", ""),
        ("? 1", "? 2"),
        ("too high", "too low"),
        ("too high", "too hig"),
        ("e: fail", "fail"),
        ("...\n", ""),
        ("fail: 0 of[..]", ""),
        ("fail: 0 of[..]", "fail: 0 of[..]\nmore"),
        ("fail: 0 of[..]", "fail: 0 of[..]\n! too"),
        ("fail: 0 of[..]", "fail: 0 of[..]\n2> error"),
        ("--order 1", "--order 2"),
        ("$ powers", "$ cat t\nh e\n$ powers"),
        ("$ powers", "$ ls .\n$ powers"),
        (
            "$ powers",
            "$ cp t u\n$ sed |16|17| u\n$ same t u\n$ powers",
        ),
        ("$ powers", "$ sed |17|16| t\n$ powers"),
    ] {
        assert!(
            right.contains(old) && is_found(&right.replacen(old, wrong, 1)),
            "{wrong:?}"
        );
    }
}
