//! The schemas and the readers allow the same keys: every file of the repository satisfies its
//! schema, and a file with a key too many, a key too few or a value of another type is refused by
//! both or by none.

mod mutants;
mod schema;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use convergence_study::{KindRow, Project, Template};
use manufacture::Manufacture;
use serde_json::Value;
use thermobeam_study::scene::Scene;

use xtask::PROJECT;
use xtask::references::{Reference, made, verdicts};

use crate::place::{read, root};

use mutants::{Mutant, insertions, mutants};
use schema::complaint;

/// Both answers to a text: of the schema, and of the reader.
#[derive(Debug)]
struct Answers {
    schema: Option<String>,
    reader: Option<String>,
}

impl Answers {
    /// * `read`: what the reader makes of the text.
    fn new<T, E: std::fmt::Display>(schema: &Value, text: &str, read: Result<T, E>) -> Self {
        Self {
            schema: complaint(schema, &as_json(text), ""),
            reader: read.err().map(|error| error.to_string()),
        }
    }
}

/// The TOML files of a folder, in the order of their names, with their texts.
fn toml_files(folder: &str) -> impl Iterator<Item = (PathBuf, String)> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let files: BTreeSet<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files
        .into_iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| (path.clone(), fs::read_to_string(&path).unwrap()))
}

fn as_json(text: &str) -> Value {
    let table: toml::Table = toml::from_str(text).expect("TOML");
    serde_json::to_value(table).expect("JSON")
}

/// The changes that a reader refuses and a schema does not, because the reader compares values of
/// several keys, counts tables, or needs a key for some values of another.
const STRICTER: &str = include_str!("stricter.txt");

/// Tries all changes but the `known` ones; returns those to which the two answers differ.
///
/// * `schema`: that of the file.
fn compare(
    text: &str,
    name: &str,
    schema: &Value,
    known: &mut BTreeSet<String>,
    answers: impl Fn(&str) -> Answers,
) -> Vec<Differing> {
    let own = answers(text);
    assert_eq!((own.schema, own.reader), (None, None), "{name}");
    let mut differing = vec![];
    for Mutant { text, change } in mutants(text).into_iter().chain(insertions(text, schema)) {
        if known.contains(&change) || toml::from_str::<toml::Table>(&text).is_err() {
            continue;
        }
        known.insert(change.clone());
        let answers = answers(&text);
        if answers.schema.is_some() != answers.reader.is_some() {
            differing.push(Differing { change, answers });
        }
    }
    differing
}

/// A change to which the answers differ.
#[derive(Debug)]
struct Differing {
    change: String,
    answers: Answers,
}

/// The changes that only the reader refuses; there is no other to which the answers differ.
fn stricter(differing: &[Differing]) -> BTreeSet<&str> {
    let is_stricter = |found: &Differing| found.answers.schema.is_none();
    assert!(differing.iter().all(is_stricter), "{differing:#?}");
    differing
        .iter()
        .map(|found| found.change.as_str())
        .collect()
}

#[test]
fn schema_and_readers_of_studies_allow_the_same_keys() {
    let schema = schema_of("study");
    let mut known = std::collections::BTreeMap::<String, BTreeSet<String>>::new();
    let mut differing = vec![];
    for (path, text) in toml_files("studies").chain(toml_files("studies/programs")) {
        let read = |text: &str| KindRow::parse_any(PROJECT.kinds, text, &path);
        let kind = read(&text).unwrap().header().kind.clone();
        let answers = |text: &str| Answers::new(&schema, text, read(text));
        let name = path.display().to_string();
        let known = known.entry(kind.clone()).or_default();
        let kinds = schema["allOf"].as_array().unwrap().iter();
        let mut kinds = kinds.filter(|rule| {
            rule["if"]["properties"]["study"]["properties"]["kind"]["const"] == kind.as_str()
        });
        let own = &kinds.next().unwrap()["then"];
        differing.extend(compare(&text, &name, own, known, answers));
    }
    let kinds: Vec<&str> = PROJECT.kinds.iter().map(|row| row.name).collect();
    assert_eq!(known.len(), kinds.len(), "each of {kinds:?} has a study");
    assert_eq!(stricter(&differing), STRICTER.lines().collect());
    let tried: usize = known.values().map(BTreeSet::len).sum();
    assert!(tried > 650, "{tried}");
}

/// The schema of files of this name.
fn schema_of(name: &str) -> Value {
    let mut schemas = PROJECT.schemas().into_iter();
    schemas.find(|(own, _)| *own == name).unwrap().1
}

#[test]
fn schema_and_reader_of_scenes_allow_the_same_keys() {
    let schema = schema_of("scene");
    let mut known = BTreeSet::new();
    let mut differing = vec![];
    for (path, text) in toml_files("studies/scenes") {
        let name = path.display().to_string();
        let answers = |text: &str| Answers::new(&schema, text, Scene::parse(text, &name));
        differing.extend(compare(&text, &name, &schema, &mut known, answers));
    }
    assert!(known.len() > 30, "{known:?}");
    // The keys of `[time]` depend on its scheme.
    let of_time = ["[time] without dt", "[time] without scheme"];
    assert_eq!(stricter(&differing), of_time.into());
}

