//! What continuous integration runs.

use std::fs;

use yaml_rust2::{Yaml, YamlLoader};

use crate::place::{read, root};

/// The files in `.github/workflows`.
pub(crate) const WORKFLOWS: [&str; 3] = ["ci.yml", "release.yml", "site.yml"];

pub(crate) fn text(name: &str) -> String {
    read(&format!(".github/workflows/{name}"))
}

pub(crate) fn workflow(name: &str) -> Yaml {
    YamlLoader::load_from_str(&text(name))
        .expect("YAML")
        .remove(0)
}

pub(crate) fn keys(map: &Yaml) -> Vec<&str> {
    let map = map.as_hash().expect("a map");
    map.keys()
        .map(|key| key.as_str().expect("a text"))
        .collect()
}

pub(crate) fn steps(job: &Yaml) -> &Vec<Yaml> {
    job["steps"].as_vec().expect("steps")
}

/// All commands of a workflow, with the names of their jobs.
pub(crate) fn commands(workflow: &Yaml) -> Vec<(&str, &str)> {
    let jobs = workflow["jobs"].as_hash().expect("jobs");
    let of_job = |(name, job)| -> Vec<(&str, &str)> {
        let name: &Yaml = name;
        let runs = steps(job).iter().filter_map(|step| step["run"].as_str());
        runs.map(|run| (name.as_str().expect("a name"), run))
            .collect()
    };
    jobs.iter().flat_map(of_job).collect()
}

/// Each job of a workflow has these rights and no other, and leaves no token in its checkout.
///
/// * `jobs`: name and rights, in the order of the file.
#[track_caller]
pub(crate) fn assert_rights(name: &str, jobs: &[(&str, &str)]) {
    let workflow = workflow(name);
    assert!(workflow["permissions"].as_hash().expect("none").is_empty());
    let names: Vec<&str> = jobs.iter().map(|(job, _)| *job).collect();
    assert_eq!(keys(&workflow["jobs"]), names);
    for (job, rights) in jobs {
        let permissions = &workflow["jobs"][*job]["permissions"];
        let given = keys(permissions).into_iter().map(|right| {
            let value = permissions[right].as_str().expect("a text");
            format!("{right}: {value}")
        });
        let given: Vec<String> = given.collect();
        assert_eq!(given.join(", "), *rights, "{job}");
        let is_left = |step: &&Yaml| {
            let uses = step["uses"].as_str().unwrap_or_default();
            uses.starts_with("actions/checkout@")
                && step["with"]["persist-credentials"].as_bool() != Some(false)
        };
        let left = steps(&workflow["jobs"][*job]).iter().find(is_left);
        assert_eq!(left, None, "{job} leaves its token in the checkout");
    }
}

/// Each action of a workflow is named by its commit and its version.
///
/// * `least`: how many there are at least.
#[track_caller]
pub(crate) fn assert_pinned(name: &str, least: usize) {
    let text = text(name);
    let uses: Vec<&str> = text
        .lines()
        .filter_map(|line| line.trim_start().split_once("uses: "))
        .map(|(_, action)| action)
        .collect();
    assert!(uses.len() >= least, "{uses:?}");
    for action in uses {
        let (_, pin) = action.split_once('@').expect("a version");
        let (commit, version) = pin.split_once(" # v").expect("a commit and its version");
        let is_commit = commit.len() == 40 && commit.chars().all(|c| c.is_ascii_hexdigit());
        assert!(is_commit && !version.is_empty(), "{action}");
    }
}

/// Whatever a job of a workflow does, a developer can run.
#[track_caller]
pub(crate) fn assert_no_logic(name: &str) {
    let workflow = workflow(name);
    let commands = commands(&workflow);
    assert!(!commands.is_empty());
    for (job, command) in commands {
        let has_logic = command.contains('\n')
            || ["if ", "for ", "|"]
                .iter()
                .any(|word| command.contains(word));
        assert!(!has_logic, "{job}: {command}");
    }
}

#[test]
fn no_workflow_is_forgotten() {
    let entries = fs::read_dir(root().join(".github/workflows")).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, WORKFLOWS);
}

/// The commands of `.ci/run`.
fn steps_of_script(script: &str) -> Vec<&str> {
    script
        .lines()
        .filter_map(|line| line.strip_prefix("step "))
        .collect()
}

#[test]
fn the_page_for_contributors_has_each_command_of_ci_run_and_no_other() {
    let script = read(".ci/run");
    let steps = steps_of_script(&script);
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
    let mut text = String::new();
    for workflow in WORKFLOWS.map(workflow) {
        let commands = commands(&workflow).into_iter();
        text += &commands
            .map(|(_, run)| format!("{run}\n"))
            .collect::<String>();
    }
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
