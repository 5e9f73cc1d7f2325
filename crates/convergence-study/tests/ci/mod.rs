//! CI of other projects: runners can read the action and the examples, and everything named in them
//! exists.

#[cfg(unix)]
mod install;
#[cfg(unix)]
mod key;
#[cfg(unix)]
mod script;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Command;

use convergence_study::Project;
use yaml_rust2::{Yaml, YamlLoader};

use crate::readme::blocks::fenced;

fn text(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

/// A script, ended where it hangs.
#[cfg(unix)]
fn script(name: &str) -> Command {
    let mut command = Command::new("timeout");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    command.args(["120", "bash"]).arg(script);
    command
}

fn yaml(text: &str) -> Yaml {
    YamlLoader::load_from_str(text)
        .unwrap_or_else(|error| panic!("{error}: {text}"))
        .remove(0)
}

/// The code blocks of Markdown in a language.
fn blocks(markdown: &str, language: &str) -> Vec<String> {
    let blocks = fenced(markdown).into_iter();
    let blocks = blocks.filter(|(of, _)| of == language);
    blocks.map(|(_, text)| text).collect()
}

/// All texts of a document, with the keys that lead to them.
fn texts<'y>(value: &'y Yaml, key: &'y str) -> Vec<(&'y str, &'y str)> {
    match value {
        Yaml::String(text) => vec![(key, text)],
        Yaml::Array(values) => values.iter().flat_map(|value| texts(value, key)).collect(),
        Yaml::Hash(map) => map
            .iter()
            .flat_map(|(key, value)| texts(value, key.as_str().unwrap_or("")))
            .collect(),
        _ => vec![],
    }
}

/// The text after the name of the program in a script, up to the end of the command.
fn command_lines(script: &str) -> Vec<Vec<String>> {
    let lines = script
        .lines()
        .filter(|line| !line.trim_start().starts_with('#'));
    let commands = lines.flat_map(|line| line.split([';', '|', '&', '\'']));
    let words = |command: &str| {
        command
            .split_whitespace()
            .map(|word| word.trim_matches('"').to_owned())
            .collect()
    };
    let words = commands.map(words);
    words
        .filter(|words: &Vec<String>| {
            words
                .first()
                .is_some_and(|word| word == "convergence-study")
        })
        .collect()
}

#[track_caller]
fn is_understood(words: &[String]) {
    let line = Project::PROGRAMS.own_command_line();
    // A comment after the command.
    let words = words.iter().take_while(|word| !word.starts_with('#'));
    if let Err(error) = line.try_get_matches_from(words.clone()) {
        assert!(
            !error.use_stderr(),
            "{:?}: {error}",
            words.collect::<Vec<_>>()
        );
    }
}

/// The pages of the book.
fn pages() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/src");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect();
    paths.sort();
    assert!(paths.len() > 10);
    paths
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect()
}

#[test]
fn every_command_of_the_examples_is_understood() {
    let readme = text("ci/README.md");
    let jobs: Vec<Yaml> = blocks(&readme, "yaml")
        .iter()
        .map(|block| yaml(block))
        .collect();
    let groovy = blocks(&readme, "groovy");
    assert_eq!((jobs.len(), groovy.len()), (2, 1));
    let scripts = jobs.iter().flat_map(|job| texts(job, ""));
    let mut scripts: Vec<String> = scripts
        .filter(|(key, _)| ["run", "script"].contains(key))
        .map(|(_, text)| text.to_owned())
        .collect();
    scripts.extend(
        groovy
            .into_iter()
            .chain(blocks(&readme, "sh"))
            .chain(blocks(&text("README.md"), "sh")),
    );
    for page in pages() {
        scripts.extend(blocks(&page, "sh"));
    }
    let commands: Vec<Vec<String>> = scripts
        .iter()
        .flat_map(|script| command_lines(script))
        .collect();
    assert!(commands.len() >= 3, "{commands:?}");
    commands.iter().for_each(|words| is_understood(words));
    // Commands given to the action.
    for run in ["verify", "study poisson.toml", "rates errors.csv --order 2"] {
        assert!(readme.contains(run), "{run}");
        is_understood(&command_lines(&format!("convergence-study {run} --out report")).concat());
    }
}

#[test]
#[should_panic(expected = "unexpected argument")]
fn a_flag_that_is_not_there_is_found() {
    command_lines("cd x && convergence-study verify --output report")
        .iter()
        .for_each(|words| is_understood(words));
}

/// The names after `${{ WHERE.` in a text.
fn named(text: &str, place: &str) -> BTreeSet<String> {
    let names = text.split(place).skip(1);
    names
        .map(|rest| {
            rest.chars()
                .take_while(|c| c.is_alphanumeric() || "-_".contains(*c))
                .collect()
        })
        .collect()
}

fn step<'y>(job: &'y Yaml, id: &str) -> &'y Yaml {
    let mut steps = job["steps"].as_vec().unwrap().iter();
    steps.find(|step| step["id"].as_str() == Some(id)).unwrap()
}

fn keys(map: &Yaml) -> BTreeSet<String> {
    map.as_hash()
        .unwrap()
        .keys()
        .map(|key| key.as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn the_action_and_its_example_agree_on_inputs_and_outputs() {
    let (action, readme) = (text("ci/action.yml"), text("ci/README.md"));
    let parsed = yaml(&action);
    assert_eq!(parsed["runs"]["using"].as_str(), Some("composite"));
    assert_eq!(keys(&parsed["inputs"]), named(&action, "inputs."));
    let job = yaml(&blocks(&readme, "yaml")[0]);
    let step = step(&job["jobs"]["convergence"], "convergence");
    assert_eq!(keys(&step["with"]), keys(&parsed["inputs"]));
    assert!(
        step["uses"]
            .as_str()
            .unwrap()
            .contains("/crates/convergence-study/ci@")
    );
    let outputs = keys(&parsed["outputs"]);
    assert!(named(&readme, "steps.convergence.outputs.").is_subset(&outputs));
    assert!(
        outputs
            .iter()
            .all(|name| readme.contains(&format!("`{name}`"))),
        "{outputs:?}"
    );
    // Without `source`, nothing is compiled.
    assert_eq!(
        parsed["inputs"]["source"]["default"].as_str(),
        Some("false")
    );
    let compiles = |step: &&Yaml| {
        step["run"]
            .as_str()
            .is_some_and(|run| run.contains("cargo "))
    };
    let steps = parsed["runs"]["steps"].as_vec().unwrap();
    let compiling: Vec<&Yaml> = steps.iter().filter(compiles).collect();
    assert!(!compiling.is_empty());
    for step in compiling {
        let condition = step["if"].as_str().unwrap();
        assert!(condition.contains("inputs.source == 'true'"), "{condition}");
    }
    // A composite action names the shell of each script; an output of a step must be written by its
    // script.
    let scripts = steps.iter().filter(|step| !step["run"].is_badvalue());
    let shells: Vec<_> = scripts.map(|step| step["shell"].as_str()).collect();
    assert!(shells.len() >= 4 && shells.iter().all(|shell| *shell == Some("bash")));
    let script = text("ci/run.sh");
    assert!(
        named(&action, "steps.run.outputs.")
            .iter()
            .all(|name| script.contains(&format!("\"{name}=$")))
    );
}
