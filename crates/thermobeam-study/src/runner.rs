//! Runs the cases of all studies on all threads; the one place that knows of threads.
//!
//! Parallel across cases only: a case is computed by one thread from start to end and the results are put back into the
//! order of the cases, so an [`Outcome`] has the same bits for any number of threads. What varies from run to run, the
//! time, is kept apart in [`Spent`].

mod caught;
mod queue;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::time::Duration;
use thiserror::Error;

use crate::case::{Case, CaseFailure, Measured};
use crate::contract;
use crate::outcome::{Check, Outcome};
use crate::study::Study;
use crate::study_file::StudyHeader;
use caught::caught;
use queue::{Counter, Done, Job};

pub use queue::Progress;

/// A study that has been run.
#[derive(Debug, Clone)]
pub struct Finished {
    /// Its id, claim, tier and kind.
    pub header: StudyHeader,
    /// What it found.
    pub outcome: Outcome,
    /// Cases without a result, in the order of the cases.
    pub failed_cases: Vec<FailedCase>,
    /// What it cost, which is different each time.
    pub spent: Spent,
}

/// A case that did not come to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedCase {
    /// Its label.
    pub label: String,
    /// Why, in words.
    pub reason: String,
}

/// Time spent on a study.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spent {
    /// Added up over its cases, whichever thread ran them, and its conclusion.
    pub busy: Duration,
    /// From the start of its first case to the end of its last one.
    pub wall: Duration,
}

/// Why nothing was run.
#[derive(Debug, Error)]
pub enum RunError {
    /// Two studies of one name: what is said about one would be taken for the other.
    #[error("two studies have the id `{0}`; allowed is an id for each study of its own")]
    DuplicateId(String),
    /// The operating system refuses the threads.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
}

/// What a run may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Number of threads; no more than there are cases are started.
    pub jobs: NonZeroUsize,
    /// The longest that a case may take; `None` for as long as it takes.
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
    let Effort { jobs, case_limit } = effort.into();
    refuse_duplicates(studies)?;
    let plans: Vec<Plan> = studies.iter().map(|study| caught(|| study.cases())).collect();
    let cases: usize = plans.iter().flatten().map(Vec::len).sum();
    // Threads without a case would only be started and ended.
    let pool = ThreadPoolBuilder::new().num_threads(jobs.get().min(cases.max(1))).build()?;
    let results = run_cases(&pool, studies, &plans, case_limit, progress);
    let planned = studies.par_iter().zip(&plans).zip(results);
    // Figures are drawn here, which takes its time too.
    Ok(pool.install(|| planned.map(|((study, plan), done)| conclude(study.as_ref(), plan, done)).collect()))
}

/// The cases of a study, or why it panicked over listing them.
type Plan = Result<Vec<Case>, String>;

fn refuse_duplicates(studies: &[Box<dyn Study>]) -> Result<(), RunError> {
    let mut ids: Vec<&str> = studies.iter().map(|study| study.header().id.as_str()).collect();
    ids.sort_unstable();
    match ids.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(RunError::DuplicateId(pair[0].to_owned())),
        None => Ok(()),
    }
}

/// Results of all cases: for each study, in the order of its cases.
fn run_cases(
    pool: &ThreadPool,
    studies: &[Box<dyn Study>],
    plans: &[Plan],
    limit: Option<Duration>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Vec<Vec<Done>> {
    let jobs = queue::costliest_first(plans.iter().map(|plan| plan.as_deref().unwrap_or(&[])));
    let counter = Counter::new(&jobs, progress);
    let run = |job: Job| {
        let study = &studies[job.study];
        let done = job.time(limit, || match caught(|| study.run(job.case)) {
            Ok(result) => result,
            Err(reason) => Err(CaseFailure { reason }),
        });
        counter.count(&job);
        done
    };
    // A parallel iterator over the vector would cut it in halves; the bridge hands out one job after the other.
    let done: Vec<Done> = pool.install(|| jobs.into_iter().par_bridge().map(run).collect());
    queue::in_order(done, studies.len())
}

/// The outcome of one study from the results of its cases.
fn conclude(study: &dyn Study, plan: &Plan, done: Vec<Done>) -> Finished {
    let header = study.header().clone();
    let mut spent = queue::spent(&done);
    let stopped: Vec<bool> = done.iter().map(|done| done.is_stopped).collect();
    let results: Vec<Result<Measured, CaseFailure>> = done.into_iter().map(|done| done.result).collect();
    let started = std::time::Instant::now();
    let mut outcome = match plan {
        Ok(_) => caught(|| study.conclude(&results)).unwrap_or_else(|reason| broken("judge its results", &reason)),
        Err(reason) => broken("list its cases", reason),
    };
    spent.busy += started.elapsed();
    let cases = plan.as_deref().unwrap_or(&[]);
    for ((case, result), _) in cases.iter().zip(&results).zip(&stopped).filter(|(_, stopped)| **stopped) {
        let reason = result.as_ref().err().map_or("", |failure| &failure.reason);
        outcome.checks.push(Check::that(false, format!("{} ends within the limit", case.label), reason));
    }
    let failed_cases = cases.iter().zip(&results).filter_map(|(case, result)| match result {
        Ok(_) => None,
        Err(failure) => Some(FailedCase { label: case.label.clone(), reason: failure.reason.clone() }),
    });
    Finished { outcome: contract::settle(&header.id, outcome), failed_cases: failed_cases.collect(), header, spent }
}

fn broken(what: &str, reason: &str) -> Outcome {
    let claim = format!("the study can {what}");
    Outcome::new(format!("the study cannot {what}: {reason}"), vec![], vec![Check::that(false, claim, reason)])
}
