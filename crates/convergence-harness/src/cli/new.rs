//! `new WHAT NAME`: files to start from.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};

use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::json;

use super::exit::{Outcome, Unusable};
use super::flags::Flags;
use crate::judge::verdict::Verdict;
use crate::project::{Project, Template};
use crate::store::atomic;
use crate::study::header::{NAME, is_name};
use crate::text::visible;

/// Write a commented file that runs unchanged
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// What to start
    #[arg(index = 1)]
    what: String,
    /// Its name: lowercase letters, digits, `.` and `-`
    #[arg(index = 2, value_parser = name)]
    name: String,
    #[command(flatten)]
    flags: Flags,
}

fn name(text: &str) -> Result<String, String> {
    if is_name(text) {
        Ok(text.to_owned())
    } else {
        Err(format!("expected {NAME}"))
    }
}

/// The command line with the templates of a project as values of `WHAT`; without templates, the
/// command is hidden.
pub(super) fn with_templates(command: clap::Command, project: &Project) -> clap::Command {
    // A changed argument moves behind the others: hence the positions, `index`, above.
    let values = project
        .templates
        .iter()
        .map(|template| PossibleValue::new(template.name).help(template.about));
    let values = PossibleValuesParser::new(values);
    let is_hidden = project.templates.is_empty();
    command.mut_subcommand("new", |new| {
        new.mut_arg("what", |what| what.value_parser(values))
            .hide(is_hidden)
    })
}

/// Runs the command. It never overwrites an existing file.
pub(super) fn run(project: &Project, arguments: &Arguments) -> Outcome {
    let Arguments { what, name, flags } = arguments;
    let template = project
        .templates
        .iter()
        .find(|template| template.name == what);
    let template = template
        .ok_or_else(|| Unusable::because(&format!("found `{what}`; expected a template")))?;
    let folder = flags.out.as_deref().unwrap_or(Path::new(""));
    let path = |(ending, text): &(&str, _)| (folder.join(format!("{name}{ending}")), *text);
    let files: Vec<(PathBuf, &str)> = template.files.iter().map(path).collect();
    if let Some((taken, _)) = files
        .iter()
        .find(|(path, _)| fs::symlink_metadata(path).is_ok())
    {
        return Err(Unusable::because(&format!(
            "{}: expected a new file, found one of that name; take another name, or remove the file first",
            visible::path(taken)
        )));
    }
    if let Some(folder) = &flags.out {
        atomic::prepare_folder(folder)?;
    }
    let (directory, below) = places(folder);
    let python = format!("[\"{}\"", python());
    for (path, text) in &files {
        let text = text
            .replace("NAME", name)
            .replace("PROGRAM", project.command)
            .replace("[\"python3\"", &python);
        atomic::write(
            path,
            text.replace("DIRECTORY", &directory)
                .replace("BELOW", &below),
        )?;
    }
    // Reports are written below the folder that the commands run in: the current one, if the files
    // are below it.
    let ignored = if directory == "." {
        folder
    } else {
        Path::new("")
    }
    .join(".gitignore");
    if !template.ignored.is_empty() && fs::symlink_metadata(&ignored).is_err() {
        atomic::write(&ignored, template.ignored)?;
    }
    let wrote: Vec<String> = files
        .iter()
        .map(|(path, _)| path.display().to_string())
        .collect();
    let written = format!("wrote {}", wrote.join(", "));
    let first = wrote.first().map_or("", String::as_str);
    let text = format!("{written}\n{}", next_steps(project, template, first));
    let words = flags.words(Verdict::Pass, &written, || text);
    Ok(flags.print(Verdict::Pass, &json!({"wrote": wrote}), &words)?)
}

/// The command that starts Python 3 on this machine; on Windows it often has no 3. Looking for a
/// file is not enough there: a file of that name may only lead to a shop.
fn python() -> &'static str {
    const NAMES: [&str; 2] = ["python3", "python"];
    NAMES
        .into_iter()
        .find(|name| is_python3(name))
        .unwrap_or(NAMES[0])
}

fn is_python3(command: &str) -> bool {
    let version = Command::new(command)
        .arg("--version")
        .stdin(Stdio::null())
        .output();
    version.is_ok_and(|version| version.status.success() && version.stdout.starts_with(b"Python 3"))
}

/// The commands that the user may type next, each on a line, with the first file written.
fn next_steps(project: &Project, template: &Template, file: &str) -> String {
    let steps = template.next.iter().zip(["now", "and"]);
    let line = |(command, then)| format!("{then}  {} {command} {file}\n", project.command);
    steps.map(line).collect()
}

/// The folder that the command runs in as seen from the files, and theirs as seen from there, both
/// with a trailing slash. For a folder that is not below it, the folder that contains both.
fn places(folder: &Path) -> (String, String) {
    let parts: Vec<Component<'_>> = folder
        .components()
        .filter(|part| *part != Component::CurDir)
        .collect();
    let is_below = |part: &Component<'_>| matches!(part, Component::Normal(name) if !name.as_encoded_bytes().contains(&b'"'));
    if parts.is_empty() || !parts.iter().all(is_below) {
        return (".".to_owned(), String::new());
    }
    let below = parts
        .iter()
        .map(|part| format!("{}/", part.as_os_str().display()))
        .collect();
    (vec![".."; parts.len()].join("/"), below)
}
