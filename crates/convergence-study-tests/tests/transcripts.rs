//! What `powers` prints, as documents show it.

use std::panic::catch_unwind;

use convergence_study_tests::transcript::follow;
use foreign_tools::{GIT, MKFIFO, PYTHON, SHELL, TOUCH};

const POWERS: &str = env!("CARGO_BIN_EXE_powers");

#[test]
fn manufacture_is_as_its_transcript_shows() {
    follow(include_str!("transcripts/manufacture.md"), POWERS);
}

#[test]
fn rates_is_as_its_transcripts_show() {
    follow(include_str!("transcripts/rates.md"), POWERS);
    follow(include_str!("transcripts/outside.md"), POWERS);
    follow(include_str!("transcripts/refused.md"), POWERS);
    follow(include_str!("transcripts/said.md"), POWERS);
    follow(include_str!("transcripts/tables.md"), POWERS);
}

#[test]
fn verify_is_as_its_transcript_shows() {
    follow(include_str!("transcripts/verify.md"), POWERS);
    follow(include_str!("transcripts/select.md"), POWERS);
}

#[cfg(unix)]
#[test]
fn places_that_are_no_plain_files_are_as_their_transcript_shows() {
    if foreign_tools::are_here(&[MKFIFO, TOUCH]) {
        follow(include_str!("transcripts/places.md"), POWERS);
    }
}

#[cfg(unix)]
#[test]
fn programs_are_judged_as_their_transcripts_show() {
    if foreign_tools::are_here(&[SHELL, TOUCH]) {
        follow(include_str!("transcripts/programs.md"), POWERS);
        follow(include_str!("transcripts/samples.md"), POWERS);
        follow(include_str!("transcripts/table.md"), POWERS);
        follow(include_str!("transcripts/taylor.md"), POWERS);
    }
}

#[test]
fn new_studies_are_as_their_transcripts_show() {
    if crate::awk_is_here() {
        follow(include_str!("transcripts/new.md"), POWERS);
    }
    if foreign_tools::are_here(&[GIT, PYTHON]) {
        follow(include_str!("transcripts/new-python.md"), POWERS);
    }
}

#[cfg(unix)]
#[test]
fn answers_of_programs_and_lost_orders_are_as_their_transcripts_show() {
    if crate::awk_is_here() {
        follow(include_str!("transcripts/answers.md"), POWERS);
        follow(include_str!("transcripts/kept.md"), POWERS);
        follow(include_str!("transcripts/where.md"), POWERS);
    }
}

/// A table of second order, and what is wrong about it.
#[test]
fn a_transcript_that_is_wrong_is_found() {
    let table = "# t\n```text t\nh e\n4 16\n2 4\n1 1\n```\n## It is judged\n```console\n";
    let is_found = |shown: &str| {
        let document = format!("{table}{shown}\n```\n");
        catch_unwind(|| follow(&document, POWERS)).is_err()
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
