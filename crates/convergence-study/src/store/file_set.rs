//! Reports are put on their shelf as a set: after a crash the next run finds the old set or completes the new one.
//!
//! All files that differ from those on the shelf are first written into a staging folder. Its renaming to `pending` is the
//! one moment at which the new set counts: from then on files are only moved to their places, which can be done again
//! after any interruption. What the former set had and the new one does not is removed; a manifest, moved last, lists the
//! set. Files that no manifest lists are never touched: that is why the folder is not exchanged as a whole, which would lose
//! what others write to it meanwhile. A lock, which the operating system frees even after a crash, keeps two runs apart.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use crate::store::atomic;
use crate::store::writing;

/// The file that lists all files of the set, one a line.
pub const MANIFEST: &str = "manifest.txt";

/// Files by their path relative to the shelf, with `/` between folders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReportSet {
    files: BTreeMap<String, Vec<u8>>,
}

impl ReportSet {
    /// Adds a file.
    ///
    /// # Errors
    /// A path that is there already or that does not stay on the shelf.
    pub fn add(&mut self, path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> io::Result<()> {
        let path = path.into();
        let refuse =
            |what: &str| Err(io::Error::new(io::ErrorKind::InvalidInput, format!("the report `{path}` {what}")));
        if !stays_inside(&path) || path == MANIFEST {
            return refuse("has a name that no report may have");
        }
        // Some file systems take names for equal that differ in upper and lower case.
        if self.files.keys().any(|known| known.eq_ignore_ascii_case(&path)) {
            return refuse("is there twice");
        }
        self.files.insert(path, bytes.into());
        Ok(())
    }

    /// The files: path and bytes.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice()))
    }

    fn manifest(&self) -> String {
        self.files.keys().map(|path| format!("{path}\n")).collect()
    }
}

/// Whether a relative path leads to a file below, and to nowhere else.
fn stays_inside(path: &str) -> bool {
    let plain = |component| matches!(component, Component::Normal(_));
    !path.is_empty() && !path.contains(['\\', '\n', '\r', ':']) && Path::new(path).components().all(plain)
}

/// A place for one set of reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shelf {
    /// Where the reports are to be found.
    pub place: PathBuf,
    /// A folder on the same file system for what is under way.
    pub workshop: PathBuf,
}

/// Waits until no other process is writing reports, and keeps others waiting until it is dropped.
///
/// # Errors
/// What the file system says.
pub fn lock(path: &Path) -> io::Result<File> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let file = File::options().create(true).append(true).open(path)?;
    file.lock()?;
    Ok(file)
}

impl Shelf {
    /// Replaces the former set by this one. Call it with the [`lock`] held.
    ///
    /// # Errors
    /// What the file system says; an interrupted replacement is completed by the next one.
    pub fn publish(&self, set: &ReportSet) -> io::Result<()> {
        let _writing = writing::begin();
        self.tidy()?;
        let (staging, manifest) = (self.staging(), set.manifest());
        let changed: Vec<_> = set.files().filter(|(path, bytes)| !self.holds(path, bytes)).collect();
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

    /// Whether a file is there as it should be: it is then left alone.
    fn holds(&self, path: &str, bytes: &[u8]) -> bool {
        fs::read(self.place.join(path)).is_ok_and(|found| found == bytes)
    }

    /// Completes a replacement that was interrupted, and removes what was not yet one. Call it with the [`lock`] held.
    ///
    /// # Errors
    /// What the file system says.
    pub fn tidy(&self) -> io::Result<()> {
        self.complete_interrupted()?;
        remove_if_there(&self.staging())
    }

    /// Moves what is pending to its place. Nothing happens where nothing is pending.
    fn complete_interrupted(&self) -> io::Result<()> {
        let pending = self.pending();
        // Without its manifest all that was pending has been moved: only the empty folder was left.
        if let Some(manifest) = read_if_there(&pending.join(MANIFEST))? {
            let former = read_if_there(&self.place.join(MANIFEST))?.unwrap_or_default();
            self.keep(manifest.lines().filter(|path| pending.join(path).exists()));
            for path in manifest.lines() {
                move_if_there(&pending.join(path), &self.place.join(path))?;
            }
            let stale = former.lines().filter(|path| stays_inside(path) && !manifest.lines().any(|new| new == *path));
            stale.map(|path| self.place.join(path)).try_for_each(|path| self.remove_stale(&path))?;
            move_if_there(&pending.join(MANIFEST), &self.place.join(MANIFEST))?;
        }
        remove_if_there(&pending)?;
        remove_if_there(&self.kept())
    }

    /// Holds on to what is replaced until all is moved: to free a file takes longer than to move one, and the time in which
    /// old files and new ones lie side by side is to be short.
    fn keep<'p>(&self, paths: impl Iterator<Item = &'p str>) {
        let kept = self.kept();
        // Without it the moves take longer, and that is all.
        if fs::create_dir_all(&kept).is_ok() {
            for (k, path) in paths.enumerate() {
                let _ = fs::hard_link(self.place.join(path), kept.join(k.to_string()));
            }
        }
    }

    fn kept(&self) -> PathBuf {
        self.workshop.join("kept")
    }

    /// Removes a file of a former set, and the folder that becomes empty with it.
    fn remove_stale(&self, path: &Path) -> io::Result<()> {
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        if let Some(folder) = path.parent().filter(|folder| *folder != self.place) {
            // It fails where the folder is not empty, which is as it should be.
            let _ = fs::remove_dir(folder);
        }
        Ok(())
    }

    fn staging(&self) -> PathBuf {
        self.workshop.join("staging")
    }

    fn pending(&self) -> PathBuf {
        self.workshop.join("pending")
    }
}

fn write_new(path: &Path, bytes: &[u8]) -> io::Result<()> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    atomic::write_through(path, bytes)
}

fn read_if_there(path: &Path) -> io::Result<Option<String>> {
    if_there(fs::read_to_string(path))
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

fn if_there<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}
