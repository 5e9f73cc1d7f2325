//! The workspace: its studies, their selection by tier, id or pattern, and what the last run of
//! each has left in it.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use glob::Pattern;

use super::exit::Unusable;
use super::screen;
use crate::project::Project;
use crate::store;
use crate::store::{LastRun, Provenance};
use crate::study::{Header, StudyFile, Tier};
use crate::text::names::by_distance;
use crate::text::visible;

impl Project {
    /// The folder of the project that the process runs in: the nearest one with `studies/`, here or
    /// above.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn root() -> Result<PathBuf, Unusable> {
        let here = env::current_dir()?;
        let root = here
            .ancestors()
            .find(|folder| folder.join("studies").is_dir());
        root.map(Path::to_owned).ok_or_else(|| {
            Unusable::because(
                "expected a folder studies/, here or above; found none (`study FILE` runs a file from anywhere)",
            )
        })
    }
}

/// All studies of the workspace, those of files and those in code, by id.
///
/// # Errors
/// A folder that cannot be listed, the first file that is not a study, and a study in code with the
/// id of another one.
pub(crate) fn studies(project: &Project, root: &Path) -> Result<Vec<StudyFile>, Unusable> {
    let folder = root.join("studies");
    let paths = toml_files(&folder).map_err(|error| Unusable::file(&folder, &error))?;
    let mut files = StudyFile::read_all(project.kinds, &paths)?;
    for study in project.studies {
        let study = study();
        let Header { id, home, .. } = study.header();
        let home = home.unwrap_or_default();
        if let Some(other) = files.iter().find(|file| file.study.header().id == *id) {
            return Err(Unusable::because(&format!(
                "{home}: expected an id that no other study has, found \"{id}\", which {} has too",
                visible::path(&other.path)
            )));
        }
        files.push(StudyFile {
            path: PathBuf::from(home),
            study,
        });
    }
    files.sort_by(|a, b| a.study.header().id.cmp(&b.study.header().id));
    warn_of_near_names(root);
    Ok(files)
}

/// Warns on standard error about files that hold a study but are not run, because their extension
/// is not `toml`.
fn warn_of_near_names(root: &Path) {
    let entries = fs::read_dir(root.join("studies"))
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    let mut paths: Vec<PathBuf> = entries
        .filter(|path| has_near_extension(path) && is_study(path))
        .collect();
    paths.sort();
    for path in paths {
        let name = visible::path(path.strip_prefix(root).unwrap_or(&path));
        screen::tell(&format!(
            "warning: {name}: a study that is not run; expected a name that ends in .toml"
        ));
    }
}

/// Whether a file has the table of a study.
fn is_study(path: &Path) -> bool {
    let text = store::read_to_string(path).unwrap_or_default();
    text.lines().any(|line| {
        line.split('#')
            .next()
            .is_some_and(|line| line.trim() == "[study]")
    })
}

/// Whether the extension is `toml`, in any case of its letters: some systems write `UP.TOML`.
pub(crate) fn is_toml(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// Whether the extension is almost `toml`: one wrong letter, or something after it.
fn has_near_extension(path: &Path) -> bool {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    !is_toml(path)
        && [".toml", ".tml", ".tom", ".toml.txt", ".toml~"]
            .iter()
            .any(|end| name.ends_with(end))
}

fn toml_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = entries.collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| is_toml(path));
    paths.sort();
    // Messages name files relative to the current folder.
    let here = env::current_dir().unwrap_or_default();
    Ok(paths
        .iter()
        .map(|path| path.strip_prefix(&here).unwrap_or(path).to_owned())
        .collect())
}

/// The last run of each study by `verify` on this machine, by its id.
///
/// # Errors
/// A file that exists but cannot be read.
pub(super) fn last_runs(root: &Path) -> Result<HashMap<String, LastRun>, Unusable> {
    let runs = Provenance::read(&root.join("reports/local/provenance.json"))?;
    let runs = runs.into_iter().flat_map(|origin| origin.studies);
    Ok(runs.map(|run| (run.id.clone(), run)).collect())
}

/// Reads a tier from the command line.
pub(crate) fn tier_parser() -> impl TypedValueParser<Value = Tier> {
    let names = PossibleValuesParser::new(Tier::ALL.map(Tier::name));
    names.map(|name| {
        if name == Tier::Full.name() {
            Tier::Full
        } else {
            Tier::Quick
        }
    })
}

/// The studies that are selected.
///
/// * `words`: ids and patterns (`*`, `?`, `[a-z]`). If empty: every study of the tier. An id
///   selects its study whatever the tier; a pattern stays within the tier. The full tier includes
///   the quick one.
///
/// # Errors
/// A pattern that cannot be read, or one that matches nothing: a misspelt name must not pass.
pub(crate) fn select(
    project: &Project,
    mut all: Vec<StudyFile>,
    tier: Tier,
    words: &[String],
) -> Result<Vec<StudyFile>, Unusable> {
    let in_tier = |header: &Header| header.tier <= tier;
    if words.is_empty() {
        let count = all.len();
        all.retain(|file| in_tier(file.study.header()));
        return match all.is_empty() {
            true => Err(Unusable::because(&none_in(tier, count, project))),
            false => Ok(all),
        };
    }
    let mut selected: HashSet<String> = HashSet::new();
    for word in words {
        let pattern = Pattern::new(word)
            .map_err(|error| Unusable::because(&format!("`{word}` is not a pattern: {error}")))?;
        let headers: Vec<&Header> = all.iter().map(|file| file.study.header()).collect();
        let matching = headers.iter().filter(|header| {
            header.id == *word || (in_tier(header) && pattern.matches(&header.id))
        });
        let matching: Vec<String> = matching.map(|header| header.id.clone()).collect();
        if matching.is_empty() {
            let list = format!("{} list", project.command);
            return Err(Unusable::because(&no_match(
                word, &pattern, &headers, tier, &list,
            )));
        }
        selected.extend(matching);
    }
    all.retain(|file| selected.contains(&file.study.header().id));
    Ok(all)
}

/// No study is in the tier, of so many in all.
fn none_in(tier: Tier, count: usize, project: &Project) -> String {
    let none = format!("no study in the tier {}", tier.name());
    if count > 0 {
        return format!("{none}, and {count} with --tier full");
    }
    let mut templates = project.templates.iter();
    let template = templates.find(|template| template.next == "study");
    let advice = template.map(|template| {
        let begin = format!("{} new {} NAME", project.command, template.name);
        format!(", such as `{begin}` writes")
    });
    format!(
        "{none}; expected a file studies/NAME.toml{}",
        advice.unwrap_or_default()
    )
}

fn no_match(word: &str, pattern: &Pattern, all: &[&Header], tier: Tier, list: &str) -> String {
    let outside = all
        .iter()
        .filter(|header| pattern.matches(&header.id))
        .count();
    if outside > 0 {
        return format!(
            "`{word}` matches no study in the tier {}, and {outside} with --tier full",
            tier.name()
        );
    }
    // A longer list would fill the screen.
    const FEW: usize = 12;
    const NEAREST: usize = 3;
    let ids: Vec<&str> = all.iter().map(|header| header.id.as_str()).collect();
    let allowed = if ids.len() <= FEW {
        ids.join(", ")
    } else {
        let nearest = by_distance(word, ids)[..NEAREST].join(", ");
        format!("what `{list}` shows, of which {nearest} are nearest")
    };
    format!("`{word}` matches no study; expected {allowed}, or a pattern such as '*-space'")
}
