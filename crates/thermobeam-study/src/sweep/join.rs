//! Merging the shares of a sweep.

use std::path::{Path, PathBuf};

use convergence_study::store::atomic;

use super::SweepError;
use super::journal::{JOURNAL, Manifest, RESULTS};
use super::lines::{self, Place};

/// Numbers of missing cases that are listed.
const LISTED: usize = 10;

/// What [`merge`] has joined.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Merged {
    /// Cases of the sweep.
    pub cases: usize,
    /// Those of them that failed.
    pub failed: usize,
    /// The file with a line for each.
    pub results: PathBuf,
}

/// Joins the shares in `folders` into the file that one run would have written, [`RESULTS`] in the folder `out`.
///
/// # Errors
/// [`SweepError`]: folders of different sweeps, a missing or repeated case, a file that cannot be read or written. Nothing
/// is written then.
pub fn merge(folders: &[PathBuf], out: &Path) -> Result<Merged, SweepError> {
    let manifests = folders.iter().map(|folder| Manifest::require(folder)).collect::<Result<Vec<_>, _>>()?;
    let results = out.join(RESULTS);
    let Some(first) = manifests.first() else { return Ok(Merged { cases: 0, failed: 0, results }) };
    for (folder, manifest) in folders.iter().zip(&manifests) {
        manifest.agrees_but_for_share(first, folder)?;
    }
    let files: Vec<PathBuf> = folders
        .iter()
        .map(|folder| [RESULTS, JOURNAL].map(|name| folder.join(name)))
        .map(|[results, journal]| if results.exists() { results } else { journal })
        .collect();
    let mut found = vec![];
    for (index, file) in files.iter().enumerate() {
        found.extend(lines::places(file, index, first.cases, |_, _| Ok(()))?.0);
    }
    lines::sort(&mut found, &files)?;
    let shares: Vec<&str> = manifests.iter().map(|manifest| manifest.share.as_str()).collect();
    none_missing(&found, first.cases, &shares.join(", "))?;
    atomic::prepare_folder(out)?;
    lines::copy(&found, &files, &results)?;
    Ok(Merged { cases: found.len(), failed: found.iter().filter(|place| !place.passed).count(), results })
}

/// Refuses sorted places without one for every case.
fn none_missing(found: &[Place], cases: usize, shares: &str) -> Result<(), SweepError> {
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
    let more = if count > missing.len() { format!(" and {} more", count - missing.len()) } else { String::new() };
    Err(SweepError::Missing { count, cases, named: missing.join(", ") + &more, shares: shares.to_owned() })
}
