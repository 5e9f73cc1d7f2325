//! Verification, without command line and terminal: run, judge, compare with the baseline, bless,
//! write the report.

mod destination;
mod folder;
mod rebuilt;

use std::fs::File;
use std::io;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread;

use glob::Pattern;
use thiserror::Error;

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::{Findings, NEWEST};
use crate::run::{self, Effort, Finished, Progress, RunError};
use crate::store::{
    Baseline, Change, Provenance, Record, Refusal, Works, atomic, diagnosis::diagnose, json,
    write_json,
};
use crate::study::{Header, Study, Tier};
use crate::text::names::quoted;

#[cfg(feature = "command-line")]
pub(crate) use destination::folder_of_figures;
#[cfg(feature = "command-line")]
pub(crate) use folder::reports_around;
pub use rebuilt::{publish, report};
pub(crate) use rebuilt::{rebuild, record};

use destination::{Destination, scopes, tiers};
use folder::{lock_file, lock_reports, unwritable};

/// Which studies to run. This decides where the report goes: a report on a selection never replaces
/// one on a tier.
///
/// | scope | reports |
/// | --- | --- |
/// | the quick tier | `reports/`; if it does not pass, `reports/local/quick/` |
/// | the full tier | `reports/full/`; if it does not pass, `reports/local/full/` |
/// | a selection | `reports/local/partial/` |
///
/// Git ignores `reports/local/`: a run that does not pass leaves the committed report as it is. The
/// files in `reports/` that git ignores and other programs read, such as `junit.xml` ([`NEWEST`]),
/// are always those of the newest run: while it is under way, and after it has been killed, there
/// are none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scope {
    /// All studies of a tier; the headers of all existing studies, whatever their tier: the claims
    /// of all are compared.
    Tier(Tier, Vec<Header>),
    /// Some studies, as named on the command line.
    Selection(Vec<String>),
}

impl Scope {
    /// The name in records.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Tier(tier, _) => tier.name(),
            Self::Selection(_) => "selection",
        }
    }

    /// The command of a project that runs it.
    pub fn command(&self, project: &Project) -> String {
        let verify = format!("{} verify", project.command);
        match self {
            Self::Tier(Tier::Quick, _) => verify,
            Self::Tier(Tier::Full, _) => verify + " --tier full",
            Self::Selection(asked) => {
                let words = asked.iter().map(|word| quoted(word)).collect::<Vec<_>>();
                format!("{verify} {}", words.join(" "))
            }
        }
    }

    /// The headers of all existing studies, if a whole tier is run.
    pub fn known(&self) -> Option<&[Header]> {
        match self {
            Self::Tier(_, known) => Some(known),
            Self::Selection(_) => None,
        }
    }
}

/// A verification to be done.
#[derive(Debug, Clone)]
pub struct Request {
    /// Which studies these are.
    pub scope: Scope,
    /// Threads and time.
    pub effort: Effort,
    /// Whether to accept the new numbers as baseline.
    pub bless: bool,
    /// Why claims have changed, for blessing them.
    pub reason: Option<String>,
    /// Names or patterns of the changes to accept; if empty, all. Needs a reason.
    pub only: Vec<String>,
    /// The project's folder, which contains `studies/baseline.json`.
    pub root: PathBuf,
    /// The folder of its reports, usually `reports/` in it.
    pub reports: PathBuf,
}

impl Request {
    /// All these studies, as those of a tier, on all processors; nothing is blessed.
    ///
    /// * `root`: the project's folder; the reports go to `reports/` in it.
    pub fn of_tier(tier: Tier, studies: &[Box<dyn Study>], root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        let headers = studies.iter().map(|study| study.header().clone()).collect();
        let jobs = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Self {
            scope: Scope::Tier(tier, headers),
            effort: jobs.into(),
            bless: false,
            reason: None,
            only: vec![],
            reports: root.join("reports"),
            root,
        }
    }

    /// The file of the baseline.
    pub fn baseline(&self) -> PathBuf {
        self.root.join("studies").join("baseline.json")
    }

    /// Waits for other processes that write the reports, and then blocks them; for a blessing first
    /// for those that write the baseline, whose lock is in the project, wherever the reports go.
    fn lock(&self) -> io::Result<[Option<File>; 2]> {
        let baseline = self
            .bless
            .then(|| lock_reports(&self.root.join("reports")))
            .transpose()?;
        // A second lock on the same file would wait for the first.
        let is_held = baseline.is_some() && self.is_one_lock();
        Ok([
            baseline,
            if is_held {
                None
            } else {
                Some(lock_reports(&self.reports)?)
            },
        ])
    }

