//! Where the studies are.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use thermobeam_study::study;
use thermobeam_study::study_file::StudyHeader;

/// A study file of the workspace.
pub(crate) struct Listed {
    pub(crate) path: PathBuf,
    pub(crate) header: StudyHeader,
}

/// The workspace: above the package that cargo runs, or else above the current folder.
pub(crate) fn root() -> Result<PathBuf, Box<dyn Error>> {
    let package = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let starts = package.into_iter().chain(env::current_dir().ok());
    let is_root = |folder: &Path| folder.join("Cargo.toml").is_file() && folder.join("studies").is_dir();
    let above = |start: PathBuf| start.ancestors().find(|folder| is_root(folder)).map(Path::to_owned);
    starts
        .into_iter()
        .find_map(above)
        .ok_or_else(|| "found no folder with Cargo.toml and studies/ here or above".into())
}

/// All studies of the workspace, by id.
pub(crate) fn studies(root: &Path) -> Result<Vec<Listed>, Box<dyn Error>> {
    let folder = root.join("studies");
    let paths = toml_files(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let headers = study::headers(&paths)?;
    let mut listed: Vec<Listed> =
        paths.into_iter().zip(headers).map(|(path, header)| Listed { path, header }).collect();
    listed.sort_by(|a, b| a.header.id.cmp(&b.header.id));
    Ok(listed)
}

fn toml_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = entries.collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    // Complaints name files as they are seen from where the command is given.
    let here = env::current_dir().unwrap_or_default();
    Ok(paths.iter().map(|path| path.strip_prefix(&here).unwrap_or(path).to_owned()).collect())
}
