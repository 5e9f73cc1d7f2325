//! The reports of a project: `reports/`, and what is below it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use crate::report::{NEWEST, SeeAlso, newest};
use crate::store::{README, ReportFolder, ReportSet, atomic, lock};
use crate::study::Tier;
use crate::text::visible;

/// The folder of the report on the full tier, in that of the report on the quick tier.
const FULL_FOLDER: &str = "full";

/// What git ignores of the reports: what each run makes anew, for one machine.
const IGNORED: &str = "# Made anew by each run; what people review is committed.\nlocal/\nindex.html\njunit.xml\n\
                       results.json\nsummary.md\n**/figures/page/\n";

/// Where the report on a scope is, among all reports of its project: decided once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reports {
    /// All reports. Their lock keeps two runs apart; what belongs to one machine is in `local/`.
    root: PathBuf,
    /// The report on a run that passes or is blessed.
    pub(super) accepted: ReportFolder,
    /// That on any other run of a tier, which leaves what git holds of the accepted one.
    failing: Option<ReportFolder>,
}

impl Reports {
    /// * `scope`: the name of a tier, or of any other scope, whose report is never committed.
    pub(super) fn of(root: impl Into<PathBuf>, scope: &str) -> Self {
        let root = root.into();
        let local = root.join("local");
        let folder = match scope {
            _ if scope == Tier::Quick.name() => root.clone(),
            _ if scope == Tier::Full.name() => root.join(FULL_FOLDER),
            _ => local.join("partial"),
        };
        let prepared_in = |folder: PathBuf, workshop: &str| ReportFolder {
            folder,
            workshop: local.join("workshop").join(workshop),
        };
        let is_tier = Tier::ALL.iter().any(|tier| tier.name() == scope);
        Self {
            accepted: prepared_in(folder, scope),
            failing: is_tier.then(|| prepared_in(local.join(scope), &format!("{scope}-failing"))),
            root,
        }
    }

    /// The report in a folder, of a project if that has a lock: `reports/` of `reports/full/`.
    pub(crate) fn around(folder: &Path, scope: &str) -> Self {
        let mut roots = folder.ancestors().take(3);
        let root = roots.find(|root| Self::of(*root, scope).lock_file().is_file());
        let own = Self::of(root.unwrap_or(folder), scope);
        if own.accepted.folder == folder {
            return own;
        }
        let accepted = ReportFolder {
            folder: folder.to_owned(),
            workshop: own.local().join("workshop/rebuilt"),
        };
        Self {
            accepted,
            failing: None,
            ..own
        }
    }

    /// Where the run comes from, with times.
    pub(crate) fn provenance(&self) -> PathBuf {
        self.local().join("provenance.json")
    }

    /// Where the answers of a study are kept.
    pub(super) fn answers(&self, id: &str) -> PathBuf {
        self.local().join("answers").join(id)
    }

    /// The folder of the report on a run that passes, or does not.
    pub(crate) fn folder(&self, is_accepted: bool) -> &Path {
        match &self.failing {
            Some(failing) if !is_accepted => &failing.folder,
            _ => &self.accepted.folder,
        }
    }

    /// The report on the other tier, if it is there.
    pub(super) fn see_also(&self, scope: &str) -> Option<SeeAlso> {
        let own = &self.accepted.folder;
        let (folder, other, place) = match scope {
            _ if scope == Tier::Quick.name() => (FULL_FOLDER, Tier::Full, own.join(FULL_FOLDER)),
            // The folder of the full tier may not yet exist.
            _ if scope == Tier::Full.name() => ("..", Tier::Quick, own.parent()?.to_owned()),
            _ => return None,
        };
        let has = |file: &str| place.join(file).is_file();
        has(README).then(|| SeeAlso {
            tier: other.name(),
            folder,
            has_page: has("index.html"),
        })
    }

    /// Writes the report; of a run that does not pass, the files that programs read also to the
    /// place of the accepted one. The caller must hold the lock.
    pub(super) fn publish(&self, files: &ReportSet, is_accepted: bool) -> io::Result<()> {
        let published = match &self.failing {
            Some(failing) if !is_accepted => failing
                .publish(files)
                .and_then(|()| self.accepted.renew(&newest(files))),
            failing => self
                .accepted
                .publish(files)
                .and_then(|()| failing.as_ref().map_or(Ok(()), ReportFolder::clear)),
        };
        published
            .and_then(|()| self.ignore())
            .map_err(|error| self.unwritable(&error))
    }

    /// Tells git what each run makes anew, unless the folder says already what to ignore.
    fn ignore(&self) -> io::Result<()> {
        let ignored = self.root.join(".gitignore");
        if ignored.exists() {
            return Ok(());
        }
        atomic::write(&ignored, IGNORED)
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

    /// Whether a run has been here: then there is something to set aside, or to tidy.
    pub(super) fn is_used(&self) -> bool {
        let has = |name: &&str| self.accepted.folder.join(name).exists();
        self.local().exists() || NEWEST.iter().any(has)
    }

    /// Makes the folder, and says before a run if it cannot be written.
    pub(super) fn prepare(&self) -> io::Result<()> {
        atomic::prepare_folder(&self.root).map_err(|error| self.unwritable(&error))
    }

    /// Removes what killed runs have left, and sets aside what programs read. The caller must hold
    /// the lock.
    pub(super) fn begin(&self) -> io::Result<()> {
        atomic::remove_leftovers(&self.provenance())?;
        // Left by a run that was killed while it tested the folder.
        atomic::remove_leftovers(&self.root.join(atomic::PROBE))?;
        for scope in ["quick", "full", "selection"] {
            let Self {
                accepted, failing, ..
            } = Self::of(&self.root, scope);
            accepted.tidy()?;
            failing.map_or(Ok(()), |failing| failing.tidy())?;
        }
        self.accepted.set_aside(&NEWEST)
    }

    /// The same error, preceded by the folder.
    pub(super) fn unwritable(&self, error: &io::Error) -> io::Error {
        let folder = visible::path(&self.root);
        io::Error::new(
            error.kind(),
            format!("{folder}: the reports cannot be written: {error}"),
        )
    }

    fn local(&self) -> PathBuf {
        self.root.join("local")
    }

    fn lock_file(&self) -> PathBuf {
        self.local().join("lock")
    }
}

/// Whether a folder holds the files of a report that programs read, and a page may be missing.
#[cfg(feature = "command-line")]
pub(crate) fn is_report(folder: &Path) -> bool {
    let mut files = NEWEST.iter().filter(|name| !name.ends_with(".html"));
    files.all(|name| folder.join(name).is_file())
}
