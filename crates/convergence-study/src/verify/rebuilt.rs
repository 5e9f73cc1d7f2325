//! Reports on studies that have run and on records, without running anything.

use std::path::{Path, PathBuf};

use super::{Reports, VerificationError, judged};
use crate::project::Project;
use crate::report::Findings;
use crate::run::{self, Finished};
use crate::store::{Provenance, Record, atomic, refuse_other_files};

impl Project {
    /// Writes a report on studies that have run, without a baseline.
    ///
    /// * `folder`: the report is its `README.md` and `index.html`; missing folders are made.
    ///
    /// # Errors
    /// A folder or a file that cannot be written.
    pub fn write_report(
        &self,
        finished: &[Finished],
        folder: &Path,
    ) -> Result<(), VerificationError> {
        let record = record(finished, self.command);
        publish(self, record, run::available().get(), folder)
    }
}

/// The record of studies that have run without a baseline.
///
/// * `command`: the command that ran them.
pub(crate) fn record(finished: &[Finished], command: &str) -> Record {
    judged("files", command, finished.to_vec(), None)
}

/// Writes the report on them into a separate folder; missing folders are made.
///
/// * `jobs`: number of threads that ran them.
pub(crate) fn publish(
    project: &Project,
    record: Record,
    jobs: usize,
    folder: &Path,
) -> Result<(), VerificationError> {
    let here = Provenance::collect(Path::new("."), &record, jobs);
    rebuild(project, record, Some(&here), true, folder).map(drop)
}

/// Writes the report on a record, without running its studies. In a folder of reports it is the
/// report of that record's scope. Returns where the report is.
///
/// * `provenance`: where the run comes from, if known.
/// * `has_titles`: whether the picture of the rates has a title; those of the record stay.
pub(crate) fn rebuild(
    project: &Project,
    record: Record,
    provenance: Option<&Provenance>,
    has_titles: bool,
    folder: &Path,
) -> Result<PathBuf, VerificationError> {
    refuse_other_files(folder)?;
    let record = record.committed();
    let reports = Reports::around(folder, &record.scope);
    let _lock = reports.lock()?;
    let files = reports.files(Findings {
        provenance,
        has_titles,
        ..Findings::of(project, &record)
    })?;
    let _writing = atomic::begin_write();
    reports.beside(&files, record.verdict)?.place()?;
    Ok(reports.folder(record.verdict).to_owned())
}
