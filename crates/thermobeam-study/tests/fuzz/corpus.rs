//! Inputs worth keeping: each was once refused badly, or looks as if it could be.

use std::path::{Path, PathBuf};

use super::readers::Reading;

/// Their folder; the names of files begin with the kind of file.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus")
}

/// All inputs: path, kind and bytes.
pub(crate) fn inputs() -> Vec<(PathBuf, Reading, Vec<u8>)> {
    let entries = std::fs::read_dir(folder()).expect("the corpus");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an input").path())
        .collect();
    paths.sort();
    let input = |path: PathBuf| {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let reading = Reading::ALL
            .into_iter()
            .find(|reading| name.starts_with(reading.name()));
        let bytes = std::fs::read(&path).expect("an input");
        (
            path,
            reading.unwrap_or_else(|| panic!("{name}: of which kind?")),
            bytes,
        )
    };
    paths.into_iter().map(input).collect()
}
