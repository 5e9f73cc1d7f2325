//! The hash of a study's settings and of the names of its numbers, by which deleted lines are
//! missed.

use std::collections::BTreeMap;

use super::{Blessed, change};
use crate::study::Header;
use crate::study::content_hash;

/// What the hash of a study says of its lines in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lines {
    /// They are those that were blessed, with these settings.
    Whole,
    /// With the numbers of the run that the file lacks they would be: somebody has deleted them.
    Deleted,
    /// The settings are others, or the lines.
    Others,
}

/// The names of numbers, and whether each has a claim.
pub(super) type Names = BTreeMap<String, bool>;

impl Blessed {
    pub(super) fn names(&self) -> Names {
        let numbers = self.numbers.iter();
        let numbers = numbers.map(|(name, number)| (name.clone(), number.claim.is_some()));
        let claims = self.claims.keys().map(|name| (name.clone(), true));
        let sources = self.sources.is_some();
        let sources = sources.then(|| (change::SOURCES.to_owned(), false));
        numbers.chain(claims).chain(sources).collect()
    }
}

/// The hash of every value of a study's file, of the labels of its cases, and of its names.
pub(super) fn hash(
    Header {
        settings, cases, ..
    }: &Header,
    names: &Names,
) -> String {
    let mut lines: Vec<String> = settings
        .iter()
        .map(|(path, value)| format!("{path} = {value}\n"))
        .collect();
    lines.sort_unstable();
    lines.extend(cases.iter().map(|case| format!("case {}\n", case.label)));
    let names = names.iter();
    lines.extend(names.map(|(name, claimed)| format!("number {name}, claimed: {claimed}\n")));
    content_hash(lines.concat().as_bytes())
}
