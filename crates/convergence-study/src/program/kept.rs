//! Results that are kept by content: a case is not repeated while its command and the files it depends on are unchanged.
//!
//! A result is a file of its own, named after the hash of its [`Key`] and holding the whole key; anything else under that name is not a
//! result, and the case is computed anew.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, io};

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::command::Invocation;
use crate::store::{atomic, content_hash, regular};

/// Version of the form of the files: a result of another form is not a result.
const FORM: u32 = 4;

/// The folder of kept results, beside the study file.
const FOLDER: &str = ".convergence-study";

/// All that a result depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Key {
    form: u32,
    /// The version of this crate, which may read an answer otherwise.
    version: String,
    /// The folder in which the program runs, as the study file has it.
    directory: String,
    words: Vec<String>,
    program: Option<Executable>,
    input: String,
    /// Each file with the hash of its content.
    files: Vec<(String, String)>,
}

/// The program that a name without a folder is found as, through `PATH`: rebuilt or replaced, it is another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Executable {
    /// Without symbolic links.
    path: String,
    /// Bytes.
    size: u64,
    /// Nanoseconds since 1970.
    modified: u128,
}

impl Executable {
    /// `None` for a name with a folder, whose content is in the key, and for one that is not found.
    fn found(Invocation { words, directory, .. }: &Invocation) -> Option<Self> {
        let name = words.first().filter(|name| Path::new(name.as_str()).components().count() == 1)?;
        let folders = env::var_os("PATH")?;
        let candidates = env::split_paths(&folders).map(|folder| directory.join(folder).join(name));
        let path = candidates.filter(|path| is_executable(path)).find_map(|path| path.canonicalize().ok())?;
        let about = path.metadata().ok()?;
        let modified = about.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos();
        Some(Self { path: path.display().to_string(), size: about.len(), modified })
    }
}

#[cfg(unix)]
fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata().is_ok_and(|about| about.is_file() && about.permissions().mode() & 0o111 != 0)
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
    /// * `directory`: where the program runs, as the study file has it.
    /// * `files`: what every result depends on beside its command and the files that this names.
    pub(super) fn new(folder: &Path, id: &str, directory: String, files: Vec<PathBuf>) -> Self {
        Self { folder: folder.join(FOLDER).join(id), directory, files }
    }

    /// The key of a case now. A file that a word of its command names is part of it, whether or not `files` lists it.
    pub(super) fn key(&self, invocation: &Invocation) -> io::Result<Key> {
        let hashed = |path: &PathBuf| {
            let bytes = regular::read(path).map_err(|error| atomic::naming(path, &error))?;
            let name = path.strip_prefix(&invocation.directory).unwrap_or(path);
            Ok((name.display().to_string(), format!("{:016x}", content_hash(&bytes))))
        };
        let named = invocation.words.iter().map(|word| invocation.directory.join(word));
        let named: Vec<PathBuf> = named.filter(|path| path.is_file() && !self.files.contains(path)).collect();
        Ok(Key {
            form: FORM,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            directory: self.directory.clone(),
            words: invocation.words.clone(),
            program: Executable::found(invocation),
            input: invocation.input.clone(),
            files: self.files.iter().chain(&named).map(hashed).collect::<io::Result<_>>()?,
        })
    }

    /// The kept answer of a case; `None` where there is none, whatever else there may be.
    pub(super) fn get(&self, key: &Key) -> Option<Answer> {
        let text = regular::read_to_string(&self.path(key)).ok()?;
        let (kept, answer): (Key, Answer) = serde_json::from_str(&text).ok()?;
        (kept == *key).then_some(answer)
    }

    /// Keeps an answer. Where the files have changed while the program ran, nothing tells which of them it has read: it is not kept.
    pub(super) fn put(&self, key: &Key, invocation: &Invocation, answer: &Answer) -> io::Result<()> {
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
        self.folder.join(format!("{:016x}.json", content_hash(text.as_bytes())))
    }
}
