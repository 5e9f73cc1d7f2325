//! Tests that no files of a crate form a circle, and that no folder uses one above it. The
//! workspace is checked if it is present.
//!
//! A file uses those whose items its paths name, also through re-exports; items shared by a module
//! and the files below it do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The crates in which no file may use one that uses it.
const CRATES: [&str; 7] = [
    "convergence-calibration",
    "convergence-judge",
    "convergence-harness",
    "thermobeam",
    "thermobeam-cli",
    "thermobeam-exact",
    "thermobeam-study",
];

/// The modules of other crates from bottom to top, if they are ordered: each may use itself and
/// those before it. `layering.rs` has the modules of this crate.
const ORDERS: [(&str, &[&str]); 5] = [
    (
        "convergence-calibration",
        &[
            "sheet",
            "draw",
            "shapes",
            "laws",
            "hidden",
            "held_out",
            "rules",
            "intervals",
            "claims",
            "bars",
            "grids",
            "kind",
        ],
    ),
    ("convergence-judge", &["time_limit", "text", "judge"]),
    (
        "thermobeam",
        &[
            "bracket",
            "lanes",
            "mesh",
            "parameters",
            "scheme",
            "norms",
            "contact",
            "kirchhoff",
            "error",
            "block_tridiagonal",
            "tridiagonal",
            "contraction",
            "linearized",
            "solve",
            "energy",
            "dg",
            "simulation",
            "ensemble",
        ],
    ),
    (
        "thermobeam-exact",
        &[
            "norm",
            "quadrature",
            "assembly",
            "expression",
            "function",
            "formulas",
            "defect",
            "solution",
            "sources",
            "errors",
            "any_order",
            "stumpff",
            "equilibrium",
            "vibration",
        ],
    ),
    (
        "thermobeam-study",
        &[
            "scene", "run", "figures", "error", "predict", "sweep", "kinds", "timing",
        ],
    ),
];

/// Remaining uses against these orders: crate, file, file used.
const ARROWS_UP: [(&str, &str, &str); 4] = [
    ("thermobeam", "solve/balance", "energy"),
    ("thermobeam", "solve/balance", "energy/sums"),
    ("thermobeam", "solve/stepper", "energy"),
    ("thermobeam-exact", "expression", "function"),
];

/// A module by its path inside the crate; empty for the root.
type Module = Vec<String>;

/// The code of a crate's modules, without comments and tests.
type Code = BTreeMap<Module, String>;

fn path(text: &str) -> Module {
    text.split("::")
        .map(str::trim)
        .filter(|part| !part.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Reads the sources of a crate.
fn code(folder: &Path, above: &Module, code: &mut Code) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let entry = entry.unwrap().path();
        let stem = entry.file_stem().unwrap().to_string_lossy().into_owned();
        let module = [&above[..], std::slice::from_ref(&stem)].concat();
        if entry.is_dir() {
            self::code(&entry, &module, code);
        } else if entry.extension().is_some_and(|extension| extension == "rs") && stem != "main" {
            let text = fs::read_to_string(&entry).unwrap();
            let text = text
                .split("\n#[cfg(test)]")
                .next()
                .unwrap()
                .split("\n#[cfg(all(test")
                .next()
                .unwrap();
            let lines: Vec<&str> = text
                .lines()
                .map(|line| line.split("//").next().unwrap_or(""))
                .collect();
            let module = if stem == "mod" || stem == "lib" {
                above.clone()
            } else {
                module
            };
            code.insert(module, lines.join("\n"));
        }
    }
}

