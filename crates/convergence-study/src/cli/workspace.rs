//! Finds the workspace and its studies.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use super::exit::Unusable;
use crate::project::Project;
use crate::study::StudyFile;

/// The folder of the project: the nearest one with `studies/`, here or above.
///
/// # Errors
/// Where there is none.
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

/// The study files of a folder that can be read, for looking one up by its id.
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
