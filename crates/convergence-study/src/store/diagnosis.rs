//! What the failing cases of a run have in common, by agreement and difference: a setting is named
//! if the failing cases of two studies or more have it, all of them, and cases that have all else
//! that they share, but not it, pass. What a single study shows is said by its own checks.
//!
//! A case that has what the failing ones share and passes is counted against: it may be blind to
//! the mistake, or something else is to blame.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::run::Finished;
use crate::store::GuardedChange;
use crate::study::settings::Setting;
use crate::study::{Header, NamedRate, Outcome, Subject};
use crate::text::lists::{and_more, distinct};

/// Most studies, changed claims and settings that are named.
const NAMED: usize = 3;

/// How likely chance alone may be to put the failing studies among those with a setting.
const CHANCE: f64 = 0.05;

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

/// Settings that all failing cases have, of two studies or more, and without which cases pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shared {
    /// The settings.
    pub settings: Vec<Setting>,
    /// How many failing cases have them, those with equal settings of a study counted once.
    pub cases: usize,
    /// The number of studies of these cases.
    pub studies: usize,
}

/// Cases of a study with the same settings, or what several cases share that fail together.
struct Unit {
    /// The place of the study.
    study: usize,
    settings: BTreeSet<Setting>,
}

/// The cases of a run, for and against.
#[derive(Default)]
struct Evidence {
    failing: Vec<Unit>,
    /// What cases share of which a check or a number is about several, and fails.
    failing_together: Vec<Unit>,
    passing: Vec<Unit>,
    /// The studies and quantities of the items that fail.
    quantities: BTreeSet<(usize, String)>,
    /// Studies in which other quantities do not fail.
    other_quantities: BTreeSet<(usize, String)>,
}

/// Diagnoses a run that does not pass; `None` for one in which no study fails and no number moved.
///
/// * `changes`: differences from the baseline.
pub(crate) fn diagnose(finished: &[Finished], changes: &[GuardedChange]) -> Option<Diagnosis> {
    let all_pass = finished.iter().all(|study| study.outcome.verdict.is_pass());
    let moved: Vec<&GuardedChange> = changes.iter().filter(|change| is_number(change)).collect();
    if all_pass && moved.is_empty() {
        return None;
    }
    let claims: Vec<String> = changes
        .iter()
        .filter(|change| change.movement.is_of_claims())
        .map(GuardedChange::to_string)
        .collect();
    Some(Diagnosis {
        claims,
        shared: Evidence::of(finished, &moved).shared(),
        clearest: clearest(finished),
    })
}

/// Whether a number has moved or vanished: a new one has no cause.
fn is_number(change: &GuardedChange) -> bool {
    !change.movement.is_of_claims() && change.movement.weight() > 0.0
}

/// What a rate, a check or a guarded number is about, and whether it fails: a number that moved
/// does.
fn items(id: &str, outcome: &Outcome, moved: &[&GuardedChange]) -> Vec<(Subject, bool)> {
    let mut items = vec![];
    for NamedRate { subject, rate, .. } in &outcome.rates {
        items.push((subject.clone(), !rate.verdict.is_pass()));
    }
    // The cases that did not complete are listed by themselves.
    let checks = outcome.checks.iter();
    for check in checks.filter(|check| !check.is_completion) {
        let subject = Subject {
            quantity: check.quantity(),
            ..check.subject.clone()
        };
        items.push((subject, !check.verdict.is_pass()));
    }
    for quantity in &outcome.quantities {
        let is_own = |change: &&GuardedChange| change.study == id && change.name == quantity.name;
        items.push((quantity.subject.clone(), moved.iter().any(is_own)));
    }
    items
}

/// Whether cases of the study say something of themselves.
fn is_described(header: &Header) -> bool {
    header.cases.iter().any(|case| !case.settings.is_empty())
}

