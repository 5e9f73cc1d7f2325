//! The kinds of study that a project knows, by the names that study files have for them.

use std::path::{Path, PathBuf};

use super::from_file::FromFile;
use super::header::Header;
use super::kind::{Study, erased};
use crate::input::{self, InputError, Section};
use crate::text::visible;

/// Reads a study of one kind from the document of its file.
pub type Reader = fn(Header, &Section<'_>, &Path) -> Result<Box<dyn Study>, InputError>;

/// The reader of a kind.
pub fn reader<K: FromFile + 'static>(
    header: Header,
    root: &Section<'_>,
    folder: &Path,
) -> Result<Box<dyn Study>, InputError> {
    Ok(erased(K::from_document(header, root, folder)?))
}

/// A kind of study: its name, its reader, and what it means in words.
#[derive(Debug, Clone, Copy)]
pub struct KindRow {
    /// The value of `[study] kind`.
    pub name: &'static str,
    /// Its reader.
    pub read: Reader,
    /// Why the claim should hold.
    pub why: &'static str,
    /// How it is judged.
    pub judged: &'static str,
    /// What a failure would mean.
    pub failure: &'static str,
}

/// All kinds of study of a project; the first is that of a file without `kind`.
pub type Kinds = [KindRow];

/// A study file, read once.
pub struct StudyFile {
    /// The file.
    pub path: PathBuf,
    /// The study.
    pub study: Box<dyn Study>,
}

impl StudyFile {
    /// Reads a study file of any of these kinds.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    pub fn read(kinds: &Kinds, path: &Path) -> Result<Self, InputError> {
        let study = input::parse_beside(&input::read_text(path)?, path, |root, folder| {
            let header = Header::from_document(root)?;
            let row = row(kinds, root, &header)?;
            (row.read)(header, root, folder)
        })?;
        Ok(Self { path: path.to_owned(), study })
    }

    /// Reads study files; each id must be that of one file.
    ///
    /// # Errors
    /// As [`StudyFile::read`], and where two studies have the same id.
    pub fn read_all(kinds: &Kinds, paths: &[PathBuf]) -> Result<Vec<Self>, InputError> {
        let mut files: Vec<Self> = Vec::with_capacity(paths.len());
        for path in paths {
            let file = Self::read(kinds, path)?;
            let id = &file.study.header().id;
            if let Some(earlier) = files.iter().find(|earlier| earlier.study.header().id == *id) {
                let found = format!("\"{id}\", which {} has too", visible::path(&earlier.path));
                return Err(refuse(path, "id", &found, "an id that no other study has"));
            }
            files.push(file);
        }
        Ok(files)
    }
}

fn row<'k>(kinds: &'k Kinds, root: &Section<'_>, header: &Header) -> Result<&'k KindRow, InputError> {
    if let Some(row) = kinds.iter().find(|row| row.name == header.kind) {
        return Ok(row);
    }
    let names: Vec<String> = kinds.iter().map(|row| format!("\"{}\"", row.name)).collect();
    let study = root.require("study", "a table")?.section()?;
    // A file without kind has the default one, which not every project knows.
    study.require("kind", &names.join(", "))?;
    Err(study.refuse("kind", format!("\"{}\"", header.kind), names.join(", ")))
}

/// The error about a key of `[study]` of a file that was read before, with its line.
fn refuse(path: &Path, key: &str, found: &str, allowed: &str) -> InputError {
    let complain = |root: &Section<'_>| -> Result<InputError, InputError> {
        let study = root.require("study", "a table")?.section()?;
        Ok(study.refuse(key, found, allowed))
    };
    let text = input::read_text(path);
    text.and_then(|text| input::parse(&text, &path.display().to_string(), complain)).unwrap_or_else(|error| error)
}
