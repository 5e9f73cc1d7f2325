//! Records of earlier runs: the last verdict of each study, and its time on this machine.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::time::SystemTime;
use std::{fs, io};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::exit::Unusable;
use crate::store::regular;

/// Where `verify` leaves its records, below the workspace; of two of the same age the later one counts.
const RECORDS: [&str; 3] = ["reports/full/results.json", "reports/results.json", "reports/local/partial/results.json"];

/// Where `verify` leaves the times of its last run.
const TIMES: &str = "reports/local/provenance.json";

/// By study.
#[derive(Debug, Default)]
pub(super) struct History {
    verdicts: HashMap<String, String>,
    seconds: HashMap<String, f64>,
}

#[derive(Deserialize)]
struct Record {
    studies: Vec<StudyRecord>,
}

#[derive(Deserialize)]
struct StudyRecord {
    id: String,
    verdict: String,
}

#[derive(Deserialize)]
struct Times {
    studies: Vec<StudyTime>,
}

#[derive(Deserialize)]
struct StudyTime {
    id: String,
    busy_seconds: f64,
}

impl History {
    /// Reads what there is.
    ///
    /// # Errors
    /// A file that is there and cannot be read, or is no record.
    pub(super) fn read(root: &Path) -> Result<Self, Unusable> {
        let mut records: Vec<(SystemTime, Record)> = vec![];
        for path in RECORDS {
            records.extend(read(&root.join(path))?);
        }
        // Stable, so that the order of RECORDS decides between equals; a later one overwrites.
        records.sort_by_key(|(written, _)| *written);
        let studies = records.into_iter().flat_map(|(_, record)| record.studies);
        let verdicts = studies.map(|study| (study.id, study.verdict)).collect();
        let times: Option<(SystemTime, Times)> = read(&root.join(TIMES))?;
        let times = times.into_iter().flat_map(|(_, times)| times.studies);
        let seconds = times.map(|study| (study.id, study.busy_seconds)).collect();
        Ok(Self { verdicts, seconds })
    }

    /// The verdict of the newest record that has the study.
    pub(super) fn verdict(&self, id: &str) -> Option<&str> {
        self.verdicts.get(id).map(String::as_str)
    }

    /// Its time over all threads, if it was in the last run on this machine.
    pub(super) fn seconds(&self, id: &str) -> Option<f64> {
        self.seconds.get(id).copied()
    }
}

/// A file and when it was written; `None` where it is missing.
fn read<T: DeserializeOwned>(path: &Path) -> Result<Option<(SystemTime, T)>, Unusable> {
    let name = |error: &dyn Error| Unusable::file(path, error);
    let text = match regular::read_to_string(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        other => other.map_err(|error| name(&error))?,
    };
    let written = fs::metadata(path).and_then(|data| data.modified()).map_err(|error| name(&error))?;
    let value = serde_json::from_str(&text).map_err(|error| name(&error))?;
    Ok(Some((written, value)))
}
