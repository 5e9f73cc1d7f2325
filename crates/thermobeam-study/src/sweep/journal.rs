//! The folder of a sweep: the identity of the sweep, the completed cases, and finally the results
//! in order.
//!
//! | file | holds |
//! | --- | --- |
//! | `sweep.json` | identifies the sweep, its share, the number of cases: a [`Manifest`] |
//! | `journal.jsonl` | a line for each completed case, in the order of completion; removed at the end |
//! | `results.jsonl` | the same lines in the order of the cases, once all are completed |
//!
//! One call of the operating system writes the lines of a group of cases as soon as these are
//! completed. A process that is killed loses its running cases and leaves at most one incomplete
//! line, which the next process removes.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::lines::{self, LinePosition};
use super::{CaseLine, Sweep, SweepError, SweepShare};
use convergence_study::internal::store::atomic;

/// Identifies the sweep of the folder.
const MANIFEST: &str = "sweep.json";

/// Maximum number of missing cases in a message.
const LISTED: usize = 10;

/// Lines in the order of completion.
const JOURNAL: &str = "journal.jsonl";

/// Lines in the order of the cases: the result.
pub const RESULTS: &str = "results.jsonl";

/// Identifies the sweep to which a folder of results belongs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// The sweep's name.
    pub sweep: String,
    /// Hash of sweep file and scene.
    pub fingerprint: String,
    /// Version of the program: another version may compute other bits.
    pub version: String,
    /// Cases of the whole sweep.
    pub cases: usize,
    /// The share, such as `3/8`.
    pub share: String,
}

impl Manifest {
    /// The manifest of a share of a sweep.
    pub fn new(sweep: &Sweep, share: SweepShare) -> Self {
        Self {
            sweep: sweep.name.clone(),
            fingerprint: format!("{:016x}", sweep.fingerprint()),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            cases: sweep.cases(),
            share: share.to_string(),
        }
    }

    /// The error for a file that is not the manifest of a sweep.
    fn damaged(path: &Path, reason: &str) -> SweepError {
        SweepError::damaged(path, format!("expected the manifest of a sweep: {reason}"))
    }

    /// Reads the manifest of a folder; `None` if there is none.
    fn read(folder: &Path) -> Result<Option<Self>, SweepError> {
        let path = folder.join(MANIFEST);
        match std::fs::read(&path) {
            Ok(bytes) => {
                let manifest: Self = serde_json::from_slice(&bytes)
                    .map_err(|error| Self::damaged(&path, &error.to_string()))?;
                // Messages quote it, and control characters would affect the terminal.
                let texts = [
                    &manifest.sweep,
                    &manifest.fingerprint,
                    &manifest.version,
                    &manifest.share,
                ];
                match texts.iter().find(|text| text.contains(char::is_control)) {
                    Some(text) => {
                        let reason = format!("control characters in {text:?}");
                        Err(Self::damaged(&path, &reason))
                    }
                    None => Ok(Some(manifest)),
                }
            }
            Err(error)
                if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&error.kind()) =>
            {
                Ok(None)
            }
            Err(error) => Err(atomic::naming(&path)(error).into()),
        }
    }

    /// Reads the manifest of a folder that must have one.
    fn require(folder: &Path) -> Result<Self, SweepError> {
        let reason = format!("not the folder of a sweep: it has no {MANIFEST}");
        Self::read(folder)?.ok_or_else(|| SweepError::damaged(folder, reason))
    }

    /// Refuses the folder of another sweep or share.
    fn agrees(&self, expected: &Self, share: &str, folder: &Path) -> Result<(), SweepError> {
        let pairs = [
            ("the sweep", &*self.sweep, &*expected.sweep),
            (
                "the hash of sweep file and scene",
                &self.fingerprint,
                &expected.fingerprint,
            ),
            ("the program's version", &self.version, &expected.version),
            ("the share", &self.share, share),
        ];
        match pairs
            .into_iter()
            .find(|(_, found, expected)| found != expected)
        {
            None => Ok(()),
            Some((what, found, expected)) => Err(SweepError::Other {
                folder: folder.to_owned(),
                what,
                found: found.to_owned(),
                expected: expected.to_owned(),
            }),
        }
    }
}

