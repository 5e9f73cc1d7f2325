//! The record of a run: its findings, as data with a versioned schema. Reports are made from it,
//! and programs read it.
//!
//! A study of a record is a [`Finished`] without its times: machine, revision and times belong to
//! the [`Provenance`](crate::store::Provenance). [`Record::committed`] has the digits of the file
//! under version control, which must not change by a byte when nothing has changed; reports are
//! made from it, so that this file suffices to make them anew.
//!
//! A number that is not finite is `null`; `not_finite` says where it is and what it was,
//! `failed_cases` says why. Read back, `null` is NaN. The pictures are separate files next to the
//! record, in [`FIGURES`].

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::run::Finished;
use crate::store::{self, GuardedChange, atomic, diagnosis::Diagnosis, parsed, refused};
use crate::text::number::{committed, committed_rate};
use crate::text::visible::visible;
use convergence_judge::verdict::{RateVerdict, Verdict};

/// Version of the schema; it increases when a field changes its name or meaning, not when one is
/// added.
pub(crate) const SCHEMA: u32 = 1;

/// What counts as a record.
const EXPECTED: &str =
    "expected a record as `verify` writes it to results.json, or `study --format json` prints it";

/// The keys that a record of any version has, and no other file of this harness.
const KEYS: [&str; 3] = ["schema", "crate_version", "studies"];

/// The keys of an object in JSON.
type Keys = BTreeMap<String, IgnoredAny>;

/// Whether a text is a record, of this version or of another.
pub(crate) fn is_record(text: &str) -> bool {
    serde_json::from_str(text).is_ok_and(|keys: Keys| missing(&keys).is_none())
}

/// What a record has and these do not.
fn missing(keys: &Keys) -> Option<&'static str> {
    KEYS.into_iter().find(|key| !keys.contains_key(*key))
}

/// The verdict on a run: the worst of its studies and of what differs from the baseline.
pub(crate) fn verdict_of(studies: &[Finished], changes: &[GuardedChange]) -> Verdict {
    let own = studies.iter().map(|study| study.outcome.verdict);
    let moved = changes.iter().map(|change| change.movement.verdict());
    Verdict::worst(own.chain(moved))
}

/// The folder of the pictures, next to the record.
pub(crate) const FIGURES: &str = "figures";

/// The figures that only the page shows, next to the others; they need not be committed.
pub(crate) const ONLY_ON_PAGE: &str = "figures/page";

/// A whole run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// `SCHEMA`.
    pub schema: u32,
    /// Version of this crate.
    pub crate_version: String,
    /// What was run, such as `quick`.
    pub scope: String,
    /// The command that runs it again; empty in older records.
    #[serde(default)]
    pub command: String,
    /// The verdict on the run, including changes from the baseline.
    pub verdict: Verdict,
    /// Differences from the baseline, in words.
    pub baseline_changes: Vec<String>,
    /// The same as data; `None` without a baseline.
    #[serde(default)]
    pub changes: Option<Vec<GuardedChange>>,
    /// The known facts about the cause, if the run does not pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diagnosis: Option<Diagnosis>,
    /// The studies.
    pub studies: Vec<Finished>,
}

impl Record {
    /// Reads a record that [`json`](crate::store::json) has written; its figures have no pictures.
    pub fn read(path: &Path) -> io::Result<Self> {
        Self::parse(
            &store::read_to_string(path).map_err(atomic::unread(path))?,
            path,
        )
    }

    /// The same from its text.
    ///
    /// # Errors
    /// Also a verdict that is not that of what the record has, as of one that somebody has edited.
    pub fn parse(text: &str, path: &Path) -> io::Result<Self> {
        let keys: Keys = parsed(text, path, None, [EXPECTED; 2])?;
        if let Some(key) = missing(&keys) {
            return Err(refused(path, &format!("found no `{key}`"), EXPECTED));
        }
        let record: Self = parsed(text, path, Some(SCHEMA), [EXPECTED, "1"])?;
        match record.contradiction() {
            Some(found) => Err(refused(path, &found, EXPECTED)),
            None => Ok(record),
        }
    }

    /// What no run writes: a verdict that is not made of what is there.
    fn contradiction(&self) -> Option<String> {
        if self.studies.is_empty() {
            return Some("studies: found none".to_owned());
        }
        for Finished {
            header, outcome, ..
        } in &self.studies
        {
            let id = visible(&header.id);
            let mut rates = outcome.rates.iter().map(|named| &named.rate);
            // Older records have no codes.
            if let Some(rate) = rates.find(|rate| rate.verdict < rate.code.verdict()) {
                let [found, own] = [rate.verdict, rate.code.verdict()];
                let code = rate.code.name();
                return Some(format!(
                    "{id}: rates: found {found}, and the code `{code}`, which makes it {own}"
                ));
            }
            let [found, parts] = [outcome.verdict, outcome.verdict_of_parts()];
            if found < parts {
                return Some(format!(
                    "{id}: verdict: found {found}, and rates and checks that make it {parts}"
                ));
            }
        }
        let moves = self.moves();
        if self.baseline_changes.len() != moves.len() {
            let [words, data] = [self.baseline_changes.len(), moves.len()];
            return Some(format!(
                "baseline_changes: found {words}, and {data} in changes"
            ));
        }
        let parts = verdict_of(&self.studies, moves);
        let found = self.verdict;
        (found != parts).then(|| {
            format!("verdict: found {found}, and studies and changes that make it {parts}")
        })
    }

    /// The record of a run.
    ///
    /// * `changes`: differences from the baseline; `None` without a baseline.
    pub fn new(
        scope: &str,
        command: &str,
        verdict: Verdict,
        changes: Option<&[GuardedChange]>,
        studies: Vec<Finished>,
    ) -> Self {
        Self {
            schema: SCHEMA,
            crate_version: env!("CARGO_PKG_VERSION").to_owned(),
            scope: scope.to_owned(),
            command: command.to_owned(),
            verdict,
            baseline_changes: changes
                .unwrap_or_default()
                .iter()
                .map(GuardedChange::to_string)
                .collect(),
            changes: changes.map(<[GuardedChange]>::to_vec),
            diagnosis: None,
            studies,
        }
    }

    /// Differences from the baseline, if there is one.
    pub fn moves(&self) -> &[GuardedChange] {
        self.changes.as_deref().unwrap_or_default()
    }

    /// The same with digits that do not vary between runs and hardly between machines: see
    /// [`committed`].
    #[must_use]
    pub fn committed(mut self) -> Self {
        for Finished {
            outcome, untested, ..
        } in &mut self.studies
        {
            // Whether it was searched for depends on the command.
            untested.clear();
            for level in &mut outcome.levels {
                level
                    .errors
                    .iter_mut()
                    .for_each(|error| error.value = committed(error.value));
                level.step = level.step.map(committed);
                level.work = level.work.map(committed);
            }
            for named in &mut outcome.rates {
                round(&mut named.rate);
            }
            outcome
                .quantities
                .iter_mut()
                .for_each(|quantity| quantity.value = committed(quantity.value));
        }
        self
    }
}

fn round(rate: &mut RateVerdict) {
    rate.pairwise
        .iter_mut()
        .for_each(|rate| *rate = committed_rate(*rate));
    rate.fitted = rate.fitted.map(committed_rate);
    rate.constant = rate.constant.map(committed);
    rate.interval = rate.interval.map(|ends| ends.map(committed_rate));
    rate.extrapolated = rate.extrapolated.map(committed_rate);
}
