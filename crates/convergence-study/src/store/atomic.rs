//! Writes files atomically: a reader sees the old content or the new one, never a part. Code that
//! writes several holds the guard of [`begin_write`] until they are complete; code that ends the
//! process on request calls [`finish_writes`] first.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock, RwLockReadGuard};
use std::time::{Duration, Instant};
use std::{mem, process, thread};

#[cfg(feature = "command-line")]
use crate::store;
use crate::store::if_there;
use crate::text::visible;

/// Writes a file so that every reader, and every crash, sees the old bytes or the new ones.
///
/// The bytes go to a separate file next to it, which then takes its name. Missing folders are
/// created.
///
/// # Errors
/// The error of the operating system, preceded by `path`; the old file is then untouched and
/// nothing is left behind.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    write_with(path, |file| file.write_all(bytes.as_ref()))
}

/// As [`write()`], for content too long for memory: `fill` writes it piece by piece.
///
/// # Errors
/// The error of the operating system or of `fill`, preceded by `path`; nothing is left behind.
pub fn write_with(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let _writing = begin_write();
    let written = Prepared::new(path, fill).map_err(unwritten(path));
    written.and_then(Prepared::place)
}

/// Refuses a place where a file is that does not begin as one that is to replace it: it is
/// somebody else's, and would be lost.
///
/// # Errors
/// The file, and what to do.
#[cfg(feature = "command-line")]
pub(crate) fn refuse_other(path: &Path, beginning: &str) -> io::Result<()> {
    match store::read(path) {
        Ok(found) if !found.starts_with(beginning.as_bytes()) => {
            let words = "found a file of somebody else in the place of a result; expected --out of another folder";
            Err(naming(path)(io::Error::new(
                io::ErrorKind::AlreadyExists,
                words,
            )))
        }
        // If it cannot be read, the write that follows says why.
        _ => Ok(()),
    }
}

/// A file that is on the disk next to its place, and not yet there.
#[derive(Debug)]
pub(crate) struct Prepared {
    beside: PathBuf,
    path: PathBuf,
}

