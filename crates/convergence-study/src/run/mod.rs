//! Runs the cases of all studies on all threads; only this module uses threads.
//!
//! Parallel across cases only: one thread computes a case from start to end, and the results are
//! put back into the order of the cases, so an [`Outcome`] has the same bits for any number of
//! threads. The time varies from run to run and is kept separately in [`Spent`].

mod failures;
mod json;
mod levels;
mod queue;
mod where_lost;

use rayon::prelude::*;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

use crate::study::erased::plan;
use crate::study::kind::reasons;
use crate::study::outcome::{self, NotFinite};
use crate::study::{
    Case, CaseFailure, Check, Header, Kind, Outcome, Plan, Study, Subject, Untested, catch,
};
use convergence_judge::verdict::Verdict;
use queue::{Counter, Done};

pub(crate) use convergence_judge::time_limit;
pub(crate) use failures::{Item, advice, items, items_not_passed, not_passed};
pub use levels::assert_order;
pub use queue::Progress;
pub use where_lost::WhereLost;
pub(crate) use where_lost::{Fate, VariantRate, VariantRates};

/// A study that has been run: one object of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
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
    /// What the study fails to test although it passes; only `study` searches for it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untested: Vec<Untested>,
    /// Where its order is lost; only `--where` searches for it.
    #[serde(rename = "where", default, skip_serializing_if = "Option::is_none")]
    pub where_lost: Option<WhereLost>,
    /// The time taken, which differs from run to run.
    #[serde(skip)]
    pub spent: Spent,
    /// The work that each case has counted, by its label: the same at every run, and not guarded.
    #[serde(skip)]
    pub work: Vec<(String, u64)>,
}

/// A case without a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Sum over its cases, on all threads, and over judging their results.
    pub busy: Duration,
    /// From the start of its first case to the end of its last one.
    pub wall: Duration,
    /// The number of its cases.
    pub cases: usize,
}

/// Why nothing was run.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// Two studies have the same id, which baseline and report need to be unique.
    #[error("found two studies with the id `{0}`; expected an id of its own for each study")]
    DuplicateId(String),
    /// The operating system refuses the threads.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
}

/// Limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Effort {
    /// Number of threads; at most one for each case is started.
    pub jobs: NonZeroUsize,
    /// The time limit of each case; `None` for none.
    pub time_limit: Option<Duration>,
    /// Whether no case begins after a study has failed: studies that had not ended are then left
    /// out.
    pub fail_fast: bool,
}

/// The work limit of a case, by its study and its label; `None` for none.
pub(crate) type Allowed<'a> = &'a (dyn Fn(&Header, &str) -> Option<u64> + Sync);

impl From<NonZeroUsize> for Effort {
    fn from(jobs: NonZeroUsize) -> Self {
        Self {
            jobs,
            time_limit: None,
            fail_fast: false,
        }
    }
}