/// An open folder, locked against other processes.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    results: PathBuf,
    file: File,
    /// Which cases are completed.
    done: Vec<bool>,
    failed: usize,
}

impl Journal {
    /// Opens the folder of a share, and creates it if necessary.
    ///
    /// * `resume`: whether to continue the work in the folder; every line must belong to a case of
    ///   this share.
    ///
    /// # Errors
    /// [`SweepError`]; nothing has been written then, unless the disk fails.
    pub fn open(
        folder: &Path,
        sweep: &Sweep,
        share: SweepShare,
        resume: bool,
    ) -> Result<Self, SweepError> {
        let manifest = &Manifest::new(sweep, share);
        let found = Manifest::read(folder)?;
        if let Some(found) = &found {
            if !resume {
                return Err(SweepError::Taken(folder.to_owned()));
            }
            found.agrees(manifest, &manifest.share, folder)?;
        }
        atomic::prepare_folder(folder)?;
        let _writing = atomic::begin_write();
        let [path, results] = [JOURNAL, RESULTS].map(|name| folder.join(name));
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let file = file.map_err(atomic::naming(&path))?;
        // A file system without locks cannot keep a second process out.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(SweepError::Busy(folder.to_owned()));
        }
        for name in [MANIFEST, RESULTS] {
            atomic::remove_leftovers(&folder.join(name))?;
        }
        if found.is_none() {
            let bytes = file.metadata().map_err(atomic::naming(&path))?.len();
            if bytes > 0 {
                let reason =
                    format!("expected {MANIFEST} beside it, which names the sweep; found none");
                return Err(SweepError::damaged(&path, reason));
            }
            atomic::write(
                &folder.join(MANIFEST),
                serde_json::to_string(manifest).map_err(std::io::Error::from)? + "\n",
            )?;
        }
        let mut journal = Self {
            path,
            results,
            file,
            done: vec![false; manifest.cases],
            failed: 0,
        };
        journal.read_done(sweep, share)?;
        Ok(journal)
    }

    /// Reads which cases are completed, and removes an incomplete last line.
    fn read_done(&mut self, sweep: &Sweep, share: SweepShare) -> Result<(), SweepError> {
        let is_complete = self.results.exists();
        let source = if is_complete {
            &self.results
        } else {
            &self.path
        };
        let (places, end) = lines::places(
            std::slice::from_ref(source),
            self.done.len(),
            |place, line| check_share(sweep, share, place, line),
        )?;
        // A process killed after writing the results leaves a journal; the results contain all of
        // it.
        self.file
            .set_len(if is_complete { 0 } else { end })
            .map_err(atomic::naming(&self.path))?;
        for place in &places {
            self.count(place.case, place.passed);
        }
        Ok(())
    }

    fn count(&mut self, case: usize, passed: bool) {
        self.done[case] = true;
        self.failed += usize::from(!passed);
    }

    /// Whether a case is completed.
    pub fn has(&self, case: usize) -> bool {
        self.done[case]
    }

    /// Number of failed cases so far.
    pub fn failed(&self) -> usize {
        self.failed
    }

    /// Appends a line. After the return, killing the process no longer loses it.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn append(&mut self, line: &CaseLine) -> Result<(), std::io::Error> {
        let whole = format!("{}\n", line.json);
        let _writing = atomic::begin_write();
        self.file
            .write_all(whole.as_bytes())
            .map_err(atomic::naming(&self.path))?;
        self.count(line.case, line.passed);
        Ok(())
    }

    /// Writes the results in the order of their cases, and removes the journal.
    ///
    /// # Errors
    /// [`SweepError`]; the journal remains.
    pub fn finish(self) -> Result<PathBuf, SweepError> {
        let both = [&self.results, &self.path].map(PathBuf::clone);
        let files: Vec<PathBuf> = both.into_iter().filter(|file| file.exists()).collect();
        let (places, _) = lines::places(&files, self.done.len(), |_, _| Ok(()))?;
        lines::copy(&places, &files, &self.results)?;
        std::fs::remove_file(&self.path).map_err(atomic::naming(&self.path))?;
        Ok(self.results)
    }
}

