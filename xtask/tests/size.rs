//! The ratchet: files, lines and types of each crate, in `src` and outside it, and names shared by several of its types,
//! against `.ci/size.toml`. They may only decrease.
//!
//! All tracked `.rs` and `.py` files count. Files outside `src` have their own entries, so moving code does not count as shrinking. A
//! crate that has shrunk passes: `LOWER_SIZE=1 cargo test -p xtask --test size` writes its new size. To grow, edit the list and give
//! the reason in the commit.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files, lines, and definitions of types outside `#[cfg(test)]`.
type Size = [usize; 3];
const NAMES: [&str; 3] = ["files", "lines", "types"];

/// A table for `src`, one for other files, one for homonyms; each lists the crates, or the folders outside all crates.
type Sizes = BTreeMap<String, BTreeMap<String, BTreeMap<String, usize>>>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The names of the types that a file defines, except in tests.
fn types(text: &str) -> Vec<String> {
    let (mut is_test, mut is_open, mut depth, mut types) = (false, false, 0, vec![]);
    for line in text.lines().map(str::trim) {
        if !is_test && line.starts_with("#[cfg(test)]") {
            (is_test, is_open, depth) = (true, false, 0);
        }
        if is_test {
            depth += line.matches('{').count() as i32 - line.matches('}').count() as i32;
            is_open |= line.contains('{');
            is_test = !(is_open && depth <= 0);
            continue;
        }
        let rest = line.strip_prefix("pub").map_or(line, |rest| rest.trim_start_matches(|c| c != ' ').trim_start());
        let kinds = ["struct ", "enum ", "type ", "trait ", "union ", "class "];
        let name = kinds.iter().find_map(|kind| rest.strip_prefix(kind));
        let is_of_a_name = |c: &char| c.is_alphanumeric() || *c == '_';
        types.extend(name.map(|name| name.chars().take_while(is_of_a_name).collect::<String>()));
    }
    types
}

fn size(text: &str) -> Size {
    [1, text.lines().count(), types(text).len()]
}

/// The table and the entry of a file.
fn entry(path: &str) -> (&'static str, String) {
    if let Some((of, _)) = path.split_once("/src/") {
        return ("src", of.to_owned());
    }
    let folders = if path.starts_with("crates/") { 2 } else { 1 };
    ("beside", path.split('/').take(folders).collect::<Vec<_>>().join("/"))
}

fn counted() -> Sizes {
    let listed = Command::new("git").args(["ls-files", "*.rs", "*.py"]).current_dir(root()).output().expect("git");
    assert!(listed.status.success(), "git ls-files: {}", String::from_utf8_lossy(&listed.stderr));
    let (mut sizes, mut names) = (Sizes::new(), BTreeMap::<String, Vec<String>>::new());
    for path in String::from_utf8(listed.stdout).expect("names in UTF-8").lines() {
        // A file may have been removed but not committed yet.
        let Ok(text) = fs::read_to_string(root().join(path)) else { continue };
        let (table, name) = entry(path);
        if table == "src" {
            names.entry(name.clone()).or_default().extend(types(&text));
        }
        let of = sizes.entry(table.to_owned()).or_default().entry(name).or_default();
        for (name, count) in NAMES.into_iter().zip(size(&text)) {
            *of.entry(name.to_owned()).or_default() += count;
        }
    }
    for (of, names) in names {
        let count = BTreeMap::from([("names".to_owned(), homonyms(names))]);
        sizes.entry("homonyms".to_owned()).or_default().insert(of, count);
    }
    sizes
}

/// The number of names shared by several types. Each command has its `Arguments`, and the `Object` that it prints.
fn homonyms(mut names: Vec<String>) -> usize {
    names.retain(|name| !matches!(name.as_str(), "Arguments" | "Object"));
    names.sort();
    names.chunk_by(|one, next| one == next).filter(|same| same.len() > 1).count()
}

