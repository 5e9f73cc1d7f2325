//! Where a report goes: that of a run that passes, or is blessed, where git holds it; any other
//! into `reports/local/`.

use std::io;
use std::path::Path;

use super::{Reports, Scope};
use crate::report::{FULL, NEWEST, newest, shared};
use crate::store::{Record, ReportFolder, ReportSet};
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

    /// The report on the full tier, next to that on the quick one. Its page is not committed: a
    /// fresh checkout has only its Markdown. A report elsewhere has no neighbour.
    pub(super) fn see_also(&self, record: &Record) -> Option<&'static str> {
        let Self::One { target, .. } = self else {
            return None;
        };
        let has = |file: &&str| target.folder.join(file).is_file();
        if record.scope == Tier::Quick.name() && has(&FULL) {
            ["full/index.html", FULL].into_iter().find(has)
        } else {
            None
        }
    }

    pub(super) fn publish(&self, files: ReportSet, reports: &Reports) -> io::Result<()> {
        match self {
            Self::One { target, failing } => {
                shared::publish(target, files, &reports.tiers())?;
                failing.as_ref().map_or(Ok(()), ReportFolder::clear)
            }
            Self::Apart { failing, committed } => {
                let newest = newest(&files);
                shared::publish(failing, files, &reports.tiers())?;
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
