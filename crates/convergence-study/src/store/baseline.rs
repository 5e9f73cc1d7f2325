//! The baseline: numbers of an earlier run that a new one must reproduce, each within its
//! tolerance, and the claims of the study files when they were blessed: every value of every file.
//!
//! The file is `studies/baseline.json`: it states expectations, so it lives with the claims and not
//! with the files that a run writes. Only a blessing changes it. Numbers have all their digits.
//!
//! ```json
//! {
//!   "schema": 2,
//!   "claims": { "heat-equation-space": { "expect[0].tolerance": { "value": "0.02", "reason": "levels are few" } } },
//!   "studies": { "heat-equation-space": { "error l2, n = 64": { "value": 4.4e-8, "tolerance": 0.001 } } }
//! }
//! ```
//!
//! A changed claim is blessed only with a reason, which is kept with it; a withdrawn claim stays as
//! `null` with the reason. A blessing accepts the claims of the studies that were run: a claim
//! changes only with a run that passes.
//!
//! A number that is accepted alone, or blessed with a reason, keeps its reason, too.
//!
//! The baseline can only make a run worse: studies are first judged on their own, and a run that
//! did not pass is not blessed.
//!
//! The file `studies/work.json` next to it has the work of each case when it was blessed. It guards
//! nothing: it stops runs that go wrong, at the same step on every machine.

mod change;

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::judge::verdict::Verdict;
use crate::run::Finished;
use crate::store::{read_if_there, write_json};
use crate::study::{Header, Quantity};
use crate::text::{json, visible};

use change::Claims;
pub(crate) use change::signed_percent;
pub(crate) use change::without_baseline;
pub use change::{BlessedClaim, GuardedChange, Movement};

/// Version of the file format.
const SCHEMA: u32 = 2;

/// What to do about another version.
const EXPECTED: &str = "2, which also guards what study files claim; remove the file and run `verify --bless`, then `verify --tier full --bless`; to \
                        keep the numbers of schema 1, write `\"schema\": 2, \"claims\": {}` in place of its version first";

/// The committed numbers and claims.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    schema: u32,
    /// Sorted by id and path.
    claims: BTreeMap<String, Claims>,
    /// Sorted by id and name, so that a blessing changes only the lines that moved.
    studies: BTreeMap<String, BTreeMap<String, Guarded>>,
}

/// A guarded number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guarded {
    /// Its value; `null`, which agrees with nothing, is read as NaN.
    #[serde(deserialize_with = "json::nan")]
    pub value: f64,
    /// The relative change tolerated.
    #[serde(deserialize_with = "json::nan")]
    pub tolerance: f64,
    /// Why it was changed; `None` if no reason was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// Why a run was not accepted as baseline. Shown in the words of the command line.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}", self.words("--bless --reason TEXT"))]
pub enum BlessingRefusal {
    /// A study does not pass, or was not run; a number cannot be met by any run, because it is not
    /// finite or its tolerance is invalid: in words.
    Unacceptable(String),
    /// These claims have changed, and no reason is given.
    Unreasoned(Vec<String>),
}

impl BlessingRefusal {
    /// The message.
    ///
    /// * `blessing`: the options that bless with a reason.
    pub fn words(&self, blessing: &str) -> String {
        match self {
            Self::Unacceptable(why) => why.clone(),
            Self::Unreasoned(claims) => format!(
                "not blessed: a changed claim needs a reason; repeat it with {blessing}\n  {}",
                claims.join("\n  ")
            ),
        }
    }
}

impl Default for Baseline {
    fn default() -> Self {
        Self {
            schema: SCHEMA,
            claims: BTreeMap::new(),
            studies: BTreeMap::new(),
        }
    }
}

impl Baseline {
    /// Reads the file. A missing file is an empty baseline: every number is then new.
    ///
    /// # Errors
    /// A file that exists but is not a baseline.
    pub fn read(path: &Path) -> io::Result<Self> {
        let expected = [
            "restore it, or remove it and run `verify --bless`",
            EXPECTED,
        ];
        Ok(read_if_there(path, Some(SCHEMA), expected)?.unwrap_or_default())
    }

