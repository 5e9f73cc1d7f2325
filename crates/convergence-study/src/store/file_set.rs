//! A report replaces the last one as a set of files: after a crash the next run finds the old set
//! or completes the new one.
//!
//! 1. All files that differ from those of the previous set are written into the folder `staging` of
//!    the workshop.
//! 2. `staging` is renamed to `pending`. From this moment on, the new set counts.
//! 3. Its files are moved to their places, files only in the previous set are removed, and the
//!    manifest, which lists the set, is moved last. After an interruption the whole step is
//!    repeated.
//!
//! Files that no manifest lists are never touched. (Exchanging the whole folder would lose files
//! that others write to it meanwhile.) A lock, which the operating system releases even after a
//! crash, keeps two runs apart.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::store::{self, atomic, if_there};
use crate::text::visible;

/// The file that lists all files of the set, one per line.
pub(crate) const MANIFEST: &str = "manifest.txt";

/// The files of a report by their path relative to its folder, with `/` between folders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReportSet {
    files: BTreeMap<String, Vec<u8>>,
}

impl ReportSet {
    /// Adds a file.
    ///
    /// # Errors
    /// A path that already exists in the set or that leads out of the folder.
    pub fn add(&mut self, path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> io::Result<()> {
        let path = path.into();
        if !stays_inside(&path) || path == MANIFEST {
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
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files
            .iter()
            .map(|(path, bytes)| (path.as_str(), bytes.as_slice()))
    }

    /// The bytes of a file.
    pub(crate) fn get(&self, path: &str) -> Option<&Vec<u8>> {
        self.files.get(path)
    }

    /// The text of a file; `None` also if it is none.
    pub(crate) fn text(&self, path: &str) -> Option<String> {
        String::from_utf8(self.get(path)?.clone()).ok()
    }

    /// Takes a file out.
    pub(crate) fn remove(&mut self, path: &str) {
        self.files.remove(path);
    }

    /// Gives a file other content.
    pub(crate) fn replace(&mut self, path: &str, bytes: impl Into<Vec<u8>>) {
        self.files.insert(path.to_owned(), bytes.into());
    }

    fn manifest(&self) -> String {
        manifest(self.files.keys())
    }
}

/// The error of a file that no set can hold.
fn refusal(path: &str, reason: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidInput,
        format!("the report `{path}` {reason}"),
    )
}

fn manifest<'p>(paths: impl IntoIterator<Item = &'p String>) -> String {
    paths.into_iter().map(|path| format!("{path}\n")).collect()
}

/// Whether a relative path leads to a file below the folder.
fn stays_inside(path: &str) -> bool {
    let mut components = Path::new(path).components();
    !path.is_empty()
        && !path.contains(|c: char| c.is_control() || matches!(c, '\\' | ':'))
        && components.all(|component| matches!(component, Component::Normal(_)))
}

/// The folder of one report, and the workshop in which its next set of files is prepared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReportFolder {
    /// Where readers find the report.
    pub folder: PathBuf,
    /// A folder on the same file system, for sets that are not yet in place.
    pub workshop: PathBuf,
}

/// Waits until no other process is writing reports, and keeps others waiting until the file is
/// dropped.
pub fn lock(path: &Path) -> io::Result<File> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let file = store::open(path, File::options().create(true).append(true))?;
    file.lock()?;
    Ok(file)
}

impl ReportFolder {
    /// Replaces the previous set by this one. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system; the next replacement completes an interrupted one.
    pub fn publish(&self, set: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        self.tidy()?;
        self.replace(set, &set.manifest())
    }

    /// Replaces these files of the previous set, or adds them; the others stay. The caller must
    /// hold the [`lock`].
    ///
    /// # Errors
    /// As [`publish`](Self::publish).
    pub(crate) fn renew(&self, files: &ReportSet) -> io::Result<()> {
        let _writing = atomic::begin_write();
        self.tidy()?;
        let mut listed = self.stored()?;
        listed.extend(files.files.keys().cloned());
        self.replace(files, &manifest(&listed))
    }

    /// Puts files in their places as one step, and removes those of the previous set that the new
    /// manifest does not list.
    fn replace(&self, set: &ReportSet, manifest: &str) -> io::Result<()> {
        let staging = self.staging();
        let changed: Vec<_> = set
            .files()
            .filter(|(path, bytes)| !self.holds(path, bytes))
            .collect();
        if changed.is_empty() && self.holds(MANIFEST, manifest.as_bytes()) {
            return Ok(());
        }
        for (path, bytes) in changed {
            write_new(&staging.join(path), bytes)?;
        }
        write_new(&staging.join(MANIFEST), manifest.as_bytes())?;
        fs::rename(&staging, self.pending())?;
        self.complete_interrupted()
    }