    /// Whether baseline and reports have the same lock. One of them must be held: its file then
    /// exists.
    fn is_one_lock(&self) -> bool {
        let [baseline, reports] = [&self.root.join("reports"), &self.reports]
            .map(|folder| lock_file(folder).canonicalize().ok());
        baseline.is_some() && baseline == reports
    }
}

/// Whether the numbers and claims of a run have become the baseline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Blessing {
    /// That was not requested.
    NotAsked,
    /// They have.
    Taken,
    /// They have not, for this reason.
    Refused(Refusal),
}

impl Blessing {
    fn of(taken: Result<(), Refusal>) -> Self {
        taken.map_or_else(Self::Refused, |()| Self::Taken)
    }
}

/// The result of a verification.
#[derive(Debug)]
#[non_exhaustive]
pub struct Verification {
    /// The record of the run, with all digits and times: the studies in the order given; no changes
    /// after a blessing.
    pub record: Record,
    /// Whether the baseline was replaced.
    pub blessing: Blessing,
    /// The folder of the reports.
    pub reports: PathBuf,
}

/// Why there is no verification.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VerificationError {
    /// The studies cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The baseline cannot be used, or the reports cannot be written.
    #[error(transparent)]
    Files(#[from] io::Error),
    /// A pattern of [`Request::only`] that matches no change.
    #[error("--only: found `{pattern}`, which matches no change; expected one of {changes}{}", .some.iter().map(|id| format!(", `{id}`")).collect::<String>())]
    NoChange {
        /// The pattern.
        pattern: String,
        /// How many changes there are.
        changes: usize,
        /// The first of them.
        some: Vec<String>,
    },
}