    /// Writes the file, as a whole or not at all.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        write_json(path, self)
    }

    /// Every guarded number of these studies and every claim that differs: moved, changed, new or
    /// vanished.
    ///
    /// * `known`: the headers of all existing studies, run or not: claims are compared for all of
    ///   them, numbers for those that were run. A study of the baseline that is not among them was
    ///   deleted, which is one change, including its numbers; `None` if only a selection matters.
    pub fn compare(&self, finished: &[Finished], known: Option<&[Header]>) -> Vec<GuardedChange> {
        let none = BTreeMap::new();
        let mut changes = Vec::new();
        for Finished {
            header, outcome, ..
        } in finished
        {
            changes.extend(self.changed_claims(header));
            let expected = self.studies.get(&header.id).unwrap_or(&none);
            changes.extend(change::of_numbers(
                &header.id,
                expected,
                &outcome.quantities,
            ));
        }
        let others = known
            .unwrap_or_default()
            .iter()
            .filter(|header| find(finished, &header.id).is_none());
        changes.extend(others.flat_map(|header| self.changed_claims(header)));
        for id in self.vanished(known) {
            match self
                .claims
                .get(&id)
                .and_then(|claims| change::vanished(&id, claims))
            {
                // This change already covers its numbers.
                Some(deleted) => changes.push(deleted),
                None => changes.extend(change::of_numbers(
                    &id,
                    self.studies.get(&id).unwrap_or(&none),
                    &[],
                )),
            }
        }
        changes
    }

    fn changed_claims(&self, header: &Header) -> Vec<GuardedChange> {
        change::of_claims(header, self.claims.get(&header.id), self.guards(&header.id))
    }

    /// The ids of studies in the baseline that no longer exist.
    fn vanished(&self, known: Option<&[Header]>) -> Vec<String> {
        let Some(known) = known else { return vec![] };
        let known: BTreeSet<&String> = known.iter().map(|header| &header.id).collect();
        let blessed: BTreeSet<&String> = self.claims.keys().chain(self.studies.keys()).collect();
        blessed.difference(&known).map(|id| (*id).clone()).collect()
    }

    /// Accepts the numbers of these studies that have moved or are new; all others keep their
    /// digits. Likewise accepts their claims; unchanged claims keep their reasons.
    ///
    /// * `known`: as for [`Baseline::compare`]; the numbers of studies that have vanished are
    ///   dropped, their claims withdrawn.
    /// * `reason`: why claims have changed or vanished; not required if none has, nor for a new
    ///   study.
    ///
    /// # Errors
    /// [`BlessingRefusal`]; the baseline then stays unchanged.
    pub fn bless(
        &mut self,
        finished: &[Finished],
        known: Option<&[Header]>,
        reason: Option<&str>,
    ) -> Result<(), BlessingRefusal> {
        finished.iter().try_for_each(acceptable)?;
        let mut changes = self.compare(finished, known);
        // Claims of known studies that were not run are left alone.
        let is_left =
            |id: &str| known.is_some_and(|known| known.iter().any(|header| header.id == *id));
        changes.retain(|change| find(finished, &change.study).is_some() || !is_left(&change.study));
        let unreasoned = changes
            .iter()
            .filter(|change| reason.is_none() && change.movement.needs_a_reason());
        let claims: Vec<String> = unreasoned
            .map(|change| visible::visible(&change.to_string()))
            .collect();
        if !claims.is_empty() {
            return Err(BlessingRefusal::Unreasoned(claims));
        }
        changes.iter().try_for_each(|change| {
            let is_new = matches!(change.movement, Movement::New { .. });
            self.take(finished, change, reason.filter(|_| !is_new))
        })
    }

    /// Accepts one of the changes found by [`Baseline::compare`]; all others stay as they are.
    ///
    /// * `reason`: kept with the number or the claim.
    ///
    /// # Errors
    /// [`BlessingRefusal`]; the baseline then stays unchanged. As for [`Baseline::bless`], the
    /// study must pass.
    pub fn accept(
        &mut self,
        finished: &[Finished],
        change: &GuardedChange,
        reason: &str,
    ) -> Result<(), BlessingRefusal> {
        find(finished, &change.study).map_or(Ok(()), acceptable)?;
        self.take(finished, change, Some(reason))
    }

    fn take(
        &mut self,
        finished: &[Finished],
        change: &GuardedChange,
        reason: Option<&str>,
    ) -> Result<(), BlessingRefusal> {
        let GuardedChange {
            study,
            name,
            movement,
        } = change;
        let reason = reason.filter(|text| !text.is_empty()).map(str::to_owned);
        let claims = &mut self.claims;
        let numbers = &mut self.studies;
        match (movement, find(finished, study)) {
            (Movement::Vanished { .. }, _) => {
                numbers
                    .get_mut(study)
                    .into_iter()
                    .for_each(|guarded| drop(guarded.remove(name)));
            }
            (Movement::VanishedFile { .. }, _) => {
                numbers.remove(study);
                // The reason stays.
                let value = None;
                let withdrawn = BlessedClaim { value, reason };
                claims.insert(study.clone(), [(change::ID.to_owned(), withdrawn)].into());
            }
            // It changes only with a run that passes.
            (_, None) => {
                return Err(BlessingRefusal::Unacceptable(format!(
                    "not accepted: `{study}` was not run; name it, or its tier"
                )));
            }
            (Movement::NewFile { guarded, .. }, Some(ran)) => {
                let reason = reason.filter(|_| *guarded > 0);
                let study_claims = claims.entry(study.clone()).or_default();
                for (path, value) in &ran.header.settings {
                    let value = Some(value.clone());
                    let reason = reason.clone();
                    study_claims.insert(path.clone(), BlessedClaim { value, reason });
                }
            }
            (Movement::Claim { to, .. }, Some(_)) => {
                let value = to.clone();
                let study_claims = claims.entry(study.clone()).or_default();
                study_claims.insert(name.clone(), BlessedClaim { value, reason });
            }
            (
                Movement::Moved { .. } | Movement::Tolerance { .. } | Movement::New { .. },
                Some(ran),
            ) => {
                let mut quantities = ran.outcome.quantities.iter();
                let quantity = quantities.find(|quantity| quantity.name == *name);
                let new = quantity.map(|quantity| Guarded {
                    value: quantity.value,
                    tolerance: quantity.tolerance,
                    reason,
                });
                let of_study = numbers.entry(study.clone()).or_default();
                of_study.extend(new.map(|new| (name.clone(), new)));
            }
        }
        numbers.retain(|_, guarded| !guarded.is_empty());
        Ok(())
    }

    /// A blessed claim of a study, by its dotted path.
    pub fn claim(&self, id: &str, path: &str) -> Option<&BlessedClaim> {
        self.claims.get(id)?.get(path)
    }

    /// A guarded number of a study.
    pub fn number(&self, id: &str, name: &str) -> Option<&Guarded> {
        self.studies.get(id)?.get(name)
    }

    /// Number of guarded numbers of a study.
    pub fn guards(&self, id: &str) -> usize {
        self.studies.get(id).map_or(0, BTreeMap::len)
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
        let refused = format!(
            "the verdict on `{study}` is {verdict}, and a baseline is made of runs that pass"
        );
        return Err(BlessingRefusal::Unacceptable(format!(
            "not blessed: {refused}"
        )));
    }
    let cannot_be_met =
        |quantity: &&Quantity| !change::meets(quantity.value, quantity.value, quantity.tolerance);
    outcome.quantities.iter().find(cannot_be_met).map_or(Ok(()), |Quantity { name, value, tolerance, .. }| {
        let refused =
            format!("`{name}` of `{study}` is {value} with a tolerance of {tolerance}, which no run can meet");
        Err(BlessingRefusal::Unacceptable(format!("not blessed: {refused}")))
    })
}

