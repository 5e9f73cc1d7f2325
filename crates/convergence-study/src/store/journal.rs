//! The journal of runs: a file that the user names, to which every run appends one line of JSON.
//!
//! A line says when and at which revision the run was, and of every study its verdict, rates, finest errors and cost. It is appended as a whole, with the file
//! locked; what a killed run has left unfinished stays a line of its own.

use std::fs::OpenOptions;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::record::Errors;
use super::record::form::null_is_nan;
use super::{atomic, regular, writing};
use crate::judge::verdict::{RateVerdict, Verdict};
use crate::run::Finished;
use crate::store::provenance::{Provenance, is_none};
use crate::text::visible;

/// Version of a line's form.
const SCHEMA: u32 = 1;

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Version of the form.
    pub schema: u32,
    /// Its end, in seconds since 1970.
    pub finished_at: Option<u64>,
    /// Git revision of the working tree.
    pub git_revision: Option<String>,
    /// Whether the working tree differed from that revision.
    pub git_modified: Option<bool>,
    /// What was run, as a command.
    pub command: String,
    /// The verdict on the run, changes against the baseline included.
    pub verdict: Verdict,
    /// Its studies.
    pub studies: Vec<StudyRun>,
}

/// One study of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StudyRun {
    /// Its id.
    pub id: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// The rates that were judged.
    pub rates: Vec<RateRun>,
    /// Each error on the finest level that has it.
    pub errors: Errors,
    /// Time over all threads.
    #[serde(deserialize_with = "null_is_nan")]
    pub busy_seconds: f64,
    /// Cases whose results were kept from an earlier run.
    #[serde(default, skip_serializing_if = "is_none")]
    pub kept_cases: usize,
}

/// A rate of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RateRun {
    /// The norm.
    pub norm: String,
    /// What theory says.
    #[serde(deserialize_with = "null_is_nan")]
    pub order: f64,
    /// What was observed.
    pub fitted: Option<f64>,
}

/// A journal that cannot be read or appended to.
#[derive(Debug, Error)]
pub enum JournalError {
    /// The file cannot be read or written.
    #[error("{}: {error}", visible::path(.path))]
    File {
        /// The file.
        path: PathBuf,
        /// What was wrong.
        error: io::Error,
    },
    /// A line that no run has written.
    #[error("{}:{line}: {}; expected a line as `--journal` appends it; remove the line", visible::path(.path), visible::visible(.found))]
    Line {
        /// The file.
        path: PathBuf,
        /// The number of the line, from 1.
        line: usize,
        /// What was wrong.
        found: String,
    },
    /// No line at all.
    #[error("{}: found no run; expected at least one line as `--journal` appends it", visible::path(.path))]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

impl Run {
    /// The line of a run.
    pub fn new(origin: Provenance, verdict: Verdict, finished: &[Finished]) -> Self {
        Self {
            schema: SCHEMA,
            finished_at: origin.finished_at,
            git_revision: origin.git_revision,
            git_modified: origin.git_modified,
            command: origin.command,
            verdict,
            studies: finished.iter().map(StudyRun::new).collect(),
        }
    }
}

impl StudyRun {
    fn new(Finished { header, outcome, spent, .. }: &Finished) -> Self {
        let mut errors: Vec<(String, f64)> = vec![];
        for (name, error) in outcome.levels.iter().rev().flat_map(|level| &level.errors) {
            if !errors.iter().any(|(known, _)| known == name) {
                errors.push((name.clone(), *error));
            }
        }
        let rate = |(norm, rate): &(String, RateVerdict)| RateRun {
            norm: norm.clone(),
            order: rate.order,
            fitted: rate.fitted,
        };
        Self {
            id: header.id.clone(),
            verdict: outcome.verdict,
            rates: outcome.rates.iter().map(rate).collect(),
            errors: Errors(errors),
            busy_seconds: spent.busy.as_secs_f64(),
            kept_cases: spent.kept,
        }
    }
}

/// Proves that a line could be appended, and changes nothing; to be called before the run.
///
/// # Errors
/// [`JournalError::File`].
pub fn check(path: &Path) -> Result<(), JournalError> {
    let tried = match regular::open(path, OpenOptions::new().append(true)) {
        // A link that leads nowhere is no missing file: nothing can be made beside what it leads to.
        Err(error) if error.kind() == io::ErrorKind::NotFound && !path.is_symlink() => atomic::probe(path),
        tried => tried.map(drop),
    };
    tried.map_err(|error| JournalError::File { path: path.to_owned(), error })
}

/// Appends the line of a run; a file that is not there is made.
///
/// # Errors
/// [`JournalError::File`].
pub fn append(path: &Path, run: &Run) -> Result<(), JournalError> {
    let tried = serde_json::to_string(run).map_err(io::Error::from).and_then(|line| append_line(path, &line));
    tried.map_err(|error| JournalError::File { path: path.to_owned(), error })
}

fn append_line(path: &Path, line: &str) -> io::Result<()> {
    let _writing = writing::begin();
    let mut file = regular::open(path, OpenOptions::new().read(true).append(true).create(true))?;
    file.lock()?;
    let mut last = [b'\n'];
    if file.seek(SeekFrom::End(0))? > 0 {
        file.seek(SeekFrom::End(-1))?;
        file.read_exact(&mut last)?;
    }
    let gap = if last == [b'\n'] { "" } else { "\n" };
    file.write_all(format!("{gap}{line}\n").as_bytes())?;
    file.sync_all()
}

/// Reads all lines, oldest first.
///
/// # Errors
/// [`JournalError`], for the first line that is damaged.
pub fn read(path: &Path) -> Result<Vec<Run>, JournalError> {
    let text = regular::read(path).map_err(|error| JournalError::File { path: path.to_owned(), error })?;
    let mut runs = vec![];
    for (index, line) in text.split(|byte| *byte == b'\n').enumerate().filter(|(_, line)| !line.trim_ascii().is_empty())
    {
        let damaged = |found: String| JournalError::Line { path: path.to_owned(), line: index + 1, found };
        let run: Run = serde_json::from_slice(line).map_err(|error| damaged(error.to_string()))?;
        if run.schema != SCHEMA {
            return Err(damaged(format!("schema: found {}; expected {SCHEMA}", run.schema)));
        }
        runs.push(run);
    }
    if runs.is_empty() { Err(JournalError::Empty { path: path.to_owned() }) } else { Ok(runs) }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_journal_that_cannot_be_made_is_refused_and_nothing_is_left() {
        let folder = tempfile::tempdir().unwrap();
        check(&folder.path().join("runs.jsonl")).unwrap();
        for name in ["none/runs.jsonl".to_owned(), "x".repeat(300)] {
            let message = check(&folder.path().join(&name)).unwrap_err().to_string();
            assert!(message.contains(&name), "{message}");
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
