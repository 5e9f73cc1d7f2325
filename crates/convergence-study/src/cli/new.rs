//! `new WHAT NAME`: files to start from.

use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

use clap::builder::{PossibleValue, PossibleValuesParser};
use serde_json::json;

use super::exit::{CommandOutcome, Unusable};
use super::flags::Flags;
use crate::program::{self, begin};
use crate::project::{Project, Template};
use crate::store::atomic;
use crate::study::header::{NAME, is_name};
use crate::text::names::quoted;
use crate::text::visible;
use convergence_judge::verdict::Verdict;

/// Write a commented file that runs unchanged
///
/// A study goes into studies/ of the project, if there is one here or above, anything else into the
/// current folder. The commands of a study run in the folder that holds studies/.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// What to start
    #[arg(index = 1)]
    what: String,
    /// Its name: lowercase letters, digits, `.` and `-`
    #[arg(index = 2, value_parser = name)]
    name: String,
    /// The language of a program, which is otherwise Python
    #[arg(long, value_name = "LANGUAGE", conflicts_with = "command", value_parser = PossibleValuesParser::new(begin::LANGUAGES.map(|language| language.name)))]
    language: Option<String>,
    /// The command of a program that exists, such as "./solver {h}"
    #[arg(long, value_name = "COMMAND")]
    command: Option<String>,
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
    let mut names = project.templates.iter().map(|template| template.name);
    let without_program = names.all(|name| name != program::TEMPLATE.name);
    command.mut_subcommand("new", |new| {
        new.mut_arg("what", |what| what.value_parser(values))
            .mut_arg("language", |option| option.hide(without_program))
            .mut_arg("command", |option| option.hide(without_program))
            .hide(is_hidden)
    })
}

/// Runs the command. It never overwrites an existing file.
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let Arguments {
        what, name, flags, ..
    } = arguments;
    let template = project
        .templates
        .iter()
        .find(|template| template.name == what);
    let template = template
        .ok_or_else(|| Unusable::because(&format!("found `{what}`; expected a template")))?;
    let begun = begun(arguments, template)?;
    let place = TargetFolder::of(flags.out.as_deref(), template)?;
    let names = begun.iter().map(|begun| format!("{name}{}", begun.ending));
    let files: Vec<PathBuf> = names.map(|name| place.folder.join(name)).collect();
    if let Some(taken) = files.iter().find(|path| fs::symlink_metadata(path).is_ok()) {
        return Err(Unusable::because(&format!(
            "{}: expected a new file, found one of that name; take another name, or remove the file first",
            visible::path(taken)
        )));
    }
    if let Some(folder) = &flags.out {
        atomic::prepare_folder(folder)?;
    }
    for (path, begun) in files.iter().zip(&begun) {
        let mut text = begun
            .text
            .replace("NAME", name)
            .replace("PROGRAM", project.command)
            .replace("DIRECTORY", &place.directory)
            .replace("BELOW", &place.below);
        // To look for Python starts a process, which only a study of a Python program needs.
        if text.contains(PYTHON3) {
            text = text.replace(PYTHON3, &format!("[\"{}\"", python()));
        }
        atomic::write(path, text)?;
    }
    let mut wrote = files;
    let ignored = place.root.join(".gitignore");
    if !template.ignored.is_empty() && fs::symlink_metadata(&ignored).is_err() {
        atomic::write(&ignored, template.ignored)?;
        wrote.push(ignored);
    }
    let wrote: Vec<String> = wrote
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let written = format!("wrote {}", wrote.join(", "));
    let first = quoted(wrote.first().map_or("", String::as_str));
    let text = format!(
        "{written}\nrun: {} {} {first}\n",
        project.command, template.next
    );
    let words = flags.words(Verdict::Pass, &written, || text);
    Ok(flags.print(Verdict::Pass, &json!({"wrote": wrote}), &words)?)
}

/// The beginning of a command in a template that runs Python.
const PYTHON3: &str = "[\"python3\"";

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

/// The words of a command, as a shell separates them: by blanks outside quotes.
///
/// # Errors
/// No word, and a quote without its end, in words.
pub(super) fn words(command: &str) -> Result<Vec<String>, String> {
    let mut words = vec![];
    let mut word: Option<String> = None;
    let mut quote: Option<char> = None;
    for c in command.chars() {
        if quote == Some(c) {
            quote = None;
        } else if quote.is_none() && (c == '"' || c == '\'') {
            quote = Some(c);
            word.get_or_insert_default();
        } else if quote.is_none() && c.is_whitespace() {
            words.extend(word.take());
        } else {
            word.get_or_insert_default().push(c);
        }
    }
    words.extend(word);
    if let Some(quote) = quote {
        return Err(format!("found {quote} without its end; expected another"));
    }
    if words.is_empty() {
        return Err("found no word; expected a program and its arguments".to_owned());
    }
    Ok(words)
}

/// The files of a template, or of a program in another language or with a command of its own.
///
/// # Errors
/// A language or a command for another template, and a command that cannot be used.
fn begun(arguments: &Arguments, template: &Template) -> Result<Vec<begin::Begun>, Unusable> {
    let Arguments {
        language, command, ..
    } = arguments;
    let is_program = template.name == program::TEMPLATE.name;
    if (language.is_some() || command.is_some()) && !is_program {
        let option = match command {
            Some(_) => "--command",
            None => "--language",
        };
        return Err(Unusable::because(&format!(
            "{option}: found `new {}`; expected `new {}`",
            template.name,
            program::TEMPLATE.name
        )));
    }
    if let Some(command) = command {
        return words(command)
            .and_then(begin::of_command)
            .map_err(|reason| Unusable::because(&format!("--command: {reason}")));
    }
    let chosen = begin::LANGUAGES
        .iter()
        .find(|known| language.as_deref() == Some(known.name));
    Ok(chosen.map_or_else(|| begin::of_template(template), begin::in_language))
}

/// Where files are written.
struct TargetFolder {
    /// As the command line names it.
    folder: PathBuf,
    /// The folder that the commands run in, where reports are written.
    root: PathBuf,
    /// That folder as seen from the files.
    directory: String,
    /// The folder of the files as seen from there, with a slash at its end.
    below: String,
}

impl TargetFolder {
    /// The folder of `--out`; without it `studies/` of the project for a study, if there is one,
    /// and the current folder for anything else.
    fn of(out: Option<&Path>, template: &Template) -> Result<Self, Unusable> {
        let is_study = template.next == "study";
        let root = Project::root().ok().filter(|_| is_study && out.is_none());
        if let Some(root) = root {
            let here = env::current_dir()?;
            let depth = here
                .strip_prefix(&root)
                .map_or(0, |below| below.components().count());
            let root: PathBuf = vec![".."; depth].iter().collect();
            return Ok(Self {
                folder: root.join("studies"),
                root,
                directory: "..".to_owned(),
                below: "studies/".to_owned(),
            });
        }
        let folder = out.unwrap_or(Path::new(""));
        let (directory, below) = places(folder);
        // Reports are written below the folder that the commands run in: the current one, if the
        // files are below it.
        let root = if directory == "." {
            folder
        } else {
            Path::new("")
        };
        Ok(Self {
            folder: folder.to_owned(),
            root: root.to_owned(),
            directory,
            below,
        })
    }
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
