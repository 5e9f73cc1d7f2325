//! `explain NAME`: what a study, a term, a reason for a verdict or a kind of study means.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::exit::{CommandOutcome, Unusable};
use super::flags::Flags;
use super::workspace;
use crate::judge::verdict::{Reason, Verdict};
use crate::project::Project;
use crate::study::{KindRow, Study, StudyFile};
use crate::text::lists::grouped;
use crate::text::names::nearest;
use crate::text::section::section;
use crate::text::visible::{self, visible};

/// Explain what a study claims, why it should hold, how it is judged, what failing means
#[derive(Debug, Args)]
pub struct Arguments {
    /// A study's id or file; or a reason for a verdict (too-low), a kind of study, a word of the
    /// project. Without it: everything that can be explained
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
pub(super) fn run(project: &Project, arguments: &Arguments) -> CommandOutcome {
    let Some(name) = arguments.name.as_deref() else {
        return show(arguments, &contents(project));
    };
    // Terms, reasons and files can be explained outside a workspace.
    let studies =
        || workspace::root().map_or_else(|_| PathBuf::from("studies"), |root| root.join("studies"));
    if let Some(folder) = arguments.dir.as_deref().filter(|folder| !folder.is_dir()) {
        return Err(Unusable::because(&format!(
            "--dir {}: expected a folder with studies, found none",
            visible::path(folder)
        )));
    }
    let folder = arguments.dir.clone().unwrap_or_else(studies);
    let text = match term(project, name) {
        Some(text) => text,
        None if name.ends_with(".toml") => {
            of_study(project, &StudyFile::read(project.kinds, Path::new(name))?)
        }
        None => {
            let files = workspace::readable_studies(project, &folder);
            let named = files.iter().find(|file| file.study.header().id == name);
            named.map(|file| of_study(project, file)).ok_or_else(|| {
                let ids = files.iter().map(|file| file.study.header().id.as_str());
                let nearest = nearest_name(project, ids, name);
                Unusable::because(&unknown(project, name, &folder, nearest))
            })?
        }
    };
    show(arguments, &text)
}

fn show(arguments: &Arguments, text: &str) -> CommandOutcome {
    let Arguments { name, flags, .. } = arguments;
    // The first line is the name and what it names.
    let words = flags.words(Verdict::Pass, text.lines().next().unwrap_or(""), || {
        text.to_owned()
    });
    Ok(flags.show(
        "explain",
        Verdict::Pass,
        &json!({"name": name, "text": text}),
        &words,
    )?)
}

/// The kind of a file that was read is one that the project knows.
fn of_study(project: &Project, file: &StudyFile) -> String {
    study(project, file.study.as_ref()).unwrap_or_default()
}

fn unknown(project: &Project, name: &str, folder: &Path, nearest: Option<String>) -> String {
    let hint = nearest.map_or_else(
        || {
            format!(
                "`{} explain` lists all that can be explained",
                project.command
            )
        },
        |name| format!("did you mean {name}?"),
    );
    format!(
        "found no study, term, reason or kind `{}` in {}; {hint}",
        visible(name),
        visible::path(folder)
    )
}

/// The code of a case stopped at its work limit.
const WORK: &str = "work";

const WORK_MEANS: &str = "The case has counted three times the node-steps of its blessing, and two per cent of its tier's: it was stopped, at \
    the same step on every machine. An iteration needs more steps, a run does not come to rest, or steps have become smaller. If more \
    work is meant: `verify --bless`, which limits nothing, takes the new counts for `studies/work.json`.";

/// A term of the project, a reason or a kind, in words; `None` if the name is unknown.
pub fn term(project: &Project, name: &str) -> Option<String> {
    if let Some(term) = project.terms.iter().find(|term| term.name == name) {
        return Some(page(
            &format!("{name}, {}", term.what),
            &[("what it means", &format!("{}.", term.text))],
        ));
    }
    if let Some(reason) = Reason::all().find(|reason| reason.code() == name) {
        let in_short = format!("{}.", reason.text());
        let (advice, mathematics) = (reason.advice(), reason.mathematics());
        let parts = [
            ("in short", &*in_short),
            ("what it means", advice),
            ("mathematics, and what to try", mathematics),
        ];
        return Some(page(
            &format!("{name}, a reason for {}", reason.verdict()),
            &parts,
        ));
    }
    if name == WORK {
        return Some(page(
            &format!("{name}, a reason for which a case fails"),
            &[("what it means", WORK_MEANS)],
        ));
    }
    let kind = project.kinds.iter().find(|kind| kind.name == name)?;
    Some(page(
        &format!("{name}, a kind of study"),
        &of_kind(kind, &[]),
    ))
}

/// The names that [`term`] knows.
pub fn terms(project: &Project) -> Vec<&'static str> {
    groups(project)
        .into_iter()
        .flat_map(|(_, names)| names)
        .collect()
}

/// The names that [`term`] knows, group by group.
pub fn contents(project: &Project) -> String {
    let groups: Vec<_> = groups(project)
        .into_iter()
        .map(|(title, names)| (title, names.join(", ")))
        .collect();
    let list = format!("see `{} list`", project.command);
    let mut parts: Vec<(&str, &str)> = groups
        .iter()
        .map(|(title, names)| (*title, names.as_str()))
        .collect();
    parts.push(("studies, by id or file", &list));
    page("what can be explained", &parts)
}

fn groups(project: &Project) -> Vec<(&'static str, Vec<&'static str>)> {
    let mut groups = grouped(project.terms.iter().map(|term| (term.what, term.name)));
    groups.push((
        "reasons for a verdict",
        Reason::all().map(Reason::code).collect(),
    ));
    groups.push(("reasons for which a case fails", vec![WORK]));
    groups.push((
        "kinds of study",
        project.kinds.iter().map(|kind| kind.name).collect(),
    ));
    groups
}

/// A study in words; `None` if the project does not know its kind.
pub fn study(project: &Project, study: &dyn Study) -> Option<String> {
    let header = study.header();
    let kind = project.kinds.iter().find(|kind| kind.name == header.kind)?;
    let details = study.details();
    let parts = [
        vec![("what is claimed", header.claim.as_str())],
        of_kind(kind, &details),
    ]
    .concat();
    Some(page(
        &format!(
            "{} ({}, tier {})",
            header.id,
            header.kind,
            header.tier.name()
        ),
        &parts,
    ))
}

/// The id or term closest to a misspelt one, or the kind with this source.
pub fn nearest_name<'i>(
    project: &Project,
    ids: impl IntoIterator<Item = &'i str>,
    name: &str,
) -> Option<String> {
    let kind = KindRow::with_source(project.kinds, name).map(|kind| kind.name);
    kind.or_else(|| nearest(name, ids.into_iter().chain(terms(project))))
        .map(str::to_owned)
}

/// * `details`: paragraphs on one study, each with its title.
fn of_kind<'t>(kind: &KindRow, details: &'t [(String, String)]) -> Vec<(&'t str, &'t str)> {
    let details = details
        .iter()
        .map(|(title, paragraph)| (title.as_str(), paragraph.as_str()));
    let judged = [
        ("how it is judged", kind.judged),
        ("what a failure would mean", kind.failure),
    ];
    [("why it should hold", kind.why)]
        .into_iter()
        .chain(details)
        .chain(judged)
        .collect()
}

/// A head, and sections, each with its title.
fn page(head: &str, parts: &[(&str, &str)]) -> String {
    let mut text = format!("{head}\n");
    parts
        .iter()
        .for_each(|(title, paragraph)| section(&mut text, title, paragraph));
    text
}