impl Prepared {
    /// Writes it; missing folders are made.
    ///
    /// # Errors
    /// The error of the operating system or of `fill`; nothing is left behind.
    pub(crate) fn new(
        path: &Path,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> io::Result<Self> {
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        let prepared = Self {
            beside: name_beside(path)?,
            path: path.to_owned(),
        };
        let mut file = BufWriter::new(File::create_new(&prepared.beside)?);
        fill(&mut file)?;
        let file = file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        Ok(prepared)
    }

    /// The same with these bytes.
    ///
    /// # Errors
    /// As [`write()`].
    pub(crate) fn of(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<Self> {
        Self::new(path, |file| file.write_all(bytes.as_ref())).map_err(unwritten(path))
    }

    /// Moves it to its place, whatever is there.
    ///
    /// # Errors
    /// As [`write()`].
    pub(crate) fn place(self) -> io::Result<()> {
        fs::rename(&self.beside, &self.path).map_err(unwritten(&self.path))
    }
}

impl Drop for Prepared {
    fn drop(&mut self) {
        // It is at its place, or the first error says what is wrong.
        let _ = fs::remove_file(&self.beside);
    }
}

/// Creates the folder and those above it, and proves that files can be written to it.
///
/// # Errors
/// The error of the operating system, preceded by `folder`.
pub fn prepare_folder(folder: &Path) -> io::Result<()> {
    let mut taken = folder
        .ancestors()
        .filter(|above| above.exists() && !above.is_dir());
    if let Some(file) = taken.next() {
        let problem = "expected a folder, found a file";
        return Err(naming(file)(io::Error::other(problem)));
    }
    fs::create_dir_all(folder)
        .and_then(|()| probe(&folder.join("probe")))
        .map_err(unwritten(folder))
}

/// Proves that a file of this name can be made. It makes one next to it: another process may be
/// writing the file itself.
fn probe(path: &Path) -> io::Result<()> {
    let beside = name_beside(path)?;
    fs::write(&beside, "")?;
    // Another process may have removed it.
    if_there(fs::remove_file(&beside)).map(drop)
}

/// Behind the name of an unfinished file: `.NAME.unfinished-PROCESS-COUNT`.
const UNFINISHED: &str = ".unfinished-";

/// Removes the unfinished files that killed writers have left in a folder. No other process may be
/// writing there.
pub(crate) fn remove_unfinished(folder: &Path) -> io::Result<()> {
    let entries = if_there(fs::read_dir(folder)).map_err(naming(folder))?;
    for entry in entries.into_iter().flatten() {
        let path = entry.map_err(naming(folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.') && name.contains(UNFINISHED) {
            // Another run may have removed its own probe since the folder was read.
            if_there(fs::remove_file(&path)).map_err(naming(&path))?;
        }
    }
    Ok(())
}

/// For `map_err`: the same error, preceded by the name of the file.
pub(crate) fn naming(path: &Path) -> impl Fn(io::Error) -> io::Error {
    described(path, "")
}

/// The same of a file that was to be read.
pub(crate) fn unread(path: &Path) -> impl Fn(io::Error) -> io::Error {
    described(path, "cannot be read: ")
}

/// The same of a file or a folder that was to be written.
fn unwritten(path: &Path) -> impl Fn(io::Error) -> io::Error {
    described(path, "cannot be written: ")
}

/// * `what`: what stands between the name and the error.
fn described(path: &Path, what: &'static str) -> impl Fn(io::Error) -> io::Error {
    move |error| {
        let problem = format!("{}: {what}{error}", visible::path(path));
        io::Error::new(error.kind(), problem)
    }
}

/// A name in the same folder that no other thread or process uses.
fn name_beside(path: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "a folder, not a file"))?;
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut beside = std::ffi::OsString::from(".");
    beside.push(name);
    beside.push(format!("{UNFINISHED}{}-{count}", process::id()));
    Ok(path.with_file_name(beside))
}

/// Read by pending writes. It is never waited for with `write`: a thread may begin a write within
/// another one.
static PENDING: RwLock<()> = RwLock::new(());

/// Between two looks at the pending writes.
const PAUSE: Duration = Duration::from_millis(1);

/// Registers a write, which is pending until the guard is dropped. After `finish_writes` it
/// blocks until the process ends.
pub fn begin_write() -> RwLockReadGuard<'static, ()> {
    PENDING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for pending writes and blocks new ones. Call it right before the process exits.
///
/// * `patience`: it returns after this time even if a write is pending, for example on a disk that
///   hangs; new ones are then not blocked.
pub(crate) fn finish_writes(patience: Duration) {
    close_of(&PENDING, patience);
}

fn close_of(pending: &'static RwLock<()>, patience: Duration) {
    let end = Instant::now() + patience;
    loop {
        match pending.try_write() {
            Ok(closed) => return mem::forget(closed),
            Err(_) if Instant::now() >= end => return,
            Err(_) => thread::sleep(PAUSE),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;
    use std::sync::mpsc;

    use super::*;

    #[test]
    fn the_new_bytes_replace_the_old_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/file.txt");
        write(&path, "old, and longer").unwrap();
        write(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("full")).unwrap();
        assert!(write(&taken, "bytes").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn unfinished_files_of_killed_writers_are_removed_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            ".a.json.unfinished-17-0",
            ".a.json.17-0",
            ".b.json.unfinished-18-3",
            "a.json",
            "a.json.unfinished-17-0",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_unfinished(folder.path()).unwrap();
        remove_unfinished(&folder.path().join("nowhere")).unwrap();
        let mut names: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, [".a.json.17-0", "a.json", "a.json.unfinished-17-0"]);
    }

    #[test]
    fn a_folder_is_made_with_those_above_it_and_stays_empty() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        prepare_folder(&deep).unwrap();
        assert_eq!(fs::read_dir(&deep).unwrap().count(), 0);
        fs::write(folder.path().join("file"), "").unwrap();
        let message = prepare_folder(&folder.path().join("file"))
            .unwrap_err()
            .to_string();
        assert!(message.contains("file"), "{message}");
    }

    const LONG: Duration = Duration::from_secs(60);
    const SHORT: Duration = Duration::from_millis(50);

    #[test]
    fn closing_waits_for_pending_writes() {
        static OPEN: RwLock<()> = RwLock::new(());
        let is_whole = AtomicBool::new(false);
        let (begun, begins) = mpsc::channel();
        thread::scope(|scope| {
            scope.spawn(|| {
                let first = OPEN.read();
                begun.send(()).unwrap();
                thread::sleep(SHORT);
                is_whole.store(true, Ordering::SeqCst);
                drop(first);
            });
            begins.recv().unwrap();
            drop(OPEN.read());
            close_of(&OPEN, LONG);
            assert!(is_whole.load(Ordering::SeqCst));
        });
    }

    #[test]
    fn closing_gives_up_on_a_write_that_hangs() {
        static OPEN: RwLock<()> = RwLock::new(());
        let _hanging = OPEN.read();
        let start = Instant::now();
        close_of(&OPEN, SHORT);
        assert!((SHORT..LONG).contains(&start.elapsed()));
    }

    #[test]
    fn no_write_begins_after_closing() {
        static CLOSED: RwLock<()> = RwLock::new(());
        close_of(&CLOSED, Duration::ZERO);
        let (sender, receiver) = mpsc::channel();
        // It waits for the end of the process.
        thread::spawn(move || {
            drop(CLOSED.read());
            sender.send(())
        });
        assert_eq!(
            receiver.recv_timeout(SHORT),
            Err(mpsc::RecvTimeoutError::Timeout)
        );
    }
}
