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
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(naming(path))?;
    }
    let beside = name_beside(path)?;
    let written = fill_through(&beside, fill).and_then(|()| fs::rename(&beside, path));
    if written.is_err() {
        // The first error is reported; a failure to remove the file would only follow from it.
        let _ = fs::remove_file(&beside);
    }
    written.map_err(naming(path))
}

/// The file with which [`prepare_folder`] tests a folder; it is removed again.
pub(crate) const PROBE: &str = "probe";

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
        .and_then(|()| probe(&folder.join(PROBE)))
        .map_err(naming(folder))
}

/// Proves that a file of this name can be made. It makes one next to it: another process may be
/// writing the file itself.
fn probe(path: &Path) -> io::Result<()> {
    let beside = name_beside(path)?;
    fs::write(&beside, "")?;
    // Another process may have removed it.
    if_there(fs::remove_file(&beside)).map(drop)
}

/// Whether a file name is that of an unfinished file of another: `.NAME.PROCESS-COUNT`.
fn is_leftover(other: &str, name: &str) -> bool {
    let number = other
        .strip_prefix('.')
        .and_then(|rest| rest.strip_prefix(name))
        .and_then(|rest| rest.strip_prefix('.'));
    number
        .and_then(|number| number.split_once('-'))
        .is_some_and(|(process, count)| is_digits(process) && is_digits(count))
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Removes the unfinished files that killed writers of `path` have left next to it. No other
/// process may be writing this file.
pub(crate) fn remove_leftovers(path: &Path) -> io::Result<()> {
    let (Some(folder), Some(name)) = (
        path.parent(),
        path.file_name().and_then(|name| name.to_str()),
    ) else {
        return Ok(());
    };
    let entries = if_there(fs::read_dir(folder)).map_err(naming(folder))?;
    for entry in entries.into_iter().flatten() {
        let entry = entry.map_err(naming(folder))?;
        let other = entry.file_name();
        if other.to_str().is_some_and(|other| is_leftover(other, name)) {
            // Another run may have removed its own probe since the folder was read.
            if_there(fs::remove_file(entry.path())).map_err(naming(&entry.path()))?;
        }
    }
    Ok(())
}

/// Writes a file that does not exist yet and waits until it is on the disk.
pub(super) fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    fill_through(path, |file| file.write_all(bytes))
}

fn fill_through(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut file = BufWriter::new(File::create_new(path)?);
    fill(&mut file)?;
    file.into_inner()
        .map_err(io::IntoInnerError::into_error)?
        .sync_all()
}

/// For `map_err`: the same error, preceded by the name of the file.
pub(crate) fn naming(path: &Path) -> impl Fn(io::Error) -> io::Error {
    move |error| io::Error::new(error.kind(), format!("{}: {error}", visible::path(path)))
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
    beside.push(format!(".{}-{count}", process::id()));
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
            ".a.json.17-0",
            ".a.json.17-x",
            ".b.json.17-0",
            "a.json",
            ".a.json.-0",
            "a.json.17-0",
        ] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_leftovers(&folder.path().join("a.json")).unwrap();
        remove_leftovers(&folder.path().join("nowhere/a.json")).unwrap();
        let mut names: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(
            names,
            [
                ".a.json.-0",
                ".a.json.17-x",
                ".b.json.17-0",
                "a.json",
                "a.json.17-0"
            ]
        );
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
