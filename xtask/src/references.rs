//! `dev references`: the schemas and reference pages of study files and scenes, made from the
//! structs that files are read into, which the site has and git ignores; and the book's page on
//! verdicts, made from their reasons, which is committed.

use std::path::PathBuf;

use convergence_judge::text::lists::grouped;
use convergence_study::{Project, Reason, Verdict, atomic, command_line::Unusable};
use thermobeam_cli::project;

/// Write the schemas and the reference pages of files anew
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The folder of the repository, or another one
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
}

/// Writes the files.
pub(crate) fn run(Arguments { folder }: &Arguments) -> Result<Verdict, Unusable> {
    for Reference { path, text } in made().into_iter().chain([verdicts()]) {
        atomic::write(&folder.join(path), text)?;
    }
    Ok(Verdict::Pass)
}

/// Where the references of the harness are.
const HARNESS: &str = "crates/convergence-study";

/// The page of the book on verdicts, and the title of its last chapter, which is made.
const VERDICTS: &str = "book/src/inconclusive.md";
const CHAPTER: &str = "\n## Every reason\n";

/// A file that is made from what the code knows.
#[derive(Debug)]
pub struct Reference {
    /// Its path below the folder of the repository.
    pub path: String,
    /// What it holds.
    pub text: String,
}

/// Those that git ignores.
pub fn made() -> Vec<Reference> {
    let mut files = vec![];
    for (folder, project) in [
        (HARNESS, Project::PROGRAMS),
        ("crates/thermobeam-study", project("thermobeam")),
    ] {
        let in_folder = |name: &str, text: String| Reference {
            path: format!("{folder}/{name}"),
            text,
        };
        files.push(in_folder("STUDIES.md", project.reference_page()));
        for (name, schema) in project.schemas() {
            // Both projects have the files of `manufacture`.
            if name != "manufacture" || folder == HARNESS {
                let file = match name {
                    "study" => "schema.json".to_owned(),
                    other => format!("{other}.schema.json"),
                };
                files.push(in_folder(&file, format!("{schema:#}\n")));
            }
        }
    }
    files
}

/// The page on verdicts: its own words, and then every reason with what to do. Reasons with the
/// same mathematics stand together.
pub fn verdicts() -> Reference {
    let page = include_str!("../../crates/convergence-study/book/src/inconclusive.md");
    let (own, _) = page.split_once(CHAPTER).unwrap_or((page, ""));
    let mut text = format!("{own}{CHAPTER}");
    for (mathematics, reasons) in grouped(Reason::all().map(|one| (one.mathematics(), one))) {
        let codes: Vec<String> = reasons
            .iter()
            .map(|reason| format!("`{}`", reason.name()))
            .collect();
        text += &format!("\n### {}\n\n", codes.join(", "));
        for reason in reasons {
            let [code, words, advice] = [reason.name(), reason.text(), reason.advice()];
            text += &format!("- `{code}`, {}: {words}. {advice}\n", reason.verdict());
        }
        text += &format!("\n{mathematics}\n");
    }
    Reference {
        path: format!("{HARNESS}/{VERDICTS}"),
        text,
    }
}
