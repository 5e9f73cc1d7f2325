//! The work of each case when it was blessed: it guards nothing, and stops runs that go wrong, at
//! the same step on every machine.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::run::Finished;
use crate::store::read_if_there;
use crate::study::Header;

/// How many times the blessed work of a case is allowed.
const TIMES: u64 = 3;

/// Share of its tier's work that a case may do in addition: a small case may grow more.
const SPARE: u64 = 50;

/// Tier, study and label of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Works(BTreeMap<String, BTreeMap<String, BTreeMap<String, u64>>>);

impl Works {
    /// Reads the file; without a file nothing is limited.
    pub(crate) fn read(path: &Path) -> io::Result<Self> {
        let expected = "restore it, or remove it and run `verify --bless`";
        Ok(read_if_there(path, None, [expected; 2])?.unwrap_or_default())
    }

    /// The most work that a case may do: three times that of its blessing, or of the largest case
    /// of its study if the case is new, plus two per cent of its tier's; `None` for a study that
    /// was never blessed.
    pub(crate) fn allowed(&self, header: &Header, label: &str) -> Option<u64> {
        let tier = self.0.get(header.tier.name())?;
        let cases = tier.get(&header.id)?;
        let own = cases.get(label).or_else(|| cases.values().max())?;
        let all: u64 = tier.values().flat_map(BTreeMap::values).sum();
        Some(TIMES * own + all / SPARE)
    }

    /// Accepts the work of studies that were run; cases that count none are left out.
    pub(crate) fn take(&mut self, finished: &[Finished]) {
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
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