/// The paths of a `use`, its braces resolved.
fn spread(text: &str) -> Vec<String> {
    let Some((before, list)) = text.split_once('{') else {
        return vec![text.split(" as ").next().unwrap().to_owned()];
    };
    let list = list.rsplit_once('}').map_or(list, |(list, _)| list);
    let (mut items, mut depth) = (vec![String::new()], 0);
    for c in list.chars() {
        match c {
            ',' if depth == 0 => items.push(String::new()),
            _ => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                items.last_mut().unwrap().push(c);
            }
        }
    }
    let items = items
        .iter()
        .map(|item| item.trim())
        .filter(|item| !item.is_empty());
    items
        .flat_map(spread)
        .map(|item| format!("{}{item}", before.trim()))
        .collect()
}

/// A path relative to the crate's root; `None` for a path into another crate.
fn absolute(from: &Module, text: &str, code: &Code) -> Option<Module> {
    let mut parts = path(text);
    let base = match parts.first()?.as_str() {
        "crate" => vec![],
        "self" => from.clone(),
        "super" => {
            let up = parts.iter().take_while(|part| *part == "super").count();
            parts.drain(..up - 1);
            from[..from.len().checked_sub(up)?].to_vec()
        }
        first => {
            let below = [&from[..], &[first.to_owned()]].concat();
            return code
                .contains_key(&below)
                .then(|| [&from[..], &parts].concat());
        }
    };
    Some([base, parts[1..].to_vec()].concat())
}

/// The files that each file uses.
fn graph(code: &Code) -> BTreeMap<&Module, BTreeSet<&Module>> {
    let (mut names, mut used) = (BTreeMap::new(), vec![]);
    for (module, text) in code {
        for statement in text.split(';') {
            let import = statement
                .rsplit_once("use ")
                .map(|(_, import)| import)
                .filter(|import| !import.contains("fn "));
            for found in import
                .into_iter()
                .flat_map(spread)
                .filter_map(|found| absolute(module, &found, code))
            {
                if let Some(name) = found.last() {
                    names.insert(
                        [&module[..], std::slice::from_ref(name)].concat(),
                        found.clone(),
                    );
                }
                used.push((module, found));
            }
        }
        let is_of_a_path = |c: char| c.is_alphanumeric() || matches!(c, '_' | ':');
        let paths = text
            .split(|c| !is_of_a_path(c))
            .filter(|word| word.contains("::"));
        used.extend(paths.filter_map(|found| Some((module, absolute(module, found, code)?))));
    }
    let mut graph: BTreeMap<&Module, BTreeSet<&Module>> = BTreeMap::new();
    for (module, found) in used {
        if let Some(target) = file(&found, code, &names, 5) {
            let is_below = |one: &Module, other: &Module| one.starts_with(other);
            if !is_below(module, target) && !is_below(target, module) {
                graph.entry(module).or_default().insert(target);
            }
        }
    }
    graph
}

/// The file that holds the item of a path; `often` limits how many re-exports are followed.
fn file<'c>(
    found: &Module,
    code: &'c Code,
    names: &BTreeMap<Module, Module>,
    often: usize,
) -> Option<&'c Module> {
    let length = (0..=found.len())
        .rev()
        .find(|length| code.contains_key(&found[..*length]))?;
    let (module, _) = code.get_key_value(&found[..length])?;
    let name = found
        .get(..=length)
        .and_then(|name| names.get(name))
        .filter(|whole| *whole != found && often > 0);
    match name {
        Some(whole) => file(
            &[whole, &found[length + 1..]].concat(),
            code,
            names,
            often - 1,
        ),
        None => Some(module),
    }
}

/// All files reachable from a file.
fn reached<'c>(
    from: &'c Module,
    graph: &BTreeMap<&'c Module, BTreeSet<&'c Module>>,
) -> BTreeSet<&'c Module> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(next) = open.pop() {
        open.extend(
            graph
                .get(next)
                .into_iter()
                .flatten()
                .filter(|file| reached.insert(**file)),
        );
    }
    reached
}

