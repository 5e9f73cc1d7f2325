//! Survivors that are accepted, each with the reason why it changes nothing that counts.

use std::path::Path;

use serde::Deserialize;

use super::list::Mutant;
use convergence_study::cli::exit::Unusable;

/// The list.
pub(super) const FILE: &str = ".cargo/mutants-accepted.toml";

/// The mutants that may survive.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Accepted {
    #[serde(default)]
    accepted: Vec<Entry>,
}

/// One of them, or several of one line: by what it says, for line numbers change.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    file: String,
    /// As cargo-mutants calls it, without the place.
    mutant: String,
    /// The line of the file, without blanks at its ends.
    code: String,
    reason: String,
}

impl Entry {
    fn is(&self, mutant: &Mutant) -> bool {
        (&self.file, &self.mutant, &self.code) == (&mutant.file, &mutant.what, &mutant.code)
    }
}

impl Accepted {
    /// Reads the list; without one nothing is accepted.
    pub(super) fn read(root: &Path) -> Result<Self, Unusable> {
        let path = root.join(FILE);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = std::fs::read_to_string(&path).map_err(|error| Unusable::file(&path, &error))?;
        let list: Self = toml::from_str(&text).map_err(|error| Unusable::file(&path, &error))?;
        match list.accepted.iter().find(|entry| entry.reason.trim().is_empty()) {
            Some(entry) => Err(Unusable::because(&format!("{FILE}: no reason for `{}`", entry.mutant))),
            None => Ok(list),
        }
    }

    /// Why a mutant may survive, if it may.
    pub(super) fn reason(&self, mutant: &Mutant) -> Option<&str> {
        self.accepted.iter().find(|entry| entry.is(mutant)).map(|entry| entry.reason.as_str())
    }

    /// Entries that are about no mutant any more.
    pub(super) fn stale(&self, all: &[Mutant]) -> Vec<String> {
        let stale = self.accepted.iter().filter(|entry| !all.iter().any(|mutant| entry.is(mutant)));
        stale.map(|entry| format!("{}: {} in `{}`", entry.file, entry.mutant, entry.code)).collect()
    }
}
