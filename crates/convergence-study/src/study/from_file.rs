//! Studies that files describe: what a kind reads, and the table `[study]` of every file.

use std::path::Path;

use super::header::{DEFAULT_KIND, Header, NAME, Tier, is_name};
use super::kind::Kind;
use crate::input::{self, InputError, Section};

/// A kind of study that a file describes.
pub trait FromFile: Kind + Sized {
    /// Reads the study from the document of its file.
    ///
    /// * `header`: the table `[study]`, read already.
    /// * `root`: the document.
    /// * `folder`: the folder of the file, which names of other files are relative to.
    ///
    /// # Errors
    /// [`InputError`] with file, line, field, the value found and the values allowed.
    fn from_document(header: Header, root: &Section<'_>, folder: &Path) -> Result<Self, InputError>;

    /// Reads a study from `text`; messages name `file`, and files that it names are looked for beside it.
    ///
    /// # Errors
    /// As [`FromFile::from_document`].
    fn parse(text: &str, file: &Path) -> Result<Self, InputError> {
        input::parse_beside(text, file, |root, folder| Self::from_document(Header::from_document(root)?, root, folder))
    }

    /// Reads a study file.
    ///
    /// # Errors
    /// As [`FromFile::parse`], and where the file cannot be read.
    fn read(file: impl AsRef<Path>) -> Result<Self, InputError> {
        Self::parse(&input::read_text(file.as_ref())?, file.as_ref())
    }
}

impl Header {
    /// Reads `[study]` of a file and nothing else.
    ///
    /// # Errors
    /// [`InputError`] with file, line and field.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Self::parse(&input::read_text(path)?, &path.display().to_string())
    }

    /// Reads `[study]` of `text` and nothing else; messages refer to `file_name`.
    ///
    /// # Errors
    /// [`InputError`] with file, line and field.
    pub fn parse(text: &str, file_name: &str) -> Result<Self, InputError> {
        input::parse(text, file_name, Self::from_document)
    }

    /// Reads `[study]` of a document, and takes down every value of the document.
    ///
    /// # Errors
    /// As [`Header::parse`].
    pub fn from_document(root: &Section<'_>) -> Result<Self, InputError> {
        let study = root.require("study", "a table with id, claim and tier")?.section()?;
        study.allow(&["id", "claim", "tier", "kind", "group"])?;
        let tiers = Tier::ALL.map(|tier| (tier.name(), tier));
        let kind = if study.get("kind").is_some() { name(&study, "kind")? } else { DEFAULT_KIND.to_owned() };
        Ok(Self {
            id: name(&study, "id")?,
            claim: line(&study, "claim")?,
            tier: study.require("tier", "\"quick\" or \"full\"")?.choice(&tiers)?,
            group: if study.get("group").is_some() { line(&study, "group")? } else { kind.clone() },
            kind,
            settings: root.settings(),
        })
    }
}

fn name(study: &Section<'_>, key: &str) -> Result<String, InputError> {
    let field = study.require(key, NAME)?;
    let text = field.text()?;
    if is_name(text) { Ok(text.to_owned()) } else { Err(field.refuse_as_written(NAME)) }
}

/// One line of text, without control characters: it is printed to terminals and logs.
fn line(study: &Section<'_>, key: &str) -> Result<String, InputError> {
    let allowed = "one line of text without control characters";
    let field = study.require(key, allowed)?;
    let text = field.text()?;
    let is_line = !text.trim().is_empty() && !text.contains(char::is_control);
    if is_line { Ok(text.to_owned()) } else { Err(field.refuse_as_written(allowed)) }
}
