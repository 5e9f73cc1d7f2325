//! The order in which cases are started, and the order in which their results are read.

use std::cmp::Reverse;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::Spent;
use crate::study::Case;

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
    /// The study, by its place in the list, whose last case this was.
    pub ended: Option<usize>,
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
    study: usize,
    case: usize,
    started: Instant,
    ended: Instant,
}

impl Job {
    /// Runs it and reads the clock before and after.
    pub(super) fn time(&self, run: impl FnOnce()) -> Done {
        let started = Instant::now();
        run();
        Done { study: self.study, case: self.case, started, ended: Instant::now() }
    }
}

/// All cases of all studies. The costliest come first, so that no thread is left alone with a long one at the end.
pub(super) fn costliest_first<'c>(plans: impl Iterator<Item = &'c [Case<()>]>) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (study, cases) in plans.enumerate() {
        let job = |(case, Case { cost, .. }): (usize, &Case<()>)| Job { study, case, cost: usable(*cost) };
        jobs.extend(cases.iter().enumerate().map(job));
    }
    jobs.sort_by(|a, b| b.cost.total_cmp(&a.cost));
    jobs
}

/// A cost that can be added and compared, whatever a study has estimated.
fn usable(cost: f64) -> f64 {
    if cost.is_finite() && cost > 0.0 { cost } else { 1.0 }
}

/// The results for each study, in the order of its cases.
pub(super) fn in_order(mut done: Vec<Done>, studies: usize) -> Vec<Vec<Done>> {
    done.sort_by_key(|done| Reverse((done.study, done.case)));
    let take = |study| {
        let rest = done.partition_point(|done| done.study > study);
        let mut own = done.split_off(rest);
        own.reverse();
        own
    };
    (0..studies).map(take).collect()
}

/// The time that the cases of a study took.
pub(super) fn spent(done: &[Done]) -> Spent {
    let busy = done.iter().map(|done| done.ended - done.started).sum();
    let started = done.iter().map(|done| done.started).min();
    let ended = done.iter().map(|done| done.ended).max();
    let wall = ended.zip(started).map(|(ended, started)| ended - started).unwrap_or_default();
    Spent { busy, wall, cases: done.len(), kept: 0 }
}

/// Counts the cases that have ended and reports the progress.
pub(super) struct Counter<'p> {
    /// The progress, and the number of cases left of each study.
    now: Mutex<(Progress, Vec<usize>)>,
    report: &'p (dyn Fn(Progress) + Sync),
}

impl<'p> Counter<'p> {
    pub(super) fn new(jobs: &[Job], report: &'p (dyn Fn(Progress) + Sync)) -> Self {
        let cost = jobs.iter().map(|job| job.cost).sum();
        let now = Progress { done_cases: 0, cases: jobs.len(), done_cost: 0.0, cost, ended: None };
        let studies = jobs.iter().map(|job| job.study + 1).max().unwrap_or(0);
        let mut left = vec![0; studies];
        jobs.iter().for_each(|job| left[job.study] += 1);
        Self { now: Mutex::new((now, left)), report }
    }

    /// Takes note that a case has ended; whether it was the last of its study.
    pub(super) fn leave(&self, job: &Job) -> bool {
        let mut state = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        state.1[job.study] -= 1;
        state.1[job.study] == 0
    }

    /// Reports while it holds the lock, so that the reported numbers only grow.
    ///
    /// * `is_last`: whether its study has ended with it.
    pub(super) fn count(&self, job: &Job, is_last: bool) {
        let mut state = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        let now = &mut state.0;
        now.ended = is_last.then_some(job.study);
        now.done_cases += 1;
        now.done_cost += job.cost;
        (self.report)(*now);
    }
}
