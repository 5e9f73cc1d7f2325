//! What the failing cases of a run have in common. A setting is named only where two studies agree
//! on it and no passing case has it: what a single study shows is said by its own checks.

use serde::{Deserialize, Serialize};

use crate::run::Finished;
use crate::store::GuardedChange;
use crate::study::header::{self, SettingWords};
use crate::study::{NamedRate, Origin, Outcome, Subject};
use crate::text::lists::{and_more, distinct};

/// Most studies, changed claims and settings that are named.
const NAMED: usize = 3;

/// The known facts about the cause of a failure, as data; [`Diagnosis::lines`] puts them in words.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Claims that changed, in words: they may be the cause.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub claims: Vec<String>,
    /// What failing cases share.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shared: Option<Shared>,
    /// The studies with the clearest failures, the worst first.
    pub clearest: Vec<String>,
}

/// Settings that the same failing cases have, of two studies or more, and that no passing case
/// has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shared {
    /// The settings.
    pub settings: Vec<SettingWords>,
    /// How many failing cases have them.
    pub cases: usize,
    /// How many cases fail.
    pub failing: usize,
    /// The number of studies of the cases that have them.
    pub studies: usize,
}

/// The items of one study with the same settings.
struct Case {
    /// The place of the study.
    study: usize,
    settings: Vec<SettingWords>,
    fails: bool,
}

/// Diagnoses a run that does not pass; `None` for one in which no study fails and no number moved.
///
/// * `changes`: differences from the baseline.
pub(crate) fn diagnose(finished: &[Finished], changes: &[GuardedChange]) -> Option<Diagnosis> {
    let any_fails = finished
        .iter()
        .any(|study| !study.outcome.verdict.is_pass());
    // Numbers of studies that fail move for the same cause.
    let moved: Vec<&GuardedChange> = changes
        .iter()
        .filter(|change| !any_fails && is_number(change))
        .collect();
    if !any_fails && moved.is_empty() {
        return None;
    }
    let claims: Vec<String> = changes
        .iter()
        .filter(|change| change.movement.is_of_claims())
        .map(GuardedChange::to_string)
        .collect();
    Some(Diagnosis {
        claims,
        shared: shared(&cases(finished, &moved)),
        clearest: clearest(finished),
    })
}

/// Whether a number has moved or vanished: a new one has no cause.
fn is_number(change: &GuardedChange) -> bool {
    !change.movement.is_of_claims() && change.movement.weight() > 0.0
}

/// The cases of all studies.
///
/// * `moved`: numbers that moved, if no study fails.
fn cases(finished: &[Finished], moved: &[&GuardedChange]) -> Vec<Case> {
    let mut cases = vec![];
    for (
        place,
        Finished {
            header, outcome, ..
        },
    ) in finished.iter().enumerate()
    {
        let mut own: Vec<Case> = vec![];
        for (subject, fails) in items(&header.id, outcome, moved) {
            // A ratio of two methods is about both.
            for side in subject.sides() {
                let settings = header::settings(header, &side);
                match own.iter_mut().find(|case| case.settings == settings) {
                    Some(case) => case.fails |= fails,
                    None => own.push(Case {
                        study: place,
                        settings,
                        fails,
                    }),
                }
            }
        }
        cases.append(&mut own);
    }
    cases
}

/// What the items of a study are about, and whether each fails.
fn items(id: &str, outcome: &Outcome, moved: &[&GuardedChange]) -> Vec<(Subject, bool)> {
    let mut items = vec![];
    for NamedRate { subject, rate, .. } in &outcome.rates {
        items.push((subject.clone(), !rate.verdict.is_pass()));
    }
    for check in &outcome.checks {
        // That a case has ended says nothing of its numbers.
        if check.origin != Origin::Completion || !check.verdict.is_pass() {
            // A run that failed is of no field.
            let quantity = match check.origin {
                Origin::Completion => String::new(),
                _ => check.quantity(),
            };
            let subject = Subject {
                quantity,
                ..check.subject.clone()
            };
            items.push((subject, !check.verdict.is_pass()));
        }
    }
    if !moved.is_empty() {
        for quantity in &outcome.quantities {
            let own = |change: &&&GuardedChange| change.study == id && change.name == quantity.name;
            let subject = Subject {
                quantity: quantity.subject.quantity_or(&quantity.name).to_owned(),
                ..quantity.subject.clone()
            };
            items.push((subject, moved.iter().any(|change| own(&change))));
        }
    }
    items
}

/// The settings that most failing cases share, by the rule.
fn shared(cases: &[Case]) -> Option<Shared> {
    let failing: Vec<&Case> = cases.iter().filter(|case| case.fails).collect();
    let settings = distinct(failing.iter().flat_map(|case| &case.settings));
    let mut best: Option<Shared> = None;
    for setting in settings {
        let has = |case: &&&Case| case.settings.contains(setting);
        let with: Vec<&&Case> = failing.iter().filter(has).collect();
        let studies = distinct(with.iter().map(|case| case.study)).len();
        let passes_too = cases
            .iter()
            .any(|case| !case.fails && case.settings.contains(setting));
        if studies < 2 || passes_too {
            continue;
        }
        match &mut best {
            Some(best) if best.cases > with.len() => {}
            Some(best) if best.cases == with.len() => {
                // A method without a choice has the same name under several keys.
                if best.settings.iter().all(|(_, value)| *value != setting.1) {
                    best.settings.push(setting.clone());
                }
            }
            _ => {
                best = Some(Shared {
                    settings: vec![setting.clone()],
                    cases: with.len(),
                    failing: failing.len(),
                    studies,
                });
            }
        }
    }
    best
}

/// The clearest failures: by the distance of a rate from its order, in units of its tolerance; then
/// studies with failing checks.
fn clearest(finished: &[Finished]) -> Vec<String> {
    let failing = finished
        .iter()
        .filter(|study| !study.outcome.verdict.is_pass());
    let mut failing: Vec<&Finished> = failing.collect();
    failing.sort_by(|one, next| {
        let distance = largest_distance(&next.outcome);
        distance.total_cmp(&largest_distance(&one.outcome))
    });
    let clearest = failing.into_iter().take(NAMED);
    clearest.map(|study| study.header.id.clone()).collect()
}

/// The largest distance of a rate that does not pass from its order, in units of its tolerance.
fn largest_distance(outcome: &Outcome) -> f64 {
    let mut largest: f64 = 0.0;
    for NamedRate { rate, .. } in &outcome.rates {
        if let (Some(fitted), Some(band)) = (rate.fitted, rate.claimed)
            && !rate.verdict.is_pass()
        {
            largest = largest.max(band.distance(fitted).abs());
        }
    }
    largest
}

impl Diagnosis {
    /// The known facts about the cause, in words: a keyword, and its text; none if each check must
    /// speak for itself.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![];
        if !self.claims.is_empty() {
            let named = &self.claims[..self.claims.len().min(NAMED)];
            let more = and_more(self.claims.len(), NAMED);
            lines.push(("claims", format!("changed: {}{more}", named.join("; "))));
        }
        if let Some(Shared {
            settings,
            cases,
            failing,
            studies,
        }) = &self.shared
        {
            let values = settings.iter().map(|(_, value)| value.as_str());
            let values: Vec<&str> = values.take(NAMED).collect();
            let values = values.join(", ");
            lines.push(("shared", format!("{values}: {cases} of {failing} failing cases, of {studies} studies, and no passing case of any study")));
        }
        lines
    }
}
