//! The first `verify`, before there is a baseline.

use std::fs;
use std::process::Command;

use super::{command, read, run, texts, workspace, write};

#[test]
fn a_first_run_counts_the_numbers_to_accept_and_lists_none() {
    let root = workspace(false);
    let (status, out, _) = run(&root, "verify").parts();
    assert_eq!(status, Some(1), "{out}");
    let last = "no baseline yet: 6 numbers to accept; `powers verify --bless` accepts them\n";
    assert!(out.ends_with(last) && out.contains("one    pass"), "{out}");
    assert!(!out.contains("fail") && !out.contains("is new"), "{out}");
    let page = read(&root, "reports/local/quick/README.md");
    assert!(
        page.contains("no baseline yet: 6 numbers to accept\n")
            && page.contains("`powers verify --bless` accepts them.")
            && !page.contains("is new"),
        "{page}"
    );
    let junit = read(&root, "reports/junit.xml");
    assert_eq!(junit.matches("<failure").count(), 1, "{junit}");
    assert!(junit.contains("no baseline yet: 6 numbers"), "{junit}");
    let (_, out, _) = run(&root, "verify --quiet").parts();
    assert!(out.ends_with(last), "{out}");
    let mut on_github = command(root.path(), &["verify"]);
    let (_, out, _) = texts(on_github.env("GITHUB_ACTIONS", "true")).parts();
    assert_eq!(out.matches("::error").count(), 1, "{out}");
    // As many numbers are accepted as were counted.
    let ran = run(&root, "verify --bless");
    ran.says(0, "blessed");
    ran.says_not(0, "unchanged");
    run(&root, "verify").says(0, "all 6 baseline values unchanged");
}

#[test]
fn a_new_study_beside_accepted_ones_and_one_that_fails_are_no_first_run() {
    let root = workspace(true);
    let ran = run(&root, "verify");
    ran.begins(1, "fail in ");
    ran.says(1, "1 of 2 fail (two); no baseline yet\n");
    ran.says_not(1, "accept");
    ran.says_not(1, "is new");
    let root = workspace(false);
    run(&root, "verify --bless").says(0, "");
    fs::copy(
        root.path().join("studies/one.toml"),
        root.path().join("studies/two.toml"),
    )
    .unwrap();
    let two = read(&root, "studies/two.toml");
    write(&root, "studies/two.toml", two.replace("\"one\"", "\"two\""));
    let ran = run(&root, "verify");
    ran.says(1, "; 6 numbers not yet in the baseline\n");
    ran.says(1, "if that is meant: powers verify --bless");
}

/// What a new project commits after its first blessing.
#[test]
fn git_keeps_of_a_first_blessing_what_is_worth_reviewing() {
    if !foreign_tools::are_here(&[foreign_tools::GIT]) {
        return;
    }
    let root = workspace(false);
    run(&root, "verify --bless");
    run(&root, "verify --tier full").says(0, "");
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        texts(git.args(arguments).current_dir(root.path())).stdout
    };
    git(&["init", "--quiet"]);
    git(&["add", "--all"]);
    let mut kept: Vec<String> = git(&["ls-files"]).lines().map(str::to_owned).collect();
    kept.retain(|path| path != "studies/one.toml");
    assert_eq!(
        kept,
        [
            "reports/.gitignore",
            "reports/README.md",
            "reports/figures/one-errors.svg",
            "reports/figures/rates.svg",
            "reports/full/README.md",
            "reports/full/figures/rates.svg",
            "studies/baseline.json",
        ]
    );
}
