//! One meaning a name: a reader who meets `Found` must not have to ask which of eight it is.
//!
//! A name may stand for two or three types, as where two crates cannot share one. In four modules
//! it says nothing any more.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::{files, root, without_comments};

/// The code of a file, without its tests.
struct Source {
    file: String,
    text: String,
}

impl Source {
    fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("a source");
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
        let file = path.strip_prefix(root()).expect("below the root");
        Self {
            file: file.display().to_string(),
            text: without_comments(code),
        }
    }
}

/// The modules in which a name may be defined.
const MOST: usize = 3;

/// Names with one meaning wherever they are: each command is a file with its `Arguments`, and each
/// program has its `Command`.
const SAME_EVERYWHERE: [&str; 2] = ["Arguments", "Command"];

const KEYWORDS: [&str; 4] = ["struct", "enum", "trait", "type"];

/// The name of the type that a line defines, outside of functions and traits.
fn defined(line: &str) -> Option<&str> {
    let mut words = line.split(|c: char| c.is_whitespace() || "<;({=:".contains(c));
    let first = words.next()?;
    let keyword = if first == "pub" {
        words.find(|word| KEYWORDS.contains(word))?
    } else {
        first
    };
    KEYWORDS.contains(&keyword).then(|| words.next()).flatten()
}

/// The names that are defined in more modules than [`MOST`], and where.
fn ambiguous(sources: &[Source]) -> Vec<String> {
    let mut places = BTreeMap::<&str, Vec<&str>>::new();
    for source in sources {
        for name in source.text.lines().filter_map(defined) {
            places.entry(name).or_default().push(&source.file);
        }
    }
    let places = places.into_iter();
    let ambiguous =
        places.filter(|(name, files)| files.len() > MOST && !SAME_EVERYWHERE.contains(name));
    ambiguous
        .map(|(name, files)| format!("{name}: {}", files.join(", ")))
        .collect()
}

#[test]
fn a_name_of_a_type_has_one_meaning() {
    let crates = fs::read_dir(root().join("crates")).expect("crates");
    let folders = crates.map(|entry| entry.expect("a crate").path().join("src"));
    let folders = folders.chain([root().join("xtask/src")]);
    let mut paths: Vec<PathBuf> = folders
        .filter(|folder| folder.is_dir())
        .flat_map(|folder| files(&folder, &["rs"]))
        .filter(|path| !path.ends_with("tests.rs"))
        .collect();
    paths.sort();
    let sources: Vec<Source> = paths.iter().map(|path| Source::read(path)).collect();
    assert!(sources.len() > 300, "{}", sources.len());
    let names = sources.iter().flat_map(|source| source.text.lines());
    assert!(names.filter_map(defined).count() > 900);
    assert_eq!(ambiguous(&sources), [""; 0], "name each for what it is");
}

#[test]
fn a_name_in_four_modules_is_found() {
    let forms = [
        "struct Place {",
        "pub(in crate::a) struct Place<'t> {",
        "pub enum Place {",
        "pub(crate) type Place = usize;",
    ];
    let forms = forms.iter().enumerate();
    let sources: Vec<Source> = forms
        .map(|(number, form)| Source {
            file: format!("{number}.rs"),
            text: (*form).to_owned(),
        })
        .collect();
    assert!(ambiguous(&sources[..MOST]).is_empty());
    assert_eq!(ambiguous(&sources), ["Place: 0.rs, 1.rs, 2.rs, 3.rs"]);
    assert_eq!(defined("    type Data = usize;"), None);
    assert_eq!(defined("fn place() -> Place {"), None);
}
