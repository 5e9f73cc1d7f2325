//! Files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Writes `bytes` to `path`: to a new file beside it, which then takes its name.
///
/// A reader sees the old content or the new one, and a run that is stopped half-way leaves no half-written file under
/// the name. The folder must exist.
///
/// # Errors
/// That of the operating system, `path` named in front of it; nothing stays behind.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    write_with(path, |file| file.write_all(bytes.as_ref()))
}

/// As [`write()`], for content that is too long to be held in memory: `fill` writes it piece by piece.
///
/// # Errors
/// That of the operating system or of `fill`, `path` named in front of it; nothing stays behind.
pub fn write_with(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let beside = name_beside(path)?;
    let filled = File::create(&beside).map(BufWriter::new).and_then(|mut file| {
        fill(&mut file)?;
        file.flush()
    });
    let outcome = filled.and_then(|()| fs::rename(&beside, path));
    outcome.map_err(|error| {
        // The first error is the one to tell; where even the file beside could not be made there is nothing to remove.
        let _ = fs::remove_file(&beside);
        naming(path, &error)
    })
}

/// Makes the folder, with those above it, and proves that files can be written to it.
///
/// # Errors
/// That of the operating system, `folder` named in front of it.
pub fn prepare_folder(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder).map_err(|error| naming(folder, &error))?;
    let probe = name_beside(&folder.join("probe"))?;
    fs::write(&probe, "").and_then(|()| fs::remove_file(&probe)).map_err(|error| naming(folder, &error))
}

/// A name in the same folder that no other process or thread uses.
fn name_beside(path: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let Some(name) = path.file_name() else {
        return Err(naming(path, &io::Error::new(io::ErrorKind::InvalidInput, "not the name of a file")));
    };
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let name = format!(".{}.{}-{count}.tmp", name.to_string_lossy(), std::process::id());
    Ok(path.with_file_name(name))
}

pub(crate) fn naming(path: &Path, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of this test alone, removed at its end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("thermobeam-atomic-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).unwrap();
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn the_new_content_replaces_the_old_and_nothing_else_is_left() {
        let folder = Folder::new("replace");
        let path = folder.0.join("a.txt");
        write(&path, "old").unwrap();
        write(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_failure_names_the_path_and_leaves_nothing() {
        let folder = Folder::new("failure");
        // A folder of that name is in the way of the last step.
        let path = folder.0.join("taken");
        fs::create_dir_all(path.join("inside")).unwrap();
        let message = write(&path, "x").unwrap_err().to_string();
        assert!(message.contains("taken"), "{message}");
        assert_eq!(folder.names(), ["taken"]);
        assert!(write(Path::new("/"), "x").is_err());
    }

    #[test]
    fn a_folder_is_made_with_those_above_it_and_stays_empty() {
        let folder = Folder::new("folder");
        let deep = folder.0.join("a/b");
        prepare_folder(&deep).unwrap();
        assert_eq!(fs::read_dir(&deep).unwrap().count(), 0);
        fs::write(folder.0.join("file"), "").unwrap();
        let message = prepare_folder(&folder.0.join("file")).unwrap_err().to_string();
        assert!(message.contains("file"), "{message}");
    }
}
