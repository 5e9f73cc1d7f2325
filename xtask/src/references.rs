//! `dev references`: the schemas and reference pages of study files and scenes, made from the keys
//! that the readers allow.

use convergence_study::{
    Verdict,
    internal::{
        cli::{
            exit::CommandOutcome,
            schema::{MANUFACTURE, of_studies, of_tables_file, other_files, page, text},
        },
        program,
        store::atomic,
    },
};
use thermobeam_cli::project;

/// Write the schemas and the reference pages of files anew
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {}

/// Writes the files, from the project's folder.
pub(crate) fn run(_: &Arguments) -> CommandOutcome {
    for Reference { path, text } in files() {
        atomic::write(path.as_ref(), text)?;
    }
    Ok(Verdict::Pass)
}

/// Where the references of the harness are.
const HARNESS: &str = "crates/convergence-study";

/// A file that is made from the keys of the readers.
#[derive(Debug)]
pub struct Reference {
    /// Its path below the folder of the repository.
    pub path: String,
    /// What it holds.
    pub text: String,
}

/// All of them.
pub fn files() -> Vec<Reference> {
    let mut files = vec![];
    for (folder, project) in [
        (HARNESS, program::PROJECT),
        ("crates/thermobeam-study", project("thermobeam")),
    ] {
        let in_folder = |name: &str, text: String| Reference {
            path: format!("{folder}/{name}"),
            text,
        };
        files.push(in_folder("schema.json", text(&of_studies(&project))));
        files.push(in_folder("STUDIES.md", page(&project)));
        let others = other_files(&project).into_iter();
        // Both projects have the files of `manufacture`.
        let others = others.filter(|(name, _)| *name != MANUFACTURE || folder == HARNESS);
        files.extend(others.map(|(name, set)| {
            let schema = of_tables_file(name, set);
            in_folder(&format!("{name}.schema.json"), text(&schema))
        }));
    }
    files
}
