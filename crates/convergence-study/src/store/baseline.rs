//! The baseline: numbers of an earlier run that a new one must reproduce, each within its
//! tolerance, the claims about them, and a hash of the settings of each study.
//!
//! The file is `studies/baseline.json`: it states expectations, so it lives with the claims and not
//! with the files that a run writes. Only a blessing changes it. Numbers have all their digits.
//!
//! ```json
//! {
//!   "schema": 3,
//!   "studies": {
//!     "heat-equation-space": {
//!       "settings": "a26f2ae7c1f5cb07",
//!       "numbers": {
//!         "error l2, n = 64": [4.4e-8, 0.000001],
//!         "rate l2": [2.0003, 0.0001, "2 ± 0.02"]
//!       }
//!     }
//!   }
//! }
//! ```
//!
//! A line has a number, the relative change tolerated, and what the study claims of the number.
//! `claims` has what a study in code claims of other numbers, by their names.
//! `settings` is the hash of every value of the study's file, of the labels of its cases, of the
//! names of its numbers, and of which have a claim: what somebody deletes is missed.
//! `sources` has the hashes of a table that a study judges, and of the files that it was made from.
//! `guard` the tolerance that the file asks for; `test` the test that the study belongs to.
//!
//! What is loosened, changed in its settings or taken away is blessed only on demand: a blessing
//! of moved numbers does not accept it by the way. Why it was done, and what there was before, git
//! keeps.
//!
//! The baseline can only make a run worse: studies are first judged on their own, and a run that
//! did not pass is not blessed.

mod change;
mod hash;
mod text;

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::run::Finished;
use crate::store::{atomic, read_if_there};
use crate::study::{Header, Must, Outcome, Quantity, Sources};
use crate::text::json;
use convergence_judge::verdict::Verdict;

use change::meets;
pub(crate) use change::without_baseline;
pub(crate) use change::{GuardedChange, Movement};
use hash::{Lines, Names, hash};

/// Version of the file format.
const SCHEMA: u32 = 3;

/// What to do about another version.
const EXPECTED: &str = "3, which keeps a hash of each study's settings instead of their values; restore the file, or remove it and run \
                        `verify --bless`, then `verify --tier full --bless`";

/// The setting by which pytest finds the test of a study.
const TEST: &str = "test";

/// The committed numbers and claims.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Baseline {
    schema: u32,
    /// Sorted by id, so that a blessing changes only the lines that moved.
    studies: BTreeMap<String, Blessed>,
}

/// A study as it was blessed.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Blessed {
    /// The hash of its settings; `None`, which agrees with none, if somebody has removed it.
    #[serde(default)]
    settings: Option<String>,
    /// The relative change tolerated of each of its numbers, if its file states one.
    #[serde(default)]
    guard: Option<f64>,
    /// The test that it belongs to, if any.
    #[serde(default)]
    test: Option<String>,
    /// Sorted by name.
    numbers: BTreeMap<String, Guarded>,
    /// What it claims of numbers that are not guarded, by their names.
    #[serde(default)]
    claims: BTreeMap<String, Must>,
    /// The table that it judges, and the files that this was made from, if it has one.
    #[serde(default)]
    sources: Option<Sources>,
}

impl Blessed {
    /// What a run has found, without the hash of its settings.
    fn of(header: &Header, outcome: &Outcome) -> Self {
        let mut settings = header.settings.iter();
        let test = settings.find(|(path, _)| path == TEST);
        let numbers = outcome.quantities.iter();
        let numbers = numbers.map(|quantity| (quantity.name.clone(), Guarded::from(quantity)));
        Self {
            settings: None,
            guard: header.guard,
            test: test.map(|(_, test)| test.clone()),
            numbers: numbers.collect(),
            claims: outcome.claims().into_iter().collect(),
            sources: outcome.sources.clone(),
        }
    }
}

