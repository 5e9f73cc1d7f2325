//! Running cases on all threads; lines in the order of completion.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::panic::{self, AssertUnwindSafe};
use std::time::Duration;

use rayon::ThreadPoolBuilder;
use rayon::iter::{ParallelBridge, ParallelIterator};
use serde::Serialize;

use super::{Sweep, SweepCase, lines};
use crate::run::object::Object;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::run::together::{Together, run_together};
use crate::scene::Scene;
use convergence_study::run::time_limit;

/// Cases that run side by side: one group of lanes.
const LANES: usize = 4;
/// Cases that a thread takes at a time, and groups into those that can run side by side.
const BATCH: usize = 16;

/// The result of one case: a line of JSON without its newline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The case's number.
    pub case: usize,
    /// Whether it completed.
    pub passed: bool,
    /// The line.
    pub json: String,
}

/// The JSON object of a line; names are a contract, more may be added.
#[derive(Serialize)]
struct Content<'a> {
    case: usize,
    status: &'static str,
    parameters: &'a SweepCase<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    result: Option<Object<'a>>,
}

impl Line {
    /// Computes a case; a failure is a line too.
    ///
    /// * `limit`: the longest time it may take; the line says where it was stopped.
    pub fn compute(sweep: &Sweep, index: usize, limit: Option<Duration>) -> Self {
        let read = || scene(sweep, index).map_or_else(|line| line, |scene| simulate(sweep, index, &scene));
        caught(|| time_limit::within(limit, read).0).unwrap_or_else(|| Self::panicked(sweep, index))
    }

    fn panicked(sweep: &Sweep, index: usize) -> Self {
        Self::failed(&sweep.case(index), "the program panicked".to_owned())
    }

    fn failed(case: &SweepCase<'_>, reason: String) -> Self {
        Self::of(&Content { case: case.index, status: "failed", parameters: case, reason: Some(reason), result: None })
    }

    fn of(content: &Content<'_>) -> Self {
        // Structs of numbers and texts always serialise.
        let json = serde_json::to_string(content).unwrap_or_else(|error| unreachable!("{error}"));
        Self { case: content.case, passed: content.reason.is_none(), json: lines::sealed(&json) }
    }
}

/// The result of a computation; `None` where it panics, so that the other cases are not lost.
fn caught<T>(compute: impl FnOnce() -> T) -> Option<T> {
    panic::catch_unwind(AssertUnwindSafe(compute)).ok()
}

/// The scene of a case, or the line of its failure.
fn scene(sweep: &Sweep, index: usize) -> Result<Scene, Line> {
    let case = sweep.case(index);
    sweep.scene(&case).map_err(|error| {
        // The line number would refer to a generated text.
        let field = error.field.map(|field| format!("{field}: ")).unwrap_or_default();
        Line::failed(&case, format!("{field}{}", error.complaint))
    })
}

fn simulate(sweep: &Sweep, index: usize, scene: &Scene) -> Line {
    match Simulator::new(scene) {
        Ok(simulator) => line(sweep, index, scene, &simulator.run(Recording::Summary, &mut |_, _| ())),
        Err(error) => Line::failed(&sweep.case(index), error.to_string()),
    }
}

/// The line of a run, or of the part of it that was done.
fn line(sweep: &Sweep, index: usize, scene: &Scene, run: &Run) -> Line {
    let (case, reason) = (sweep.case(index), run.complaint());
    let status = if reason.is_none() { "done" } else { "failed" };
    let result = Some(Object::reproducible(scene, run));
    Line::of(&Content { case: index, status, parameters: &case, reason, result })
}

/// Cases that run side by side: at most [`LANES`], and their scenes agree; or one that runs alone.
#[derive(Default)]
struct SideBySide {
    together: Option<Together>,
    indices: Vec<usize>,
    scenes: Vec<Scene>,
    /// The line of a case without a scene.
    failed: Option<Line>,
}

/// Groups cases; a scene that can only run alone forms a group of its own, and so does a case without a scene.
fn groups(sweep: &Sweep, indices: &[usize]) -> Vec<SideBySide> {
    let mut groups: Vec<SideBySide> = vec![];
    for &index in indices {
        let read = caught(|| scene(sweep, index)).unwrap_or_else(|| Err(Line::panicked(sweep, index)));
        let together = read.as_ref().ok().and_then(Together::of);
        let fits = |group: &&mut SideBySide| group.indices.len() < LANES && group.together == together;
        let group = match groups.iter_mut().find(fits).filter(|_| together.is_some()) {
            Some(group) => group,
            None => {
                groups.push(SideBySide { together, ..SideBySide::default() });
                groups.last_mut().unwrap_or_else(|| unreachable!("one was pushed"))
            }
        };
        group.indices.push(index);
        match read {
            Ok(scene) => group.scenes.push(scene),
            Err(line) => group.failed = Some(line),
        }
    }
    groups
}