/// How many times the blessed work of a case is allowed.
const TIMES: u64 = 3;

/// Share of its tier's work that a case may do in addition: a small case may grow more.
const SPARE: u64 = 50;

/// Tier, study and label of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Works(BTreeMap<String, BTreeMap<String, BTreeMap<String, u64>>>);

impl Works {
    /// Reads the file; without a file nothing is limited.
    pub fn read(path: &Path) -> io::Result<Self> {
        let expected = "restore it, or remove it and run `verify --bless`";
        Ok(read_if_there(path, None, [expected; 2])?.unwrap_or_default())
    }

    /// The most work that a case may do: three times that of its blessing, or of the largest case
    /// of its study if the case is new, plus two per cent of its tier's; `None` for a study that
    /// was never blessed.
    pub fn allowed(&self, header: &Header, label: &str) -> Option<u64> {
        let tier = self.0.get(header.tier.name())?;
        let cases = tier.get(&header.id)?;
        let own = cases.get(label).or_else(|| cases.values().max())?;
        let all: u64 = tier.values().flat_map(BTreeMap::values).sum();
        Some(TIMES * own + all / SPARE)
    }

    /// Accepts the work of studies that were run; cases that count none are left out.
    pub fn take(&mut self, finished: &[Finished]) {
        for Finished { header, work, .. } in finished {
            self.0
                .values_mut()
                .for_each(|tier| drop(tier.remove(&header.id)));
            let cases: BTreeMap<String, u64> =
                work.iter().filter(|(_, work)| *work > 0).cloned().collect();
            if !cases.is_empty() {
                self.0
                    .entry(header.tier.name().to_owned())
                    .or_default()
                    .insert(header.id.clone(), cases);
            }
        }
    }

    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