/// A guarded number.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(from = "Line")]
pub(crate) struct Guarded {
    /// Its value; `null`, which agrees with nothing, is read as NaN.
    pub value: f64,
    /// The relative change tolerated.
    pub tolerance: f64,
    /// What it must be, if the study claims that.
    pub claim: Option<Must>,
}

/// A guarded number as a line of the file.
#[derive(Serialize, Deserialize)]
struct Line(
    #[serde(deserialize_with = "json::nan")] f64,
    #[serde(deserialize_with = "json::nan")] f64,
    #[serde(default, skip_serializing_if = "Option::is_none")] Option<Must>,
);

impl From<Line> for Guarded {
    fn from(Line(value, tolerance, claim): Line) -> Self {
        Self {
            value,
            tolerance,
            claim,
        }
    }
}

impl From<&Quantity> for Guarded {
    fn from(quantity: &Quantity) -> Self {
        Self {
            value: quantity.value,
            tolerance: quantity.tolerance,
            claim: quantity.claim,
        }
    }
}

/// Why a run was not accepted as baseline. Shown in the words of the command line.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}", self.words("--bless --loosened"))]
pub enum BlessingRefusal {
    /// A study does not pass; a number cannot be met by any run, because it is not finite or its
    /// tolerance is invalid: in words.
    Unacceptable(String),
    /// These changes loosen what is guarded, which was not asked for.
    Loosened(Vec<GuardedChange>),
}

impl BlessingRefusal {
    /// The message.
    ///
    /// * `blessing`: the options that also bless what is loosened.
    pub fn words(&self, blessing: &str) -> String {
        match self {
            Self::Unacceptable(why) => format!("not blessed: {why}"),
            Self::Loosened(changes) => {
                let lines = changes.iter().map(|change| format!("\n  {change}"));
                let lines: String = lines.collect();
                format!("not blessed: less would be guarded; if that is meant: {blessing}{lines}")
            }
        }
    }
}

impl Default for Baseline {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            studies: BTreeMap::new(),
        }
    }
}

impl Baseline {
    /// Reads the file. A missing file is an empty baseline: every number is then new.
    ///
    /// # Errors
    /// A file that exists but is not a baseline.
    pub(crate) fn read(path: &Path) -> io::Result<Self> {
        let expected = [
            "restore it, or remove it and run `verify --bless`",
            EXPECTED,
        ];
        Ok(read_if_there(path, Some(SCHEMA), expected)?.unwrap_or_default())
    }

    /// Writes the file, as a whole or not at all.
    pub(crate) fn write(&self, path: &Path) -> io::Result<()> {
        atomic::write(path, text::of(self)?)
    }

    /// Every difference between the baseline and these studies.
    ///
    /// * `known`: the headers of all existing studies, run or not, with their cases: settings are
    ///   compared for all of them, numbers for those that were run. A study of the baseline that is
    ///   not among them was deleted, which is one change, including its numbers; `None` if only a
    ///   selection matters.
    pub(crate) fn compare(
        &self,
        finished: &[Finished],
        known: Option<&[Header]>,
    ) -> Vec<GuardedChange> {
        let mut changes = Vec::new();
        for Finished {
            header, outcome, ..
        } in finished
        {
            let found = Blessed::of(header, outcome);
            let lines = self.lines(header, &found.names());
            let mut of_study = self.changed_settings(header, lines);
            of_study.extend(self.changed_numbers(header, &outcome.quantities));
            of_study.extend(self.changed_claims(&header.id, &found.claims));
            of_study.extend(self.changed_sources(&header.id, outcome.sources.as_ref()));
            if lines == Lines::Deleted {
                of_study
                    .iter_mut()
                    .for_each(|change| change.movement.name_deletion());
            }
            changes.append(&mut of_study);
        }
        let others = known
            .unwrap_or_default()
            .iter()
            .filter(|header| find(finished, &header.id).is_none());
        changes.extend(others.flat_map(|header| {
            let lines = self.lines(header, &Names::new());
            self.changed_settings(header, lines)
        }));
        for id in self.vanished(known) {
            let numbers = self.guards(&id);
            let movement = Movement::VanishedStudy { numbers };
            changes.push(GuardedChange::new(&id, change::STUDY, movement));
        }
        changes
    }