/// The cases of a study by their labels, with their settings: what they say of themselves, or the
/// values of the study's file.
fn cases(header: &Header) -> Vec<(&str, BTreeSet<Setting>)> {
    let cases = header.cases.iter();
    if is_described(header) {
        return cases
            .map(|case| (&*case.label, case.settings.iter().cloned().collect()))
            .collect();
    }
    let of_file: BTreeSet<Setting> = header.settings_of_file().into_iter().collect();
    let labels = cases.map(|case| &*case.label);
    // A study that somebody has read from a record lists no cases.
    let none = header.cases.is_empty().then_some("");
    labels
        .chain(none)
        .map(|label| (label, of_file.clone()))
        .collect()
}

/// Whether a label has all the parts of another: `n = 4` and `p = 3, n = 4`.
fn has_parts(label: &str, parts: &str) -> bool {
    let mut parts = parts.split(", ");
    parts.all(|part| label.split(", ").any(|own| own == part))
}

/// The cases that it names, with that of a comparison; all, if it names none.
fn about(subject: &Subject, cases: &[(&str, BTreeSet<Setting>)]) -> Vec<usize> {
    let Some(case) = &subject.case else {
        return (0..cases.len()).collect();
    };
    let named = [Some(case), subject.against.as_ref()];
    let is_named = |place: &usize| {
        let mut named = named.iter().flatten();
        named.any(|parts| has_parts(cases[*place].0, parts))
    };
    let own: Vec<usize> = (0..cases.len()).filter(is_named).collect();
    if own.is_empty() {
        (0..cases.len()).collect()
    } else {
        own
    }
}

impl Evidence {
    fn of(finished: &[Finished], moved: &[&GuardedChange]) -> Self {
        let mut all = Self::default();
        // What a file says cannot be compared with what cases say of themselves.
        let are_described = finished.iter().any(|study| is_described(&study.header));
        for (study, finished) in finished.iter().enumerate() {
            if is_described(&finished.header) == are_described {
                all.add(study, finished, moved);
            }
        }
        // A case that says nothing of itself speaks neither for nor against a setting.
        if are_described {
            let speaks = |unit: &Unit| !unit.settings.is_empty();
            all.failing.retain(speaks);
            all.failing_together.retain(speaks);
            all.passing.retain(speaks);
        }
        all
    }

    /// Adds the cases of a study.
    fn add(&mut self, study: usize, finished: &Finished, moved: &[&GuardedChange]) {
        let cases = cases(&finished.header);
        let mut fail = BTreeSet::new();
        let mut together = vec![];
        let failed = finished.failed_cases.iter();
        let failed = failed.map(|failed| (Subject::default().in_case(&failed.label), true));
        let items = items(&finished.header.id, &finished.outcome, moved);
        for (subject, fails) in items.into_iter().chain(failed) {
            let about = about(&subject, &cases);
            let quantity = (study, subject.quantity);
            if !fails {
                self.other_quantities.insert(quantity);
                continue;
            }
            self.quantities.insert(quantity);
            let settings = distinct(about.iter().map(|place| &cases[*place].1));
            match settings[..] {
                [settings] => drop(fail.insert(settings)),
                _ => together.push(about),
            }
        }
        let mut doubtful: BTreeSet<&BTreeSet<Setting>> = BTreeSet::new();
        for about in together {
            let settings: Vec<_> = about.iter().map(|place| &cases[*place].1).collect();
            let settings = || settings.iter().copied();
            if !settings().any(|settings| fail.contains(settings)) {
                let settings = shared(settings());
                self.failing_together.push(Unit { study, settings });
            }
            doubtful.extend(settings());
        }
        for settings in distinct(cases.iter().map(|(_, settings)| settings)) {
            let unit = Unit {
                study,
                settings: settings.clone(),
            };
            if fail.contains(settings) {
                self.failing.push(unit);
            } else if !doubtful.contains(settings) {
                self.passing.push(unit);
            }
        }
    }

