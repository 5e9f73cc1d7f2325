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
//! `code` says that a study has no file. `guard` is the tolerance that the file asks for; `test`
//! the test that the study belongs to.
//!
//! What is loosened, changed in its settings or taken away is blessed only on demand: a blessing
//! of moved numbers does not accept it by the way. Why it was done, and what there was before, git
//! keeps.
//!
//! The baseline can only make a run worse: studies are first judged on their own, and a run that
//! did not pass is not blessed.

mod change;
mod hash;

use std::collections::{BTreeMap, BTreeSet};
use std::marker::PhantomData;
use std::path::Path;
use std::{fmt, io};

use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;
use thiserror::Error;

use crate::run::Finished;
use crate::store::{read_if_there, write_json};
use crate::study::{Header, Must, Quantity, TableOrigin};
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Baseline {
    schema: u32,
    /// Sorted by id, so that a blessing changes only the lines that moved.
    #[serde(deserialize_with = "each_once")]
    studies: BTreeMap<String, Blessed>,
}

/// A study as it was blessed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Blessed {
    /// The hash of its settings; `None`, which agrees with none, if somebody has removed it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    settings: Option<String>,
    /// The test that it belongs to, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    test: Option<String>,
    /// Whether it is in code, and not in a file: not every program of the project has it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    code: bool,
    /// The relative change tolerated of each of its numbers, if its file states one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    guard: Option<f64>,
    /// The table that it judges, and the files that this was made from, if it has one.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        serialize_with = "on_one_line"
    )]
    sources: Option<TableOrigin>,
    /// Sorted by name.
    #[serde(deserialize_with = "each_once")]
    numbers: BTreeMap<String, Guarded>,
    /// What it claims of numbers that are not guarded, by their names.
    #[serde(
        default,
        deserialize_with = "each_once",
        skip_serializing_if = "BTreeMap::is_empty"
    )]
    claims: BTreeMap<String, Must>,
}

impl Blessed {
    /// What a run has found, without the hash of its settings.
    fn of(
        Finished {
            header, outcome, ..
        }: &Finished,
    ) -> Self {
        let mut settings = header.settings.iter();
        let test = settings.find(|(path, _)| path == TEST);
        let numbers = outcome.quantities.iter();
        let numbers = numbers.map(|quantity| (quantity.name.clone(), Guarded::from(quantity)));
        Self {
            settings: None,
            code: header.home.is_some(),
            guard: header.guard,
            test: test.map(|(_, test)| test.clone()),
            numbers: numbers.collect(),
            claims: outcome.claims().into_iter().collect(),
            sources: outcome.sources.clone(),
        }
    }

    /// What its hash says of its lines.
    fn lines(&self, header: &Header, now: Option<&Self>) -> Lines {
        let is_hash_with = |names: &Names| self.settings.as_ref() == Some(&hash(header, names));
        let mut names = self.names();
        if is_hash_with(&names) {
            return Lines::Whole;
        }
        names.extend(now.map(Self::names).unwrap_or_default());
        if is_hash_with(&names) {
            Lines::Deleted
        } else {
            Lines::Others
        }
    }

    /// What has changed since then: settings and guard, numbers, claims, sources.
    fn changes(&self, header: &Header, now: Option<&Self>) -> Vec<GuardedChange> {
        let change = |name: &str, movement| GuardedChange::new(&header.id, name, movement);
        let lines = self.lines(header, now);
        let mut changes = vec![];
        if lines == Lines::Others {
            let from = self.settings.clone();
            let to = hash(header, &self.names());
            changes.push(change(change::SETTINGS, Movement::Settings { from, to }));
        }
        if self.guard != header.guard {
            let [from, to] = [self.guard, header.guard];
            changes.push(change(change::GUARD, Movement::Guard { from, to }));
        }
        let Some(now) = now else { return changes };
        for name in names_of_both(&self.numbers, &now.numbers) {
            let [from, to] = [self, now].map(|side| side.numbers.get(name));
            let movements = change::of_number(from, self.guard, to).into_iter();
            changes.extend(movements.map(|movement| change(name, movement)));
        }
        for name in names_of_both(&self.claims, &now.claims) {
            let [from, to] = [self, now].map(|side| side.claims.get(name).copied());
            if from != to {
                changes.push(change(name, Movement::Claim { from, to }));
            }
        }
        let of_sources = change::of_sources(self.sources.as_ref(), now.sources.as_ref());
        changes.extend(of_sources.map(|movement| change(change::SOURCES, movement)));
        if lines == Lines::Deleted {
            for change in &mut changes {
                change.movement.name_deletion();
            }
        }
        changes
    }
}

