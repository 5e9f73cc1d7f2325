//! The studies of a pytest run: comparison with the baseline, a new baseline, the report.

use std::path::PathBuf;

use convergence_study::{Finished, Project, TestRun};
use pyo3::prelude::*;

use crate::studied::Study;
use crate::values::refuse;

const PROJECT: Project = Project::new("pytest", "pytest");

/// The studies that the baseline guards, each with the test that it belongs to: empty if unknown.
#[pyfunction]
pub(crate) fn guarded(baseline: PathBuf) -> PyResult<Vec<(String, String)>> {
    let guarded = TestRun::guarded(&baseline).map_err(refuse)?.into_iter();
    Ok(guarded
        .map(|(id, test)| (id, test.unwrap_or_default()))
        .collect())
}

/// What pytest is asked to do with the studies of a run: the fields of [`TestRun`].
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Request {
    baseline: PathBuf,
    bless: bool,
    loosened: bool,
    report: Option<PathBuf>,
    gone: Vec<String>,
}

/// Compares the studies of a run with the baseline, accepts them as the new baseline on request,
/// and writes the report.
///
/// * `studies`: the baseline has no numbers of those that may be inconclusive.
/// * Returns lines to print, and whether everything agrees with the baseline.
#[pyfunction]
pub(crate) fn finish(
    studies: Vec<PyRef<'_, Study>>,
    request: Request,
) -> PyResult<(Vec<String>, bool)> {
    let firm = studies.iter().filter(|study| !study.allows_inconclusive());
    let firm: Vec<Finished> = firm.map(|study| study.finished.clone()).collect();
    let all: Vec<Finished> = studies.iter().map(|study| study.finished.clone()).collect();
    let run = TestRun {
        baseline: request.baseline,
        bless: request.bless,
        loosened: request.loosened,
        options: "--convergence-bless --convergence-loosened",
        report: request.report,
        gone: request.gone,
    };
    run.finish(&PROJECT, &firm, &all).map_err(refuse)
}
