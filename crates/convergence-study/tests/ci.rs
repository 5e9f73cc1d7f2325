//! CI of other projects: runners can read the action and the examples, and everything named in them
//! exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use convergence_harness::cli::program;
use convergence_harness::program::PROJECT;
use yaml_rust2::{Yaml, YamlLoader};

fn text(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}

fn yaml(text: &str) -> Yaml {
    YamlLoader::load_from_str(text)
        .unwrap_or_else(|error| panic!("{error}: {text}"))
        .remove(0)
}

/// The code blocks of Markdown in a language.
fn blocks(markdown: &str, language: &str) -> Vec<String> {
    let opening = format!("```{language}\n");
    let rest = markdown.split(&opening).skip(1);
    rest.map(|rest| rest.split("\n```").next().unwrap().to_owned())
        .collect()
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
    let line = program(&PROJECT);
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
        .filter(|path| path.is_file())
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
    let steps = job["jobs"]["convergence"]["steps"].as_vec().unwrap();
    let step = steps
        .iter()
        .find(|step| step["id"].as_str() == Some("convergence"))
        .unwrap();
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
    let scripts = parsed["runs"]["steps"]
        .as_vec()
        .unwrap()
        .iter()
        .filter(|step| !step["run"].is_badvalue());
    assert!(
        scripts.clone().count() >= 4
            && scripts
                .clone()
                .all(|step| step["shell"].as_str() == Some("bash"))
    );
    let script = text("ci/run.sh");
    assert!(
        named(&action, "steps.run.outputs.")
            .iter()
            .all(|name| script.contains(&format!("\"{name}=$")))
    );
}

/// The key under which the action keeps the compiled program.
#[cfg(unix)]
mod key {
    use std::process::Command;

    use super::*;

    /// The folder of each crate of the workspace by its name.
    fn workspace() -> Vec<(String, String)> {
        let line = |line: &str| {
            let (name, rest) = line.split_once(" = { path = \"")?;
            Some((name.to_owned(), rest.split('"').next()?.to_owned()))
        };
        text("../../Cargo.toml").lines().filter_map(line).collect()
    }

    /// The folders of a crate and of all crates of the workspace that it is made of.
    fn made_of(name: &str, workspace: &[(String, String)]) -> BTreeSet<String> {
        let (_, folder) = workspace
            .iter()
            .find(|(known, _)| known == name)
            .expect("a crate of the workspace");
        let manifest = text(&format!("../../{folder}/Cargo.toml"));
        let dependencies = manifest
            .split("\n[")
            .filter(|section| section.starts_with("dependencies]"));
        let needs = |section: &str, known: &str| {
            section
                .lines()
                .any(|line| line.split(['.', ' ']).next() == Some(known))
        };
        let mut folders = BTreeSet::from([folder.clone()]);
        for section in dependencies {
            let below = workspace.iter().filter(|(known, _)| needs(section, known));
            below.for_each(|(known, _)| folders.extend(made_of(known, workspace)));
        }
        folders
    }

    /// The key that the action computes in a copy of the repository.
    fn key(root: &Path) -> String {
        let action = yaml(&text("ci/action.yml"));
        let steps = action["runs"]["steps"].as_vec().unwrap();
        let step = steps
            .iter()
            .find(|step| step["id"].as_str() == Some("source"))
            .unwrap();
        let mut command = Command::new("bash");
        command.args(["-euo", "pipefail", "-c", step["run"].as_str().unwrap()]);
        command.env(
            "GITHUB_ACTION_PATH",
            root.join("crates/convergence-study/ci"),
        );
        let output = root.join("output");
        let ended = command.env("GITHUB_OUTPUT", &output).status().unwrap();
        let found = fs::read_to_string(&output).unwrap_or_default();
        let _ = fs::remove_file(output);
        assert!(
            ended.success() && found.starts_with("hash=") && found.trim_end().len() == 5 + 64,
            "{found}"
        );
        found
    }

    #[test]
    fn a_change_of_any_crate_that_the_program_is_made_of_gives_another_key() {
        let folder = tempfile::tempdir().unwrap();
        let workspace = workspace();
        let crates = made_of("convergence-study", &workspace);
        assert!(
            crates.contains("crates/convergence-judge") && crates.len() < workspace.len(),
            "{crates:?}"
        );
        let others = workspace
            .iter()
            .map(|(_, folder)| folder)
            .filter(|folder| !crates.contains(*folder));
        let manifests = ["Cargo.toml", "Cargo.lock"].map(str::to_owned);
        let source = |crate_folder: &String| format!("{crate_folder}/src/lib.rs");
        let program: Vec<String> = crates.iter().map(source).chain(manifests).collect();
        let others: Vec<String> = others.map(source).collect();
        for file in program.iter().chain(&others) {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "old").unwrap();
        }
        fs::create_dir_all(folder.path().join("crates/convergence-study/ci")).unwrap();
        let before = key(folder.path());
        for (file, changes) in program
            .iter()
            .map(|file| (file, true))
            .chain(others.iter().map(|file| (file, false)))
        {
            fs::write(folder.path().join(file), "new").unwrap();
            assert_eq!(key(folder.path()) != before, changes, "{file}");
            fs::write(folder.path().join(file), "old").unwrap();
        }
    }
}

/// The installation of a released program, from a folder in place of the releases.
#[cfg(unix)]
mod install {
    use std::process::{Command, Output};

    use super::*;

