//! Studies that the tests of another framework run, such as pytest: compared with a baseline,
//! accepted into it, reported.

use std::io;
use std::path::{Path, PathBuf};

use super::rebuilt::publish;
use super::{VerificationError, after_blessing, judged};
use crate::project::Project;
use crate::run::{Finished, available};
use crate::store::{Baseline, GuardedChange};
use crate::study::Header;

/// What is to be done with the studies of a run of tests.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TestRun {
    /// The file of the baseline; numbers are guarded if it exists or is to be created.
    pub baseline: PathBuf,
    /// Whether to accept the numbers.
    pub bless: bool,
    /// Whether to accept also what is loosened, changed in its settings, or gone.
    pub loosened: bool,
    /// The options that do both, which a refusal names.
    pub options: &'static str,
    /// The folder of the report.
    pub report: Option<PathBuf>,
    /// Guarded studies whose tests no longer exist.
    pub gone: Vec<String>,
}

impl TestRun {
    /// The studies that a baseline guards, each with the test that it belongs to, if it is known.
    ///
    /// # Errors
    /// A file that is no baseline.
    pub fn guarded(baseline: &Path) -> io::Result<Vec<(String, Option<String>)>> {
        let numbers = Baseline::read(baseline)?;
        let tests = numbers.tests();
        Ok(tests
            .map(|(id, test)| (id.to_owned(), test.map(str::to_owned)))
            .collect())
    }

    /// Compares the studies of the run with the baseline, accepts them on request, and writes the
    /// report.
    ///
    /// * `firm`: those that may not be inconclusive, whose numbers the baseline guards.
    /// * `all`: all of them.
    /// * Returns lines to print, and whether everything agrees with the baseline.
    ///
    /// # Errors
    /// A file that is no baseline, or a place that cannot be written.
    pub fn finish(
        &self,
        project: &Project,
        firm: &[Finished],
        all: &[Finished],
    ) -> Result<(Vec<String>, bool), VerificationError> {
        let mut lines = vec![];
        let mut is_well = true;
        let mut is_blessed = false;
        let mut changes = None;
        if self.bless || self.baseline.is_file() {
            let mut numbers = Baseline::read(&self.baseline)?;
            if self.bless {
                (lines, is_well) = self.accept(&mut numbers, firm)?;
                is_blessed = is_well;
            }
            let found = self.changes(&numbers, firm);
            // The framework itself says which tests are gone.
            let moved = found
                .iter()
                .filter(|change| !self.gone.contains(&change.study));
            lines.extend(moved.map(|change| format!("baseline: {change}")));
            is_well &= found.is_empty();
            changes = Some(found);
        }
        if let Some(folder) = &self.report {
            let record = judged("files", project.command, all.to_vec(), changes.as_deref());
            let published = publish(project, record, available().get(), folder);
            published.map_err(|error| match error {
                VerificationError::Files(error) if is_blessed => after_blessing(error).into(),
                error => error,
            })?;
            lines.push(format!("report: {}", folder.join("index.html").display()));
        }
        Ok((lines, is_well))
    }

    /// The studies of this run, and those that are guarded and that it says nothing about.
    fn known(&self, numbers: &Baseline, studies: &[Finished]) -> Vec<Header> {
        let own = studies.iter().map(|study| study.header.clone());
        let mut known: Vec<Header> = own.collect();
        for (id, _) in numbers.tests() {
            if !is_of(studies, id) && !self.gone.iter().any(|gone| gone == id) {
                known.push(Header::new(id, ""));
            }
        }
        known
    }

    /// The differences between the baseline and the studies of this run.
    fn changes(&self, numbers: &Baseline, studies: &[Finished]) -> Vec<GuardedChange> {
        let mut changes = numbers.compare(studies, Some(&self.known(numbers, studies)));
        changes.retain(|change| is_of(studies, &change.study) || self.gone.contains(&change.study));
        changes
    }

    /// Accepts the studies into the baseline.
    ///
    /// * Returns the lines to print, and whether it is accepted.
    fn accept(
        &self,
        numbers: &mut Baseline,
        studies: &[Finished],
    ) -> io::Result<(Vec<String>, bool)> {
        let known = self.known(numbers, studies);
        let loosened = match numbers.bless(studies, Some(&known), self.loosened) {
            Ok(loosened) => loosened,
            Err(refusal) => {
                let words = refusal.words(self.options);
                return Ok((vec![format!("baseline: {words}")], false));
            }
        };
        numbers.write(&self.baseline)?;
        let lines = loosened.iter().map(|change| format!("loosened: {change}"));
        let blessed = format!("baseline: blessed, see {}", self.baseline.display());
        Ok((lines.chain([blessed]).collect(), true))
    }
}

fn is_of(studies: &[Finished], id: &str) -> bool {
    studies.iter().any(|study| study.header.id == *id)
}
