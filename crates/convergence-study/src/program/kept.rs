//! Answers of levels that are expensive, kept from one `verify` to the next: an answer is taken
//! again if the command and the hashes of the files are the same.
//!
//! The cheapest case is always run, and must answer what it has answered before: what the result
//! depends on and is not in `files` shows there. Its answer replaces the kept one only if both are
//! equal, or if they are of different files. Without a kept answer of the cheapest case, made with
//! the same files, no other is taken.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::answer::Answer;
use super::command::Invocation;
use super::expectation::Expectation;
use super::refine::RefinedCase;
use super::sources::SourceFile;
use crate::input::Refusal;
use crate::store::{atomic, json};
use crate::study::{CaseFailure, HashedFile, content_hash};
use crate::text::named::NamedNumber;
use crate::text::number::error_text;

/// By how much the cheapest case may differ from its kept answer, unless the study has a guard.
const TOLERANCE: f64 = 1e-6;

/// The answers that a study keeps.
#[derive(Debug, Clone)]
pub(super) struct Kept {
    /// What a result depends on.
    files: Vec<SourceFile>,
    /// The case that is always run.
    pub(super) cheapest: RefinedCase,
    /// The relative change tolerated.
    tolerance: f64,
    /// Where they are; unset while nobody asks for them.
    place: OnceLock<Place>,
}

/// Where answers are kept.
#[derive(Debug, Clone)]
struct Place {
    folder: PathBuf,
    may_reuse: bool,
}

/// What decides an answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Made {
    command: Vec<String>,
    directory: String,
    variables: Vec<(String, String)>,
    input: String,
    files: Vec<HashedFile>,
}

/// A kept answer.
#[derive(Debug, Serialize, Deserialize)]
struct KeptAnswer {
    made: Made,
    answer: Answer,
}

impl Kept {
    /// * `names`: of files beside those that the words of a command name.
    /// * `cheapest`: the case that is always run.
    ///
    /// # Errors
    /// A file that is not there.
    pub(super) fn new(
        names: &[String],
        folder: &Path,
        guard: Option<f64>,
        cheapest: RefinedCase,
    ) -> Result<Self, Refusal> {
        Ok(Self {
            files: SourceFile::all("files", names, folder)?,
            cheapest,
            tolerance: guard.unwrap_or(TOLERANCE).max(TOLERANCE),
            place: OnceLock::new(),
        })
    }

    /// Says where answers are kept, and whether they may be taken from there.
    pub(super) fn keep_in(&self, folder: &Path, may_reuse: bool) {
        let folder = folder.to_owned();
        // The first run of a study decides.
        let _ = self.place.set(Place { folder, may_reuse });
    }

    /// The answer of a case: a kept one, or that of the program.
    ///
    /// * `label`, `invocation`: the case; `of_cheapest`: the command of the case that is always
    ///   run.
    /// * `expected`: an answer that lacks one of these numbers is not taken again.
    pub(super) fn answer(
        &self,
        label: &str,
        [invocation, of_cheapest]: [&Invocation; 2],
        expected: &[Expectation],
        run: impl FnOnce() -> Result<Answer, CaseFailure>,
    ) -> Result<Answer, CaseFailure> {
        let Some(place) = self.place.get() else {
            return run();
        };
        let made = self.made(invocation)?;
        let has_all = |answer: &Answer| expected.iter().all(|one| answer.number(one).is_some());
        let kept = place.may_reuse.then(|| place.read(label)).flatten();
        let kept = kept.filter(|kept| kept.made == made && has_all(&kept.answer));
        let cheapest = &self.cheapest.label;
        let is_cheapest = label == cheapest;
        if let Some(kept) = kept.as_ref().filter(|_| !is_cheapest) {
            let made = self.made(of_cheapest)?;
            let witness = place.read(cheapest);
            if witness.is_some_and(|witness| witness.made == made) {
                return Ok(Answer {
                    is_reused: true,
                    ..kept.answer.clone()
                });
            }
        }
        let mut answer = run()?;
        if let Some(kept) = kept.filter(|_| is_cheapest) {
            answer.differs = difference(&kept.answer, &answer, self.tolerance);
        }
        if answer.differs.is_none() {
            place.write(label, made, &answer)?;
        }
        Ok(answer)
    }

