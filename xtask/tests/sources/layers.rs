//! What may use what: between the crates of the workspace, and between the folders of the harness.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::{crate_folder, files, without_comments};

const HARNESS: &str = "convergence-study";

/// Words of the application that the harness was first written for; it must serve any other as
/// well.
const FOREIGN: [&str; 21] = [
    "beam",
    "beams",
    "clamped",
    "contact",
    "contacts",
    "equilibria",
    "equilibrium",
    "kirchhoff",
    "obstacle",
    "obstacles",
    "phi",
    "scene",
    "scenes",
    "thermal",
    "thermobeam",
    "thermoviscoelastic",
    "theta",
    "timoshenko",
    "tip",
    "viscosity",
    "zeta",
];

/// The modules of the harness from bottom to top: each may use itself and those before it.
const ORDER: [&str; 14] = [
    "input",
    "chart",
    "exchange",
    "taylor",
    "rates",
    "study",
    "run",
    "where_lost",
    "project",
    "store",
    "program",
    "report",
    "verify",
    "cli",
];

/// The modules of the judge, which every module may use under the harness's name.
const BELOW: [&str; 3] = ["interval", "text", "judge"];

/// Libraries that only some modules may use.
const LIBRARIES: [(&str, &[&str]); 11] = [
    ("clap", &["cli"]),
    ("clap_complete", &["cli"]),
    ("console", &["cli"]),
    ("ctrlc", &["cli"]),
    ("indicatif", &["cli"]),
    ("manufacture", &["cli"]),
    ("nix", &["program"]),
    ("toml", &["input"]),
    ("plotters", &["chart"]),
    ("minijinja", &["report"]),
    ("rayon", &["run"]),
];

/// The crates of the workspace, and which of them each may depend on.
const CRATES: [(&str, &[&str]); 9] = [
    (
        "convergence-calibration",
        &["convergence-judge", "convergence-study"],
    ),
    ("convergence-judge", &[]),
    ("manufacture", &[]),
    ("convergence-study", &["convergence-judge", "manufacture"]),
    ("convergence-study-tests", &["convergence-study"]),
    ("thermobeam", &[]),
    ("thermobeam-exact", &["manufacture", "thermobeam"]),
    (
        "thermobeam-study",
        &[
            "convergence-judge",
            "convergence-study",
            "thermobeam",
            "thermobeam-exact",
        ],
    ),
    (
        "thermobeam-cli",
        &[
            "convergence-judge",
            "convergence-study",
            "thermobeam",
            "thermobeam-exact",
            "thermobeam-study",
        ],
    ),
];

/// Libraries that the solver must not use.
const NOT_IN_THE_SOLVER: [&str; 2] = ["rayon", "serde"];

fn words(text: &str) -> impl Iterator<Item = String> {
    text.split(|c: char| !c.is_alphabetic())
        .map(str::to_lowercase)
}

fn foreign(text: &str) -> Vec<(usize, String)> {
    let in_line = |(number, line): (usize, &str)| {
        let found = words(line).filter(|word| FOREIGN.contains(&word.as_str()));
        found.map(|word| (number + 1, word)).collect::<Vec<_>>()
    };
    // The address of a schema has the name of the repository.
    let is_address = |line: &str| line.starts_with("#:schema https://");
    let lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !is_address(line));
    lines.flat_map(in_line).collect()
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
            let text = fs::read_to_string(&path).unwrap();
            foreign(&text)
                .into_iter()
                .map(move |(line, word)| format!("{}:{line}: {word}", path.display()))
        })
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert_eq!(
        foreign("fn a() {}\n// the Obstacle's g1, beam_length\n"),
        [(2, "obstacle".into()), (2, "beam".into())]
    );
}

