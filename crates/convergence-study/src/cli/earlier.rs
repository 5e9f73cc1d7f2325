//! What earlier runs have left: their records, and the times of the last one.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::time::SystemTime;

use super::exit::Unusable;
use crate::judge::verdict::Verdict;
use crate::store::provenance::Provenance;
use crate::store::record::Record;

/// Where `verify` leaves its records, below the workspace; of two of the same age the later one counts.
const RECORDS: [&str; 3] = ["reports/full/results.json", "reports/results.json", "reports/local/partial/results.json"];

/// Where `verify` leaves the times of its last run.
const TIMES: &str = "reports/local/provenance.json";

/// All records that there are, the newest last.
///
/// # Errors
/// As [`Earlier::read`].
pub(super) fn records(root: &Path) -> Result<Vec<Record>, Unusable> {
    let mut records: Vec<(SystemTime, Record)> = vec![];
    for path in RECORDS.map(|path| root.join(path)).iter().filter(|path| is_there(path)) {
        let written = fs::metadata(path).and_then(|data| data.modified());
        records.push((written.map_err(|error| Unusable::file(path, &error))?, Record::read(path)?));
    }
    // Stable, so that the order of RECORDS decides between equals.
    records.sort_by_key(|(written, _)| *written);
    Ok(records.into_iter().map(|(_, record)| record).collect())
}

/// By study.
#[derive(Debug, Default)]
pub(super) struct Earlier {
    verdicts: HashMap<String, Verdict>,
    seconds: HashMap<String, f64>,
}

impl Earlier {
    /// Reads what there is.
    ///
    /// # Errors
    /// A file that is there and cannot be read, or is no record.
    pub(super) fn read(root: &Path) -> Result<Self, Unusable> {
        // A later one overwrites.
        let studies = records(root)?.into_iter().flat_map(|record| record.studies);
        let verdicts = studies.map(|study| (study.header.id, study.outcome.verdict)).collect();
        let times = root.join(TIMES);
        let times = Provenance::read(&times)
            .map_err(|error| Unusable::file(&times, &error))?
            .into_iter()
            .flat_map(|provenance| provenance.studies);
        let seconds = times.map(|study| (study.id, study.busy_seconds)).collect();
        Ok(Self { verdicts, seconds })
    }

    /// The verdict of the newest record that has the study.
    pub(super) fn verdict(&self, id: &str) -> Option<Verdict> {
        self.verdicts.get(id).copied()
    }

    /// Its time over all threads, if it was in the last run on this machine.
    pub(super) fn seconds(&self, id: &str) -> Option<f64> {
        self.seconds.get(id).copied()
    }
}

/// Whether there is anything at that place, be it something that cannot be read.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}
