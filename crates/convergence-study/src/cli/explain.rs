//! `explain NAME`: what a study, a term, a reason for a verdict or a kind of study means.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::exit::{Ended, Outcome, Unusable};
use super::flags::Flags;
use super::workspace;
use crate::explain;
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::study::StudyFile;
use crate::text::visible::{self, visible};

/// Explain what a study claims, why it should hold, how it is judged, and what a failure would mean
#[derive(Debug, Args)]
pub struct Arguments {
    /// A study's id or file; or a reason for a verdict (too-low), a kind of study, a word of the project. Without it:
    /// everything that can be explained
    #[arg(value_name = "ID")]
    name: Option<String>,
    /// The folder with the studies [default: studies/ of the workspace]
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    #[command(flatten)]
    flags: Flags,
}

/// Prints the explanation.
///
/// # Errors
/// An unknown name, and a study file that cannot be used.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let Some(name) = arguments.name.as_deref() else {
        return show(arguments, &contents(project));
    };
    // Terms, reasons and files can be explained outside a workspace.
    let studies = || workspace::root().map_or_else(|_| PathBuf::from("studies"), |root| root.join("studies"));
    let folder = arguments.dir.clone().unwrap_or_else(studies);
    let text = match explain::term(project, name) {
        Some(text) => text,
        None if name.ends_with(".toml") => of_study(project, &StudyFile::read(project.kinds, Path::new(name))?),
        None => {
            let files = workspace::readable_studies(project, &folder);
            let named = files.iter().find(|file| file.study.header().id == name);
            named.map(|file| of_study(project, file)).ok_or_else(|| {
                let ids = files.iter().map(|file| file.study.header().id.as_str());
                let meant = explain::meant(project, ids, name);
                Unusable::because(&unknown(project, name, &folder, meant))
            })?
        }
    };
    show(arguments, &text)
}

fn show(arguments: &Arguments, text: &str) -> Outcome {
    let Arguments { name, flags, .. } = arguments;
    // The first line is the name and what it names.
    let words = flags.words(Verdict::Pass, text.lines().next().unwrap_or(""), || text.to_owned());
    flags.show("explain", Verdict::Pass, &json!({"name": name, "text": text}), &words)?;
    Ok(Ended::Well)
}

/// The kind of a file that was read is one that the project knows.
fn of_study(project: &Project, file: &StudyFile) -> String {
    explain::study(project, file.study.as_ref()).unwrap_or_default()
}

fn contents(project: &Project) -> String {
    format!("{}\nstudies, by id or file\n  see `{} list`\n", explain::contents(project), project.command)
}

fn unknown(project: &Project, name: &str, folder: &Path, meant: Option<String>) -> String {
    let hint = meant.map_or_else(
        || format!("`{} explain` lists all that can be explained", project.command),
        |meant| format!("did you mean {meant}?"),
    );
    format!("found no study, term, reason or kind `{}` in {}; {hint}", visible(name), visible::path(folder))
}
