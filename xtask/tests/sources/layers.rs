//! What may use what: between the crates of the workspace, and between the folders of the harness.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use toml::{Table, Value};

use super::{crate_folder, files, paths, without_comments};
use crate::place::read;

const HARNESS: &str = "convergence-study";

/// What may use what.
#[derive(serde::Deserialize)]
struct Layers {
    modules: Vec<String>,
    below: Vec<String>,
    foreign: Vec<String>,
    not_in_the_solver: Vec<String>,
    libraries: BTreeMap<String, Vec<String>>,
    crates: BTreeMap<String, Vec<String>>,
}

static LAYERS: LazyLock<Layers> =
    LazyLock::new(|| toml::from_str(include_str!("layers.toml")).expect("layers"));

/// The words of the application in a text, each with its line.
fn foreign(text: &str) -> Vec<String> {
    // The address of a schema has the name of the repository.
    let is_address = |line: &str| line.starts_with("#:schema https://");
    let lines = (1..).zip(text.lines());
    let lines = lines.filter(|(_, line)| !is_address(line));
    lines
        .flat_map(|(number, line)| {
            let words = line.split(|c: char| !c.is_alphabetic());
            let words = words.map(str::to_lowercase);
            let found = words.filter(|word| LAYERS.foreign.contains(word));
            found.map(move |word| format!("{number}: {word}"))
        })
        .collect()
}

