//! Reports on studies that have run and on records, without running anything.

use std::path::{Path, PathBuf};

use super::destination::{Destination, scopes, tiers};
use super::folder::{lock_file, reports_around, unwritable};
use super::{VerificationError, verdict};
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::report::Findings;
use crate::run::{self, Finished};
use crate::store::{Provenance, Record, ReportFolder, diagnosis::diagnose, lock};

/// Writes a report on studies that have run, without a baseline.
///
/// * `folder`: the report is its `README.md` and `index.html`; missing folders are made.
pub fn report(
    project: &Project,
    finished: &[Finished],
    folder: &Path,
) -> Result<(), VerificationError> {
    publish(
        project,
        record(project, finished, project.command),
        run::available().get(),
        folder,
    )
}

/// The record of studies that have run without a baseline.
///
/// * `command`: the command that ran them.
pub(crate) fn record(project: &Project, finished: &[Finished], command: &str) -> Record {
    let diagnosis = diagnose(project, finished, &[]);
    Record {
        diagnosis,
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
pub fn publish(
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
    let publish = || {
        let reports = reports_around(folder);
        let _lock = lock(&lock_file(&reports))?;
        let rebuilt = ReportFolder {
            folder: folder.to_owned(),
            workshop: reports.join("local/workshop/rebuilt"),
        };
        let is_accepted = record.verdict == Verdict::Pass;
        let own = scopes()
            .into_iter()
            .find(|scope| scope.report_folder(&reports).folder == folder);
        let destination = own.map_or(
            Destination::One {
                target: rebuilt,
                failing: None,
            },
            |scope| {
                // Only a run of the tier is one that the folder of the tier waits for.
                let is_other = scope.name() != record.scope;
                Destination::new(&scope, &reports, is_accepted || is_other)
            },
        );
        let see_also = destination.see_also(&record);
        let findings = Findings {
            project,
            record: &record,
            see_also,
            provenance,
        };
        destination.publish(findings.files()?, &tiers(&reports))?;
        Ok(destination.folder().to_owned())
    };
    Ok(publish().map_err(unwritable(folder))?)
}