    /// What decides the answer of a command. The files that its words name are hashed, too, and so
    /// is a program that the system finds on its search path.
    fn made(&self, invocation: &Invocation) -> Result<Made, CaseFailure> {
        let words = invocation.words.iter();
        let names: BTreeSet<&str> = words.flat_map(|word| names_in(word)).collect();
        let named = names.into_iter().map(|name| SourceFile {
            name: name.to_owned(),
            path: invocation.directory.join(name),
        });
        let named = named.chain(program_on_path(invocation));
        let files = self.files.iter().cloned();
        let files = files.chain(named.filter(|file| file.path.is_file()));
        let files: Result<Vec<_>, _> = files.map(|file| file.hashed()).collect();
        Ok(Made {
            command: invocation.words.clone(),
            directory: invocation.directory.display().to_string(),
            variables: invocation.variables.clone(),
            input: invocation.input.clone(),
            files: files?,
        })
    }
}

/// What a word of a command may name: itself, the words of a shell script, and what follows an `=`
/// in any of them.
fn names_in(word: &str) -> impl Iterator<Item = &str> {
    let pieces = word.split_whitespace();
    let pieces = pieces.map(|piece| piece.trim_matches(|c| "'\"();&|<>".contains(c)));
    pieces.chain([word]).flat_map(|name| {
        let value = name.split_once('=').map(|(_, value)| value);
        [Some(name), value].into_iter().flatten()
    })
}

/// The program that the system finds by a name without a folder.
fn program_on_path(invocation: &Invocation) -> Option<SourceFile> {
    let name = invocation.words.first()?;
    let mut variables = invocation.variables.iter();
    let own = variables.find(|(name, _)| name == "PATH");
    let folders = own.map_or_else(|| env::var_os("PATH"), |(_, path)| Some(path.into()))?;
    let is_name = Path::new(name).components().count() == 1;
    let mut paths = env::split_paths(&folders).map(|folder| folder.join(name));
    let path = paths.find(|path| is_name && path.is_file())?;
    let name = path.display().to_string();
    Some(SourceFile { name, path })
}

impl Place {
    fn file(&self, label: &str) -> PathBuf {
        let name = format!("{}.json", content_hash(label.as_bytes()));
        self.folder.join(name)
    }

    /// The kept answer of a case; `None` if there is none that can be read.
    fn read(&self, label: &str) -> Option<KeptAnswer> {
        let text = fs::read_to_string(self.file(label)).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps an answer, if it is complete.
    fn write(&self, label: &str, made: Made, answer: &Answer) -> Result<(), CaseFailure> {
        if answer.failure.is_some() {
            return Ok(());
        }
        let answer = answer.clone();
        let text = json(&KeptAnswer { made, answer })?;
        fs::create_dir_all(&self.folder)?;
        Ok(atomic::write(&self.file(label), text)?)
    }
}

/// What two answers do not have in common, within a relative tolerance.
fn difference(before: &Answer, now: &Answer, tolerance: f64) -> Option<String> {
    let [before, now] = [before, now].map(numbers);
    let is_same = |one: &NamedNumber| {
        let other = NamedNumber::find(&now, &one.name);
        other.is_some_and(|other| (other - one.value).abs() <= tolerance * one.value.abs())
    };
    if let Some(one) = before.iter().find(|one| !is_same(one)) {
        let other = NamedNumber::find(&now, &one.name);
        let other = other.map_or("missing".to_owned(), error_text);
        return Some(format!(
            "{} was {}, is {other}",
            one.name,
            error_text(one.value)
        ));
    }
    let is_new = |one: &&NamedNumber| NamedNumber::find(&before, &one.name).is_none();
    now.iter()
        .find(is_new)
        .map(|one| format!("{} is new", one.name))
}

/// The steps, errors and values of an answer.
fn numbers(answer: &Answer) -> Vec<NamedNumber> {
    let steps = [("h", answer.h), ("dt", answer.dt)].into_iter();
    let steps = steps.filter_map(|(name, step)| Some(NamedNumber::new(name, step?)));
    [
        steps.collect(),
        answer.errors.clone(),
        answer.values.clone(),
    ]
    .concat()
}