    const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// A folder with the releases of this version for Linux, whose program is a script.
    fn releases() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let name = format!("convergence-study-{VERSION}-x86_64-unknown-linux-musl");
        let pack = format!(
            "mkdir -p 'v{VERSION}' {name} && printf '#!/bin/sh\\necho released\\n' >{name}/convergence-study && \
             chmod +x {name}/convergence-study && tar -czf 'v{VERSION}/{name}.tar.gz' {name} && \
             cd 'v{VERSION}' && sha256sum {name}.tar.gz >{name}.tar.gz.sha256"
        );
        let mut shell = Command::new("sh");
        shell.args(["-euc", &pack]).current_dir(folder.path());
        assert!(shell.status().unwrap().success());
        folder
    }

    #[derive(Debug)]
    struct Installed {
        output: Output,
        /// What the step adds to the PATH.
        path: String,
    }

    fn install(releases: &Path, version: &str, architecture: &str) -> Installed {
        let file = releases.join("path");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("ci/install.sh");
        let mut command = Command::new("timeout");
        command.args(["120", "bash"]).arg(script);
        command.envs([
            ("VERSION", version),
            ("RUNNER_OS", "Linux"),
            ("RUNNER_ARCH", architecture),
        ]);
        command
            .env("DOWNLOADS", format!("file://{}", releases.display()))
            .env("RUNNER_TEMP", releases)
            .env("GITHUB_PATH", &file);
        Installed {
            output: command.output().unwrap(),
            path: fs::read_to_string(file).unwrap_or_default(),
        }
    }

    #[track_caller]
    fn is_refused(installed: &Installed, reason: &str) {
        let printed = String::from_utf8_lossy(&installed.output.stdout);
        assert_eq!(installed.output.status.code(), Some(2), "{printed}");
        assert!(printed.contains(reason), "{printed}");
        assert_eq!(installed.path, "");
    }

    #[test]
    fn the_program_of_a_version_is_installed_with_its_sum() {
        for version in ["", VERSION, concat!("v", env!("CARGO_PKG_VERSION"))] {
            let releases = releases();
            let installed = install(releases.path(), version, "X64");
            assert_eq!(installed.output.status.code(), Some(0), "{installed:?}");
            let program = Path::new(installed.path.trim_end()).join("convergence-study");
            let released = Command::new(program).output().unwrap();
            assert_eq!(released.stdout, b"released\n");
        }
    }

    #[test]
    fn a_program_with_another_sum_is_not_installed() {
        let releases = releases();
        let name =
            format!("v{VERSION}/convergence-study-{VERSION}-x86_64-unknown-linux-musl.tar.gz");
        let archive = releases.path().join(name);
        let mut bytes = fs::read(&archive).unwrap();
        bytes.push(0);
        fs::write(&archive, bytes).unwrap();
        is_refused(&install(releases.path(), "", "X64"), "found the sum");
    }

    #[test]
    fn what_is_not_released_is_named() {
        let releases = releases();
        let missing = install(releases.path(), "99.0.0", "X64");
        is_refused(&missing, "expected a released `version`");
        let unknown = install(releases.path(), "", "RISCV64");
        is_refused(&unknown, "no program is released for Linux RISCV64");
    }
}

/// The script of the action as the runner runs it, with the program itself.
#[cfg(unix)]
mod script {
    use std::process::Command;

    use super::*;

    struct Ran {
        folder: tempfile::TempDir,
        status: Option<i32>,
        output: String,
    }

    fn run(asked: &str) -> Ran {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("bin")).unwrap();
        fs::create_dir(at("temporary files")).unwrap();
        std::os::unix::fs::symlink(
            env!("CARGO_BIN_EXE_convergence-study"),
            at("bin/convergence-study"),
        )
        .unwrap();
        fs::write(
            at("errors.csv"),
            "h,L2\n0.4,1.6e-1\n0.2,4e-2\n0.1,1e-2\n0.05,2.5e-3\n0.025,6.25e-4\n",
        )
        .unwrap();
        let path = format!("{}:{}", at("bin").display(), std::env::var("PATH").unwrap());
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("ci/run.sh");
        // A script that hangs is ended.
        let mut command = Command::new("timeout");
        command
            .args(["120", "bash"])
            .arg(script)
            .current_dir(folder.path())
            .env("PATH", path)
            .env("RUN", asked);
        command
            .env("RUNNER_TEMP", at("temporary files"))
            .env("GITHUB_OUTPUT", at("output"));
        let status = command
            .env_remove("GITHUB_ACTIONS")
            .output()
            .unwrap()
            .status
            .code();
        let output = fs::read_to_string(at("output")).unwrap_or_default();
        Ran {
            folder,
            status,
            output,
        }
    }

    #[test]
    fn the_step_ends_as_the_program_does_and_hands_on_the_report() {
        for (asked, status) in [
            ("rates errors.csv --order 2", 0),
            ("rates errors.csv --order 1", 1),
        ] {
            let ran = run(asked);
            assert_eq!(ran.status, Some(status));
            assert!(
                ran.output.starts_with(&format!("status={status}\nreport=")),
                "{}",
                ran.output
            );
            let comment = ran
                .output
                .lines()
                .find_map(|line| line.strip_prefix("comment="))
                .unwrap();
            assert!(
                comment.starts_with(&ran.folder.path().display().to_string()),
                "{comment}"
            );
            assert!(
                fs::read_to_string(comment)
                    .unwrap()
                    .starts_with("# Rates of errors.csv\n"),
                "{comment}"
            );
        }
    }

    #[test]
    fn where_nothing_was_written_nothing_is_handed_on() {
        for asked in ["rates missing.csv --order 2", "verify", "nonsense"] {
            let ran = run(asked);
            assert_eq!(
                (ran.status, ran.output.as_str()),
                (Some(2), "status=2\n"),
                "{asked}"
            );
        }
    }
}
