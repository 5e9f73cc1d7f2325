//! The key under which the action keeps the compiled program.

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
    if !foreign_tools::are_here(&[foreign_tools::BASH]) {
        return;
    }
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
