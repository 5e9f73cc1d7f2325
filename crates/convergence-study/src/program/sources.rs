//! Files that a result depends on, with the hashes of their contents.

use std::fs;
use std::path::{Path, PathBuf};

use crate::input::{Refusal, named_file};
use crate::study::{CaseFailure, HashedFile};
use crate::text::visible::visible;

/// A file, by the name that its study has for it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SourceFile {
    pub(super) name: String,
    pub(super) path: PathBuf,
}

impl SourceFile {
    /// The file of that name in a folder.
    ///
    /// * `path`: of the field that names it.
    ///
    /// # Errors
    /// There is no such file, or it is a folder.
    pub(super) fn new(path: &str, name: &str, folder: &Path) -> Result<Self, Refusal> {
        let file = named_file(path, name, folder)?;
        if !file.is_file() {
            let allowed = "the name of a file, relative to this file's folder";
            return Err(Refusal::written_and(path, ", which is no file", allowed));
        }
        Ok(Self {
            name: name.to_owned(),
            path: file,
        })
    }

    /// All files of a list.
    pub(super) fn all(path: &str, names: &[String], folder: &Path) -> Result<Vec<Self>, Refusal> {
        let names = names.iter().enumerate();
        names
            .map(|(k, name)| Self::new(&format!("{path}[{k}]"), name, folder))
            .collect()
    }

    /// The hash of its content now.
    ///
    /// # Errors
    /// It cannot be read.
    pub(super) fn hashed(&self) -> Result<HashedFile, CaseFailure> {
        let content = fs::read(&self.path)
            .map_err(|error| CaseFailure::new(format!("{}: {error}", visible(&self.name))))?;
        Ok(HashedFile::new(&self.name, &content))
    }
}
