//! Runs the cases of all studies on all threads; the one place that knows of threads.
//!
//! Parallel across cases only: a case is computed by one thread from start to end and the results are put back into the
//! order of the cases, so an [`Outcome`] has the same bits for any number of threads. What varies from run to run, the
//! time, is kept apart in [`Spent`].

mod caught;
mod levels;
mod queue;
pub mod time_limit;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

use crate::judge::verdict::Verdict;
use crate::study::kind::plan;
use crate::study::outcome::NotFinite;
use crate::study::soundness;
use crate::study::{Case, CaseFailure, Check, Header, Kind, Outcome, Plan, Study, Untested};
use caught::caught;
use queue::{Counter, Done, Job};

pub use levels::assert_order;
pub use queue::Progress;

/// A study that has been run: one object of a record.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Finished {
    /// Its id, claim, tier and kind.
    #[serde(flatten)]
    pub header: Header,
    /// What it found.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Cases without a result, in the order of the cases.
    pub failed_cases: Vec<FailedCase>,
    /// The meaning of every `null` that stands for a number.
    pub not_finite: Vec<NotFinite>,
    /// What the study is no test of although it passes; only `study` looks for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untested: Vec<Untested>,
    /// The time that it took, which differs from run to run.
    #[serde(skip)]
    pub spent: Spent,
}

/// A case without a result.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FailedCase {
    /// Its label.
    #[serde(rename = "case")]
    pub label: String,
    /// Why, in words.
    pub reason: String,
}

/// Time spent on a study.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spent {
    /// Sum over its cases, on whatever thread, and over judging their results.
    pub busy: Duration,
    /// From the start of its first case to the end of its last one.
    pub wall: Duration,
    /// The number of its cases.
    pub cases: usize,
    /// How many of them were not computed: their results are those of an earlier run.
    pub kept: usize,
}

/// Why nothing was run.
#[derive(Debug, Error)]
pub enum RunError {
    /// Two studies have the same id, by which baseline and report tell studies apart.
    #[error("found two studies with the id `{0}`; expected an id of its own for each study")]
    DuplicateId(String),
    /// The operating system refuses the threads.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
}

/// Limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Number of threads; at most one for each case is started.
    pub jobs: NonZeroUsize,
    /// The longest time that a case may take; `None` for no limit.
    pub case_limit: Option<Duration>,
}

impl From<NonZeroUsize> for Effort {
    fn from(jobs: NonZeroUsize) -> Self {
        Self { jobs, case_limit: None }
    }
}

/// Runs all studies, costliest cases first, and judges them.
///
/// * `effort`: threads and time, or the number of threads alone.
/// * `progress`: called after every case, by one thread at a time.
/// * Returns the studies in the order in which they were given.
///
/// A case that fails or panics becomes an `Err` for its study to judge and stops nothing else. A study that panics
/// while listing its cases or judging them fails; so does one of which a case was stopped at its limit.
///
/// # Errors
/// [`RunError`], before anything was run.
pub fn run(
    studies: &[Box<dyn Study>],
    effort: impl Into<Effort>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, RunError> {
    refuse_duplicates(studies)?;
    let planned = studies.iter().map(|study| Planned::new(study.header(), || study.plan()));
    run_planned(planned.collect(), effort.into(), progress)
}

/// Runs one study on all threads of the machine, as [`run`] does.
///
/// # Panics
/// The operating system refuses the threads.
pub fn run_one<K: Kind>(study: &K) -> Finished {
    let planned = vec![Planned::new(study.header(), || plan(study))];
    let finished = run_planned(planned, available().into(), &|_| {}).map(|mut finished| finished.pop());
    finished.expect("the threads are refused").expect("a study that was run")
}

/// As many threads as the machine has processors.
pub fn available() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

fn run_planned(
    planned: Vec<Planned<'_>>,
    Effort { jobs, case_limit }: Effort,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, RunError> {
    let cases: usize = planned.iter().map(|planned| planned.cases.len()).sum();
    // Threads without a case would only be started and ended.
    let pool = ThreadPoolBuilder::new().num_threads(jobs.get().min(cases.max(1))).build()?;
    let done = run_cases(&pool, &planned, case_limit, progress);
    // Figures are drawn here, which takes its time too.
    Ok(pool.install(|| planned.into_par_iter().zip(done).map(|(planned, done)| conclude(planned, &done)).collect()))
}

/// A study and its plan, or the message of the panic that listing its cases ended in.
struct Planned<'s> {
    header: &'s Header,
    plan: Result<Box<dyn Plan + 's>, String>,
    cases: Vec<Case<()>>,
}

impl<'s> Planned<'s> {
    fn new(header: &'s Header, plan: impl FnOnce() -> Box<dyn Plan + 's>) -> Self {
        let listed = caught(|| {
            let plan = plan();
            let cases = plan.cases();
            (plan, cases)
        });
        let (plan, cases) = match listed {
            Ok((plan, cases)) => (Ok(plan), cases),
            Err(reason) => (Err(reason), vec![]),
        };
        Self { header, plan, cases }
    }
}

fn refuse_duplicates(studies: &[Box<dyn Study>]) -> Result<(), RunError> {
    let mut ids: Vec<&str> = studies.iter().map(|study| study.header().id.as_str()).collect();
    ids.sort_unstable();
    match ids.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(RunError::DuplicateId(pair[0].to_owned())),
        None => Ok(()),
    }
}

