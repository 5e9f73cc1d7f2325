//! The files of a report. All that differ are written before the first of them takes its place, so
//! that a full disk changes nothing; the report in Markdown takes its place last. A run that is
//! killed between two of these moves leaves files of two runs, each of them whole, until the next
//! run; its Markdown is then the old one.
//!
//! Figures that a new report does not have are removed; no other file is. (Exchanging the whole
//! folder would lose files that others write to it meanwhile.) A lock, which the operating system
//! releases even after a crash, keeps two runs apart.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::store::{self, FIGURES, atomic, if_there};

/// The report in Markdown, whose links lead to the other files.
pub(crate) const README: &str = "README.md";

/// The files of a report by their path relative to its folder, with `/` between folders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct ReportSet {
    files: BTreeMap<String, Vec<u8>>,
}

impl ReportSet {
    /// Adds a file.
    ///
    /// # Errors
    /// A path that already exists in the set or that leads out of the folder.
    pub(crate) fn add(
        &mut self,
        path: impl Into<String>,
        bytes: impl Into<Vec<u8>>,
    ) -> io::Result<()> {
        let path = path.into();
        if !stays_inside(&path) {
            return Err(refusal(&path, "has a name that no report may have"));
        }
        // Some file systems ignore case in names.
        if self
            .files
            .keys()
            .any(|known| known.eq_ignore_ascii_case(&path))
        {
            return Err(refusal(&path, "is there twice"));
        }
        self.files.insert(path, bytes.into());
        Ok(())
    }

    /// The files: path and bytes.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files
            .iter()
            .map(|(path, bytes)| (path.as_str(), bytes.as_slice()))
    }

    /// The bytes of a file.
    pub(crate) fn get(&self, path: &str) -> Option<&Vec<u8>> {
        self.files.get(path)
    }

    /// Gives a file other content.
    pub(crate) fn replace(&mut self, path: &str, bytes: impl Into<Vec<u8>>) {
        self.files.insert(path.to_owned(), bytes.into());
    }
}

/// The error of a file that no set can hold.
fn refusal(path: &str, reason: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("the report `{path}` {reason}"),
    )
}

/// Whether a relative path leads to a file below the folder.
fn stays_inside(path: &str) -> bool {
    let mut components = Path::new(path).components();
    !path.is_empty()
        && !path.contains(|c: char| c.is_control() || matches!(c, '\\' | ':'))
        && components.all(|component| matches!(component, Component::Normal(_)))
}

/// The folder of one report, and the workshop in which its next files are prepared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ReportFolder {
    /// Where readers find the report.
    pub folder: PathBuf,
    /// A folder on the same file system, for files that are not yet in place.
    pub workshop: PathBuf,
}

/// Waits until no other process is writing reports, and keeps others waiting until the file is
/// dropped.
pub(crate) fn lock(path: &Path) -> io::Result<File> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let file = store::open(path, File::options().create(true).append(true))?;
    file.lock()?;
    Ok(file)
}

impl ReportFolder {
    /// Replaces the report by this one, and removes the figures that it does not have. The caller
    /// must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system. Unless it arises from moving files, the old report is
    /// then untouched.
    pub(crate) fn publish(&self, set: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        self.renew(set)?;
        for folder in [FIGURES.to_owned(), format!("{FIGURES}/page")] {
            for path in self.pictures(&folder)? {
                if set.get(&path).is_none() {
                    self.remove(&path)?;
                }
            }
        }
        Ok(())
    }

    /// Replaces these files of the report, or adds them; the others stay. The caller must hold the
    /// [`lock`].
    ///
    /// # Errors
    /// As [`publish`](Self::publish).
    pub(crate) fn renew(&self, files: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        self.tidy()?;
        let staging = self.staging();
        // A file that already has its new content is left alone.
        let mut changed: Vec<&str> = vec![];
        for (path, bytes) in files.files() {
            let found = if_there(store::read(&self.folder.join(path)));
            if !found.is_ok_and(|found| found.as_deref() == Some(bytes)) {
                write_new(&staging.join(path), bytes)?;
                changed.push(path);
            }
        }
        changed.sort_by_key(|path| *path == README);
        for path in changed {
            move_if_there(&staging.join(path), &self.folder.join(path))?;
        }
        remove_if_there(&staging)
    }

    /// The pictures in one of its folders, by their paths.
    fn pictures(&self, folder: &str) -> io::Result<Vec<String>> {
        let mut paths = vec![];
        for entry in if_there(fs::read_dir(self.folder.join(folder)))?
            .into_iter()
            .flatten()
        {
            let name = entry?.file_name();
            let name = name.to_str().filter(|name| name.ends_with(".svg"));
            paths.extend(name.map(|name| format!("{folder}/{name}")));
        }
        Ok(paths)
    }

    /// Removes a file, and its folder if that becomes empty. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system.
    pub(crate) fn remove(&self, path: &str) -> io::Result<()> {
        let path = self.folder.join(path);
        if_there(fs::remove_file(&path))?;
        let folders = path.ancestors().skip(1);
        for folder in folders.take_while(|folder| **folder != *self.folder) {
            // This fails if the folder is not empty; then the folder stays.
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }

    /// Removes the report with all that is in its folder. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system.
    pub(crate) fn clear(&self) -> io::Result<()> {
        remove_if_there(&self.folder)
    }

    /// Takes files of the report out of sight while a run is under way: if it is killed, no reader
    /// takes what they say for what the run has found. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system.
    pub(crate) fn set_aside(&self, paths: &[&str]) -> io::Result<()> {
        let before = self.before();
        remove_if_there(&before)?;
        paths
            .iter()
            .try_for_each(|path| move_if_there(&self.folder.join(path), &before.join(path)))
    }

    /// Puts back what [`set_aside`](Self::set_aside) has taken, for a run that ends without a
    /// result; a file that another run has written meanwhile stays. The caller must hold the
    /// [`lock`].
    ///
    /// # Errors
    /// The error of the operating system.
    pub(crate) fn put_back(&self, paths: &[&str]) -> io::Result<()> {
        let before = self.before();
        paths
            .iter()
            .map(|path| (before.join(path), self.folder.join(path)))
            .filter(|(_, place)| !place.exists())
            .try_for_each(|(aside, place)| move_if_there(&aside, &place))?;
        remove_if_there(&before)
    }

    /// Removes what a killed run has prepared or set aside. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system.
    pub(crate) fn tidy(&self) -> io::Result<()> {
        remove_if_there(&self.before())?;
        remove_if_there(&self.staging())
    }

    /// Where [`set_aside`](Self::set_aside) keeps files.
    fn before(&self) -> PathBuf {
        self.workshop.join("before")
    }

    /// Where files are written before they are moved.
    fn staging(&self) -> PathBuf {
        self.workshop.join("staging")
    }
}

fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    atomic::write_through(path, bytes)
}

fn move_if_there(from: &Path, to: &Path) -> io::Result<()> {
    if !from.exists() {
        return Ok(());
    }
    to.parent().map_or(Ok(()), fs::create_dir_all)?;
    fs::rename(from, to)
}

fn remove_if_there(folder: &Path) -> io::Result<()> {
    if_there(fs::remove_dir_all(folder)).map(|_| ())
}