#[test]
fn nothing_in_the_harness_names_the_application() {
    let folders = ["src", "tests", "examples"].map(|name| crate_folder(HARNESS).join(name));
    let found: Vec<String> = folders
        .iter()
        .flat_map(|folder| files(folder, &["rs", "js", "css", "toml", "csv"]))
        .chain(files(
            &crate_folder("convergence-judge").join("src"),
            &["rs", "md"],
        ))
        .chain(["README.md", "Cargo.toml"].map(|name| crate_folder(HARNESS).join(name)))
        // It has the Greek letters.
        .filter(|path| !path.ends_with("src/rates/latex.rs"))
        .flat_map(|path| {
            let found = foreign(&fs::read_to_string(&path).unwrap()).into_iter();
            found.map(move |word| format!("{}:{word}", path.display()))
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert_eq!(
        foreign("fn a() {}\n// the Obstacle's g1, beam_length\n"),
        ["2: obstacle", "2: beam"]
    );
}

/// The module of the first level that a source file belongs to.
fn module(path: &Path) -> String {
    let inside = path.strip_prefix(crate_folder(HARNESS).join("src"));
    let first = inside.unwrap().iter().next().unwrap();
    first.to_string_lossy().trim_end_matches(".rs").to_owned()
}

/// What a module uses that it may not.
fn breaches(module: &str, text: &str) -> Vec<String> {
    let code = without_comments(text);
    let place = |name: &str| LAYERS.modules.iter().position(|known| known == name);
    let is_allowed = |path: &String| {
        let target = path.split("::").next().unwrap_or(path);
        let is_below = || Some(place(target)? <= place(module)?);
        let mut below = LAYERS.below.iter();
        path.is_empty() || below.any(|name| name == target) || is_below() == Some(true)
    };
    let mut found = paths(&code, "crate");
    found.retain(|path| !is_allowed(path));
    for (name, of) in &LAYERS.libraries {
        if !of.iter().any(|user| user == module) && code.contains(&format!("{name}::")) {
            found.push(format!("the library {name}"));
        }
    }
    found
}

#[test]
fn modules_use_only_those_below_them() {
    let mut seen = BTreeSet::new();
    let mut found = vec![];
    for path in files(&crate_folder(HARNESS).join("src"), &["rs"]) {
        let module = module(&path);
        if !["lib", "main", "tests"].contains(&module.as_str()) {
            let own = breaches(&module, &fs::read_to_string(&path).unwrap());
            found.extend(own.iter().map(|used| format!("{module} uses {used}")));
            seen.insert(module);
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    let ordered = LAYERS.modules.iter().cloned().collect();
    assert_eq!(seen, ordered, "every module has its place in the order");
}

#[test]
fn a_use_against_the_order_is_found() {
    for (module, text, found) in [
        ("input", "use crate::run::queue;", "run::queue"),
        (
            "study",
            "fn f() { crate::store::atomic::write(); }",
            "store::atomic::write",
        ),
        (
            "input",
            "pub(crate) use crate::{chart::axis, study, judge};",
            "chart::axis, study",
        ),
        ("report", "use rayon::prelude::*;", "the library rayon"),
        ("store", "use crate::nowhere;", "nowhere"),
        (
            "store",
            "use crate::run::Finished; pub(crate) struct A; // crate::cli",
            "",
        ),
    ] {
        assert_eq!(breaches(module, text).join(", "), found, "{text}");
    }
}

/// The modules of `lib.rs` that exist without any feature.
fn always_there(lib: &str) -> BTreeSet<String> {
    let lines: Vec<&str> = lib.lines().collect();
    let ungated = |(number, line): (usize, &&str)| {
        let name = line.strip_prefix("mod ")?.strip_suffix(';')?;
        let before = number.checked_sub(1).map_or("", |above| lines[above]);
        (!before.starts_with("#[cfg(feature")).then(|| name.to_owned())
    };
    lines.iter().enumerate().filter_map(ungated).collect()
}

#[test]
fn a_library_that_the_rule_does_without_is_optional() {
    let modules = always_there(&read(&format!("crates/{HARNESS}/src/lib.rs")));
    assert_eq!(
        modules,
        ["column", "run", "study", "taylor"]
            .map(str::to_owned)
            .into()
    );
    let known = dependencies(HARNESS, false);
    for (library, users) in &LAYERS.libraries {
        let dependency = known.get(library).expect(library);
        let is_optional = dependency.get("optional").and_then(Value::as_bool);
        let is_needed = users.iter().any(|user| modules.contains(user));
        assert_eq!(is_optional == Some(true), !is_needed, "{library}");
    }
    assert_eq!(
        always_there("#[cfg(feature = \"a\")]\nmod a;\nmod b;\n"),
        ["b".to_owned()].into()
    );
}

/// The dependencies in all tables of a crate's manifest; with those for tests if `of_tests`.
fn dependencies(name: &str, of_tests: bool) -> Table {
    let manifest: Table = read(&format!("crates/{name}/Cargo.toml")).parse().unwrap();
    let targets = manifest.get("target").and_then(Value::as_table);
    let targets = targets.into_iter().flat_map(Table::values);
    let tables = targets.filter_map(Value::as_table).chain([&manifest]);
    let mut kinds = vec!["dependencies", "build-dependencies"];
    kinds.extend(of_tests.then_some("dev-dependencies"));
    let own = |table: &Table| {
        let own = kinds.iter().filter_map(|kind| table.get(*kind)?.as_table());
        own.flat_map(Table::clone).collect::<Vec<_>>()
    };
    tables.flat_map(own).collect()
}

#[test]
fn crates_depend_only_on_those_below_them() {
    for (name, allowed) in &LAYERS.crates {
        // Tests may use a crate above the one tested, but not here: the harness is tested without
        // the application.
        let found = dependencies(name, name == HARNESS);
        let mut names: Vec<&String> = LAYERS.crates.keys().collect();
        names.retain(|name| found.contains_key(*name));
        assert!(names.into_iter().eq(allowed), "{name}");
    }
}

#[test]
fn the_solver_does_without_threads_and_files() {
    let found = dependencies("thermobeam", false);
    assert!(found.contains_key("thiserror"), "{found:?}");
    let mut refused = LAYERS.not_in_the_solver.iter();
    assert!(!refused.any(|name| found.contains_key(name)), "{found:?}");
}
