//! What continuous integration runs.

use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

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

#[test]
fn each_script_is_run_by_the_workflow() {
    let workflow = read(".github/workflows/ci.yml");
    let all = read(".ci/run");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../.ci");
    let names = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let names: Vec<String> = names.collect();
    assert!(names.len() >= 5, "{names:?}");
    for name in names {
        // As a word of its own at the end of a line.
        let is_run = |line: &str| {
            line.trim_start().starts_with("- run: ") && line.ends_with(&format!(" .ci/{name}"))
        };
        let is_step = all.lines().any(|line| line == format!("step .ci/{name}"));
        assert!(
            is_step || workflow.lines().any(is_run),
            "no job runs .ci/{name}"
        );
    }
}
