//! Verification, without command line and terminal: run, judge, compare with the baseline, bless,
//! write the report.

mod rebuilt;
mod reports;
mod test_run;

use std::fs::File;
use std::io;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::thread;

use thiserror::Error;

use crate::project::Project;
use crate::report::Findings;
use crate::run::{self, Effort, Finished, Progress, RunError};
use crate::store::{
    Baseline, BlessingRefusal, GuardedChange, Provenance, Record, Works, atomic, atomic::Prepared,
    diagnosis::diagnose, json_beside, lock, verdict_of,
};
use crate::study::{Header, Study, Tier};
use crate::text::names::quoted;

pub(crate) use rebuilt::{publish, rebuild, record};
pub use test_run::TestRun;

pub(crate) use reports::Reports;
#[cfg(feature = "command-line")]
pub(crate) use reports::is_report;

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
/// files in `reports/` that git ignores and other programs read, such as `junit.xml`,
/// are always those of the newest run: while it is under way, and after it has been killed, there
/// are none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Scope {
    /// All studies of a tier; the headers of all existing studies, whatever their tier, with their
    /// cases: the settings of all are compared.
    Tier(Tier, Vec<Header>),
    /// Some studies, as named on the command line.
    Selection(Vec<String>),
}

impl Scope {
    /// The command of a project that runs it.
    pub(crate) fn command(&self, project: &Project) -> String {
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

    /// The headers of all existing studies, unless some were named.
    pub(crate) fn known(&self) -> Option<&[Header]> {
        match self {
            Self::Tier(_, known) => Some(known),
            Self::Selection(_) => None,
        }
    }
}

/// A verification to be done.
#[derive(Debug, Clone)]
pub struct VerifyRequest {
    /// Which studies these are.
    pub(crate) scope: Scope,
    /// Threads and time.
    pub(crate) effort: Effort,
    /// Whether to accept the new numbers as baseline.
    pub bless: bool,
    /// Whether a blessing accepts also what is loosened, changed in its settings, or gone.
    pub loosened: bool,
    /// The project's folder, which contains `studies/baseline.json`.
    pub root: PathBuf,
    /// The folder of its reports, usually `reports/` in it.
    pub reports: PathBuf,
}

impl VerifyRequest {
    /// All these studies, as those of a tier, on all processors; nothing is blessed.
    ///
    /// * `root`: the project's folder; the reports go to `reports/` in it.
    pub fn of_tier(tier: Tier, studies: &[Box<dyn Study>], root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        let headers = studies.iter().map(|study| run::listed(study.as_ref()));
        let jobs = thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        Self {
            scope: Scope::Tier(tier, headers.collect()),
            effort: jobs.into(),
            bless: false,
            loosened: false,
            reports: root.join("reports"),
            root,
        }
    }

    /// The tier that is run whole; `None` if studies may be missing.
    pub(crate) fn tier(&self) -> Option<Tier> {
        match self.scope {
            Scope::Tier(tier, _) if !self.effort.fail_fast => Some(tier),
            _ => None,
        }
    }

    /// The name of the scope in records.
    fn scope_name(&self) -> &'static str {
        self.tier().map_or("selection", Tier::name)
    }

    /// The file of the baseline.
    pub fn baseline(&self) -> PathBuf {
        self.root.join("studies").join("baseline.json")
    }

    /// The file of the work limits.
    fn works(&self) -> PathBuf {
        self.root.join("studies").join("work.json")
    }

    /// Whether other processes must not write the baseline meanwhile. A run that leaves the project
    /// as it is, and writes its reports elsewhere, needs no place for a lock there.
    fn owns_baseline(&self) -> bool {
        self.bless || self.reports == self.root.join("reports")
    }

    /// Waits for other processes that write the reports, and then blocks them; first for those that
    /// write the baseline, whose lock is in the project, wherever the reports go.
    fn lock(&self, reports: &Reports) -> io::Result<[Option<File>; 2]> {
        let path = self.root.join("reports/local/baseline-lock");
        let baseline = self.owns_baseline();
        let baseline = baseline.then(|| lock(&path).map_err(atomic::naming(&path)));
        Ok([baseline.transpose()?, Some(reports.lock()?)])
    }
}

/// Whether the numbers and claims of a run have become the baseline.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Blessing {
    /// That was not requested.
    NotAsked,
    /// They have, and with them these changes by which less is guarded.
    Taken(Vec<GuardedChange>),
    /// They have not, for this reason.
    Refused(BlessingRefusal),
}

impl Blessing {
    /// An error that came after it, which says what it has left.
    pub(crate) fn added_to(&self, error: io::Error) -> io::Error {
        match self {
            Self::Taken(_) => after_blessing(error),
            Self::NotAsked | Self::Refused(_) => error,
        }
    }
}

/// The error of a run whose baseline is in its place.
fn after_blessing(error: io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("{error}; the baseline is blessed all the same"),
    )
}

/// The result of a verification.
#[derive(Debug)]
#[non_exhaustive]
pub struct Verification {
    /// The record of the run, with all digits and times: the studies in the order given; no changes
    /// after a blessing.
    pub record: Record,
    /// Whether the baseline was replaced.
    pub(crate) blessing: Blessing,
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
}

