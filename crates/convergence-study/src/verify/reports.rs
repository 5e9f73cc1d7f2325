//! The reports of a project: `reports/`, and what is below it.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use crate::report::{Findings, SeeAlso};
use crate::store::{
    LOCK, NEWEST, README, ReportSet, atomic, beside, clear, if_there, lock, place, prepare,
    remove_folder, remove_other_figures,
};
use crate::study::Tier;
use crate::text::visible;
use convergence_judge::verdict::Verdict;

/// The folder of the report on the full tier, in that of the report on the quick tier.
const FULL_FOLDER: &str = "full";

/// What git ignores of the reports: what each run makes anew, for one machine.
const IGNORED: &str = "# Made anew by each run; what people review is committed.\nlocal/\nindex.html\njunit.xml\n\
                       results.json\nsummary.md\n**/figures/page/\n.*.unfinished-*\n";

/// A report whose files are on the disk, next to their places.
pub(super) struct Unplaced<'r> {
    reports: &'r Reports,
    /// The folder of the whole report, and what belongs there.
    folder: &'r Path,
    files: &'r ReportSet,
    /// The files that differ.
    changed: Vec<atomic::Prepared>,
}

/// Where the report on a scope is, among all reports of its project: decided once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reports {
    /// All reports. Their lock keeps two runs apart; what belongs to one machine is in `local/`.
    root: PathBuf,
    /// The tier that was run; any other report is never committed.
    tier: Option<Tier>,
    /// The folder of the report on a run that passes or is blessed.
    accepted: PathBuf,
    /// That on any other run of a tier, which leaves what git holds of the accepted one.
    failing: Option<PathBuf>,
}

impl Reports {
    /// * `scope`: its name in records.
    pub(super) fn of(root: impl Into<PathBuf>, scope: &str) -> Self {
        let root = root.into();
        let local = root.join("local");
        let tier = Tier::ALL.into_iter().find(|tier| tier.name() == scope);
        let accepted = match tier {
            Some(Tier::Quick) => root.clone(),
            Some(Tier::Full) => root.join(FULL_FOLDER),
            None => local.join("partial"),
        };
        Self {
            failing: tier.map(|tier| local.join(tier.name())),
            accepted,
            tier,
            root,
        }
    }

    /// The report in a folder, of a project if that has a lock: `reports/` of `reports/full/`.
    pub(crate) fn around(folder: &Path, scope: &str) -> Self {
        let mut roots = folder.ancestors().take(3);
        let root = roots.find(|root| Self::of(*root, scope).lock_file().is_file());
        let mut own = Self::of(root.unwrap_or(folder), scope);
        if own.accepted != folder {
            own.accepted = folder.to_owned();
            own.failing = None;
        }
        own
    }

    /// Where the run comes from, with times.
    pub(crate) fn provenance(&self) -> PathBuf {
        self.local().join("provenance.json")
    }

    /// Where the answers of a study are kept.
    pub(super) fn answers(&self, id: &str) -> PathBuf {
        self.local().join("answers").join(id)
    }

    /// The folder of the report on a run with this verdict.
    pub(crate) fn folder(&self, verdict: Verdict) -> &Path {
        match &self.failing {
            Some(failing) if !verdict.is_pass() => failing,
            _ => &self.accepted,
        }
    }

    /// The files of the report on findings.
    pub(super) fn files(&self, findings: Findings<'_>) -> io::Result<ReportSet> {
        let see_also = self.see_also();
        let findings = Findings {
            see_also: see_also.filter(|_| findings.record.verdict.is_pass()),
            ..findings
        };
        findings.files().map_err(self.unwritable())
    }

    /// The report on the other tier, if it is there.
    fn see_also(&self) -> Option<SeeAlso> {
        let own = &self.accepted;
        match self.tier? {
            Tier::Quick => report_in(&own.join(FULL_FOLDER), FULL_FOLDER, Tier::Full),
            // The folder of the full tier may not yet exist.
            Tier::Full => report_in(own.parent()?, "..", Tier::Quick),
        }
    }