/// Runs the studies and writes the reports, and the baseline if requested.
///
/// The page "Test in Rust" of the book has an example.
///
/// # Errors
/// [`VerificationError`]; an unreadable baseline and a folder that cannot be written are reported
/// before anything is run.
pub fn verify(
    project: &Project,
    studies: &[Box<dyn Study>],
    request: &Request,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Verification, VerificationError> {
    let baseline_file = request.baseline();
    Baseline::read(&baseline_file)?;
    let folder = &request.reports;
    tidy(request)?;
    // A folder that is not writable is reported before the run.
    atomic::prepare_folder(folder).map_err(unwritable(folder))?;
    let works = Works::read(&works_file(request))?;
    let newest = request.scope.report_folder(folder);
    if newest.has_any(&NEWEST) {
        locked(request, || newest.set_aside(&NEWEST))?;
    }
    let verification = run_and_write(project, studies, request, works, progress);
    if verification.is_err() {
        // The error of the run says more than one of putting back.
        let _ = locked(request, || newest.put_back(&NEWEST));
    }
    verification
}

/// The file of the work limits.
fn works_file(request: &Request) -> PathBuf {
    request.root.join("studies/work.json")
}

/// Changes files of the reports while no other process writes them.
fn locked(request: &Request, change: impl FnOnce() -> io::Result<()>) -> io::Result<()> {
    let _lock = request.lock()?;
    let _writing = atomic::begin_write();
    change().map_err(unwritable(&request.reports))
}

/// The part of [`verify`] behind the checks of its input.
fn run_and_write(
    project: &Project,
    studies: &[Box<dyn Study>],
    request: &Request,
    mut works: Works,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Verification, VerificationError> {
    let folder = &request.reports;
    let baseline_file = request.baseline();
    // Blessed runs may take longer than before.
    let allowed =
        |header: &Header, label: &str| works.allowed(header, label).filter(|_| !request.bless);
    let finished = run::run_within(studies, request.effort, &allowed, progress)?;

    let _lock = request.lock()?;
    // A request to end the process waits until everything is written.
    let _writing = atomic::begin_write();
    // Another run may have blessed in the meantime: the baseline is read again under the lock.
    let mut baseline = Baseline::read(&baseline_file)?;
    let blessing = bless(&mut baseline, &finished, request)?;
    let changes = baseline.compare(&finished, request.scope.known());
    let command = request.scope.command(project);
    let record = diagnosed(project, request, finished, &changes);
    // Everything is prepared before anything is written.
    let provenance = Provenance::collect(
        &request.root,
        command,
        request.effort.jobs.get(),
        &record.studies,
    );
    let committed = record.clone().committed();
    // A blessing of some changes, or of one tier, can leave others: the run then still fails.
    let passes = record.verdict == Verdict::Pass;
    let destination = Destination::new(&request.scope, folder, passes);
    let see_also = destination.see_also(&committed);
    let findings = Findings {
        project,
        record: &committed,
        see_also,
        provenance: Some(&provenance),
    };
    let files = findings.files().map_err(unwritable(folder))?;
    let provenance = json(&provenance).map_err(unwritable(folder))?;
    if blessing == Blessing::Taken {
        baseline.write(&baseline_file)?;
        works.take(&record.studies);
        if !works.is_empty() {
            write_json(&works_file(request), &works)?;
        }
    }
    destination
        .publish(files, &tiers(folder))
        .map_err(unwritable(folder))?;
    atomic::write(&folder.join("local").join("provenance.json"), provenance)
        .map_err(unwritable(folder))?;
    Ok(Verification {
        record,
        blessing,
        reports: destination.folder().to_owned(),
    })
}

/// The record of a run, with the diagnosis of one that does not pass.
fn diagnosed(
    project: &Project,
    request: &Request,
    finished: Vec<Finished>,
    changes: &[Change],
) -> Record {
    let command = request.scope.command(project);
    let verdict = verdict(&finished, changes);
    let name = request.scope.name();
    let mut record = Record::new(name, &command, verdict, Some(changes), finished);
    record.diagnosis = diagnose(project, &record.studies, changes);
    if let Some(diagnosis) = &mut record.diagnosis {
        diagnosis.add_repetition(project, changes);
    }
    record
}

/// Accepts all changes into the baseline, or those selected: all of them or none.
fn bless(
    baseline: &mut Baseline,
    finished: &[Finished],
    request: &Request,
) -> Result<Blessing, VerificationError> {
    let known = request.scope.known();
    let reason = request.reason.as_deref();
    if !request.bless {
        return Ok(Blessing::NotAsked);
    }
    if request.only.is_empty() {
        return Ok(Blessing::of(baseline.bless(finished, known, reason)));
    }
    let changes = baseline.compare(finished, known);
    let mut is_chosen = vec![false; changes.len()];
    for word in &request.only {
        let pattern = Pattern::new(word).ok();
        let matches =
            |id: &str| id == word || pattern.as_ref().is_some_and(|pattern| pattern.matches(id));
        let mut occurs = false;
        for (change, is_chosen) in changes.iter().zip(&mut is_chosen) {
            if matches(&change.id()) {
                *is_chosen = true;
                occurs = true;
            }
        }
        if !occurs {
            return Err(VerificationError::NoChange {
                pattern: word.clone(),
                changes: changes.len(),
                some: changes.iter().take(3).map(Change::id).collect(),
            });
        }
    }
    let mut new = baseline.clone();
    let chosen = changes.iter().zip(is_chosen).filter(|(_, chosen)| *chosen);
    for (change, _) in chosen {
        if let Err(refusal) = new.accept(finished, change, reason.unwrap_or_default()) {
            return Ok(Blessing::Refused(refusal));
        }
    }
    *baseline = new;
    Ok(Blessing::Taken)
}

/// Completes or removes what killed runs of any scope have left.
fn tidy(request: &Request) -> io::Result<()> {
    let reports = &request.reports;
    let local = reports.join("local");
    if !local.is_dir() {
        return Ok(());
    }
    locked(request, || remove_leftovers(request, &local))
}

/// Removes what runs that were killed have left.
fn remove_leftovers(request: &Request, local: &Path) -> io::Result<()> {
    // If the lock of the baseline is not held, another process may be writing it.
    if request.bless || request.is_one_lock() {
        atomic::remove_leftovers(&request.baseline())?;
    }
    atomic::remove_leftovers(&local.join("provenance.json"))?;
    // Left by a run that was killed while it tested the folder.
    atomic::remove_leftovers(&request.reports.join(atomic::PROBE))?;
    for scope in scopes() {
        scope.report_folder(&request.reports).tidy()?;
        if let Some(failing) = scope.failing_folder(&request.reports) {
            failing.tidy()?;
        }
    }
    Ok(())
}

/// The worst verdict of all studies; fail if the baseline differs.
fn verdict(finished: &[Finished], changes: &[Change]) -> Verdict {
    let own = Verdict::worst(finished.iter().map(|finished| finished.outcome.verdict));
    if changes.is_empty() {
        own
    } else {
        Verdict::Fail
    }
}