impl Project {
    /// Runs the studies and writes the reports, and the baseline if requested.
    ///
    /// The page "Test in Rust" of the book has an example.
    ///
    /// # Errors
    /// [`VerificationError`]; an unreadable baseline and a folder that cannot be written are
    /// reported before anything is run.
    pub fn verify(
        &self,
        studies: &[Box<dyn Study>],
        request: &VerifyRequest,
        progress: &(dyn Fn(Progress) + Sync),
    ) -> Result<Verification, VerificationError> {
        let begun = request.begin(studies)?;
        let allowed = |header: &_, label: &_| begun.allowed(header, label);
        let finished = run::run_within(studies, request.effort, &allowed, progress)?;
        Ok(begun.write(self, finished)?)
    }
}

/// A verification whose studies are to be run.
#[derive(Debug)]
pub(crate) struct Begun<'r> {
    request: &'r VerifyRequest,
    reports: Reports,
    works: Works,
}

impl VerifyRequest {
    /// Reads what the run is compared with, and makes room for its reports.
    ///
    /// # Errors
    /// An unreadable baseline, and a folder that cannot be written.
    pub(crate) fn begin(&self, studies: &[Box<dyn Study>]) -> io::Result<Begun<'_>> {
        Baseline::read(&self.baseline())?;
        let works = Works::read(&self.works())?;
        let reports = Reports::of(&self.reports, self.scope_name());
        reports.prepare()?;
        self.clear(&reports)?;
        for study in studies {
            study.keep_answers(&reports.answers(&study.header().id), !self.bless);
        }
        Ok(Begun {
            request: self,
            reports,
            works,
        })
    }

    /// Removes what killed runs have left, and what an older run has found.
    fn clear(&self, reports: &Reports) -> io::Result<()> {
        // A lock would be a file of a run that is interrupted and writes nothing.
        if !self.bless && !reports.is_used() {
            return Ok(());
        }
        let _lock = self.lock(reports)?;
        if self.owns_baseline() {
            atomic::remove_unfinished(&self.root.join("studies"))?;
        }
        reports.begin()
    }

    /// Accepts the run into the baseline, if that is requested.
    fn accept(&self, baseline: &mut Baseline, finished: &[Finished]) -> Blessing {
        if !self.bless {
            return Blessing::NotAsked;
        }
        match baseline.bless(finished, self.scope.known(), self.loosened) {
            Ok(loosened) => Blessing::Taken(loosened),
            Err(refusal) => Blessing::Refused(refusal),
        }
    }
}

impl Begun<'_> {
    /// The most work that a case may do; blessed runs may take longer than before.
    pub(crate) fn allowed(&self, header: &Header, label: &str) -> Option<u64> {
        let allowed = self.works.allowed(header, label);
        allowed.filter(|_| !self.request.bless)
    }

    /// Compares with the baseline, and writes what has been found.
    ///
    /// # Errors
    /// The error of the operating system, with the file or the folder.
    pub(crate) fn write(
        self,
        project: &Project,
        finished: Vec<Finished>,
    ) -> io::Result<Verification> {
        let Self {
            request,
            reports,
            mut works,
        } = self;
        let _lock = request.lock(&reports)?;
        // A request to end the process waits until everything is written.
        let _writing = atomic::begin_write();
        // Another run may have blessed in the meantime: the baseline is read again under the lock.
        let mut baseline = Baseline::read(&request.baseline())?;
        let blessing = request.accept(&mut baseline, &finished);
        let scope = &request.scope;
        // A blessing of one tier can leave changes of another: the run then still fails.
        let changes = baseline.compare(&finished, scope.known());
        let record = judged(
            request.scope_name(),
            &scope.command(project),
            finished,
            Some(&changes),
        );
        // Everything is prepared before anything is written.
        let mut origin = Provenance::collect(&request.root, &record, request.effort.jobs.get());
        let committed = record.clone().committed();
        let files = reports.files(Findings {
            provenance: Some(&origin),
            ..Findings::of(project, &committed)
        })?;
        let report = reports.beside(&files, record.verdict)?;
        // A file that cannot be read is written anew.
        origin.keep(Provenance::read(&reports.provenance()).unwrap_or_default());
        let origin = json_beside(&reports.provenance(), &origin)?;
        // A full disk has now refused what it holds no more, and nothing is blessed.
        if matches!(blessing, Blessing::Taken(_)) {
            works.take(&record.studies);
            let works = (!works.is_empty()).then(|| json_beside(&request.works(), &works));
            let works = works.transpose()?;
            baseline.write(&request.baseline())?;
            works
                .map_or(Ok(()), Prepared::place)
                .map_err(|error| blessing.added_to(error))?;
        }
        let placed = report.place().and_then(|()| origin.place());
        placed.map_err(|error| blessing.added_to(error))?;
        Ok(Verification {
            reports: reports.folder(record.verdict).to_owned(),
            record,
            blessing,
        })
    }
}

/// The record of a run, with a diagnosis unless it is a pass.
fn judged(
    scope: &str,
    command: &str,
    finished: Vec<Finished>,
    changes: Option<&[GuardedChange]>,
) -> Record {
    let moves = changes.unwrap_or_default();
    let verdict = verdict_of(&finished, moves);
    Record {
        diagnosis: diagnose(&finished, moves),
        ..Record::new(scope, command, verdict, changes, finished)
    }
}
