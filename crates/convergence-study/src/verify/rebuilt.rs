//! Reports on studies that have run and on records, without running anything.

use std::path::{Path, PathBuf};

use super::{Reports, VerificationError, verdict};
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::Findings;
use crate::run::{self, Finished};
use crate::store::{Provenance, Record, diagnosis::diagnose};

/// Writes a report on studies that have run, without a baseline.
///
/// * `folder`: the report is its `README.md` and `index.html`; missing folders are made.
pub fn write_report(
    project: &Project,
    finished: &[Finished],
    folder: &Path,
) -> Result<(), VerificationError> {
    publish(
        project,
        record(finished, project.command),
        run::available().get(),
        folder,
    )
}

/// The record of studies that have run without a baseline.
///
/// * `command`: the command that ran them.
pub(crate) fn record(finished: &[Finished], command: &str) -> Record {
    Record {
        diagnosis: diagnose(finished, &[]),
        ..Record::new(
            "files",
            command,
            verdict(finished, &[]),
            None,
            finished.to_vec(),
        )
    }
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
    let here = Provenance::collect(
        Path::new("."),
        record.command.clone(),
        jobs,
        &record.studies,
    );
    rebuild(project, record, Some(&here), folder).map(drop)
}

/// Writes the report on a record, without running its studies. In a folder of reports it is the
/// report of that record's scope. Returns where the report is.
///
/// * `provenance`: where the run comes from, if known.
pub(crate) fn rebuild(
    project: &Project,
    record: Record,
    provenance: Option<&Provenance>,
    folder: &Path,
) -> Result<PathBuf, VerificationError> {
    let record = record.committed();
    let reports = Reports::around(folder, &record.scope);
    let _lock = reports.lock()?;
    let is_accepted = record.verdict == Verdict::Pass;
    let see_also = reports.see_also(&record.scope);
    let findings = Findings {
        project,
        record: &record,
        see_also: see_also.filter(|_| is_accepted),
        provenance,
    };
    let files = findings.files();
    let files = files.map_err(|error| reports.unwritable(&error))?;
    reports.publish(&files, is_accepted)?;
    Ok(reports.folder(is_accepted).to_owned())
}
