//! Running cases on all threads; lines in the order of the cases.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::iter::Peekable;
use std::slice::Iter;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use rayon::ThreadPoolBuilder;
use rayon::iter::{ParallelBridge, ParallelIterator};
use serde::{Serialize, Serializer};

use super::Sweep;
use crate::run::RunError;
use crate::run::object::Object;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::run::together::{Together, run_together};
use crate::scene::Scene;
use convergence_judge::time_limit;
use convergence_study::{CaseFailure, atomic};

/// Cases that run together: one group of lanes.
const LANES: usize = 4;
/// Cases that a thread takes at a time, and groups into those that can run together.
const BATCH: usize = 16;

/// The varied keys with their values in a case, in the order of the file.
struct Parameters<'s> {
    sweep: &'s Sweep,
    case: usize,
}

impl Serialize for Parameters<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let axes = self.sweep.axes.iter();
        serializer.collect_map(axes.map(|axis| (&axis.path, axis.json(self.case))))
    }
}

/// The JSON object of a line; names are a contract, keys may be added.
#[derive(Serialize)]
struct Content<'a> {
    case: usize,
    status: &'static str,
    parameters: Parameters<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    result: Option<Object<'a>>,
}

/// The result of one case.
struct CaseLine {
    case: usize,
    /// Whether it completed.
    passed: bool,
    /// A line of JSON without its newline.
    json: String,
}

impl CaseLine {
    fn failed(sweep: &Sweep, case: usize, reason: String) -> Self {
        Self::of(sweep, case, Some(reason), None)
    }

    /// From a run, or from the completed part of one.
    fn of_run(sweep: &Sweep, case: usize, scene: &Scene, run: &Run) -> Self {
        let result = Object::reproducible(scene, run);
        Self::of(sweep, case, run.complaint(), Some(result))
    }

    fn of(sweep: &Sweep, case: usize, reason: Option<String>, result: Option<Object<'_>>) -> Self {
        let passed = reason.is_none();
        let content = Content {
            case,
            status: if passed { "done" } else { "failed" },
            parameters: Parameters { sweep, case },
            reason,
            result,
        };
        // Structs of numbers and texts always serialise.
        let json = serde_json::to_string(&content).unwrap_or_else(|error| unreachable!("{error}"));
        Self { case, passed, json }
    }
}

/// The scene of a case, or the line of its failure.
fn scene(sweep: &Sweep, case: usize) -> Result<Scene, CaseLine> {
    // A panic is a failure of its case, so that the others are not lost.
    let read = CaseFailure::caught(|| sweep.scene(case));
    let read = read.map_err(|failure| CaseLine::failed(sweep, case, failure.reason))?;
    read.map_err(|error| {
        // The line number would refer to a generated text.
        let field = error.field.as_ref().map(|field| format!("{field}: "));
        let reason = format!("{}{}", field.unwrap_or_default(), error.complaint());
        CaseLine::failed(sweep, case, reason)
    })
}

/// A case with its scene.
struct SweptScene {
    case: usize,
    scene: Scene,
}

impl SweptScene {
    /// Its line, from a run on its own.
    fn simulate(&self, sweep: &Sweep) -> CaseLine {
        let Self { case, scene } = self;
        let simulated = CaseFailure::caught(|| {
            let run = Simulator::new(scene)?.run(Recording::Summary, &mut |_, _| ());
            Ok(CaseLine::of_run(sweep, *case, scene, &run))
        });
        simulated
            .and_then(|line: Result<CaseLine, RunError>| Ok(line?))
            .unwrap_or_else(|failure| CaseLine::failed(sweep, *case, failure.reason))
    }
}

/// Scenes in groups that run together, at most [`LANES`] each.
fn groups(scenes: impl IntoIterator<Item = SweptScene>) -> Vec<Vec<SweptScene>> {
    let mut groups: Vec<Vec<SweptScene>> = vec![];
    for swept in scenes {
        let together = Together::of(&swept.scene);
        let group = groups.iter_mut().find(|group| {
            together.is_some() && group.len() < LANES && Together::of(&group[0].scene) == together
        });
        match group {
            Some(group) => group.push(swept),
            None => groups.push(vec![swept]),
        }
    }
    groups
}

