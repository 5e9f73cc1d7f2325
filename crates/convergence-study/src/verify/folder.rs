//! The folder of reports that a run writes to: its lock, and errors that name it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use crate::store::lock;
use crate::text::visible;

/// The folder of reports that contains a folder, and has the lock: `reports/` for `reports/full/`;
/// otherwise the folder itself.
pub(crate) fn reports_around(folder: &Path) -> PathBuf {
    let mut folders = folder.ancestors().take(3);
    let with_lock = folders.find(|folder| lock_file(folder).is_file());
    with_lock.unwrap_or(folder).to_owned()
}

/// Waits for other processes that write to a folder of reports, and then blocks them.
pub(super) fn lock_reports(folder: &Path) -> io::Result<File> {
    lock(&lock_file(folder)).map_err(unwritable(folder))
}

/// For `map_err`: the same error, preceded by the folder of the reports.
pub(super) fn unwritable(reports: &Path) -> impl Fn(io::Error) -> io::Error {
    move |error| {
        io::Error::new(
            error.kind(),
            format!(
                "{}: the reports cannot be written: {error}",
                visible::path(reports)
            ),
        )
    }
}

pub(super) fn lock_file(reports: &Path) -> PathBuf {
    reports.join("local").join("lock")
}