/// The result of [`merge`].
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Merged {
    /// Cases of the sweep.
    pub cases: usize,
    /// Number of failed cases.
    pub failed: usize,
    /// The file with a line for each case.
    pub results: PathBuf,
}

/// Refuses a line of another sweep, or of a case outside the share.
fn check_share(
    sweep: &Sweep,
    share: SweepShare,
    place: &LinePosition,
    line: &[u8],
) -> Result<(), String> {
    let case = sweep.case(place.case);
    place.is_of(line, &case)?;
    if share.holds(case.hash()) {
        Ok(())
    } else {
        let index = place.case;
        Err(format!(
            "expected a case of the share {share}, found {index}"
        ))
    }
}

/// The file with the lines of a folder: its results, or its journal if it has not finished.
fn source_of_lines(folder: &Path) -> PathBuf {
    let [results, journal] = [RESULTS, JOURNAL].map(|name| folder.join(name));
    if results.exists() { results } else { journal }
}

/// Joins the shares in `folders` into [`RESULTS`] in the folder `out`, the file that a single run
/// would have written.
///
/// # Errors
/// [`SweepError`]: folders of different sweeps, a missing or repeated case, `out` among `folders`,
/// a file that cannot be read or written. Nothing is written then.
pub fn merge(folders: &[PathBuf], out: &Path) -> Result<Merged, SweepError> {
    let manifests = folders
        .iter()
        .map(|folder| Manifest::require(folder))
        .collect::<Result<Vec<_>, _>>()?;
    if let Ok(place) = out.canonicalize()
        && let Some(share) = folders
            .iter()
            .find(|share| share.canonicalize().is_ok_and(|share| share == place))
    {
        return Err(SweepError::Other {
            folder: share.clone(),
            what: "another folder",
            expected: "for the joined results".to_owned(),
            found: "that of a share".to_owned(),
        });
    }
    let results = out.join(RESULTS);
    let Some(first) = manifests.first() else {
        return Ok(Merged {
            cases: 0,
            failed: 0,
            results,
        });
    };
    for (folder, manifest) in folders.iter().zip(&manifests) {
        manifest.agrees(first, &manifest.share, folder)?;
    }
    let files: Vec<PathBuf> = folders
        .iter()
        .map(|folder| source_of_lines(folder))
        .collect();
    let (places, _) = lines::places(&files, first.cases, |_, _| Ok(()))?;
    let shares: Vec<&str> = manifests
        .iter()
        .map(|manifest| manifest.share.as_str())
        .collect();
    none_missing(&places, first.cases, &shares.join(", "))?;
    atomic::prepare_folder(out)?;
    lines::copy(&places, &files, &results)?;
    Ok(Merged {
        cases: places.len(),
        failed: places.iter().filter(|place| !place.passed).count(),
        results,
    })
}

/// Refuses sorted places unless every case has one.
fn none_missing(found: &[LinePosition], cases: usize, shares: &str) -> Result<(), SweepError> {
    if found.len() == cases {
        return Ok(());
    }
    let mut present = found.iter().map(|place| place.case).peekable();
    let missing: Vec<String> = (0..cases)
        .filter(|case| present.next_if_eq(case).is_none())
        .take(LISTED)
        .map(|case| case.to_string())
        .collect();
    let count = cases - found.len();
    let more = if count > missing.len() {
        format!(" and {} more", count - missing.len())
    } else {
        String::new()
    };
    Err(SweepError::Missing {
        count,
        cases,
        named: missing.join(", ") + &more,
        shares: shares.to_owned(),
    })
}