/// The lines of a group: its cases together, or one after the other if that fails.
fn lines(sweep: &Sweep, group: &[SweptScene]) -> Vec<CaseLine> {
    let scenes: Vec<&Scene> = group.iter().map(|swept| &swept.scene).collect();
    let runs = match scenes[..] {
        [_] => None,
        _ => CaseFailure::caught(|| run_together(&scenes).ok()).unwrap_or_default(),
    };
    let Some(runs) = runs else {
        let alone = group.iter().map(|swept| swept.simulate(sweep));
        return alone.collect();
    };
    let mut lines = vec![];
    for (SweptScene { case, scene }, run) in group.iter().zip(&runs) {
        lines.push(CaseLine::of_run(sweep, *case, scene, run));
    }
    lines
}

/// Computes a batch of cases, and passes their lines to `sink`.
fn run_batch(
    sweep: &Sweep,
    cases: &[usize],
    sink: &impl Fn(CaseLine) -> io::Result<()>,
) -> io::Result<()> {
    let mut scenes = vec![];
    for &case in cases {
        match scene(sweep, case) {
            Ok(scene) => scenes.push(SweptScene { case, scene }),
            Err(line) => sink(line)?,
        }
    }
    for group in groups(scenes) {
        lines(sweep, &group).into_iter().try_for_each(sink)?;
    }
    Ok(())
}

/// Writes lines in the order of their cases; lines that arrive early are kept until their turn.
struct InOrder<'c, W, P> {
    output: W,
    progress: P,
    /// Cases whose lines have not been written, in order.
    expected: Peekable<Iter<'c, usize>>,
    early: BTreeMap<usize, String>,
}

impl<W: Write, P: FnMut(usize, usize)> InOrder<'_, W, P> {
    /// Accepts a line and writes all lines whose turn has come. After the return, killing the
    /// process no longer loses these.
    fn add(&mut self, line: CaseLine) -> io::Result<()> {
        let failed = usize::from(!line.passed);
        self.early.insert(line.case, line.json);
        let (mut due, mut count) = (String::new(), 0);
        while let Some(json) = self
            .expected
            .peek()
            .and_then(|next| self.early.remove(next))
        {
            due = due + &json + "\n";
            count += 1;
            self.expected.next();
        }
        let _writing = atomic::begin_write();
        self.output.write_all(due.as_bytes())?;
        self.output.flush()?;
        (self.progress)(count, failed);
        Ok(())
    }
}

/// Computes the cases on `jobs` threads (0: one per processor), each within `limit`, and writes a
/// line for each to `output`, in their order. A failure also gives a line; with a limit the line
/// says where its case was stopped.
///
/// Scenes with equal numbers of elements and steps run together, four at a time; with a limit each
/// runs on its own, so that the limit applies to a single case. Lines are the same either way.
///
/// * `cases`: increasing.
/// * `progress`: receives, time after time, how many more lines are written and cases have failed.
///
/// # Errors
/// The error of `output`, which ends the sweep, or the failure to start threads.
pub fn run(
    sweep: &Sweep,
    cases: &[usize],
    jobs: usize,
    limit: Option<Duration>,
    output: impl Write + Send,
    progress: impl FnMut(usize, usize) + Send,
) -> io::Result<()> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(io::Error::other)?;
    // Batches are small enough that every thread has work.
    let batch = match limit {
        Some(_) => 1,
        None => cases.len().div_ceil(pool.current_num_threads()),
    };
    let lines = Mutex::new(InOrder {
        output,
        progress,
        expected: cases.iter().peekable(),
        early: BTreeMap::new(),
    });
    let add = |line| {
        let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
        lines.add(line)
    };
    // They start in the given order, so that few lines wait for their turn.
    let batches = cases.chunks(batch.clamp(1, BATCH)).par_bridge();
    pool.install(|| {
        batches.try_for_each(|batch| time_limit::within(limit, || run_batch(sweep, batch, &add)).0)
    })
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
        let (mut scenes, mut failed) = (vec![], vec![]);
        for case in 0..sweep.cases {
            match scene(&sweep, case) {
                Ok(scene) => scenes.push(SweptScene { case, scene }),
                Err(line) => failed.push(line.case),
            }
        }
        // dt = 0.3 does not divide t_end = 0.8: every fourth case has no scene. The others have
        // different numbers of steps.
        let four = |case: usize| vec![case, case + 4, case + 8, case + 12];
        let expected = [four(0), four(1), four(2), vec![16], vec![17], vec![18]];
        let of_group = |group: &Vec<SweptScene>| group.iter().map(|swept| swept.case).collect();
        let found: Vec<Vec<usize>> = groups(scenes).iter().map(of_group).collect();
        assert_eq!(found, expected);
        assert_eq!(failed, [3, 7, 11, 15, 19]);
    }
}