/// The paths that follow `crate::` in a source, up to two segments, braces resolved one level deep.
fn uses(text: &str) -> BTreeSet<String> {
    let segment = |text: &str| {
        text.chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices("crate::") {
        if text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &text[at + "crate::".len()..];
        let list = rest
            .strip_prefix('{')
            .and_then(|rest| rest.split_once('}'))
            .map(|(list, _)| list);
        for path in list.map_or(vec![rest], |list| list.split(',').map(str::trim).collect()) {
            let first = segment(path);
            let second = path[first.len()..]
                .strip_prefix("::")
                .map(segment)
                .filter(|second| !second.is_empty());
            found.insert(second.map_or(first.clone(), |second| format!("{first}::{second}")));
        }
    }
    found.retain(|path| !path.is_empty());
    found
}

/// The module of the first level that a source file belongs to.
fn module(path: &Path) -> String {
    let inside = path
        .strip_prefix(crate_folder(HARNESS).join("src"))
        .unwrap();
    inside
        .components()
        .next()
        .unwrap()
        .as_os_str()
        .to_string_lossy()
        .trim_end_matches(".rs")
        .to_owned()
}

fn breaches(module: &str, text: &str) -> Vec<String> {
    let place = |name: &str| ORDER.iter().position(|known| *known == name);
    let is_allowed = |path: &String| {
        let target = path.split("::").next().unwrap_or(path);
        BELOW.contains(&target)
            || place(target).is_some_and(|target| place(module).is_some_and(|own| target <= own))
    };
    let upwards = uses(text)
        .into_iter()
        .filter(|path| !is_allowed(path))
        .map(|path| format!("{module} uses {path}"));
    let libraries = LIBRARIES
        .iter()
        .filter(|(name, of)| !of.contains(&module) && text.contains(&format!("{name}::")));
    upwards
        .chain(libraries.map(|(name, _)| format!("{module} uses the library {name}")))
        .collect()
}

#[test]
fn modules_use_only_those_below_them() {
    let mut seen = BTreeSet::new();
    let mut found = vec![];
    for path in files(&crate_folder(HARNESS).join("src"), &["rs"]) {
        let module = module(&path);
        if !["lib", "main", "tests"].contains(&module.as_str()) {
            found.extend(breaches(
                &module,
                &without_comments(&fs::read_to_string(&path).unwrap()),
            ));
            seen.insert(module);
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert_eq!(
        seen,
        ORDER.map(str::to_owned).into(),
        "every module has its place in the order"
    );
}

#[test]
fn a_use_against_the_order_is_found() {
    for (module, text, found) in [
        ("input", "use crate::run::queue;", "input uses run::queue"),
        (
            "study",
            "fn f() { crate::store::atomic::write(); }",
            "study uses store::atomic",
        ),
        (
            "input",
            "pub(crate) use crate::{chart::axis, study, judge};",
            "input uses chart::axis, input uses study",
        ),
        (
            "report",
            "use rayon::prelude::*;",
            "report uses the library rayon",
        ),
        ("store", "use crate::nowhere;", "store uses nowhere"),
        (
            "store",
            "use crate::run::Finished; pub(crate) struct A; // crate::cli",
            "",
        ),
    ] {
        assert_eq!(
            breaches(module, &without_comments(text)).join(", "),
            found,
            "{text}"
        );
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
    let read = |file: &str| fs::read_to_string(crate_folder(HARNESS).join(file)).unwrap();
    let (modules, manifest) = (always_there(&read("src/lib.rs")), read("Cargo.toml"));
    assert_eq!(
        modules,
        ["run", "study", "taylor"].map(str::to_owned).into()
    );
    for (library, users) in LIBRARIES {
        let is_its_line = |line: &&str| {
            line.split(['.', ' '])
                .next()
                .unwrap_or("")
                .replace('-', "_")
                == library
        };
        let line = manifest
            .lines()
            .find(is_its_line)
            .unwrap_or_else(|| panic!("{library} in Cargo.toml"));
        let is_needed = users.iter().any(|user| modules.contains(*user));
        assert_eq!(line.contains("optional = true"), !is_needed, "{line}");
    }
    assert_eq!(
        always_there("#[cfg(feature = \"a\")]\nmod a;\nmod b;\n"),
        ["b".to_owned()].into()
    );
}

/// The names of the crates in a manifest's tables of dependencies; with those for tests if
/// `of_tests`.
fn dependencies(manifest: &str, of_tests: bool) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut is_table = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(table) = line.strip_prefix('[') {
            let table = table.trim_end_matches(']');
            let ends = |name: &str| table == name || table.ends_with(&format!(".{name}"));
            is_table = ends("dependencies")
                || ends("build-dependencies")
                || (of_tests && ends("dev-dependencies"));
        } else if is_table && !line.starts_with('#') {
            let name = line.split(['.', '=', ' ']).next().unwrap_or("");
            if !name.is_empty() {
                names.insert(name.to_owned());
            }
        }
    }
    names
}

#[test]
fn crates_depend_only_on_those_below_them() {
    let names = CRATES.map(|(name, _)| name);
    for (name, allowed) in CRATES {
        let path = crate_folder(name).join("Cargo.toml");
        let manifest = fs::read_to_string(&path).unwrap();
        // Tests may use a crate above the one tested, but not here: the harness is tested without
        // the application.
        let found = dependencies(&manifest, name == HARNESS);
        let found: Vec<&str> = names
            .into_iter()
            .filter(|name| found.contains(*name))
            .collect();
        assert_eq!(found, allowed, "{name}");
    }
}

#[test]
fn the_solver_does_without_threads_and_files() {
    let path = crate_folder("thermobeam").join("Cargo.toml");
    let manifest = fs::read_to_string(path).unwrap();
    let found = dependencies(&manifest, false);
    assert!(found.contains("thiserror"), "{found:?}");
    assert!(
        NOT_IN_THE_SOLVER.iter().all(|name| !found.contains(*name)),
        "{found:?}"
    );
}

#[test]
fn dependencies_are_read_from_every_table() {
    let manifest = "[dependencies]\na.workspace = true\n# b = 1\n[target.'cfg(unix)'.dependencies]\nc = { path = \"x\" }\n\
                    [dev-dependencies]\nd = \"1\"\n[lints]\ne = 1\n";
    let set = |names: &[&str]| {
        names
            .iter()
            .map(|name| (*name).to_owned())
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(dependencies(manifest, false), set(&["a", "c"]));
    assert_eq!(dependencies(manifest, true), set(&["a", "c", "d"]));
}
