//! `schema`: the JSON schema of a project's files, by which editors complete and check them.
//!
//! It is made from the structs that files are read into. It is weaker where a reader compares
//! values: a list whose numbers must increase is a list of numbers here.

mod page;

use serde_json::{Value, json};

use super::exit::{CommandOutcome, Unusable};
use super::screen;
use crate::project::Project;
use crate::study::KindRow;
use crate::study::header::DEFAULT_KIND;
use crate::study::{STUDY, study_schema};
use convergence_judge::verdict::Verdict;

use page::page;

/// The dialect that editors of TOML read.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// The study files, which every project has.
const STUDIES: &str = "study";

/// Print the JSON schema of study files, or of other files, for completion in editors
///
/// An editor that understands TOML schemas (Even Better TOML, taplo) completes and checks a file
/// whose first line is `#:schema URL`, or `#:schema ./FILE`.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Of which files; an unknown name lists all that there are
    #[arg(value_name = "FILES", default_value = STUDIES)]
    files: String,
}

/// Runs the command.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let schemas = project.schemas();
    let schema = schemas.iter().find(|(name, _)| *name == arguments.files);
    let Some((_, schema)) = schema else {
        let names: Vec<&str> = schemas.iter().map(|(name, _)| *name).collect();
        return Err(Unusable::because(&format!(
            "schema: found `{}`; expected one of {}",
            arguments.files,
            names.join(", ")
        )));
    };
    screen::print(&format!("{schema:#}\n"))?;
    Ok(Verdict::Pass)
}

impl Project {
    /// The files that it reads, by name, with their JSON schemas: `study` first.
    pub fn schemas(&self) -> Vec<(&'static str, Value)> {
        let studies = (STUDIES, of_studies(self));
        [studies].into_iter().chain(other_files(self)).collect()
    }

    /// The reference page of these files, in Markdown.
    pub fn reference_page(&self) -> String {
        page(self)
    }
}

/// The files of a project that are no studies, by name, with their schemas.
fn other_files(project: &Project) -> Vec<(&'static str, Value)> {
    let files = (project.tables)().into_iter();
    #[cfg(feature = "manufacture")]
    let files = files.chain([(
        "manufacture",
        crate::input::schema::of::<manufacture::ProblemFile>(),
    )]);
    files
        .map(|(name, mut schema)| {
            schema["$schema"] = json!(DIALECT);
            schema["title"] = json!(format!("{name} files"));
            (name, schema)
        })
        .collect()
}

/// The schema of the study files of a project.
fn of_studies(project: &Project) -> Value {
    let mut study = study_schema();
    let names: Vec<&str> = project.kinds.iter().map(|row| row.name).collect();
    study["properties"]["kind"]["enum"] = json!(names);
    if !names.contains(&DEFAULT_KIND) {
        study["required"] = json!(["id", "claim", "tier", "kind"]);
    }
    let kinds: Vec<Value> = project.kinds.iter().map(of_kind).collect();
    json!({
        "$schema": DIALECT,
        "title": format!("study files of {}", project.name),
        "type": "object",
        "properties": { STUDY: study },
        "required": [STUDY],
        "allOf": kinds,
    })
}

/// The tables of a file, if its kind is this one. A file without `kind` has the default one.
fn of_kind(row: &KindRow) -> Value {
    let mut kind = json!({ "properties": { "kind": { "const": row.name } } });
    if row.name != DEFAULT_KIND {
        kind["required"] = json!(["kind"]);
    }
    let mut tables = (row.schema)();
    tables["properties"][STUDY] = json!({ "type": "object" });
    json!({
        "if": { "properties": { STUDY: kind } },
        "then": tables,
    })
}
