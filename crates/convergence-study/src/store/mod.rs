//! What a run compares with and leaves behind: baseline, records, provenance, and the files
//! of a report.
//!
//! Files that the harness itself has written are read only if they are regular files: a pipe or a
//! device in their place would block it for ever.

pub(crate) mod atomic;
mod baseline;
pub(crate) mod diagnosis;
mod provenance;
mod record;
mod report_folder;
mod works;

pub(crate) use baseline::{Baseline, GuardedChange, Movement};
pub(crate) use baseline::{BlessingRefusal, without_baseline};
pub(crate) use provenance::{LastRun, Provenance};
pub(crate) use record::Record;
pub(crate) use record::{FIGURES, ONLY_ON_PAGE, SCHEMA, is_record, verdict_of};
pub(crate) use report_folder::{LOCK, NEWEST, README};
pub(crate) use report_folder::{
    ReportSet, beside, clear, lock, place, prepare, refuse_other_files, remove_folder,
    remove_other_figures,
};
pub(crate) use works::Works;

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::text::visible;
use atomic::Prepared;

/// The content of a file. Another schema has other keys, so its number is read first.
///
/// * `schema`: its version, if it has one.
/// * `expected`: advice for a file with another format or schema.
///
/// # Errors
/// One line with the file, what was found with line and column, and the advice.
pub(crate) fn parsed<T: DeserializeOwned>(
    text: &str,
    path: &Path,
    schema: Option<u32>,
    expected: [&str; 2],
) -> io::Result<T> {
    #[derive(Deserialize)]
    #[serde(expecting = "an object with the key `schema`")]
    struct Version {
        schema: u32,
    }
    let malformed = |error: serde_json::Error| {
        let found = visible::visible(&error.to_string());
        refused(path, &found, expected[0])
    };
    if let Some(schema) = schema {
        let Version { schema: found } = serde_json::from_str(text).map_err(malformed)?;
        if found != schema {
            let expected = match found > schema {
                true => format!("expected {schema}: a newer version has written it; update"),
                false => format!("expected {}", expected[1]),
            };
            return Err(refused(path, &format!("schema: found {found}"), &expected));
        }
    }
    serde_json::from_str(text).map_err(malformed)
}

fn refused(path: &Path, found: &str, expected: &str) -> io::Error {
    let words = format!("{}: {found}; {expected}", visible::path(path));
    io::Error::new(io::ErrorKind::InvalidData, words)
}

/// The same for a file; `None` if it does not exist.
pub(crate) fn read_if_there<T: DeserializeOwned>(
    path: &Path,
    schema: Option<u32>,
    expected: [&str; 2],
) -> io::Result<Option<T>> {
    let text = if_there(read_to_string(path)).map_err(atomic::unread(path))?;
    text.map(|text| parsed(&text, path, schema, expected))
        .transpose()
}

/// An object as JSON text with a line end, as in files; a number that is not finite becomes `null`,
/// because JSON has none.
pub(crate) fn json(object: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string_pretty(object)? + "\n")
}

/// Writes an object to a file, atomically.
pub(crate) fn write_json(path: &Path, object: &impl Serialize) -> io::Result<()> {
    atomic::write(path, json(object)?)
}

/// The same, next to the file.
pub(crate) fn json_beside(path: &Path, object: &impl Serialize) -> io::Result<Prepared> {
    Prepared::of(path, json(object)?)
}

/// The text of a regular file.
///
/// # Errors
/// The error of the operating system; also if the file is not a regular file or not UTF-8.
pub(crate) fn read_to_string(path: &Path) -> io::Result<String> {
    check(path)?;
    fs::read_to_string(path).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => {
            io::Error::other("found bytes that are no UTF-8; expected UTF-8 text")
        }
        _ => error,
    })
}

/// The bytes of a regular file.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
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

/// Links are followed. The check comes first because opening a pipe already waits for its other
/// end.
fn check(path: &Path) -> io::Result<()> {
    if fs::metadata(path)?.is_file() {
        Ok(())
    } else {
        Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "expected a regular file, found a folder, a pipe or a device",
        ))
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn pipes_devices_and_folders_are_refused_at_once() {
        foreign_tools::needs!(MKFIFO);
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(
            std::process::Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        for path in [pipe.as_path(), Path::new("/dev/zero"), folder.path()] {
            let refused = [
                read_to_string(path).unwrap_err(),
                read(path).unwrap_err(),
                open(path, File::options().append(true)).unwrap_err(),
            ];
            for error in refused {
                assert!(
                    error.to_string().contains("expected a regular file"),
                    "{error}"
                );
            }
        }
        let file = folder.path().join("file");
        assert_eq!(read(&file).unwrap_err().kind(), io::ErrorKind::NotFound);
        open(&file, File::options().append(true).create(true)).unwrap();
        assert_eq!(read_to_string(&file).unwrap(), "");
    }
}
