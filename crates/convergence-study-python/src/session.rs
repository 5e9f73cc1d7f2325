//! The studies of a pytest run: comparison with the baseline, a new baseline, the report.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use convergence_study::{
    Finished, Header, Project, Verdict, atomic,
    internal::{
        run,
        store::{Baseline, GuardedChange, Movement, Record},
        verify,
    },
};
use pyo3::prelude::*;

use crate::studied::Study;
use crate::values::refuse;

const PROJECT: Project = Project::new("pytest", "pytest");

/// The studies that the baseline guards, each with the test that it belongs to: empty if unknown.
#[pyfunction]
pub(crate) fn guarded(baseline: PathBuf) -> PyResult<Vec<(String, String)>> {
    let numbers = Baseline::read(&baseline).map_err(refuse)?;
    let tests = numbers.tests();
    Ok(tests
        .map(|(id, test)| (id.to_owned(), test.unwrap_or_default().to_owned()))
        .collect())
}

/// What pytest is asked to do with the studies of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Request {
    /// The file of the baseline; numbers are guarded if it exists or is to be created.
    baseline: PathBuf,
    /// Whether to accept the numbers.
    bless: bool,
    /// Whether to accept also what is loosened, changed in its settings, or gone.
    loosened: bool,
    /// The folder of the report.
    report: Option<PathBuf>,
    /// Guarded studies whose tests no longer exist.
    gone: Vec<String>,
}

impl Request {
    /// The guarded studies that this run says nothing about.
    fn not_judged(&self, numbers: &Baseline, known: &[Header]) -> Vec<Header> {
        let changes = numbers.compare(&[], Some(known));
        let ids: BTreeSet<String> = changes
            .into_iter()
            .filter(is_deleted)
            .map(|change| change.study)
            .filter(|id| !self.gone.contains(id))
            .collect();
        ids.into_iter().map(|id| Header::new(id, "")).collect()
    }

    /// The differences between the baseline and the studies of this run.
    fn changes(&self, numbers: &Baseline, studies: &[Finished]) -> Vec<GuardedChange> {
        let known = headers(studies);
        let mut changes = numbers.compare(studies, Some(&known));
        let is_known = |id: &String| known.iter().any(|header| header.id == *id);
        changes.retain(|change| is_known(&change.study) || self.gone.contains(&change.study));
        changes
    }

    /// Accepts the studies into the baseline.
    ///
    /// * Returns the lines to print, and whether it is accepted.
    fn bless(&self, numbers: &mut Baseline, studies: &[Finished]) -> PyResult<(Vec<String>, bool)> {
        let mut known = headers(studies);
        known.extend(self.not_judged(numbers, &known));
        let loosened = match numbers.bless(studies, Some(&known), self.loosened) {
            Ok(loosened) => loosened,
            Err(refusal) => {
                let words = refusal.words("--convergence-bless --convergence-loosened");
                return Ok((vec![format!("baseline: {words}")], false));
            }
        };
        if let Some(folder) = self.baseline.parent() {
            atomic::prepare_folder(folder)?;
        }
        numbers.write(&self.baseline).map_err(refuse)?;
        let mut lines: Vec<String> = loosened
            .iter()
            .map(|change| format!("loosened: {change}"))
            .collect();
        lines.push(format!(
            "baseline: blessed, see {}",
            self.baseline.display()
        ));
        Ok((lines, true))
    }
}

fn headers(studies: &[Finished]) -> Vec<Header> {
    studies.iter().map(|study| study.header.clone()).collect()
}

fn is_deleted(change: &GuardedChange) -> bool {
    matches!(
        change.movement,
        Movement::VanishedStudy { .. } | Movement::Vanished { .. }
    )
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
    let mut lines = vec![];
    let mut is_well = true;
    let mut changes = None;
    if request.bless || request.baseline.is_file() {
        let mut numbers = Baseline::read(&request.baseline).map_err(refuse)?;
        if request.bless {
            (lines, is_well) = request.bless(&mut numbers, &firm)?;
        }
        let found = request.changes(&numbers, &firm);
        let moved = found.iter().filter(|change| !is_gone(change, &request));
        lines.extend(moved.map(|change| format!("baseline: {change}")));
        is_well &= found.is_empty();
        changes = Some(found);
    }
    if let Some(folder) = &request.report {
        let all = studies.iter().map(|study| study.finished.clone());
        report(all.collect(), changes.as_deref(), is_well, folder)?;
        lines.push(format!("report: {}", folder.join("index.html").display()));
    }
    Ok((lines, is_well))
}

/// Whether pytest itself says that the test is gone.
fn is_gone(change: &GuardedChange, request: &Request) -> bool {
    request.gone.contains(&change.study)
}

/// Writes the report on the studies of a run.
fn report(
    studies: Vec<Finished>,
    changes: Option<&[GuardedChange]>,
    is_well: bool,
    folder: &Path,
) -> PyResult<()> {
    let own = Verdict::worst(studies.iter().map(|study| study.outcome.verdict));
    let verdict = if is_well { own } else { Verdict::Fail };
    let record = Record::new("files", PROJECT.command, verdict, changes, studies);
    verify::publish(&PROJECT, record, run::available().get(), folder).map_err(refuse)
}
