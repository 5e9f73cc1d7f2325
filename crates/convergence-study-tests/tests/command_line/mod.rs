//! A project's command line.

mod begun;
mod blessings;
mod manufacture;
mod options;
mod tables;
pub(crate) mod visible;
#[cfg(unix)]
mod where_lost;

use convergence_study::command_line::Command as Harness;
use convergence_study_tests::{Ended, output};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// A workspace with the study `one`, which passes.
fn workspace() -> TempDir {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("studies")).unwrap();
    write(&root, "studies/one.toml", study("one", "c", 1.0));
    root
}

fn study(id: &str, claim: &str, exponent: f64) -> String {
    let head = format!("exponent = {exponent:?}\n[study]\nid = \"{id}\"\nclaim = \"{claim}\"\n");
    head + "tier = \"quick\"\nkind = \"power\"\n"
}

pub(crate) fn command(root: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_powers"));
    command.args(arguments).current_dir(root);
    command
        .env_remove("GITHUB_ACTIONS")
        .env_remove("GITHUB_STEP_SUMMARY");
    command
}

#[track_caller]
fn read(root: &TempDir, name: &str) -> String {
    fs::read_to_string(root.path().join(name)).unwrap()
}

#[track_caller]
fn write(root: &TempDir, name: &str, text: impl AsRef<[u8]>) {
    fs::write(root.path().join(name), text).unwrap();
}

/// A command line of words without blanks.
fn run(root: &TempDir, line: &str) -> Ended {
    run_words(root, &line.split_whitespace().collect::<Vec<_>>())
}

fn run_words(root: &TempDir, arguments: &[&str]) -> Ended {
    texts(&mut command(root.path(), arguments))
}

/// Exit status, standard output and standard error.
pub(crate) fn texts(command: &mut Command) -> Ended {
    output(command).into()
}

/// The blocks of a page in a language.
fn blocks<'p>(page: &'p str, language: &str) -> Vec<&'p str> {
    let opening = format!("```{language}\n");
    let blocks = page.split(&opening).skip(1);
    blocks
        .map(|rest| rest.split("```").next().unwrap())
        .collect()
}

#[test]
fn every_command_is_in_the_help() {
    let root = workspace();
    let help = run(&root, "--help");
    help.says(0, "Exit status: 0 ");
    let is_listed = |name: &&str| help.well().contains(&format!("\n  {name}"));
    assert!(Harness::NAMES.iter().all(is_listed), "{help:?}");
    for name in Harness::NAMES {
        let page = run(&root, &format!("{name} --help"));
        let widest = page.well().lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(100), "{page:?}");
    }
}