    /// What is named, by the rule.
    fn shared(mut self) -> Option<Shared> {
        // Where cases of two studies fail by themselves, those that fail together say no more.
        if studies(self.failing.iter()) < 2 {
            self.failing.append(&mut self.failing_together);
        }
        let failing_studies = studies(self.failing.iter());
        if failing_studies < 2 {
            return None;
        }
        let common = shared(self.failing.iter().map(|unit| &unit.settings));
        let passing_with = |settings: &[&Setting]| -> Vec<&Unit> {
            let has_all = |unit: &&Unit| settings.iter().all(|one| unit.settings.contains(*one));
            self.passing.iter().filter(has_all).collect()
        };
        let alike = passing_with(&common.iter().collect::<Vec<_>>()).into_iter();
        let alike = studies(alike);
        let is_to_blame = |setting: &&Setting| {
            let is_else = |other: &&Setting| other != setting && !is_below(other, setting);
            let rest: Vec<&Setting> = common.iter().filter(is_else).collect();
            let without = passing_with(&rest).into_iter();
            let without = studies(without.filter(|unit| !unit.settings.contains(*setting)));
            chance(failing_studies, alike, without) <= CHANCE
        };
        let named: Vec<&Setting> = common.iter().filter(is_to_blame).collect();
        let is_last = |one: &&&Setting| !named.iter().any(|other| is_below(other, one));
        let settings = named.iter().filter(is_last);
        let mut settings: Vec<Setting> = settings.map(|one| (*one).clone()).collect();
        settings.extend(self.quantity());
        (!settings.is_empty()).then_some(Shared {
            settings,
            cases: self.failing.len(),
            studies: failing_studies,
        })
    }

    /// The quantity of which all failing items of two studies are, while others of these studies
    /// do not fail.
    fn quantity(&self) -> Option<Setting> {
        let names = distinct(self.quantities.iter().map(|(_, name)| name));
        let [name] = names[..] else { return None };
        let mut studies = self.quantities.iter().map(|(study, _)| study);
        let has_another = |study: &usize| {
            let mut others = self.other_quantities.iter();
            others.any(|(other, quantity)| other == study && quantity != name)
        };
        let is_told_apart = studies.all(has_another) && !name.is_empty();
        let words = format!("quantity {name}");
        (is_told_apart && self.quantities.len() > 1).then(|| ("quantity".to_owned(), words))
    }
}

/// How many studies the cases are of.
fn studies<'u>(units: impl Iterator<Item = &'u Unit>) -> usize {
    units.map(|unit| unit.study).collect::<BTreeSet<_>>().len()
}

/// What all of them have.
fn shared<'s>(mut all: impl Iterator<Item = &'s BTreeSet<Setting>>) -> BTreeSet<Setting> {
    let first = all.next().cloned().unwrap_or_default();
    all.fold(first, |shared, next| &shared & next)
}

/// Whether a setting is a part of what another is about: `heat.rate` of `heat`.
fn is_below((path, _): &Setting, (above, _): &Setting) -> bool {
    path.strip_prefix(above.as_str())
        .is_some_and(|rest| rest.starts_with('.'))
}

/// The probability that all studies that fail are among those with a setting by chance alone, by
/// Fisher's exact test.
///
/// * `alike`, `without`: studies with passing cases that have the setting, and that have not.
fn chance(failing: usize, alike: usize, without: usize) -> f64 {
    let shares = (0..failing).map(|failed| {
        let with = (failing + alike - failed) as f64;
        with / (with + without as f64)
    });
    shares.product()
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
            studies,
        }) = &self.shared
        {
            let values = settings.iter().map(|(_, value)| value.as_str());
            let values: Vec<&str> = values.take(NAMED).collect();
            let values = values.join(", ");
            lines.push(("shared", format!("{values}: all {cases} failing cases, of {studies} studies; cases without it pass")));
        }
        lines
    }
}
