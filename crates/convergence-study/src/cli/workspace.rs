//! The workspace: its studies, and what earlier runs have left in it: their records, and the times of the last one.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{env, fs, io};

use super::exit::Unusable;
use super::output;
use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::store::provenance::Provenance;
use crate::store::record::Record;
use crate::store::regular;
use crate::study::StudyFile;
use crate::text::visible;

/// The folder of the project: the nearest one with `studies/`, here or above.
///
/// # Errors
/// If there is no such folder.
pub fn root() -> Result<PathBuf, Unusable> {
    let here = env::current_dir()?;
    let root = here.ancestors().find(|folder| folder.join("studies").is_dir());
    root.map(Path::to_owned).ok_or_else(|| {
        Unusable::because(
            "expected a folder studies/, here or above; found none (`study FILE` runs a file from anywhere)",
        )
    })
}

/// All studies of the workspace, by id.
///
/// # Errors
/// A folder that cannot be listed, and the first file that is not a study.
pub fn studies(project: &Project, root: &Path) -> Result<Vec<StudyFile>, Unusable> {
    let folder = root.join("studies");
    let paths = toml_files(&folder).map_err(|error| Unusable::file(&folder, &error))?;
    let mut files = StudyFile::read_all(project.kinds, &paths)?;
    files.sort_by(|a, b| a.study.header().id.cmp(&b.study.header().id));
    Ok(files)
}

/// Warns on standard error about files that hold a study but are not run, because their extension is not `toml`.
pub fn warn_of_near_names(root: &Path) {
    let entries = fs::read_dir(root.join("studies")).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_study = |path: &PathBuf| {
        let text = regular::read_to_string(path).unwrap_or_default();
        text.lines().any(|line| line.split('#').next().is_some_and(|line| line.trim() == "[study]"))
    };
    let mut paths: Vec<PathBuf> = entries.filter(|path| has_near_extension(path) && is_study(path)).collect();
    paths.sort();
    for path in paths {
        let name = visible::path(path.strip_prefix(root).unwrap_or(&path));
        output::tell(&format!("warning: {name}: a study that is not run; expected a name that ends in .toml"));
    }
}

/// Whether the extension is almost `toml`: capitals, one wrong letter, or something after it.
fn has_near_extension(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_toml = path.extension().is_some_and(|extension| extension == "toml");
    !is_toml && [".toml", ".tml", ".tom", ".toml.txt", ".toml~"].iter().any(|end| name.ends_with(end))
}

/// The readable study files of a folder, for looking one up by its id.
pub fn readable_studies(project: &Project, folder: &Path) -> Vec<StudyFile> {
    let paths = toml_files(folder).unwrap_or_default();
    paths.iter().filter_map(|path| StudyFile::read(project.kinds, path).ok()).collect()
}

fn toml_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = entries.collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    // Messages name files relative to the current folder.
    let here = env::current_dir().unwrap_or_default();
    Ok(paths.iter().map(|path| path.strip_prefix(&here).unwrap_or(path).to_owned()).collect())
}

/// Where `verify` leaves its records, below the workspace; of two equally old ones the later in this list counts.
const RECORDS: [&str; 3] = ["reports/full/results.json", "reports/results.json", "reports/local/partial/results.json"];

/// Where `verify` leaves the times of its last run.
const TIMES: &str = "reports/local/provenance.json";

/// All existing records, the newest last.
pub(super) fn records(root: &Path) -> Result<Vec<Record>, Unusable> {
    let mut records: Vec<(SystemTime, Record)> = vec![];
    for path in RECORDS.map(|path| root.join(path)).iter().filter(|path| is_there(path)) {
        let written = fs::metadata(path).and_then(|data| data.modified());
        records.push((written.map_err(|error| Unusable::file(path, &error))?, Record::read(path)?));
    }
    // The sort is stable, so the order of RECORDS decides between equals.
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
    /// Reads the existing records and times.
    ///
    /// # Errors
    /// A file that exists but cannot be read, or is not a record.
    pub(super) fn read(root: &Path) -> Result<Self, Unusable> {
        // A later one overwrites.
        let studies = records(root)?.into_iter().flat_map(|record| record.studies);
        let verdicts = studies.map(|study| (study.header.id, study.outcome.verdict)).collect();
        let times = Provenance::read(&root.join(TIMES))?.into_iter().flat_map(|provenance| provenance.studies);
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

/// Whether anything exists at that path, readable or not.
fn is_there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}
