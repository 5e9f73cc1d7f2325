//! The key under which the action keeps the compiled program.

use super::*;

/// The folders of the crates of the workspace.
fn workspace() -> BTreeSet<String> {
    let manifest = text("../../Cargo.toml");
    let folder = |line: &str| {
        let (_, rest) = line.split_once(" = { path = \"")?;
        Some(rest.split('"').next()?.to_owned())
    };
    manifest.lines().filter_map(folder).collect()
}

/// Those that the program is made of.
fn made_of(workspace: &BTreeSet<String>) -> BTreeSet<String> {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--offline", "--edges", "normal", "--prefix", "none"]);
    let output = tree.args(["--package", "convergence-study"]).output();
    let crates = String::from_utf8(output.unwrap().stdout).unwrap();
    let is_below = |folder: &&String| crates.contains(&format!("/{folder})"));
    workspace.iter().filter(is_below).cloned().collect()
}

/// The key that the action computes in a copy of the repository.
fn key(root: &Path) -> String {
    let action = yaml(&text("ci/action.yml"));
    let script = &step(&action["runs"], "source")["run"];
    let mut command = Command::new("bash");
    command.args(["-euo", "pipefail", "-c", script.as_str().unwrap()]);
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
    foreign_tools::needs!(BASH);
    let folder = tempfile::tempdir().unwrap();
    let workspace = workspace();
    let crates = made_of(&workspace);
    assert!(
        crates.contains("crates/convergence-judge") && crates.len() < workspace.len(),
        "{crates:?}"
    );
    let others = workspace.difference(&crates);
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
    for file in program.iter().chain(&others) {
        fs::write(folder.path().join(file), "new").unwrap();
        let is_changed = key(folder.path()) != before;
        assert_eq!(is_changed, program.contains(file), "{file}");
        fs::write(folder.path().join(file), "old").unwrap();
    }
}