/// Reads a map that has each name once, as a merge that keeps both sides may not: the last one
/// would silently win.
fn each_once<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<BTreeMap<String, T>, D::Error> {
    struct Entries<T>(PhantomData<T>);
    impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
        type Value = BTreeMap<String, T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an object")
        }

        fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
            let mut entries = BTreeMap::new();
            while let Some(name) = map.next_key::<String>()? {
                if entries.contains_key(&name) {
                    return Err(M::Error::custom(format!("`{name}` occurs twice")));
                }
                entries.insert(name, map.next_value()?);
            }
            Ok(entries)
        }
    }
    deserializer.deserialize_map(Entries(PhantomData))
}

/// The names of two maps, each once.
fn names_of_both<'m, T>(
    one: &'m BTreeMap<String, T>,
    other: &'m BTreeMap<String, T>,
) -> BTreeSet<&'m String> {
    one.keys().chain(other.keys()).collect()
}

/// A guarded number: a list on a line of the file, so that a difference between two versions is one
/// of lines.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub(crate) struct Guarded {
    /// Its value; `null`, which agrees with nothing, is read as NaN.
    #[serde(deserialize_with = "json::nan")]
    pub value: f64,
    /// The relative change tolerated.
    #[serde(deserialize_with = "json::nan")]
    pub tolerance: f64,
    /// What it must be, if the study claims that.
    #[serde(default)]
    pub claim: Option<Must>,
}

impl Serialize for Guarded {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self {
            value,
            tolerance,
            claim,
        } = self;
        let line = match claim {
            Some(claim) => serde_json::to_string(&(value, tolerance, claim)),
            None => serde_json::to_string(&(value, tolerance)),
        };
        raw(line.map(|line| line.replace(',', ", ")), serializer)
    }
}

fn on_one_line<S: Serializer>(
    sources: &Option<TableOrigin>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    raw(serde_json::to_string(sources), serializer)
}

fn raw<S: Serializer>(line: serde_json::Result<String>, serializer: S) -> Result<S::Ok, S::Error> {
    let line = line.and_then(RawValue::from_string);
    line.map_err(S::Error::custom)?.serialize(serializer)
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
pub(crate) enum BlessingRefusal {
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
    pub(crate) fn words(&self, blessing: &str) -> String {
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

/// Ids of studies in the baseline that are not known.
#[derive(Default)]
struct Missing {
    /// They no longer exist.
    vanished: Vec<String>,
    /// They are in code, and the program has no studies in code.
    elsewhere: Vec<String>,
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
        write_json(path, self)
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
        let others = known.unwrap_or_default().iter();
        let others = others.filter(|header| find(finished, &header.id).is_none());
        let mut changes = vec![];
        for study in finished {
            changes.append(&mut self.changes(&study.header, Some(&Blessed::of(study))));
        }
        for header in others {
            changes.append(&mut self.changes(header, None));
        }
        let missing = self.missing(known);
        for id in missing.vanished {
            let numbers = self.guards(&id);
            let movement = Movement::VanishedStudy { numbers };
            changes.push(GuardedChange::new(&id, change::STUDY, movement));
        }
        for id in missing.elsewhere {
            changes.push(GuardedChange::new(&id, change::STUDY, Movement::Elsewhere));
        }
        changes
    }

    /// What has changed of a study.
    ///
    /// * `now`: what a run has found; without one only settings are compared.
    fn changes(&self, header: &Header, now: Option<&Blessed>) -> Vec<GuardedChange> {
        if let Some(blessed) = self.studies.get(&header.id) {
            return blessed.changes(header, now);
        }
        let new = GuardedChange::new(&header.id, change::STUDY, Movement::NewStudy);
        let numbers = now.into_iter().flat_map(|now| &now.numbers);
        let numbers = numbers.map(|(name, Guarded { value, .. })| {
            GuardedChange::new(&header.id, name, Movement::New { value: *value })
        });
        [new].into_iter().chain(numbers).collect()
    }

    /// The studies in the baseline that are not known.
    fn missing(&self, known: Option<&[Header]>) -> Missing {
        let mut missing = Missing::default();
        let Some(known) = known else { return missing };
        let has_code = known.iter().any(|header| header.home.is_some());
        let known: BTreeSet<&String> = known.iter().map(|header| &header.id).collect();
        for (id, blessed) in &self.studies {
            match blessed.code && !has_code {
                _ if known.contains(id) => {}
                true => missing.elsewhere.push(id.clone()),
                false => missing.vanished.push(id.clone()),
            }
        }
        missing
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
        let vanished = self.missing(known).vanished;
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

    fn take(&mut self, study: &Finished) {
        let header = &study.header;
        let before = self.studies.remove(&header.id).unwrap_or_default();
        let mut blessed = Blessed::of(study);
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
