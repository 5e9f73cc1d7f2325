//! `explain ID`: what a study, a norm or a verdict means.

use std::path::{Path, PathBuf};

use clap::Args;
use thermobeam_study::study::explain;

use crate::exit::{Outcome, Unusable, Verdict};
use crate::output;

/// Tell in words what a study claims, why it should hold, how it is judged, and what a failure would mean
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A study's id or file; or a norm (superclose), a reason for a verdict (too-low), a kind of study (energy)
    #[arg(value_name = "ID")]
    name: String,
    /// The folder with the studies
    #[arg(long, value_name = "DIR", default_value = "studies")]
    dir: PathBuf,
}

/// Runs the command.
pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let name = arguments.name.as_str();
    let path = if name.ends_with(".toml") { Some(PathBuf::from(name)) } else { explain::find(&arguments.dir, name) };
    let text = match &path {
        Some(path) => explain::study(path)?.ok_or_else(|| Unusable::because(&no_kind(path)))?,
        None => explain::term(name).ok_or_else(|| Unusable::because(&unknown(arguments)))?,
    };
    output::print(&text)?;
    Ok(Verdict::Pass)
}

fn no_kind(path: &Path) -> String {
    format!("{}: nothing is known about studies of this kind", path.display())
}

fn unknown(arguments: &Arguments) -> String {
    let hint = explain::meant(&arguments.dir, &arguments.name).map_or_else(
        || format!("known beside the studies are {}", explain::terms().join(", ")),
        |meant| format!("did you mean {meant}?"),
    );
    format!("no study, norm, reason or kind `{}` in {}; {hint}", arguments.name, arguments.dir.display())
}