    /// Writes the report on a run with this verdict next to its place; if that is no pass, also
    /// the files that programs read to that of the accepted one. The caller must hold the lock,
    /// and that of a pending write.
    pub(super) fn beside<'r>(
        &'r self,
        files: &'r ReportSet,
        verdict: Verdict,
    ) -> io::Result<Unplaced<'r>> {
        let folder = self.folder(verdict);
        let changed = self.changed(folder, files).map_err(self.unwritable())?;
        Ok(Unplaced {
            reports: self,
            folder,
            files,
            changed,
        })
    }

    fn changed(&self, folder: &Path, files: &ReportSet) -> io::Result<Vec<atomic::Prepared>> {
        clear(folder)?;
        let mut changed = beside(folder, files)?;
        if folder != self.accepted {
            changed.append(&mut beside(&self.accepted, &files.newest())?);
        }
        // Tells git what each run makes anew, unless the folder says already what to ignore.
        let ignored = self.root.join(".gitignore");
        if !ignored.exists() {
            changed.push(atomic::Prepared::of(&ignored, IGNORED)?);
        }
        Ok(changed)
    }

    /// Waits for other processes that write here, and then blocks them until the file is dropped.
    pub(super) fn lock(&self) -> io::Result<File> {
        lock(&self.lock_file()).map_err(self.unwritable())
    }

    /// Whether a run has been here: then there is something to remove.
    pub(super) fn is_used(&self) -> bool {
        let has = |name: &&str| self.accepted.join(name).exists();
        self.local().exists() || NEWEST.iter().any(has)
    }

    /// Makes the folder, and says before a run if it cannot be written, or holds other files.
    pub(super) fn prepare(&self) -> io::Result<()> {
        prepare(&self.root)
    }

    /// Removes what killed runs have left, and what programs read: while a run is under way, and
    /// after one that ends without a result, no reader takes what an older one has found for it.
    /// The caller must hold the lock.
    pub(super) fn begin(&self) -> io::Result<()> {
        self.clear_all().map_err(self.unwritable())
    }

    fn clear_all(&self) -> io::Result<()> {
        let own = [
            "",
            FULL_FOLDER,
            "local",
            "local/quick",
            "local/full",
            "local/partial",
        ];
        for folder in own {
            clear(&self.root.join(folder))?;
        }
        for name in NEWEST {
            if_there(fs::remove_file(self.accepted.join(name)))?;
        }
        Ok(())
    }

    /// For `map_err`: the same error, preceded by the folder.
    fn unwritable(&self) -> impl Fn(io::Error) -> io::Error {
        let folder = visible::path(&self.root);
        move |error| {
            let words = format!("{folder}: the reports cannot be written: {error}");
            io::Error::new(error.kind(), words)
        }
    }

    fn local(&self) -> PathBuf {
        self.root.join("local")
    }

    fn lock_file(&self) -> PathBuf {
        self.root.join(LOCK)
    }
}

impl Unplaced<'_> {
    /// Moves the files to their places, and removes what the report does not have.
    pub(super) fn place(self) -> io::Result<()> {
        let Self {
            reports,
            folder,
            files,
            changed,
        } = self;
        let mut placed = place(changed).and_then(|()| remove_other_figures(folder, files));
        if let Some(failing) = reports.failing.as_deref().filter(|own| *own != folder) {
            placed = placed.and_then(|()| remove_folder(failing));
        }
        placed.map_err(reports.unwritable())
    }
}

/// Whether a folder holds the files of a report that programs read, and a page may be missing.
#[cfg(feature = "command-line")]
pub(crate) fn is_report(folder: &Path) -> bool {
    let mut files = NEWEST.iter().filter(|name| !name.ends_with(".html"));
    files.all(|name| folder.join(name).is_file())
}

/// The report of a folder, if it is there.
///
/// * `folder`: as seen from the other report's.
fn report_in(place: &Path, folder: &'static str, tier: Tier) -> Option<SeeAlso> {
    let has = |file: &str| place.join(file).is_file();
    has(README).then(|| SeeAlso {
        tier: tier.name(),
        folder,
        has_page: has("index.html"),
    })
}