/// Files that reach each other, each group sorted.
fn circles(graph: &BTreeMap<&Module, BTreeSet<&Module>>) -> BTreeSet<Vec<String>> {
    let all: BTreeMap<&Module, BTreeSet<&Module>> = graph
        .keys()
        .map(|file| (*file, reached(file, graph)))
        .collect();
    let of = |file: &&Module| {
        let mutual = all[*file]
            .iter()
            .filter(|other| all.get(**other).is_some_and(|back| back.contains(file)));
        mutual.map(|other| other.join("/")).collect::<Vec<_>>()
    };
    all.keys()
        .map(of)
        .filter(|circle| circle.len() > 1)
        .collect()
}

/// The sources of a crate of the workspace; empty without a workspace.
fn sources(name: &str) -> Code {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(name)
        .join("src");
    let mut sources = Code::new();
    code(&folder, &vec![], &mut sources);
    assert!(
        name != "convergence-harness" || sources.len() > 50,
        "{}",
        folder.display()
    );
    sources
}

#[test]
fn no_file_uses_one_that_uses_it() {
    for name in CRATES {
        let found = circles(&graph(&sources(name)));
        assert!(found.is_empty(), "{name}: circles of files: {found:?}");
    }
}

/// Uses of a module above, `file -> file`.
fn upwards(order: &[&str], graph: &BTreeMap<&Module, BTreeSet<&Module>>) -> Vec<String> {
    let place = |module: &Module| {
        order
            .iter()
            .position(|known| module.first().is_some_and(|first| first == known))
    };
    let all = graph
        .iter()
        .flat_map(|(file, used)| used.iter().map(move |other| (file, other)));
    let up = all.filter(|(file, used)| place(file).is_none() || place(file) < place(used));
    up.map(|(file, used)| format!("{} -> {}", file.join("/"), used.join("/")))
        .collect()
}

#[test]
fn no_folder_uses_one_above_it() {
    for (name, order) in ORDERS {
        let known: Vec<String> = ARROWS_UP
            .iter()
            .filter(|(of, ..)| *of == name)
            .map(|(_, a, b)| format!("{a} -> {b}"))
            .collect();
        let found = upwards(order, &graph(&sources(name)));
        let new: Vec<_> = found
            .iter()
            .filter(|arrow| !known.contains(arrow))
            .collect();
        assert!(new.is_empty(), "{name}: against the order: {new:#?}");
    }
    let code: Code = [("a", "use crate::b::B;"), ("b", "")]
        .map(|(module, text)| (path(module), text.to_owned()))
        .into();
    assert_eq!(upwards(&["a", "b"], &graph(&code)), ["a -> b"]);
    assert!(upwards(&["b", "a"], &graph(&code)).is_empty());
}

#[test]
fn a_circle_is_found_through_imports_paths_and_re_exports() {
    let of = |files: &[(&str, &str)]| {
        let code: Code = files
            .iter()
            .map(|(module, text)| (path(module), (*text).to_owned()))
            .collect();
        circles(&graph(&code))
            .into_iter()
            .map(|circle| circle.join(" "))
            .collect::<Vec<_>>()
    };
    let root = ("", "mod a;\nmod b;\npub use b::B;\n");
    for (a, b, circle) in [
        ("use super::b::B;\n", "use crate::a::{self, A};\n", true),
        (
            "fn f() { crate::b::g(); }",
            "use super::{a::A, c::C};\n",
            true,
        ),
        ("use crate::B;\n", "pub struct B; use super::a;\n", true),
        ("use super::b::{B, C as D};\n", "use std::a::A;\n", false),
        ("use super::root;\n", "use super::root;\n", false),
    ] {
        let found = of(&[root, ("a", a), ("b", b)]);
        assert_eq!(found, if circle { vec!["a b"] } else { vec![] }, "{a}{b}");
    }
    assert_eq!(
        spread("crate::{a::{B, c::D}, e}"),
        ["crate::a::B", "crate::a::c::D", "crate::e"]
    );
    assert!(
        of(&[root, ("a", "use b::X;\n"), ("a::b", "use super::X;\n")]).is_empty(),
        "a module and what is below it"
    );
}
