//! Results kept by content: a case is not repeated while its command and the files it depends on are unchanged.
//!
//! Each result is a file named after the hash of its [`Key`], and holds the whole key; anything else under that name is
//! not a result, and the case is computed anew.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, io};

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::command::Invocation;
use crate::store::{self, atomic, content_hash};

/// Version of the file format: a file of another version is not a result.
const FORM: u32 = 4;

/// The folder of kept results, next to the study file.
const FOLDER: &str = ".convergence-study";

/// Everything that a result depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Key {
    form: u32,
    /// The version of this crate; another version may read an answer differently.
    version: String,
    /// The folder in which the program runs, as in the study file.
    directory: String,
    words: Vec<String>,
    program: Option<Executable>,
    input: String,
    /// Each file with the hash of its content.
    files: Vec<(String, String)>,
}

/// The program found through `PATH` for a name without a folder: if rebuilt or replaced, it is another program.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Executable {
    /// Without symbolic links.
    path: String,
    /// Size in bytes.
    size: u64,
    /// Modification time, in nanoseconds since 1970.
    modified: u128,
}

impl Executable {
    /// `None` for a name with a folder, whose content is in the key, and for a program that is not found.
    fn found(
        Invocation {
            words, directory, ..
        }: &Invocation,
    ) -> Option<Self> {
        let name = words
            .first()
            .filter(|name| Path::new(name.as_str()).components().count() == 1)?;
        let folders = env::var_os("PATH")?;
        let candidates = env::split_paths(&folders).map(|folder| directory.join(folder).join(name));
        let path = candidates
            .filter(|path| is_executable(path))
            .find_map(|path| path.canonicalize().ok())?;
        let about = path.metadata().ok()?;
        let modified = about
            .modified()
            .ok()?
            .duration_since(UNIX_EPOCH)
            .ok()?
            .as_nanos();
        Some(Self {
            path: path.display().to_string(),
            size: about.len(),
            modified,
        })
    }
}

#[cfg(unix)]
fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata()
        .is_ok_and(|about| about.is_file() && about.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(path: &Path) -> bool {
    path.is_file()
}

/// Where the results of one study are kept.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Store {
    folder: PathBuf,
    directory: String,
    files: Vec<PathBuf>,
}

impl Store {
    /// * `folder`: that of the study file.
    /// * `id`: the study's.
    /// * `directory`: the folder in which the program runs, as in the study file.
    /// * `files`: what every result depends on in addition to its command and the files named in it.
    pub(super) fn new(folder: &Path, id: &str, directory: String, files: Vec<PathBuf>) -> Self {
        Self {
            folder: folder.join(FOLDER).join(id),
            directory,
            files,
        }
    }

    /// The current key of a case. It includes every file that a word of the command names, whether or not `files` lists it.
    pub(super) fn key(&self, invocation: &Invocation) -> io::Result<Key> {
        let hashed = |path: &PathBuf| {
            let bytes = store::read(path).map_err(atomic::naming(path))?;
            let name = path.strip_prefix(&invocation.directory).unwrap_or(path);
            Ok((
                name.display().to_string(),
                format!("{:016x}", content_hash(&bytes)),
            ))
        };
        let named = invocation
            .words
            .iter()
            .map(|word| invocation.directory.join(word));
        let named: Vec<PathBuf> = named
            .filter(|path| path.is_file() && !self.files.contains(path))
            .collect();
        Ok(Key {
            form: FORM,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            directory: self.directory.clone(),
            words: invocation.words.clone(),
            program: Executable::found(invocation),
            input: invocation.input.clone(),
            files: self
                .files
                .iter()
                .chain(&named)
                .map(hashed)
                .collect::<io::Result<_>>()?,
        })
    }

    /// The kept answer of a case; `None` if there is no valid one.
    pub(super) fn get(&self, key: &Key) -> Option<Answer> {
        let text = store::read_to_string(&self.path(key)).ok()?;
        let (kept, answer): (Key, Answer) = serde_json::from_str(&text).ok()?;
        (kept == *key).then_some(answer)
    }

    /// Keeps an answer, unless the files have changed while the program ran: then it is unknown which version was read.
    pub(super) fn put(
        &self,
        key: &Key,
        invocation: &Invocation,
        answer: &Answer,
    ) -> io::Result<()> {
        if self.key(invocation)? != *key {
            return Ok(());
        }
        let ignore = self.folder.with_file_name(".gitignore");
        if !ignore.exists() {
            atomic::write(&ignore, "*\n")?;
        }
        atomic::write(&self.path(key), serde_json::to_string(&(key, answer))?)
    }

    fn path(&self, key: &Key) -> PathBuf {
        let text = serde_json::to_string(key).unwrap_or_default();
        self.folder
            .join(format!("{:016x}.json", content_hash(text.as_bytes())))
    }
}
