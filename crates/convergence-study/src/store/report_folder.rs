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
use std::io::{self, Write};
use std::path::{Component, Path};

use super::atomic::{self, Prepared};
use crate::store::{self, FIGURES, ONLY_ON_PAGE, if_there, is_record};
use crate::text::visible;

/// The report in Markdown, whose links lead to the other files.
pub(crate) const README: &str = "README.md";

/// Its first line.
const HEADING: &str = "# Verification report";

/// What two runs hold while they write.
pub(crate) const LOCK: &str = "local/lock";

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
        let mut newest = self.clone();
        newest.0.retain(|path, _| NEWEST.contains(&path.as_str()));
        newest
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

/// Refuses a folder that holds files in the places of a report, but no report: they would be lost.
///
/// # Errors
/// The first of these files, and what to do.
pub(crate) fn refuse_other_files(folder: &Path) -> io::Result<()> {
    let readme = folder.join(README);
    let readme = if_there(store::read_to_string(&readme)).map_err(atomic::unread(&readme))?;
    let is_own = readme.is_some_and(|text| text.lines().next() == Some(HEADING));
    // A record that is torn has a lock or a README of its own; a whole one is long to read.
    let record = || store::read_to_string(&folder.join("results.json"));
    let has_record = || record().is_ok_and(|text| is_record(&text));
    if is_own || folder.join(LOCK).is_file() || has_record() {
        return Ok(());
    }
    let places = [README, FIGURES, "local/quick", "local/full"]
        .into_iter()
        .chain(NEWEST);
    let mut taken = places
        .map(|name| folder.join(name))
        .filter(|path| path.exists());
    taken.next().map_or(Ok(()), |path| {
        let words = "found in the place of a report, but no report; expected an empty folder, or one of reports";
        Err(io::Error::other(format!("{}: {words}", visible::path(&path))))
    })
}

/// Makes the folder of a report, and says before a run if it cannot be written, or holds other
/// files.
pub(crate) fn prepare(folder: &Path) -> io::Result<()> {
    atomic::prepare_folder(folder)?;
    refuse_other_files(folder)
}

/// Waits until no other process is writing reports, and keeps others waiting until the file is
/// dropped.
pub(crate) fn lock(path: &Path) -> io::Result<File> {
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let file = store::open(path, File::options().create(true).append(true))?;
    file.lock()?;
    Ok(file)
}

/// Removes the figures that a report does not have. The caller must hold the [`lock`].
pub(crate) fn remove_other_figures(folder: &Path, set: &ReportSet) -> io::Result<()> {
    for below in [ONLY_ON_PAGE, FIGURES] {
        let folder = folder.join(below);
        for entry in if_there(fs::read_dir(&folder))?.into_iter().flatten() {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".svg") && !set.0.contains_key(&format!("{below}/{name}")) {
                if_there(fs::remove_file(folder.join(name)))?;
            }
        }
        // This fails if the folder is not empty; then the folder stays.
        let _ = fs::remove_dir(folder);
    }
    Ok(())
}

/// Removes what killed runs have left of a report. The caller must hold the [`lock`].
pub(crate) fn clear(folder: &Path) -> io::Result<()> {
    let mut folders = [".", FIGURES, ONLY_ON_PAGE].into_iter();
    folders.try_for_each(|below| atomic::remove_unfinished(&folder.join(below)))
}

/// Writes these files of a report next to their places, if they are not there as they are. The
/// caller must hold the [`lock`], and a pending write.
///
/// # Errors
/// The error of the operating system; nothing is left behind, and the old report is untouched.
pub(crate) fn beside(folder: &Path, set: &ReportSet) -> io::Result<Vec<Prepared>> {
    let mut changed = vec![];
    for (path, bytes) in &set.0 {
        let place = folder.join(path);
        let found = if_there(store::read(&place));
        // A file that already has its new content is left alone.
        if !found.is_ok_and(|found| found.as_ref() == Some(bytes)) {
            let file = Prepared::new(&place, |file| file.write_all(bytes))?;
            changed.push((path == README, file));
        }
    }
    changed.sort_by_key(|(is_last, _)| *is_last);
    Ok(changed.into_iter().map(|(_, file)| file).collect())
}

/// Moves files to their places, whatever is there.
pub(crate) fn place(files: Vec<Prepared>) -> io::Result<()> {
    files.into_iter().try_for_each(Prepared::place)
}

/// Removes a folder with all that is in it, if it exists.
pub(crate) fn remove_folder(folder: &Path) -> io::Result<()> {
    if_there(fs::remove_dir_all(folder)).map(drop)
}
