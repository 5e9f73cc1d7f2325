//! `explain ID`: what a study, a norm or a verdict means.

use std::path::{Path, PathBuf};

use clap::Args;
use thermobeam_study::study::explain;

use crate::exit::{Outcome, Unusable, Verdict};
use crate::{output, workspace};

/// Tell in words what a study claims, why it should hold, how it is judged, and what a failure would mean
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A study's id or file; or a norm (superclose), a reason for a verdict (too-low), a kind of study (energy). Without it:
    /// all that can be explained
    #[arg(value_name = "ID")]
    name: Option<String>,
    /// The folder with the studies [default: studies/ of the workspace]
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let Some(name) = arguments.name.as_deref() else {
        output::print(&contents())?;
        return Ok(Verdict::Pass);
    };
    // Outside a workspace norms, reasons and files can be explained all the same.
    let studies = || workspace::root().map_or_else(|_| PathBuf::from("studies"), |root| root.join("studies"));
    let folder = arguments.dir.clone().unwrap_or_else(studies);
    let path = if name.ends_with(".toml") { Some(PathBuf::from(name)) } else { explain::find(&folder, name) };
    let text = match &path {
        Some(path) => explain::study(path)?.ok_or_else(|| Unusable::because(&no_kind(path)))?,
        None => explain::term(name).ok_or_else(|| Unusable::because(&unknown(name, &folder)))?,
    };
    output::print(&text)?;
    Ok(Verdict::Pass)
}

fn no_kind(path: &Path) -> String {
    format!("{}: nothing is known about studies of this kind", path.display())
}

fn contents() -> String {
    let mut text = explain::contents();
    text += "\nstudies, by id or file\n  see `cargo xtask list`\n";
    text
}

fn unknown(name: &str, folder: &Path) -> String {
    let hint = explain::meant(folder, name).map_or_else(
        || "`cargo xtask explain` names all that can be explained".to_owned(),
        |meant| format!("did you mean {meant}?"),
    );
    format!("no study, norm, reason or kind `{name}` in {}; {hint}", folder.display())
}