    /// What the hash of a study says of it.
    ///
    /// * `found`: the names that it has now, if it was run.
    fn lines(&self, header: &Header, found: &Names) -> Lines {
        let Some(blessed) = self.studies.get(&header.id) else {
            return Lines::Whole;
        };
        let is_hash_with = |names: &Names| blessed.settings.as_ref() == Some(&hash(header, names));
        let mut names = blessed.names();
        if is_hash_with(&names) {
            return Lines::Whole;
        }
        names.extend(found.clone());
        if is_hash_with(&names) {
            Lines::Deleted
        } else {
            Lines::Others
        }
    }

    /// Settings and guard of a study that differ, or a study that is new.
    fn changed_settings(&self, header: &Header, lines: Lines) -> Vec<GuardedChange> {
        let change = |name, movement| GuardedChange::new(&header.id, name, movement);
        let Some(blessed) = self.studies.get(&header.id) else {
            return vec![change(change::STUDY, Movement::NewStudy)];
        };
        let guard = blessed.guard;
        let mut changes = vec![];
        if lines == Lines::Others {
            let from = blessed.settings.clone();
            let to = hash(header, &blessed.names());
            changes.push(change(change::SETTINGS, Movement::Settings { from, to }));
        }
        if guard != header.guard {
            let [from, to] = [guard, header.guard];
            changes.push(change(change::GUARD, Movement::Guard { from, to }));
        }
        changes
    }

    /// The changed numbers of one study and claims about them: in the run's order, then those that
    /// have vanished.
    fn changed_numbers(&self, header: &Header, found: &[Quantity]) -> Vec<GuardedChange> {
        let id = &header.id;
        let none = Blessed::default();
        let Blessed { guard, numbers, .. } = self.studies.get(id).unwrap_or(&none);
        let mut changes = Vec::new();
        for quantity in found {
            let movements = change::of_number(numbers.get(&quantity.name), *guard, quantity);
            for movement in movements {
                changes.push(GuardedChange::new(id, &quantity.name, movement));
            }
        }
        let names: BTreeSet<&String> = found.iter().map(|quantity| &quantity.name).collect();
        for (name, Guarded { value, .. }) in numbers {
            if !names.contains(name) {
                let movement = Movement::Vanished { value: *value };
                changes.push(GuardedChange::new(id, name, movement));
            }
        }
        changes
    }

    /// Claims of one study about numbers that are not guarded, where they have changed.
    fn changed_claims(&self, id: &str, found: &BTreeMap<String, Must>) -> Vec<GuardedChange> {
        // Those of a new study are new with it.
        let Some(Blessed { claims, .. }) = self.studies.get(id) else {
            return vec![];
        };
        let names: BTreeSet<&String> = claims.keys().chain(found.keys()).collect();
        let mut changes = vec![];
        for name in names {
            let [from, to] = [claims, found].map(|claims| claims.get(name).copied());
            if from != to {
                changes.push(GuardedChange::new(id, name, Movement::Claim { from, to }));
            }
        }
        changes
    }

    /// The inputs of a table of one study, where they have changed and the table has not; or that
    /// their hashes are gone.
    fn changed_sources(&self, id: &str, found: Option<&Sources>) -> Option<GuardedChange> {
        let (blessed, found) = (self.studies.get(id)?, found?);
        let movement = match &blessed.sources {
            None => Movement::DeletedLine,
            Some(before) => {
                let inputs = found.newer_than_table(before);
                if inputs.is_empty() {
                    return None;
                }
                Movement::Stale { inputs }
            }
        };
        Some(GuardedChange::new(id, change::SOURCES, movement))
    }