    /// The paths that the manifest lists; none without a manifest.
    ///
    /// # Errors
    /// The manifest cannot be read.
    pub(crate) fn stored(&self) -> io::Result<BTreeSet<String>> {
        let manifest = if_there(store::read_to_string(&self.folder.join(MANIFEST)))?;
        let paths = manifest.iter().flat_map(|manifest| manifest.lines());
        Ok(paths.map(str::to_owned).collect())
    }

    /// The bytes of a file; `None` if it does not exist.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn read(&self, path: &str) -> io::Result<Option<Vec<u8>>> {
        if_there(store::read(&self.folder.join(path)))
    }

    /// The text of a file; `None` if it does not exist.
    ///
    /// # Errors
    /// A file that cannot be read or is no text.
    pub(crate) fn text(&self, path: &str) -> io::Result<Option<String>> {
        if_there(store::read_to_string(&self.folder.join(path)))
    }

    /// Writes some files of the set, in the order of their paths reversed, then removes others.
    /// The caller must hold the [`lock`].
    ///
    /// A file may refer to those behind it in the order of paths: they are written before it. The
    /// manifest lists whatever exists, before, after and in between.
    ///
    /// # Errors
    /// The error of the operating system. Each file is then the old or the new one.
    pub(crate) fn amend(&self, changed: &ReportSet, removed: &BTreeSet<String>) -> io::Result<()> {
        let _writing = atomic::begin_write();
        let mut listed = self.stored()?;
        listed.extend(changed.files.keys().cloned());
        atomic::write(&self.folder.join(MANIFEST), manifest(&listed))?;
        for (path, bytes) in changed.files.iter().rev() {
            let path = self.folder.join(path);
            path.parent().map_or(Ok(()), fs::create_dir_all)?;
            atomic::write(&path, bytes)?;
        }
        for path in removed {
            self.remove_stale(&self.folder.join(path))?;
        }
        listed.retain(|path| !removed.contains(path));
        atomic::write(&self.folder.join(MANIFEST), manifest(&listed))
    }

    /// Whether a file already has its new content: it is then left alone.
    fn holds(&self, path: &str, bytes: &[u8]) -> bool {
        store::read(&self.folder.join(path)).is_ok_and(|found| found == bytes)
    }

    /// Whether one of these files exists.
    pub(crate) fn has_any(&self, paths: &[&str]) -> bool {
        paths.iter().any(|path| self.folder.join(path).exists())
    }

    /// Takes files of the previous set out of sight while a run is under way: if it is killed, no
    /// reader takes what they say for what the run has found. The caller must hold the [`lock`].
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

    /// Completes an interrupted replacement, and removes an unfinished set and what a killed run
    /// has set aside. The caller must hold the [`lock`].
    ///
    /// # Errors
    /// The error of the operating system, and a manifest that names files outside the folder: then
    /// nothing is moved.
    pub fn tidy(&self) -> io::Result<()> {
        self.complete_interrupted()?;
        remove_if_there(&self.before())?;
        remove_if_there(&self.staging())
    }

    /// Moves pending files to their places, if there are any.
    fn complete_interrupted(&self) -> io::Result<()> {
        let pending = self.pending();
        // The manifest is moved last: without it only the empty folder is left.
        if let Some(manifest) = if_there(store::read_to_string(&pending.join(MANIFEST)))? {
            if let Some(path) = manifest
                .lines()
                .find(|path| !stays_inside(path) || *path == MANIFEST)
            {
                return Err(leads_out(&pending, path));
            }
            let former =
                if_there(store::read_to_string(&self.folder.join(MANIFEST)))?.unwrap_or_default();
            for path in manifest.lines() {
                move_if_there(&pending.join(path), &self.folder.join(path))?;
            }
            let stale = former
                .lines()
                .filter(|path| stays_inside(path) && !manifest.lines().any(|new| new == *path));
            stale
                .map(|path| self.folder.join(path))
                .try_for_each(|path| self.remove_stale(&path))?;
            move_if_there(&pending.join(MANIFEST), &self.folder.join(MANIFEST))?;
        }
        remove_if_there(&pending)
    }

    /// Removes a file of a previous set, and its folder if that becomes empty.
    fn remove_stale(&self, path: &Path) -> io::Result<()> {
        if_there(fs::remove_file(path))?;
        if let Some(folder) = path.parent().filter(|folder| *folder != self.folder) {
            // This fails if the folder is not empty; then the folder stays.
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }

    /// Where [`set_aside`](Self::set_aside) keeps files.
    fn before(&self) -> PathBuf {
        self.workshop.join("before")
    }

    fn staging(&self) -> PathBuf {
        self.workshop.join("staging")
    }

    fn pending(&self) -> PathBuf {
        self.workshop.join("pending")
    }
}

fn leads_out(pending: &Path, path: &str) -> io::Error {
    let manifest = visible::path(&pending.join(MANIFEST));
    let path = visible::visible(path);
    let expected = "paths of files below the report's folder";
    let remedy = "remove this folder and run again";
    io::Error::new(
        io::ErrorKind::InvalidData,
        format!("{manifest}: found `{path}`; expected {expected}; {remedy}"),
    )
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