/// The lines of a group: its cases side by side, or one after the other where that fails.
fn lines(sweep: &Sweep, group: &SideBySide, mut sink: impl FnMut(Line) -> io::Result<()>) -> io::Result<()> {
    let SideBySide { indices, scenes, failed, .. } = group;
    if let Some(line) = failed {
        return sink(line.clone());
    }
    let together = || {
        let runs = (scenes.len() > 1).then(|| run_together(scenes).ok()).flatten()?;
        let of = |((&index, scene), run)| line(sweep, index, scene, run);
        Some(indices.iter().zip(scenes).zip(&runs).map(of).collect::<Vec<_>>())
    };
    if let Some(lines) = caught(together).flatten() {
        return lines.into_iter().try_for_each(sink);
    }
    indices.iter().zip(scenes).try_for_each(|(&index, scene)| {
        sink(caught(|| simulate(sweep, index, scene)).unwrap_or_else(|| Line::panicked(sweep, index)))
    })
}

/// Computes the cases on `jobs` threads (0: one per processor), each within `limit`, and passes each line to `sink` on
/// completion.
///
/// Cases start in the order given, so that lines come nearly in that order; `sink` is called from every thread. Scenes with
/// equal numbers of elements and steps run side by side, four at a time; with a limit each runs alone, so that the limit
/// applies to one case. A line is the same either way.
///
/// # Errors
/// The error of `sink`, which ends the sweep, or of threads that cannot be started.
pub fn run(
    sweep: &Sweep,
    cases: &[usize],
    jobs: usize,
    limit: Option<Duration>,
    sink: impl Fn(Line) -> io::Result<()> + Sync,
) -> io::Result<()> {
    let pool = ThreadPoolBuilder::new().num_threads(jobs).build().map_err(io::Error::other)?;
    // Batches small enough that every thread has work.
    let batch = if limit.is_some() { 1 } else { cases.len().div_ceil(pool.current_num_threads()).clamp(1, BATCH) };
    let compute = |batch: &[usize]| match batch {
        [index] => sink(Line::compute(sweep, *index, limit)),
        _ => groups(sweep, batch).iter().try_for_each(|group| lines(sweep, group, &sink)),
    };
    pool.install(|| cases.chunks(batch).par_bridge().try_for_each(compute))
}

/// Writes lines in the order of their cases; those that come early are kept until their turn.
pub struct InOrder<W> {
    output: W,
    /// Cases of which the line has not been written, in order.
    expected: std::vec::IntoIter<usize>,
    next: Option<usize>,
    early: BTreeMap<usize, String>,
}

impl<W: Write> InOrder<W> {
    /// * `expected`: the cases of all lines to come, increasing.
    pub fn new(output: W, expected: Vec<usize>) -> Self {
        let mut expected = expected.into_iter();
        let next = expected.next();
        Self { output, expected, next, early: BTreeMap::new() }
    }

    /// Accepts a line and writes all lines whose turn has come.
    ///
    /// # Errors
    /// The error of the output.
    pub fn add(&mut self, line: Line) -> io::Result<()> {
        self.early.insert(line.case, line.json);
        while let Some(json) = self.next.and_then(|next| self.early.remove(&next)) {
            writeln!(self.output, "{json}")?;
            self.next = self.expected.next();
        }
        self.output.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_that_agree_are_grouped_by_four_in_the_order_of_their_cases() {
        let folder = tempfile::tempdir().unwrap();
        let base = "[mesh]\nelements = 4\n[time]\ndt = 0.1\nt_end = 1.0\n";
        std::fs::write(folder.path().join("base.toml"), base).unwrap();
        let grid = "[sweep]\nscene = \"base.toml\"\n[grid]\nbeam.beta = [0.0, 1.0, 2.0, 3.0, 4.0]\n\
            time.t_end = [0.6, 0.8]\ntime.dt = [0.2, 0.3]\n";
        std::fs::write(folder.path().join("sweep.toml"), grid).unwrap();
        let sweep = Sweep::read(folder.path().join("sweep.toml")).unwrap();
        let indices: Vec<usize> = (0..sweep.cases()).collect();
        let found: Vec<(Vec<usize>, usize)> =
            groups(&sweep, &indices).into_iter().map(|group| (group.indices, group.scenes.len())).collect();
        // dt = 0.3 does not divide t_end = 0.8: every fourth case has no scene. The others differ in their number of steps.
        let mut expected = vec![];
        for case in 0..20 {
            match case {
                _ if case % 4 == 3 => expected.push((vec![case], 0)),
                0..4 => expected.push((vec![case, case + 4, case + 8, case + 12], 4)),
                16.. => expected.push((vec![case], 1)),
                _ => {}
            }
        }
        assert_eq!(found, expected);
    }
}
