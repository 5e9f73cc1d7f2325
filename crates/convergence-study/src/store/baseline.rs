//! The baseline: numbers of an earlier run that a new one must reproduce, each within its tolerance.
//!
//! The file is `studies/baseline.json`: it says what is expected, so it lives beside the claims, not among the files that a run
//! writes. Only a blessing changes it. Numbers have all their digits.
//!
//! ```json
//! { "schema": 1, "studies": { "heat-equation-space": { "error l2, n = 64": { "value": 4.4e-8, "tolerance": 0.001 } } } }
//! ```
//!
//! The baseline can only make a run worse: studies are judged on their own first, and a run that did not pass is not blessed.

mod change;

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::store::{atomic, regular};
use crate::text::visible;

pub use change::{Change, Movement};

/// Version of the file's form.
const SCHEMA: u32 = 1;

/// The committed numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    schema: u32,
    /// Sorted by id and name, so that a blessing changes only the lines that moved.
    studies: BTreeMap<String, BTreeMap<String, Guarded>>,
}

/// A guarded number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guarded {
    /// Its value; `null`, which meets nothing, is read as NaN.
    #[serde(deserialize_with = "null_is_nan")]
    pub value: f64,
    /// The relative change that is tolerated.
    #[serde(deserialize_with = "null_is_nan")]
    pub tolerance: f64,
}

fn null_is_nan<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// A baseline that cannot be read or written.
#[derive(Debug, Error)]
pub enum BaselineError {
    /// The file cannot be read or written.
    #[error("{}: {error}", visible::path(.path))]
    File {
        /// The file.
        path: PathBuf,
        /// What was wrong.
        error: io::Error,
    },
    /// Not the form of a baseline.
    #[error("{}: {}; restore it, or remove it and run `verify --bless`", visible::path(.path), visible::visible(&.error.to_string()))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What was wrong, with line and column.
        error: serde_json::Error,
    },
    /// Written for another version of the harness.
    #[error("{}: schema: found {found}; allowed is {SCHEMA}", visible::path(.path))]
    Schema {
        /// The file.
        path: PathBuf,
        /// The version found.
        found: u32,
    },
}

/// Why a run was not taken for the baseline.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Refusal {
    /// A study does not pass.
    #[error("not blessed: the verdict on `{study}` is {verdict}, and a baseline is made of runs that pass")]
    NotPassing {
        /// The first such study.
        study: String,
        /// Its verdict.
        verdict: Verdict,
    },
    /// A guarded number is not finite, or its tolerance is no tolerance: no later run could meet it.
    #[error("not blessed: `{name}` of `{study}` is {value} with a tolerance of {tolerance}, which no run can meet")]
    NotComparable {
        /// The study.
        study: String,
        /// The quantity.
        name: String,
        /// Its value.
        value: f64,
        /// Its tolerance.
        tolerance: f64,
    },
}

impl Default for Baseline {
    fn default() -> Self {
        Self { schema: SCHEMA, studies: BTreeMap::new() }
    }
}

impl Baseline {
    /// Reads the file. One that is not there is empty: every number is then new.
    ///
    /// # Errors
    /// [`BaselineError`] where there is a file that is not a baseline.
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let text = match regular::read_to_string(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => return Err(BaselineError::File { path: path.to_owned(), error }),
            Ok(text) => text,
        };
        let baseline: Self =
            serde_json::from_str(&text).map_err(|error| BaselineError::Malformed { path: path.to_owned(), error })?;
        if baseline.schema == SCHEMA {
            Ok(baseline)
        } else {
            Err(BaselineError::Schema { path: path.to_owned(), found: baseline.schema })
        }
    }

    /// Writes the file, as a whole or not at all.
    ///
    /// # Errors
    /// [`BaselineError::File`].
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        let text = crate::store::record::json(self).map_err(io::Error::from);
        text.and_then(|text| atomic::write(path, text))
            .map_err(|error| BaselineError::File { path: path.to_owned(), error })
    }

    /// Every guarded number of these studies that is not what it was: moved, new or vanished.
    ///
    /// * `known`: the ids of all studies that there are, run or not. A study of the baseline that is not among
    ///   them has vanished; `None` where only a selection is of interest.
    pub fn compare(&self, finished: &[Finished], known: Option<&BTreeSet<String>>) -> Vec<Change> {
        let none = BTreeMap::new();
        let mut changes = Vec::new();
        for Finished { header, outcome, .. } in finished {
            let expected = self.studies.get(&header.id).unwrap_or(&none);
            changes.extend(change::between(&header.id, expected, &outcome.quantities));
        }
        let vanished = self.studies.iter().filter(|(id, _)| known.is_some_and(|known| !known.contains(*id)));
        vanished.for_each(|(id, expected)| changes.extend(change::between(id, expected, &[])));
        changes
    }

    /// Takes the numbers of these studies that have moved, or are new, for the baseline; all others keep their digits.
    ///
    /// * `known`: as for [`Baseline::compare`]; studies that have vanished are forgotten.
    ///
    /// # Errors
    /// [`Refusal`], and the baseline stays as it was.
    pub fn bless(&mut self, finished: &[Finished], known: Option<&BTreeSet<String>>) -> Result<(), Refusal> {
        finished.iter().try_for_each(acceptable)?;
        for Finished { header, outcome, .. } in finished {
            let former = self.studies.remove(&header.id).unwrap_or_default();
            // A number that has not moved keeps its digits: a blessing changes what it is asked to change.
            let guarded = outcome.quantities.iter().map(|quantity| {
                let kept = former.get(&quantity.name).filter(|former| change::holds(former, quantity)).copied();
                let new = Guarded { value: quantity.value, tolerance: quantity.tolerance };
                (quantity.name.clone(), kept.unwrap_or(new))
            });
            self.studies.insert(header.id.clone(), guarded.collect());
        }
        self.studies.retain(|id, guarded| !guarded.is_empty() && known.is_none_or(|known| known.contains(id)));
        Ok(())
    }

    /// Number of guarded numbers of a study.
    pub fn guards(&self, id: &str) -> usize {
        self.studies.get(id).map_or(0, BTreeMap::len)
    }
}

fn acceptable(Finished { header, outcome, .. }: &Finished) -> Result<(), Refusal> {
    let study = header.id.clone();
    if outcome.verdict != Verdict::Pass {
        return Err(Refusal::NotPassing { study, verdict: outcome.verdict });
    }
    let meets_nothing =
        outcome.quantities.iter().find(|quantity| !change::meets(quantity.value, quantity.value, quantity.tolerance));
    match meets_nothing {
        None => Ok(()),
        Some(quantity) => Err(Refusal::NotComparable {
            study,
            name: quantity.name.clone(),
            value: quantity.value,
            tolerance: quantity.tolerance,
        }),
    }
}