/// The files of `manufacture` in the repository: those of folders, the template, and those of
/// pages.
fn manufacture_files() -> Vec<(String, String)> {
    let folders = ["studies/manufactured", "crates/manufacture/tests/files"];
    let files = folders.into_iter().flat_map(toml_files);
    let mut files: Vec<(String, String)> = files
        .map(|(path, text)| (path.display().to_string(), text))
        .collect();
    let template = Template::MANUFACTURE.files[0].1;
    files.push(("the template".to_owned(), template.replace("NAME", "name")));
    for page in ["TEN-MINUTES.md", "NOTES.md"] {
        let text = read(&format!("crates/manufacture/{page}"));
        let blocks = text.split("```toml\n").skip(1);
        let blocks = blocks.map(|block| block.split("```").next().unwrap());
        let whole = blocks.filter(|block| block.contains("[manufacture]"));
        files.extend(whole.map(|block| (page.to_owned(), block.to_owned())));
    }
    files
}

/// The changes of files of `manufacture` that only the reader refuses, beside those of
/// [`is_a_name`].
const STRICTER_OF_MANUFACTURE: [&str; 3] = [
    "[boundary.ball] without level",
    "[boundary.circle] without level",
    "[manufacture] without time",
];

/// Whether a change takes away a name of the user's that expressions of the file have, or a term of
/// an equation, or adds one of another shape: only a reader that parses them can notice.
fn is_a_name(change: &str) -> bool {
    let tables = ["[domain]", "[parameters]", "[exact]", "[define]"];
    let is_gone = change.contains(" without ") || change.ends_with(" is missing");
    let is_in = |table: &&str| change.starts_with(*table);
    is_gone && tables.iter().any(is_in)
        || change.starts_with("[equations.") && (is_gone || change.ends_with(" has surplus"))
}

#[test]
fn schema_and_reader_of_manufacture_allow_the_same_keys() {
    let schema = schema_of(Template::MANUFACTURE.name);
    let mut known = BTreeSet::new();
    let mut differing = vec![];
    let files = manufacture_files();
    assert!(files.len() > 10, "{}", files.len());
    for (name, text) in files {
        let answers = |text: &str| Answers::new(&schema, text, Manufacture::parse(text, &name));
        differing.extend(compare(&text, &name, &schema, &mut known, answers));
    }
    assert!(known.len() > 100, "{known:?}");
    let mut stricter = stricter(&differing);
    stricter.retain(|change| !is_a_name(change));
    assert_eq!(stricter, STRICTER_OF_MANUFACTURE.into());
}

#[test]
fn the_committed_page_on_verdicts_is_current() {
    let Reference { path, text } = verdicts();
    assert!(
        read(&path) == text,
        "{path}: run `cargo xtask dev references`"
    );
}

#[test]
fn the_command_makes_every_schema_and_page_and_git_ignores_them() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    let command = command.args(["dev", "references"]).arg(folder.path());
    assert!(command.status().unwrap().success());
    let made = made();
    for Reference { path, text } in &made {
        let written = fs::read_to_string(folder.path().join(path)).expect(path);
        assert_eq!(&written, text, "{path}");
        let mut git = Command::new("git");
        git.args(["check-ignore", "-q", path]).current_dir(root());
        assert!(git.status().unwrap().success(), "{path}: not ignored");
    }
    let text = |path: &str| {
        let mut made = made.iter();
        let found = made.find(|made| made.path == path).expect(path);
        found.text.as_str()
    };
    for folder in ["convergence-study", "thermobeam-study"] {
        let page = text(&format!("crates/{folder}/STUDIES.md"));
        let schema = text(&format!("crates/{folder}/schema.json"));
        let schema: Value = serde_json::from_str(schema).expect("JSON");
        let kinds = &schema["properties"]["study"]["properties"]["kind"]["enum"];
        let kinds = kinds.as_array().expect("kinds");
        assert!(!kinds.is_empty());
        for kind in kinds {
            let kind = kind.as_str().expect("a name");
            assert!(page.contains(&format!("`{kind}`")), "{folder}: {kind}");
        }
    }
    let scene: Value =
        serde_json::from_str(text("crates/thermobeam-study/scene.schema.json")).expect("JSON");
    assert_eq!(scene["title"], "scene files");
    assert_eq!(made.len(), 6);
}

/// What `new` writes for studies and scenes names its schema, which `.ci/site` puts where the URL
/// points.
#[test]
fn new_files_name_a_schema_of_the_site() {
    const SITE: &str = "https://thermobeam.github.io/thermobeam/";
    let made: Vec<String> = made().into_iter().map(|file| file.path).collect();
    let templates = PROJECT.templates.iter().chain(Project::PROGRAMS.templates);
    let mut named = BTreeSet::new();
    for template in templates {
        let (_, text) = template.files[0];
        let line = text.lines().next().unwrap();
        let path = line.strip_prefix(&format!("#:schema {SITE}"));
        let path = path.unwrap_or_else(|| panic!("{}: {line}", template.name));
        let in_repository = format!("crates/{path}");
        assert!(made.contains(&in_repository), "{path}");
        named.insert(path);
    }
    assert_eq!(named.len(), 4, "{named:?}");
}
