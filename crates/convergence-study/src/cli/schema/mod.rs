//! `schema`: the JSON schema of a project's files, by which editors complete and check them.
//!
//! It is made from the structs that files are read into. It is weaker where a reader compares values:
//! a list whose numbers must increase is a list of numbers here.

mod page;

use serde_json::{Map, Value, json};

use super::exit::{CommandOutcome, Unusable};
use super::screen;
use crate::input::{Form, Key, Keys, schema};
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::study::KindRow;
use crate::study::header::DEFAULT_KIND;
use crate::study::{STUDY, study_schema};

pub use page::page;

/// The dialect that editors of TOML read.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// The study files, which every project has.
const STUDIES: &str = "study";

/// The files of the command `manufacture`, which every project has.
pub const MANUFACTURE: &str = "manufacture";

/// Print the JSON schema of study files, or of other files, for completion in editors
///
/// An editor that understands TOML schemas (Even Better TOML, taplo) completes and checks a file
/// whose first line is `#:schema URL`, or `#:schema ./FILE`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Of which files
    #[arg(value_name = "FILES", default_value = STUDIES)]
    files: String,
}

/// Runs the command.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let others = other_files(project);
    let schema = match others.iter().find(|(name, _)| *name == arguments.files) {
        Some((_, schema)) => schema.clone(),
        None if arguments.files == STUDIES => of_studies(project),
        None => {
            let names = others.iter().map(|(name, _)| *name);
            let names: Vec<&str> = std::iter::once(STUDIES).chain(names).collect();
            return Err(Unusable::because(&format!(
                "schema: found `{}`; expected one of {}",
                arguments.files,
                names.join(", ")
            )));
        }
    };
    screen::print(&text(&schema))?;
    Ok(Verdict::Pass)
}

/// The files of a project that are no studies, by name, with their schemas.
pub fn other_files(project: &Project) -> Vec<(&'static str, Value)> {
    let own = project
        .tables
        .iter()
        .map(|(name, schema)| (*name, schema()));
    let manufacture = (MANUFACTURE, schema::of::<manufacture::ProblemFile>());
    own.chain([manufacture])
        .map(|(name, mut schema)| {
            schema["$schema"] = json!(DIALECT);
            schema["title"] = json!(format!("{name} files"));
            (name, schema)
        })
        .collect()
}

/// A schema as a file.
pub fn text(schema: &Value) -> String {
    format!("{schema:#}\n")
}

/// The schema of the study files of a project.
pub fn of_studies(project: &Project) -> Value {
    let mut study = study_schema();
    let names: Vec<&str> = project.kinds.iter().map(|row| row.name).collect();
    study["properties"]["kind"]["enum"] = json!(names);
    if !names.contains(&DEFAULT_KIND) {
        study["required"] = json!(["id", "claim", "tier", "kind"]);
    }
    let is_known = |row: &&KindRow| row.schema.is_some() || !row.keys.is_empty();
    let kinds: Vec<Value> = project.kinds.iter().filter(is_known).map(of_kind).collect();
    json!({
        "$schema": DIALECT,
        "title": format!("study files of {}", project.name),
        "type": "object",
        "properties": { STUDY: study },
        "required": [STUDY],
        "allOf": kinds,
    })
}

/// The tables of the files of a kind beside `[study]`.
fn tables(row: &KindRow) -> Value {
    match row.schema {
        Some(schema) => schema(),
        None => one_of(row.keys.iter().map(|set| table(&[], set)).collect()),
    }
}

/// The tables of a file, if its kind is this one. A file without `kind` has the default one.
fn of_kind(row: &KindRow) -> Value {
    let mut kind = json!({ "properties": { "kind": { "const": row.name } } });
    if row.name != DEFAULT_KIND {
        kind["required"] = json!(["kind"]);
    }
    let mut tables = tables(row);
    let add = |set: &mut Value| set["properties"][STUDY] = json!({ "type": "object" });
    match tables.get_mut("anyOf").and_then(Value::as_array_mut) {
        Some(sets) => sets.iter_mut().for_each(add),
        None => add(&mut tables),
    }
    json!({
        "if": { "properties": { STUDY: kind } },
        "then": tables,
    })
}

fn one_of(mut schemas: Vec<Value>) -> Value {
    if schemas.len() == 1 {
        schemas.remove(0)
    } else {
        json!({ "anyOf": schemas })
    }
}

/// A table with these keys, and no others.
fn table(shared: &[Key], set: Keys) -> Value {
    let keys = || std::iter::once(shared).chain(set.iter().copied()).flatten();
    let properties: Map<String, Value> = keys()
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let required = keys().filter(|key| key.default.is_none());
    let required: Vec<&str> = required.map(|key| key.name).collect();
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

/// The values of a key, with what it means.
fn property(key: &Key) -> Value {
    let mut schema = form(key.form);
    let default = match key.default {
        None | Some("") => String::new(),
        Some(default) => format!(" Default: {default}."),
    };
    schema["description"] = json!(format!("{}.{default}", key.meaning));
    // Defaults in words are no JSON.
    if let Some(default) = key
        .default
        .and_then(|text| serde_json::from_str::<Value>(text).ok())
    {
        schema["default"] = default;
    }
    schema
}

fn form(values: Form) -> Value {
    match values {
        Form::Text => json!({ "type": "string" }),
        Form::Count(least) => json!({ "type": "integer", "minimum": least }),
        Form::Number => json!({ "type": "number" }),
        Form::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Form::Boolean => json!({ "type": "boolean" }),
        Form::Named(keys, values) => {
            let mut schema = table(&[], keys);
            schema["additionalProperties"] = form(*values);
            schema
        }
        Form::Choice(names) => json!({ "enum": names() }),
        Form::List(items) => json!({ "type": "array", "items": form(*items) }),
        Form::OneOf(forms) => one_of(forms.iter().map(|values| form(*values)).collect()),
        Form::Table(&[]) => json!({ "type": "object" }),
        Form::Table(sets) => one_of(sets.iter().map(|set| table(&[], set)).collect()),
    }
}