/// Runs all cases; what was measured of each, for each study in the order of its cases.
fn run_cases(
    pool: &ThreadPool,
    planned: &[Planned<'_>],
    limit: Option<Duration>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Vec<Vec<Done>> {
    let jobs = queue::costliest_first(planned.iter().map(|planned| planned.cases.as_slice()));
    let counter = Counter::new(&jobs, progress);
    let run = |job: Job| {
        let mut done = vec![run_case(&planned[job.study], limit, job)];
        let is_last = counter.leave(&job);
        if let (true, Ok(plan)) = (is_last, &planned[job.study].plan) {
            // A study that asks for more cases gets them one after the other, on this thread.
            while let Some(case) = caught(|| plan.more()).unwrap_or_else(|reason| {
                plan.fail(job.case, CaseFailure { reason });
                None
            }) {
                done.push(run_case(&planned[job.study], limit, Job { case, ..job }));
            }
        }
        counter.count(&job, is_last);
        done
    };
    // A parallel iterator over the vector would cut it in halves; the bridge hands out one job after the other.
    let done: Vec<Done> = pool.install(|| jobs.into_iter().par_bridge().flat_map_iter(run).collect());
    queue::in_order(done, planned.len())
}

/// Runs one case, within the limit of its time.
fn run_case(planned: &Planned<'_>, limit: Option<Duration>, job: Job) -> Done {
    job.time(|| {
        let Ok(plan) = &planned.plan else { return };
        let (ended, up) = time_limit::within(limit, || caught(|| plan.run(job.case)));
        if let Err(reason) = ended {
            plan.fail(job.case, CaseFailure { reason });
        }
        // A case that was stopped has no result, even if it returned one.
        if let Some(up) = up {
            plan.fail(job.case, up.into());
        }
    })
}

/// The outcome of one study from the results of its cases.
fn conclude(Planned { header, plan, .. }: Planned<'_>, done: &[Done]) -> Finished {
    let mut spent = queue::spent(done);
    let started = Instant::now();
    let mut failed_cases = vec![];
    let mut outcome = match plan {
        Ok(plan) => {
            let cases = plan.cases();
            let failed = cases.iter().enumerate().filter_map(|(i, case)| {
                Some(FailedCase { label: case.label.clone(), reason: plan.failure(i)?.reason })
            });
            failed_cases.extend(failed);
            spent.kept = (0..cases.len()).filter(|case| plan.is_kept(*case)).count();
            caught(|| plan.judge()).unwrap_or_else(|reason| broken("judge its results", &reason))
        }
        Err(reason) => broken("list its cases", &reason),
    };
    spent.busy += started.elapsed();
    // Whatever the study makes of it: a failed case cannot pass.
    if outcome.verdict == Verdict::Pass && !failed_cases.is_empty() {
        outcome.checks.push(Check::that(false, "every case has a result", format!("{} have none", failed_cases.len())));
    }
    let outcome = soundness::settle(&header.id, outcome);
    let not_finite = outcome.not_finite();
    Finished { header: header.clone(), outcome, failed_cases, not_finite, untested: vec![], spent }
}

fn broken(what: &str, reason: &str) -> Outcome {
    let claim = format!("the study can {what}");
    Outcome::new(format!("the study cannot {what}: {reason}"), vec![], vec![Check::that(false, claim, reason)])
}
