//! Reads files that the harness itself has written: a pipe or a device in their place would block it for ever.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// The text of a regular file.
///
/// # Errors
/// The error of the operating system; also if the file is not a regular file or not UTF-8.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    check(path)?;
    fs::read_to_string(path)
}

/// The bytes of a regular file.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    check(path)?;
    fs::read(path)
}

/// Opens a regular file; creates a missing one if `options` say so.
pub(crate) fn open(path: &Path, options: &OpenOptions) -> io::Result<File> {
    if_there(check(path))?;
    options.open(path)
}

/// `None` if the file does not exist.
pub(crate) fn if_there<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}

/// Links are followed. The check comes first because opening a pipe already waits for its other end.
fn check(path: &Path) -> io::Result<()> {
    if fs::metadata(path)?.is_file() {
        Ok(())
    } else {
        Err(io::Error::new(io::ErrorKind::InvalidInput, "expected a regular file, found a folder, a pipe or a device"))
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn pipes_devices_and_folders_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for path in [pipe.as_path(), Path::new("/dev/zero"), folder.path()] {
            let refused = [
                read_to_string(path).unwrap_err(),
                read(path).unwrap_err(),
                open(path, File::options().append(true)).unwrap_err(),
            ];
            for error in refused {
                assert!(error.to_string().contains("expected a regular file"), "{error}");
            }
        }
        let file = folder.path().join("file");
        assert_eq!(read(&file).unwrap_err().kind(), io::ErrorKind::NotFound);
        open(&file, File::options().append(true).create(true)).unwrap();
        assert_eq!(read_to_string(&file).unwrap(), "");
    }
}
