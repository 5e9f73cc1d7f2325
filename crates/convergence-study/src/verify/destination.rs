//! Where a report goes: that of a run that passes, or is blessed, where git holds it; any other into
//! `reports/local/`.

use std::io;
use std::path::Path;

use super::Scope;
use crate::report::{FULL, newest, shared};
use crate::store::{MANIFEST, Record, ReportFolder, ReportSet};
use crate::study::Tier;

/// The folder of the report on the full tier, in that of the report on the quick tier.
const FULL_FOLDER: &str = "full";

impl Scope {
    /// Where the report goes if the run passes or is blessed.
    pub(super) fn report_folder(&self, reports: &Path) -> ReportFolder {
        let local = reports.join("local");
        let workshop = local.join("workshop").join(self.name());
        let folder = match self {
            Self::Tier(Tier::Quick, _) => reports.to_owned(),
            Self::Tier(Tier::Full, _) => reports.join(FULL_FOLDER),
            Self::Selection(_) => local.join("partial"),
        };
        ReportFolder { folder, workshop }
    }

    /// Where the report of a tier goes otherwise; `None` for a selection, whose report is never
    /// committed.
    pub(super) fn failing_folder(&self, reports: &Path) -> Option<ReportFolder> {
        let Self::Tier(tier, _) = self else {
            return None;
        };
        let local = reports.join("local");
        Some(ReportFolder {
            folder: local.join(tier.name()),
            workshop: local
                .join("workshop")
                .join(format!("{}-failing", tier.name())),
        })
    }
}

/// The folders of the reports on both tiers, the quick one first.
pub(super) fn tiers(reports: &Path) -> [ReportFolder; 2] {
    let [quick, full, _] = scopes().map(|scope| scope.report_folder(reports));
    [quick, full]
}

/// One of each kind: the quick tier, the full one, a selection.
pub(super) fn scopes() -> [Scope; 3] {
    [
        Scope::Tier(Tier::Quick, vec![]),
        Scope::Tier(Tier::Full, vec![]),
        Scope::Selection(vec![]),
    ]
}

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
    pub(super) fn new(scope: &Scope, reports: &Path, is_accepted: bool) -> Self {
        let target = scope.report_folder(reports);
        match scope.failing_folder(reports) {
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

    /// The report on the full tier, next to that on the quick one. Its page is not committed: a fresh
    /// checkout has only its Markdown. A report elsewhere has no neighbour.
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

    pub(super) fn publish(&self, files: ReportSet, tiers: &[ReportFolder; 2]) -> io::Result<()> {
        match self {
            Self::One { target, failing } => {
                shared::publish(target, files, tiers)?;
                match failing {
                    Some(failing) if failing.folder.join(MANIFEST).is_file() => {
                        failing.publish(&ReportSet::default())
                    }
                    _ => Ok(()),
                }
            }
            Self::Apart { failing, committed } => {
                let newest = newest(&files);
                shared::publish(failing, files, tiers)?;
                committed.renew(&newest)
            }
        }
    }
}

/// The folder with the figures of the record in a folder: that of the failing run which wrote it,
/// otherwise the folder itself.
#[cfg(feature = "command-line")]
pub(crate) fn folder_of_figures(record: &Record, folder: &Path) -> std::path::PathBuf {
    use crate::judge::verdict::Verdict;

    let reports = super::folder::reports_around(folder);
    scopes()
        .into_iter()
        .filter(|scope| scope.report_folder(&reports).folder == folder)
        .filter(|scope| scope.name() == record.scope && record.verdict != Verdict::Pass)
        .filter_map(|scope| scope.failing_folder(&reports))
        .find(|failing| failing.folder.join(MANIFEST).is_file())
        .map_or_else(|| folder.to_owned(), |failing| failing.folder)
}
