//! `dev references`: the schemas and reference pages of study files and scenes, made from the keys
//! that the readers allow.

use convergence_study::Verdict;
use convergence_study::internal::cli::exit::Outcome;
use convergence_study::internal::cli::schema::{
    MANUFACTURE, of_studies, of_tables_file, other_files, page, text,
};
use convergence_study::internal::program;
use convergence_study::internal::store::atomic;
use thermobeam_cli::project;

/// Write the schemas and the reference pages of files anew
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {}

/// Writes the files, from the project's folder.
pub(crate) fn run(_: &Arguments) -> Outcome {
    for (path, text) in files() {
        atomic::write(path.as_ref(), text)?;
    }
    Ok(Verdict::Pass)
}

/// Where the references of the harness are.
const HARNESS: &str = "crates/convergence-study";

/// Paths and texts.
fn files() -> Vec<(String, String)> {
    let mut files = vec![];
    for (folder, project) in [
        (HARNESS, program::PROJECT),
        ("crates/thermobeam-study", project("thermobeam")),
    ] {
        files.push((format!("{folder}/schema.json"), text(&of_studies(&project))));
        files.push((format!("{folder}/STUDIES.md"), page(&project)));
        let others = other_files(&project).into_iter();
        // Both projects have the files of `manufacture`.
        let others = others.filter(|(name, _)| *name != MANUFACTURE || folder == HARNESS);
        for (name, set) in others {
            let schema = of_tables_file(name, set);
            files.push((format!("{folder}/{name}.schema.json"), text(&schema)));
        }
    }
    files
}

#[cfg(test)]
mod tests;
