//! What differs from the baseline, and how to accept it: the same for report and terminal.

use std::collections::HashSet;

use serde::Serialize;

use super::Findings;
use super::words::{blessing, can_be_blessed};
use crate::store::{GuardedChange, Movement, without_baseline};

/// The changes of a record, a line each.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Changes {
    /// Of what is claimed.
    pub claims: Vec<String>,
    /// Of numbers of studies that pass; those of a study that fails move for the same cause. First
    /// the worst of each study, by multiples of its tolerance.
    pub numbers: Vec<String>,
    /// The command that accepts all of it; `None` if it would be refused.
    pub command: Option<String>,
    /// Whether there is anything to accept.
    pub is_any: bool,
    /// Whether there was no baseline: then everything is new, and nothing is listed.
    pub is_first: bool,
}

impl Changes {
    /// * `of_failing`: whether to list also the numbers of studies that do not pass.
    pub(crate) fn of(findings: &Findings<'_>, of_failing: bool) -> Self {
        let record = findings.record;
        let studies = &record.studies;
        let moves = record.moves();
        let accepting = can_be_blessed(studies)
            .then(|| blessing(findings.project, &record.command, studies, moves));
        let changes = Self {
            command: accepting,
            is_any: moves
                .iter()
                .any(|change| change.movement != Movement::Elsewhere),
            is_first: without_baseline(studies, moves).is_some(),
            ..Self::default()
        };
        if changes.is_first {
            return changes;
        }
        let fails = |change: &&GuardedChange| {
            let mut all = studies.iter();
            all.any(|study| study.header.id == change.study && !study.outcome.verdict.is_pass())
        };
        let (claims, numbers): (Vec<_>, Vec<_>) = moves
            .iter()
            .partition(|change| change.movement.is_of_claims());
        let numbers = numbers.into_iter();
        let mut numbers: Vec<_> = numbers
            .filter(|change| of_failing || !fails(change))
            .collect();
        let weight = |change: &GuardedChange| change.movement.weight();
        numbers.sort_by(|one, next| weight(next).total_cmp(&weight(one)));
        let mut seen = HashSet::new();
        let (worst, others): (Vec<_>, Vec<_>) = numbers
            .into_iter()
            .partition(|change| seen.insert(&change.study));
        let numbers = worst.iter().chain(&others);
        Self {
            claims: claims.iter().map(ToString::to_string).collect(),
            numbers: numbers.map(ToString::to_string).collect(),
            ..changes
        }
    }
}