/// What has grown, in words, and the list updated for what has shrunk.
fn compared(listed: &Sizes, counted: &Sizes) -> (Vec<String>, Sizes) {
    let (mut grown, mut lowered) = (vec![], Sizes::new());
    for (table, entries) in counted {
        for (of, sizes) in entries {
            for (name, &count) in sizes {
                let allowed = listed.get(table).and_then(|table| table.get(of)?.get(name)).copied().unwrap_or(0);
                if count > allowed {
                    grown.push(format!("[{table}] \"{of}\": found {count} {name}; expected at most {allowed}"));
                }
                let entry = lowered.entry(table.clone()).or_default().entry(of.clone()).or_default();
                entry.insert(name.clone(), count.min(allowed));
            }
        }
    }
    (grown, lowered)
}

fn written(sizes: &Sizes) -> String {
    let mut text = "# The most that each crate may have; held, and lowered, by xtask/tests/size.rs.\n".to_owned();
    for (table, entries) in sizes {
        text += &format!("\n[{table}]\n");
        for (of, sizes) in entries {
            let sizes: Vec<String> = sizes.iter().map(|(name, count)| format!("{name} = {count}")).collect();
            text += &format!("\"{of}\" = {{ {} }}\n", sizes.join(", "));
        }
    }
    text
}

#[test]
fn no_crate_grows() {
    let file = root().join(".ci/size.toml");
    let listed: Sizes = toml::from_str(&fs::read_to_string(&file).expect("the list")).expect("a list of sizes");
    let (grown, lowered) = compared(&listed, &counted());
    assert!(grown.is_empty(), "{}\nshrink it, or say why in the commit that raises .ci/size.toml", grown.join("\n"));
    if std::env::var_os("LOWER_SIZE").is_some() {
        fs::write(&file, written(&lowered)).expect("the list is written");
    } else if lowered != listed {
        println!("smaller than .ci/size.toml allows: `LOWER_SIZE=1 cargo test -p xtask --test size` lowers the list");
    }
}

#[test]
fn growth_is_found_wherever_it_is_and_shrinking_lowers_the_list() {
    let sizes = |text: &str| toml::from_str::<Sizes>(text).expect("a list of sizes");
    let listed = sizes("[src]\na = { files = 1, lines = 9, types = 0 }\n");
    let (grown, lowered) = compared(&listed, &sizes("[src]\na = { files = 1, lines = 8, types = 0 }\n"));
    assert!(grown.is_empty() && lowered["src"]["a"]["lines"] == 8, "{grown:?}");
    assert_eq!(sizes(&written(&lowered)), lowered);
    let moved = sizes("[src]\na = { files = 1, lines = 10, types = 1 }\n[beside]\na = { files = 1 }\n");
    let (grown, _) = compared(&listed, &moved);
    assert_eq!(grown.len(), 3, "{grown:?}");
    assert_eq!(grown[0], "[beside] \"a\": found 1 files; expected at most 0");
}

#[test]
fn files_are_counted_by_crate_and_tests_define_no_types() {
    let text =
        "pub(crate) struct A;\nenum B {}\n#[cfg(test)]\nmod tests {\n    struct C;\n}\n    type D = A;\nstructure\n";
    assert_eq!(size(text), [1, 8, 3]);
    assert_eq!(size("class A:\n    pass\n"), [1, 2, 1]);
    let names = |names: &str| homonyms(names.split(' ').map(str::to_owned).collect());
    assert_eq!([names("A B A A C B"), names("A B C"), names("Object Object Arguments Arguments")], [2, 0, 0]);
    for (path, table, of) in [
        ("crates/a/src/b/c.rs", "src", "crates/a"),
        ("crates/a/tests/src.rs", "beside", "crates/a"),
        ("xtask/src/main.rs", "src", "xtask"),
        ("studies/programs/heat.py", "beside", "studies"),
    ] {
        assert_eq!(entry(path), (table, of.to_owned()), "{path}");
    }
}
