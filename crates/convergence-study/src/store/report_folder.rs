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

use crate::store::{self, FIGURES, ONLY_ON_PAGE, atomic, if_there};

/// The report in Markdown, whose links lead to the other files.
pub(crate) const README: &str = "README.md";

/// The files of a report that git ignores, and that browsers, programs and continuous integration
/// read: they show the newest run, whether it passes or not.
pub(crate) const NEWEST: [&str; 4] = ["index.html", "junit.xml", "results.json", "summary.md"];

/// The files of a report by their path relative to its folder, with `/` between folders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct ReportSet(pub(crate) BTreeMap<String, Vec<u8>>);

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
        let mut known = self.0.keys();
        if known.any(|known| known.eq_ignore_ascii_case(&path)) {
            return Err(refusal(&path, "is there twice"));
        }
        self.0.insert(path, bytes.into());
        Ok(())
    }

    /// Those of [`NEWEST`].
    pub(crate) fn newest(&self) -> Self {
        let files = NEWEST
            .into_iter()
            .filter_map(|path| self.0.get_key_value(path));
        Self(
            files
                .map(|(path, bytes)| (path.clone(), bytes.clone()))
                .collect(),
        )
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

/// Waits until no other process is writing reports, and keeps others waiting until the file is
/// dropped.
pub(crate) fn lock(path: &Path) -> io::Result<File> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let file = store::open(path, File::options().create(true).append(true))?;
    file.lock()?;
    Ok(file)
}

/// The folder of one report, and where its next files are prepared. Whoever changes it must hold
/// the [`lock`].
#[derive(Debug, Clone)]
pub(crate) struct ReportFolder {
    /// Where readers find the report.
    pub folder: PathBuf,
    /// A folder on the same file system, for files that are not yet in place.
    pub workshop: PathBuf,
}

impl ReportFolder {
    /// Replaces the report by this one, and removes the figures that it does not have.
    ///
    /// # Errors
    /// The error of the operating system. Unless it arises from moving files, the old report is
    /// then untouched.
    pub(crate) fn publish(&self, set: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        self.renew(set)?;
        for pictures in [FIGURES, ONLY_ON_PAGE] {
            let entries = if_there(fs::read_dir(self.folder.join(pictures)))?;
            for entry in entries.into_iter().flatten() {
                let name = entry?.file_name().to_string_lossy().into_owned();
                let path = format!("{pictures}/{name}");
                if name.ends_with(".svg") && !set.0.contains_key(&path) {
                    self.remove(&path)?;
                }
            }
        }
        Ok(())
    }

    /// Replaces these files of the report, or adds them; the others stay.
    ///
    /// # Errors
    /// As [`publish`](Self::publish).
    pub(crate) fn renew(&self, set: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        remove_folder(&self.workshop)?;
        // A file that already has its new content is left alone.
        let mut changed: Vec<&str> = vec![];
        for (path, bytes) in &set.0 {
            let found = if_there(store::read(&self.folder.join(path)));
            if !found.is_ok_and(|found| found.as_ref() == Some(bytes)) {
                let prepared = self.workshop.join(path);
                prepared.parent().map_or(Ok(()), fs::create_dir_all)?;
                atomic::write_through(&prepared, bytes)?;
                changed.push(path);
            }
        }
        changed.sort_by_key(|path| *path == README);
        for path in changed {
            let place = self.folder.join(path);
            place.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::rename(self.workshop.join(path), place)?;
        }
        remove_folder(&self.workshop)
    }

    /// Removes a file, and its folder if that becomes empty.
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
}

/// Removes a folder with all that is in it, if it exists.
pub(crate) fn remove_folder(folder: &Path) -> io::Result<()> {
    if_there(fs::remove_dir_all(folder)).map(drop)
}
