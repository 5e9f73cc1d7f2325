//! Running cases on all threads; lines in the order of completion.

use std::io;
use std::time::Duration;

use rayon::ThreadPoolBuilder;
use rayon::iter::{ParallelBridge, ParallelIterator};
use serde::{Serialize, Serializer};

use super::{CaseLine, Sweep};
use crate::run::object::Object;
use crate::run::simulate::{Recording, Run, Simulator};
use crate::run::together::{Together, run_together};
use crate::scene::Scene;
use convergence_judge::time_limit;
use convergence_study::CaseFailure;

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
        serializer.collect_map(axes.map(|axis| (axis.path, axis.json(self.case))))
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
        let field = error
            .field
            .map(|field| format!("{field}: "))
            .unwrap_or_default();
        CaseLine::failed(sweep, case, format!("{field}{}", error.complaint))
    })
}

/// A case on its own.
fn simulate(sweep: &Sweep, case: usize, scene: &Scene) -> CaseLine {
    let simulated = || match Simulator::new(scene) {
        Ok(simulator) => CaseLine::of_run(
            sweep,
            case,
            scene,
            &simulator.run(Recording::Summary, &mut |_, _| ()),
        ),
        Err(error) => CaseLine::failed(sweep, case, error.to_string()),
    };
    CaseFailure::caught(simulated)
        .unwrap_or_else(|failure| CaseLine::failed(sweep, case, failure.reason))
}

/// Cases that run together: at most [`LANES`] with scenes that agree; or a single case.
struct CaseGroup {
    together: Option<Together>,
    cases: Vec<usize>,
    scenes: Vec<Scene>,
}

impl CaseGroup {
    /// Whether a scene can be added; `None` stands for a scene that runs on its own.
    fn has_room_for(&self, together: Option<Together>) -> bool {
        together.is_some() && self.cases.len() < LANES && self.together == together
    }
}

/// Groups cases, and returns the lines of cases without a scene.
fn groups(sweep: &Sweep, indices: &[usize]) -> (Vec<CaseGroup>, Vec<CaseLine>) {
    let mut groups: Vec<CaseGroup> = vec![];
    let mut failed = vec![];
    for &index in indices {
        match scene(sweep, index) {
            Err(line) => failed.push(line),
            Ok(scene) => {
                let together = Together::of(&scene);
                match groups.iter_mut().find(|group| group.has_room_for(together)) {
                    Some(group) => {
                        group.cases.push(index);
                        group.scenes.push(scene);
                    }
                    None => groups.push(CaseGroup {
                        together,
                        cases: vec![index],
                        scenes: vec![scene],
                    }),
                }
            }
        }
    }
    (groups, failed)
}

/// The lines of a group: its cases together, or one after the other if that fails.
fn lines(sweep: &Sweep, group: &CaseGroup) -> Vec<CaseLine> {
    if let Some(lines) = CaseFailure::caught(|| lines_together(sweep, group))
        .ok()
        .flatten()
    {
        return lines;
    }
    let cases = group.cases.iter().zip(&group.scenes);
    cases
        .map(|(&index, scene)| simulate(sweep, index, scene))
        .collect()
}

/// The lines of a group of several cases; `None` if they cannot run together.
fn lines_together(
    sweep: &Sweep,
    CaseGroup { cases, scenes, .. }: &CaseGroup,
) -> Option<Vec<CaseLine>> {
    if scenes.len() == 1 {
        return None;
    }
    let runs = run_together(scenes).ok()?;
    let mut lines = vec![];
    for ((&index, scene), run) in cases.iter().zip(scenes).zip(&runs) {
        lines.push(CaseLine::of_run(sweep, index, scene, run));
    }
    Some(lines)
}

/// Computes a batch of cases, and passes their lines to `sink`.
fn run_batch(
    sweep: &Sweep,
    cases: &[usize],
    sink: &impl Fn(CaseLine) -> io::Result<()>,
) -> io::Result<()> {
    let (groups, failed) = groups(sweep, cases);
    failed.into_iter().try_for_each(sink)?;
    for group in &groups {
        lines(sweep, group).into_iter().try_for_each(sink)?;
    }
    Ok(())
}

/// Computes the cases on `jobs` threads (0: one per processor), each within `limit`, and passes
/// each line to `sink` on completion. A failure also gives a line; with a limit the line says where
/// its case was stopped.
///
/// Cases start in the given order, so that lines arrive nearly in that order; `sink` is called from
/// every thread. Scenes with equal numbers of elements and steps run together, four at a time; with
/// a limit each runs on its own, so that the limit applies to a single case. Lines are the same
/// either way.
///
/// # Errors
/// The error of `sink`, which ends the sweep, or the failure to start threads.
pub fn run(
    sweep: &Sweep,
    cases: &[usize],
    jobs: usize,
    limit: Option<Duration>,
    sink: impl Fn(CaseLine) -> io::Result<()> + Sync,
) -> io::Result<()> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(io::Error::other)?;
    // Batches are small enough that every thread has work.
    let batch = if limit.is_some() {
        1
    } else {
        cases
            .len()
            .div_ceil(pool.current_num_threads())
            .clamp(1, BATCH)
    };
    pool.install(|| {
        cases
            .chunks(batch)
            .par_bridge()
            .try_for_each(|batch| time_limit::within(limit, || run_batch(sweep, batch, &sink)).0)
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
        let indices: Vec<usize> = (0..sweep.cases).collect();
        let (groups, failed) = groups(&sweep, &indices);
        // dt = 0.3 does not divide t_end = 0.8: every fourth case has no scene. The others have
        // different numbers of steps.
        let four = |case: usize| vec![case, case + 4, case + 8, case + 12];
        let expected = [four(0), four(1), four(2), vec![16], vec![17], vec![18]];
        assert_eq!(
            groups
                .iter()
                .map(|group| group.cases.clone())
                .collect::<Vec<_>>(),
            expected
        );
        assert!(
            groups
                .iter()
                .all(|group| group.scenes.len() == group.cases.len())
        );
        assert_eq!(
            failed.iter().map(|line| line.case).collect::<Vec<_>>(),
            [3, 7, 11, 15, 19]
        );
    }
}
