//! The studies of a pytest run: comparison with the baseline, a new baseline, the report.

use std::path::PathBuf;

use convergence_harness::judge::verdict::Verdict;
use convergence_harness::project::Project;
use convergence_harness::run::{self, Finished};
use convergence_harness::store::{Baseline, Record, atomic};
use convergence_harness::verify;
use pyo3::prelude::*;

use crate::studied::Study;
use crate::values::refuse;

const PROJECT: Project = Project::new("pytest", "pytest");

/// Compares the studies of a run with the baseline, accepts them as the new baseline on request,
/// and writes the report.
///
/// * `studies`: each with a flag that allows it to be inconclusive; then the baseline has none of
///   its numbers.
/// * `baseline`: its file; numbers are guarded if it exists or is to be created.
/// * `reason`: why claims have changed.
/// * Returns lines to print, and whether everything agrees with the baseline.
#[pyfunction]
pub(crate) fn finish(
    studies: Vec<(PyRef<'_, Study>, bool)>,
    baseline: PathBuf,
    bless: bool,
    reason: Option<String>,
    report: Option<PathBuf>,
) -> PyResult<(Vec<String>, bool)> {
    let guarded: Vec<Finished> = studies
        .iter()
        .filter(|(_, excused)| !excused)
        .map(|(study, _)| study.finished.clone())
        .collect();
    let (mut lines, mut changes) = (vec![], None);
    let mut is_refused = false;
    if bless || baseline.is_file() {
        let mut numbers = Baseline::read(&baseline).map_err(refuse)?;
        if bless {
            match numbers.bless(&guarded, None, reason.as_deref()) {
                Ok(()) => {
                    if let Some(folder) = baseline.parent() {
                        atomic::prepare_folder(folder)?;
                    }
                    numbers.write(&baseline).map_err(refuse)?;
                    lines.push(format!("baseline: blessed, see {}", baseline.display()));
                }
                Err(refusal) => {
                    is_refused = true;
                    lines.push(format!("baseline: {refusal}").replace(
                        "--bless --reason",
                        "--convergence-bless --convergence-reason",
                    ));
                }
            }
        }
        changes = Some(numbers.compare(&guarded, None));
    }
    let moved = changes.as_deref().unwrap_or_default();
    lines.extend(moved.iter().map(|change| format!("baseline: {change}")));
    let is_well = moved.is_empty() && !is_refused;
    if let Some(folder) = report {
        let finished: Vec<Finished> = studies
            .iter()
            .map(|(study, _)| study.finished.clone())
            .collect();
        let own = Verdict::worst(finished.iter().map(|finished| finished.outcome.verdict));
        let verdict = if is_well { own } else { Verdict::Fail };
        let record = Record::new(
            "files",
            PROJECT.command,
            verdict,
            changes.as_deref(),
            finished,
        );
        verify::publish(&PROJECT, record, run::available().get(), &folder).map_err(refuse)?;
        lines.push(format!("report: {}", folder.join("index.html").display()));
    }
    Ok((lines, is_well))
}
