//! Finds the workspace and its studies.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use super::exit::Unusable;
use super::output;
use crate::project::Project;
use crate::store::regular;
use crate::study::StudyFile;
use crate::text::visible;

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

/// Says on standard error which files of the workspace hold a study and are not run, for their extension is not `toml`.
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

/// Whether the extension is `toml` but for capitals, another letter or what follows it.
fn has_near_extension(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_toml = path.extension().is_some_and(|extension| extension == "toml");
    !is_toml && [".toml", ".tml", ".tom", ".toml.txt", ".toml~"].iter().any(|end| name.ends_with(end))
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
