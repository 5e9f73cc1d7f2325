//! Where a report goes: that of a run that passes, or is blessed, where git holds it; any other
//! into `reports/local/`.

use std::io;
use std::path::Path;

use super::reports::FULL_FOLDER;
use super::{Reports, Scope};
use crate::report::{NEWEST, SeeAlso, newest};
use crate::store::{README, Record, ReportFolder, ReportSet};
use crate::study::Tier;

/// Where the files of a report go.
#[derive(Debug)]
pub(super) enum Destination {
    /// Into one folder. The report on a failing run of the same tier, if there is one, is removed.
    One {
        target: ReportFolder,
        failing: Option<ReportFolder>,
    },
    /// A run that does not pass: its report into `failing`, the files that git ignores also into
    /// `committed`, whose other files stay as they are.
    Apart {
        failing: ReportFolder,
        committed: ReportFolder,
    },
}

impl Destination {
    pub(super) fn new(scope: &Scope, reports: &Reports, is_accepted: bool) -> Self {
        let target = reports.report(scope);
        match reports.failing(scope) {
            Some(failing) if !is_accepted => Self::Apart {
                failing,
                committed: target,
            },
            failing => Self::One { target, failing },
        }
    }

    /// Where the report is.
    pub(super) fn folder(&self) -> &Path {
        match self {
            Self::One { target, .. } => &target.folder,
            Self::Apart { failing, .. } => &failing.folder,
        }
    }

    /// The report on the other tier, if it is there. A report elsewhere has no neighbour.
    pub(super) fn see_also(&self, record: &Record) -> Option<SeeAlso> {
        let Self::One { target, .. } = self else {
            return None;
        };
        let (folder, other, place) = match record.scope.as_str() {
            scope if scope == Tier::Quick.name() => {
                (FULL_FOLDER, Tier::Full, target.folder.join(FULL_FOLDER))
            }
            // The folder of the full tier may not yet exist.
            scope if scope == Tier::Full.name() => {
                ("..", Tier::Quick, target.folder.parent()?.to_owned())
            }
            _ => return None,
        };
        let has = |file: &str| place.join(file).is_file();
        has(README).then(|| SeeAlso {
            tier: other.name(),
            folder,
            has_page: has("index.html"),
        })
    }

    pub(super) fn publish(&self, files: &ReportSet) -> io::Result<()> {
        match self {
            Self::One { target, failing } => {
                target.publish(files)?;
                failing.as_ref().map_or(Ok(()), ReportFolder::clear)
            }
            Self::Apart { failing, committed } => {
                let newest = newest(files);
                failing.publish(files)?;
                committed.renew(&newest)
            }
        }
    }
}

/// Whether a folder holds the files of a report that programs read, and a page may be missing.
#[cfg(feature = "command-line")]
pub(crate) fn is_report(folder: &Path) -> bool {
    let mut files = NEWEST.iter().filter(|name| !name.ends_with(".html"));
    files.all(|name| folder.join(name).is_file())
}

/// The folder with the figures of the record in a folder: that of the failing run which wrote it,
/// otherwise the folder itself.
#[cfg(feature = "command-line")]
pub(crate) fn folder_of_figures(record: &Record, folder: &Path) -> std::path::PathBuf {
    use crate::judge::verdict::Verdict;

    let reports = Reports::around(folder);
    Scope::one_of_each()
        .into_iter()
        .filter(|scope| reports.report(scope).folder == folder)
        .filter(|scope| scope.name() == record.scope && record.verdict != Verdict::Pass)
        .filter_map(|scope| reports.failing(&scope))
        .find(|failing| is_report(&failing.folder))
        .map_or_else(|| folder.to_owned(), |failing| failing.folder)
}