/// Runs all studies, costliest cases first, and judges them.
///
/// * `effort`: threads and time, or the number of threads alone.
/// * `progress`: called after every case, by one thread at a time.
/// * Returns the studies in the order given.
///
/// A case that fails or panics becomes an `Err` for its study to judge and stops nothing else. A
/// study fails if it panics while listing its cases or judging them, or if one of its cases was
/// stopped at its limit.
///
/// # Errors
/// [`RunError`], before anything is run.
pub(crate) fn run(
    studies: &[Box<dyn Study + '_>],
    effort: impl Into<Effort>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, RunError> {
    run_within(studies, effort.into(), &|_, _| None, progress)
}

/// The same with a work limit of each case: a case that exceeds it fails.
pub(crate) fn run_within(
    studies: &[Box<dyn Study + '_>],
    effort: Effort,
    allowed: Allowed<'_>,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, RunError> {
    refuse_duplicates(studies)?;
    let limits = Limits {
        time: effort.time_limit,
        work: allowed,
    };
    let planned = studies
        .iter()
        .map(|study| Planned::new(study.header(), limits, || study.plan()));
    run_planned(planned.collect(), effort, progress)
}

/// The header of a study with the cases that it lists; with none if it panics.
pub(crate) fn listed(study: &(dyn Study + '_)) -> Header {
    let cases = catch(|| study.plan().cases()).unwrap_or_default();
    with_cases(study.header(), &cases)
}

fn with_cases(header: &Header, cases: &[Case<()>]) -> Header {
    Header {
        cases: cases.to_vec(),
        ..header.clone()
    }
}

/// The outcome of one study, run on all threads of the machine; its figures are
/// called `study-<what>.svg`.
///
/// # Panics
/// The operating system refuses the threads.
pub fn run_one<K: Kind>(kind: &K) -> Outcome {
    run_kind(&Header::new("study", ""), kind).outcome
}

fn run_kind<K: Kind>(header: &Header, kind: &K) -> Finished {
    let limits = Limits {
        time: None,
        work: &|_, _| None,
    };
    let planned = vec![Planned::new(header, limits, || plan(kind))];
    let finished = run_planned(planned, available().into(), &|_| {});
    let finished = finished.map(|mut finished| finished.pop());
    finished
        .expect("the threads are refused")
        .expect("a study that was run")
}

/// As many threads as the machine has processors.
pub(crate) fn available() -> NonZeroUsize {
    thread::available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

fn refuse_duplicates(studies: &[Box<dyn Study + '_>]) -> Result<(), RunError> {
    let mut ids = HashSet::new();
    let mut all = studies.iter().map(|study| &study.header().id);
    match all.find(|id| !ids.insert(*id)) {
        Some(id) => Err(RunError::DuplicateId(id.clone())),
        None => Ok(()),
    }
}

/// Runs all cases. A study is judged, and its figures are drawn, once its last case has ended.
fn run_planned(
    planned: Vec<Planned<'_>>,
    effort: Effort,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Finished>, RunError> {
    let jobs = queue::costliest_first(planned.iter().map(|planned| planned.cases.as_slice()));
    // Threads without a case would only be started and ended.
    let pool = ThreadPoolBuilder::new()
        .num_threads(effort.jobs.get().min(jobs.len().max(1)))
        .build()?;
    let counter = Counter::new(&jobs, progress);
    let is_stopped = AtomicBool::new(false);
    // A parallel iterator over the vector would split it in halves; the bridge hands out one job
    // after the other.
    pool.install(|| {
        jobs.into_iter().par_bridge().for_each(|job| {
            if is_stopped.load(Ordering::Relaxed) {
                return;
            }
            counter.enter(&job);
            let verdict = planned[job.study].run(job.case);
            if effort.fail_fast && verdict == Some(Verdict::Fail) {
                is_stopped.store(true, Ordering::Relaxed);
            }
            counter.count(&job, verdict);
        });
    });
    let mut finished = vec![];
    for planned in planned {
        // A study without cases ends here. With `fail_fast` other studies may not have ended: they
        // are left out.
        if planned.cases.is_empty() {
            finished.push(planned.conclude(&mut []));
        } else {
            finished.extend(planned.finished.into_inner());
        }
    }
    Ok(finished)
}

/// The limits of each case.
#[derive(Clone, Copy)]
struct Limits<'s> {
    time: Option<Duration>,
    work: Allowed<'s>,
}

/// A study and its plan, or the message of the panic while listing its cases.
struct Planned<'s> {
    header: &'s Header,
    limits: Limits<'s>,
    plan: Result<Box<dyn Plan + 's>, String>,
    cases: Vec<Case<()>>,
    /// Its cases that have ended.
    done: Mutex<Vec<Done>>,
    /// What it found, once its last case has ended.
    finished: OnceLock<Finished>,
}

impl<'s> Planned<'s> {
    fn new(
        header: &'s Header,
        limits: Limits<'s>,
        plan: impl FnOnce() -> Box<dyn Plan + 's>,
    ) -> Self {
        let plan_and_cases = catch(|| {
            let plan = plan();
            let cases = plan.cases();
            (plan, cases)
        });
        let (plan, cases) = match plan_and_cases {
            Ok((plan, cases)) => (Ok(plan), cases),
            Err(reason) => (Err(reason), vec![]),
        };
        Self {
            header,
            limits,
            plan,
            cases,
            done: Mutex::default(),
            finished: OnceLock::new(),
        }
    }

    /// Runs a case. If it was the last, further cases that the study requests run one after the
    /// other, on this thread, and the study is judged; then the verdict is returned.
    fn run(&self, case: usize) -> Option<Verdict> {
        let case_done = self.run_case(case);
        let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.push(case_done);
        if done.len() < self.cases.len() {
            return None;
        }
        while let Some(next) = self.next_case(case) {
            done.push(self.run_case(next));
        }
        // It is set once, by the last case of the study.
        let finished = self.finished.get_or_init(|| self.conclude(&mut done));
        Some(finished.outcome.verdict)
    }

    /// The number of another case that the study requests, if it does. If it panics, the case
    /// before fails.
    fn next_case(&self, before: usize) -> Option<usize> {
        let plan = self.plan.as_ref().ok()?;
        catch(|| plan.more()).unwrap_or_else(|reason| {
            plan.fail(before, CaseFailure::new(reason));
            None
        })
    }

    /// Runs a case within its limits.
    fn run_case(&self, case: usize) -> Done {
        Done::of(case, || {
            let Ok(plan) = &self.plan else { return 0 };
            let label = |cases: &[Case<()>]| cases.get(case).map(|case| case.label.clone());
            // The plan alone knows cases that were requested later.
            let label = label(&self.cases).or_else(|| label(&plan.cases()));
            let most = (self.limits.work)(self.header, &label.unwrap_or_default());
            let ((result, stopped), work) = time_limit::counted(most, || {
                time_limit::within(self.limits.time, || catch(|| plan.run(case)))
            });
            if let Err(reason) = result {
                plan.fail(case, CaseFailure::new(reason));
            }
            // A case that was stopped has no result, even if it returned one.
            if let Some(limit) = stopped {
                plan.fail(case, limit.into());
            }
            work
        })
    }

    /// The outcome from the results of its cases, which end in any order.
    fn conclude(&self, done: &mut [Done]) -> Finished {
        done.sort_by_key(|done| done.case);
        let mut spent = queue::spent(done);
        let mut work = vec![];
        let started = Instant::now();
        let mut failed_cases = vec![];
        let mut outcome = match &self.plan {
            Ok(plan) => {
                let cases = plan.cases();
                let failures = cases
                    .iter()
                    .enumerate()
                    .filter_map(|(i, case)| Some((case, plan.failure(i)?)));
                let (failed, failures): (Vec<_>, Vec<_>) = failures.unzip();
                for (case, reason) in failed.into_iter().zip(reasons(failures)) {
                    let label = case.label.clone();
                    failed_cases.push(FailedCase { label, reason });
                }
                for done in done {
                    work.push((cases[done.case].label.clone(), done.work));
                }
                catch(|| plan.judge())
                    .unwrap_or_else(|reason| failure_to("judge its results", &reason))
            }
            Err(reason) => failure_to("list its cases", reason),
        };
        spent.busy += started.elapsed();
        // Whatever the study concludes: a failed case cannot pass.
        if outcome.verdict == Verdict::Pass && !failed_cases.is_empty() {
            let evidence = format!("{} have none", failed_cases.len());
            let check = Check::that(false, "every case has a result", evidence);
            outcome.checks.push(check.about(Subject::of("completion")));
        }
        let outcome = outcome::settle(&self.header.id, outcome);
        Finished {
            header: with_cases(self.header, &self.cases),
            not_finite: outcome.not_finite(),
            outcome,
            failed_cases,
            untested: vec![],
            where_lost: None,
            spent,
            work,
        }
    }
}

/// The outcome of a study that panics while it does something.
fn failure_to(act: &str, reason: &str) -> Outcome {
    let claim = format!("the study can {act}");
    Outcome::new(
        format!("the study cannot {act}: {reason}"),
        vec![],
        vec![Check::that(false, claim, reason).about(Subject::of("study"))],
    )
}
