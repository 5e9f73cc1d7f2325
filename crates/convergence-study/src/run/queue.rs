//! The order in which cases are started, and the order in which their results are read.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::Spent;
use crate::study::Case;
use convergence_judge::verdict::Verdict;

/// Progress of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Cases that have ended.
    pub done_cases: usize,
    /// All cases.
    pub cases: usize,
    /// Cost of the cases that have ended.
    pub done_cost: f64,
    /// Cost of all cases.
    pub cost: f64,
    /// The study, by its index in the list, whose last case this was, and its verdict.
    pub ended: Option<(usize, Verdict)>,
    /// The study whose case has been running longest.
    pub running: Option<usize>,
}

/// One case of one study.
#[derive(Debug, Clone, Copy)]
pub(super) struct Job {
    pub(super) study: usize,
    pub(super) case: usize,
    pub(super) cost: f64,
}

/// A case that has ended.
#[derive(Debug)]
pub(super) struct Done {
    pub(super) case: usize,
    started: Instant,
    ended: Instant,
    pub(super) work: u64,
}

impl Done {
    /// Runs a case, reading the clock before and after; `run` returns the work.
    pub(super) fn of(case: usize, run: impl FnOnce() -> u64) -> Self {
        let started = Instant::now();
        let work = run();
        Self {
            case,
            started,
            ended: Instant::now(),
            work,
        }
    }
}

/// All cases of all studies. The costliest come first, so that no thread is left alone with a long
/// one at the end.
pub(super) fn costliest_first<'c>(plans: impl Iterator<Item = &'c [Case<()>]>) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (study, cases) in plans.enumerate() {
        for (case, Case { cost, .. }) in cases.iter().enumerate() {
            let cost = usable(*cost);
            jobs.push(Job { study, case, cost });
        }
    }
    jobs.sort_by(|a, b| b.cost.total_cmp(&a.cost));
    jobs
}

/// A cost that can be added and compared, whatever a study has estimated.
fn usable(cost: f64) -> f64 {
    if cost.is_finite() && cost > 0.0 {
        cost
    } else {
        1.0
    }
}

/// The time that the cases of a study took.
pub(super) fn spent(done: &[Done]) -> Spent {
    let busy = done.iter().map(|done| done.ended - done.started).sum();
    let started = done.iter().map(|done| done.started).min();
    let ended = done.iter().map(|done| done.ended).max();
    let wall = ended
        .zip(started)
        .map(|(ended, started)| ended - started)
        .unwrap_or_default();
    Spent {
        busy,
        wall,
        cases: done.len(),
    }
}

/// Counts the cases that have ended and reports the progress.
pub(super) struct Counter<'p> {
    now: Mutex<Now>,
    report: &'p (dyn Fn(Progress) + Sync),
}

struct Now {
    progress: Progress,
    /// The studies of the running cases, in the order in which these began.
    running: Vec<usize>,
}

impl<'p> Counter<'p> {
    pub(super) fn new(jobs: &[Job], report: &'p (dyn Fn(Progress) + Sync)) -> Self {
        let cost = jobs.iter().map(|job| job.cost).sum();
        let progress = Progress {
            done_cases: 0,
            cases: jobs.len(),
            done_cost: 0.0,
            cost,
            ended: None,
            running: None,
        };
        Self {
            now: Mutex::new(Now {
                progress,
                running: vec![],
            }),
            report,
        }
    }

    fn now(&self) -> MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records that a case begins.
    pub(super) fn enter(&self, job: &Job) {
        self.now().running.push(job.study);
    }

    /// Reports while holding the lock, so that the reported numbers only grow.
    ///
    /// * `ended`: the verdict on its study, if this case was its last.
    pub(super) fn count(&self, job: &Job, ended: Option<Verdict>) {
        let mut now = self.now();
        let place = now.running.iter().position(|study| *study == job.study);
        place.map(|place| now.running.remove(place));
        let running = now.running.first().copied();
        let progress = &mut now.progress;
        (progress.ended, progress.running) = (ended.map(|verdict| (job.study, verdict)), running);
        progress.done_cases += 1;
        progress.done_cost += job.cost;
        (self.report)(*progress);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_wall_time_of_a_study_is_the_time_that_passed_and_its_busy_time_the_sum_over_its_cases() {
        let now = Instant::now();
        let second = Duration::from_secs;
        let done = |from, to| Done {
            case: 0,
            started: now + second(from),
            ended: now + second(to),
            work: 0,
        };
        let spent = spent(&[done(3, 7), done(1, 5), done(2, 4)]);
        assert_eq!(
            (spent.wall, spent.busy, spent.cases),
            (second(6), second(10), 3)
        );
        assert_eq!(super::spent(&[]), Spent::default());
    }
}
