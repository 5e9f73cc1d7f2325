//! All reports of a project: `reports/`, and what is below it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use super::Scope;
use crate::store::{ReportFolder, atomic, lock};
use crate::study::Tier;
use crate::text::visible;

/// The folder of the report on the full tier, in that of the report on the quick tier.
pub(super) const FULL_FOLDER: &str = "full";

/// The folder of all reports of a project. Its lock keeps two runs apart; what belongs to one
/// machine is in `local/`, which git ignores.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reports {
    folder: PathBuf,
}

impl Reports {
    /// Those in this folder.
    pub(super) fn at(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
        }
    }

    /// Those that a folder belongs to, by their lock: `reports/` for `reports/full/`; otherwise the
    /// folder itself.
    pub(crate) fn around(folder: &Path) -> Self {
        let mut folders = folder.ancestors().take(3).map(Self::at);
        let with_lock = folders.find(|reports| reports.lock_file().is_file());
        with_lock.unwrap_or_else(|| Self::at(folder))
    }

    /// Where the run comes from, with times.
    pub(crate) fn provenance(&self) -> PathBuf {
        self.local().join("provenance.json")
    }

    /// Where the report goes if the run passes or is blessed.
    pub(super) fn report(&self, scope: &Scope) -> ReportFolder {
        let folder = match scope {
            Scope::Tier(Tier::Quick, _) => self.folder.clone(),
            Scope::Tier(Tier::Full, _) => self.folder.join(FULL_FOLDER),
            Scope::Selection(_) => self.local().join("partial"),
        };
        self.prepared_in(folder, scope.name())
    }

    /// Where the report of a tier goes otherwise; `None` for a selection, whose report is never
    /// committed.
    pub(super) fn failing(&self, scope: &Scope) -> Option<ReportFolder> {
        let Scope::Tier(tier, _) = scope else {
            return None;
        };
        let folder = self.local().join(tier.name());
        Some(self.prepared_in(folder, &format!("{}-failing", tier.name())))
    }

    /// The report in any folder that shares the lock.
    pub(super) fn elsewhere(&self, folder: &Path) -> ReportFolder {
        self.prepared_in(folder.to_owned(), "rebuilt")
    }

    /// Waits for other processes that write here, and then blocks them until the file is dropped.
    pub(super) fn lock(&self) -> io::Result<File> {
        lock(&self.lock_file()).map_err(|error| self.unwritable(&error))
    }

    /// Whether both have the same lock. One of them must be held: its file then exists.
    pub(super) fn shares_its_lock(&self, other: &Self) -> bool {
        let [own, other] = [self, other].map(|reports| reports.lock_file().canonicalize().ok());
        own.is_some() && own == other
    }

    /// Makes the folder, and says before a run if it cannot be written.
    pub(super) fn prepare(&self) -> io::Result<()> {
        atomic::prepare_folder(&self.folder).map_err(|error| self.unwritable(&error))
    }

    /// Whether anything was ever written here.
    pub(super) fn is_used(&self) -> bool {
        self.local().is_dir()
    }

    /// Removes what killed runs have left. The caller must hold the lock.
    pub(super) fn tidy(&self) -> io::Result<()> {
        atomic::remove_leftovers(&self.provenance())?;
        // Left by a run that was killed while it tested the folder.
        atomic::remove_leftovers(&self.folder.join(atomic::PROBE))?;
        for scope in Scope::one_of_each() {
            self.report(&scope).tidy()?;
            self.failing(&scope)
                .map_or(Ok(()), |failing| failing.tidy())?;
        }
        Ok(())
    }

    /// The same error, preceded by the folder.
    pub(super) fn unwritable(&self, error: &io::Error) -> io::Error {
        let folder = visible::path(&self.folder);
        io::Error::new(
            error.kind(),
            format!("{folder}: the reports cannot be written: {error}"),
        )
    }

    fn local(&self) -> PathBuf {
        self.folder.join("local")
    }

    fn lock_file(&self) -> PathBuf {
        self.local().join("lock")
    }

    /// A folder whose next files are prepared in a workshop of that name.
    fn prepared_in(&self, folder: PathBuf, workshop: &str) -> ReportFolder {
        ReportFolder {
            folder,
            workshop: self.local().join("workshop").join(workshop),
        }
    }
}
