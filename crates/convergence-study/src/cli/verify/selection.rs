//! What `verify` runs: study files, a selection, or a tier; and the list of it, for `--dry-run`.

use std::path::{Path, PathBuf};

use super::Arguments;
use crate::cli::exit::{CommandOutcome, Unusable};
use crate::cli::{screen, workspace};
use crate::judge::verdict::Verdict;
use crate::run::listed;
use crate::study::{StudyFile, Tier};
use crate::text::number::{counted, counted_as};
use crate::verify::Scope;

/// The study files that are named in place of ids.
///
/// # Errors
/// Files beside ids, and options that are about the studies of the project.
pub(super) fn files(arguments: &Arguments) -> Result<Option<Vec<PathBuf>>, Unusable> {
    let is_file = |id: &&String| workspace::is_toml(Path::new(id));
    let Some(file) = arguments.ids.iter().find(is_file) else {
        return Ok(None);
    };
    if let Some(id) = arguments.ids.iter().find(|id| !is_file(id)) {
        return Err(Unusable::because(&format!(
            "expected ids of studies or study files; found the file `{file}` beside `{id}`"
        )));
    }
    let of_the_project = [
        (arguments.tier != Tier::Quick, "--tier"),
        (arguments.bless, "--bless"),
        (arguments.verbose, "--verbose"),
        (arguments.dry_run, "--dry-run"),
        (arguments.fail_fast, "--fail-fast"),
        (arguments.durations, "--durations"),
    ];
    match of_the_project.into_iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(Unusable::because(&format!(
            "{option}: expected the studies of the project; found the file `{file}`, which is compared with no baseline"
        ))),
        None => Ok(Some(arguments.ids.iter().map(PathBuf::from).collect())),
    }
}

/// The tier, if nothing is named.
pub(super) fn scope(tier: Tier, ids: &[String], all: &[StudyFile]) -> Scope {
    if ids.is_empty() {
        Scope::Tier(
            tier,
            all.iter().map(|file| listed(file.study.as_ref())).collect(),
        )
    } else {
        Scope::Selection(ids.to_vec())
    }
}

/// Lists what would run. Nothing is run or written.
pub(super) fn dry_run(
    arguments: &Arguments,
    root: &Path,
    all: &[StudyFile],
    mask: &[bool],
) -> CommandOutcome {
    let last = workspace::last_seconds(root)?;
    let mut rows = vec![];
    let mut studies = vec![];
    let mut cases = 0;
    let mut total = 0.0;
    let selected = all.iter().zip(mask).filter(|(_, selected)| **selected);
    for (file, _) in selected {
        let id = &file.study.header().id;
        let own = file.study.plan().cases().len();
        let seconds = last.get(id).copied();
        let shown = seconds.map_or_else(|| "-".to_owned(), |seconds| format!("{seconds:.2}"));
        rows.push(vec![id.clone(), own.to_string(), shown]);
        studies.push(serde_json::json!({"id": id, "cases": own, "seconds": seconds}));
        cases += own;
        total += seconds.unwrap_or(0.0);
    }
    let sentence = format!(
        "{} with {} would run; {total:.1} s in their last runs\n",
        counted_as(rows.len(), "study", "studies"),
        counted(cases, "case")
    );
    let words = if arguments.flags.quiet {
        sentence
    } else {
        let table = screen::table(&["study", "cases", "seconds"], &rows);
        format!("{table}\n{sentence}")
    };
    let object = serde_json::json!({"studies": studies});
    Ok(arguments.flags.print(Verdict::Pass, &object, &words)?)
}
