//! The first `verify`, before there is a baseline.

use std::fs;
use std::process::Command;

use super::{command, run, texts, workspace};

#[test]
fn a_first_run_counts_the_numbers_to_accept_and_lists_none() {
    let root = workspace(false);
    let (status, out, _) = run(&root, &["verify"]);
    assert_eq!(status, Some(1), "{out}");
    let last = "no baseline yet: 6 numbers to accept; `powers verify --bless` accepts them\n";
    assert!(out.ends_with(last) && out.contains("one    pass"), "{out}");
    assert!(!out.contains("fail") && !out.contains("is new"), "{out}");
    let page = fs::read_to_string(root.path().join("reports/local/quick/README.md")).unwrap();
    assert!(
        page.contains("no baseline yet: 6 numbers to accept\n")
            && page.contains("`powers verify --bless` accepts them.")
            && !page.contains("is new"),
        "{page}"
    );
    let junit = fs::read_to_string(root.path().join("reports/junit.xml")).unwrap();
    assert_eq!(junit.matches("<failure").count(), 1, "{junit}");
    assert!(junit.contains("no baseline yet: 6 numbers"), "{junit}");
    let (_, out, _) = run(&root, &["verify", "--quiet"]);
    assert!(out.ends_with(last), "{out}");
    let mut on_github = command(root.path(), &["verify"]);
    let (_, out, _) = texts(on_github.env("GITHUB_ACTIONS", "true"));
    assert_eq!(out.matches("::error").count(), 1, "{out}");
    // As many numbers are accepted as were counted.
    let (status, out, _) = run(&root, &["verify", "--bless"]);
    assert!(
        status == Some(0) && out.contains("blessed") && !out.contains("unchanged"),
        "{out}"
    );
    let (status, out, _) = run(&root, &["verify"]);
    assert!(
        status == Some(0) && out.contains("all 6 baseline values unchanged"),
        "{out}"
    );
}

#[test]
fn a_new_study_beside_accepted_ones_and_one_that_fails_are_no_first_run() {
    let root = workspace(true);
    let (status, out, _) = run(&root, &["verify"]);
    assert_eq!(status, Some(1));
    assert!(
        out.starts_with("fail in ") && out.contains("1 of 2 fail (two); no baseline yet\n"),
        "{out}"
    );
    assert!(!out.contains("accept") && !out.contains("is new"), "{out}");
    let root = workspace(false);
    assert_eq!(run(&root, &["verify", "--bless"]).0, Some(0));
    fs::copy(
        root.path().join("studies/one.toml"),
        root.path().join("studies/two.toml"),
    )
    .unwrap();
    let two = fs::read_to_string(root.path().join("studies/two.toml")).unwrap();
    fs::write(
        root.path().join("studies/two.toml"),
        two.replace("\"one\"", "\"two\""),
    )
    .unwrap();
    let (status, out, _) = run(&root, &["verify"]);
    assert!(
        status == Some(1) && out.contains("; 6 numbers not yet in the baseline\n"),
        "{out}"
    );
    assert!(
        out.contains("if that is meant: powers verify --bless"),
        "{out}"
    );
}

/// What a new project commits after its first blessing.
#[test]
fn git_keeps_of_a_first_blessing_what_is_worth_reviewing() {
    if !foreign_tools::are_here(&[foreign_tools::GIT]) {
        return;
    }
    let root = workspace(false);
    run(&root, &["verify", "--bless"]);
    assert_eq!(run(&root, &["verify", "--tier", "full"]).0, Some(0));
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        texts(git.args(arguments).current_dir(root.path())).1
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
