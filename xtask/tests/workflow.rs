//! What continuous integration runs.

use std::fs;

use crate::place::{read, root};

/// The commands of `.ci/run`.
fn steps(script: &str) -> Vec<&str> {
    script
        .lines()
        .filter_map(|line| line.strip_prefix("step "))
        .collect()
}

#[test]
fn the_page_for_contributors_has_each_command_of_ci_run_and_no_other() {
    let script = read(".ci/run");
    let steps = steps(&script);
    assert!(steps.len() > 5, "{steps:?}");
    let block = format!("```sh\n{}\n```", steps.join("\n"));
    assert!(
        read(".github/CONTRIBUTING.md").contains(&block),
        "expected in CONTRIBUTING.md:\n{block}"
    );
}

/// Whether a text has the name of a script as a word.
fn names(text: &str, script: &str) -> bool {
    let name = format!(".ci/{script}");
    text.match_indices(&name).any(|(start, _)| {
        let next = text[start + name.len()..].chars().next();
        next.is_none_or(|c| !(c.is_alphanumeric() || "-_.".contains(c)))
    })
}

/// The commands of a workflow, one a line.
fn commands(workflow: &str) -> String {
    let lines = read(workflow);
    let runs = lines
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix("- run: "));
    runs.map(|run| format!("{run}\n")).collect()
}

#[test]
fn each_script_is_run_by_a_workflow() {
    let folder = root().join(".ci");
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let files = entries.filter(|entry| entry.file_type().unwrap().is_file());
    let scripts: Vec<String> = files
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    assert!(scripts.len() >= 10, "{scripts:?}");
    // What a workflow runs, what those scripts run, and so on.
    let mut text =
        commands(".github/workflows/ci.yml") + &commands(".github/workflows/release.yml");
    let mut rest = scripts;
    loop {
        let (run, left): (Vec<String>, Vec<String>) =
            rest.into_iter().partition(|script| names(&text, script));
        if run.is_empty() {
            assert!(left.is_empty(), "nothing runs {left:?}");
            return;
        }
        text = run
            .iter()
            .map(|script| read(&format!(".ci/{script}")))
            .collect();
        rest = left;
    }
}