    /// The ids of studies in the baseline that no longer exist.
    fn vanished(&self, known: Option<&[Header]>) -> Vec<String> {
        let Some(known) = known else { return vec![] };
        let known: BTreeSet<&String> = known.iter().map(|header| &header.id).collect();
        let blessed = self.studies.keys();
        blessed.filter(|id| !known.contains(id)).cloned().collect()
    }

    /// Accepts the numbers of these studies that have moved or are new; all others keep their
    /// digits. Likewise accepts their claims, settings and guards.
    ///
    /// * `known`: as for [`Baseline::compare`]; studies that have vanished are dropped.
    /// * `loosened`: whether to accept also what is loosened, changed in its settings, or gone.
    /// * Returns the changes accepted for that reason.
    ///
    /// # Errors
    /// [`BlessingRefusal`]; the baseline then stays unchanged.
    pub(crate) fn bless(
        &mut self,
        finished: &[Finished],
        known: Option<&[Header]>,
        loosened: bool,
    ) -> Result<Vec<GuardedChange>, BlessingRefusal> {
        finished.iter().try_for_each(acceptable)?;
        let vanished = self.vanished(known);
        let mut looser = self.compare(finished, known);
        // Settings of known studies that were not run are left alone.
        looser.retain(|change| {
            let is_accepted =
                find(finished, &change.study).is_some() || vanished.contains(&change.study);
            is_accepted && change.movement.is_loosened()
        });
        if !looser.is_empty() && !loosened {
            return Err(BlessingRefusal::Loosened(looser));
        }
        for id in vanished {
            self.studies.remove(&id);
        }
        for study in finished {
            self.take(study);
        }
        Ok(looser)
    }

    fn take(
        &mut self,
        Finished {
            header, outcome, ..
        }: &Finished,
    ) {
        let before = self.studies.remove(&header.id).unwrap_or_default();
        let mut blessed = Blessed::of(header, outcome);
        for (name, number) in &mut blessed.numbers {
            let kept = before.numbers.get(name);
            if let Some(kept) = kept.filter(|kept| meets(kept, before.guard, number.value)) {
                number.value = kept.value;
            }
        }
        blessed.settings = Some(hash(header, &blessed.names()));
        self.studies.insert(header.id.clone(), blessed);
    }

    /// The ids of the studies that it guards, and the test that each belongs to, if any.
    pub(crate) fn tests(&self) -> impl Iterator<Item = (&str, Option<&str>)> {
        let studies = self.studies.iter();
        studies.map(|(id, blessed)| (id.as_str(), blessed.test.as_deref()))
    }

    #[cfg(test)]
    /// A guarded number of a study.
    pub(crate) fn number(&self, id: &str, name: &str) -> Option<&Guarded> {
        self.studies.get(id)?.numbers.get(name)
    }

    /// Number of guarded numbers of a study.
    pub(crate) fn guards(&self, id: &str) -> usize {
        self.studies
            .get(id)
            .map_or(0, |blessed| blessed.numbers.len())
    }
}

fn find<'f>(finished: &'f [Finished], id: &str) -> Option<&'f Finished> {
    finished.iter().find(|finished| finished.header.id == *id)
}

fn acceptable(
    Finished {
        header, outcome, ..
    }: &Finished,
) -> Result<(), BlessingRefusal> {
    let study = &header.id;
    let verdict = outcome.verdict;
    if verdict != Verdict::Pass {
        return Err(BlessingRefusal::Unacceptable(format!(
            "the verdict on `{study}` is {verdict}, and a baseline is made of runs that pass"
        )));
    }
    let cannot_be_met = |quantity: &&Quantity| {
        let own = Guarded::from(*quantity);
        !meets(&own, header.guard, quantity.value)
    };
    outcome.quantities.iter().find(cannot_be_met).map_or(Ok(()), |Quantity { name, value, tolerance, .. }| {
        Err(BlessingRefusal::Unacceptable(format!(
            "`{name}` of `{study}` is {value} with a tolerance of {tolerance}, which no run can meet"
        )))
    })
}
