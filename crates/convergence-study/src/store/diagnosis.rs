//! What a failing run says about its cause: which settings separate failing from passing items,
//! which fields moved first, and where to look.

mod contrast;
mod fields;

use serde::{Deserialize, Serialize};

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::run::Finished;
use crate::store::{GuardedChange, Movement, baseline::signed_percent};
use crate::study::header::{self, SettingWords};
use crate::study::{Check, Header, NamedRate, Origin, Outcome, Study, Subject};
use crate::text::json;
use crate::text::lists::{and_more, grouped};
use crate::text::number::{decimals, short_text};
use contrast::{PartOf, Vote, contrast};

pub(crate) use contrast::Contrast;

/// How many of the clearest failures, of fields, and of groups of moved numbers are named.
const NAMED: usize = 3;

/// The known facts about the cause of a failure, as data; [`Diagnosis::lines`] puts them in words.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Claims that changed, in words. They may be the cause: then no place is named.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub claims: Vec<String>,
    /// Which settings separate failing from passing items.
    pub contrast: Contrast,
    /// Wrong fields, ordered by how much they moved within their studies.
    pub first: Vec<WrongField>,
    /// Claims of failing checks, the commonest first, and how many fail.
    pub checks: Vec<(String, usize)>,
    /// Where to look.
    pub look_at: Vec<String>,
    /// The studies with the clearest failures, the worst first.
    pub clearest: Vec<String>,
    /// Moved numbers of passing studies, grouped by field and factor.
    pub moved: Vec<String>,
}

/// A field that is wrong.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WrongField {
    /// Its name.
    pub name: String,
    /// Its share of the movement, on the finest levels, summed over studies.
    #[serde(deserialize_with = "json::nan")]
    pub share: f64,
    /// The farthest rate that does not pass.
    pub rate: Option<WrongRate>,
    /// The largest factor by which one of its errors grew, or by which another number changed.
    #[serde(deserialize_with = "json::nan")]
    pub factor: f64,
}

/// A rate that does not pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WrongRate {
    /// The rate.
    #[serde(deserialize_with = "json::nan")]
    pub observed: f64,
    /// The order claimed.
    #[serde(deserialize_with = "json::nan")]
    pub claimed: f64,
}

impl WrongRate {
    fn distance(&self) -> f64 {
        (self.observed - self.claimed).abs()
    }
}

/// Diagnoses a run that does not pass; `None` for one that passes.
///
/// * `studies`: those that have run; of one that is missing only the file is known.
/// * `changes`: differences from the baseline.
pub fn diagnose(
    project: &Project,
    studies: &[Box<dyn Study + '_>],
    finished: &[Finished],
    changes: &[GuardedChange],
) -> Option<Diagnosis> {
    let failing: Vec<&Finished> = finished
        .iter()
        .filter(|study| study.outcome.verdict != Verdict::Pass)
        .collect();
    let mut wrong: Vec<&str> = failing
        .iter()
        .map(|study| study.header.id.as_str())
        .collect();
    wrong.extend(
        changes
            .iter()
            .filter(|change| is_number(change))
            .map(|change| change.study.as_str()),
    );
    if wrong.is_empty() {
        return None;
    }
    let claims = changes
        .iter()
        .filter(|change| change.movement.is_of_claims());
    let claims: Vec<String> = claims.map(GuardedChange::to_string).collect();
    let contrast = contrast(&votes(studies, finished, changes));
    let first = fields::first(finished, changes);
    let clearest = clearest(&failing);
    let look_at = if claims.is_empty() {
        places(project, &contrast, first.first())
    } else {
        vec![]
    };
    Some(Diagnosis {
        claims,
        contrast,
        first,
        checks: checks(&failing),
        look_at,
        clearest,
        moved: groups_of_moved_numbers(finished, changes),
    })
}

impl Diagnosis {
    /// Adds the command that repeats the clearest failure of a run of `verify`, which finds studies
    /// by their ids.
    pub fn add_repetition(&mut self, project: &Project, changes: &[GuardedChange]) {
        let moved = changes
            .iter()
            .find(|change| is_number(change))
            .map(|change| &change.study);
        let clearest = self.clearest.first().or(moved);
        let line = clearest.map(|id| {
            format!(
                "`{} verify {id}` repeats the clearest failure",
                project.command
            )
        });
        self.look_at.extend(line);
    }
}

/// Where to look: the places that belong to the settings of a contrast and to a field.
fn places(project: &Project, contrast: &Contrast, first: Option<&WrongField>) -> Vec<String> {
    let field = first.map(|field| field.name.as_str());
    let mut places = vec![];
    for word in contrast.values().chain(field) {
        if let Some(known) = project.places.iter().find(|known| known.word == word) {
            places.push(known.place.to_owned());
        }
    }
    places
}

/// Whether a number has moved or vanished: a new one has no cause.
fn is_number(change: &GuardedChange) -> bool {
    !change.movement.is_of_claims() && change.movement.weight() > 0.0
}

/// The numbers of a study that moved or vanished.
fn moved_numbers<'c>(
    changes: &'c [GuardedChange],
    study: &str,
) -> impl Iterator<Item = &'c GuardedChange> {
    changes
        .iter()
        .filter(move |change| change.study == study && is_number(change))
}

/// One vote for each study and set of settings.
fn votes(
    studies: &[Box<dyn Study + '_>],
    finished: &[Finished],
    changes: &[GuardedChange],
) -> Vec<Vote> {
    let any_judged = finished
        .iter()
        .any(|study| study.outcome.verdict != Verdict::Pass);
    let mut votes = vec![];
    for Finished {
        header, outcome, ..
    } in finished
    {
        let mut known = studies.iter();
        let mut study = StudyVotes {
            study: known
                .find(|study| study.header().id == header.id)
                .map(Box::as_ref),
            header,
            votes: vec![],
        };
        for NamedRate { subject, rate, .. } in &outcome.rates {
            study.count(subject, !rate.verdict.is_pass(), any_judged);
        }
        for check in &outcome.checks {
            if check.origin == Origin::Completion && check.verdict.is_pass() {
                continue;
            }
            let subject = Subject {
                quantity: check.quantity(),
                ..check.subject.clone()
            };
            study.count(&subject, !check.verdict.is_pass(), any_judged);
        }
        let moved: Vec<&str> = moved_numbers(changes, &header.id)
            .map(|change| change.name.as_str())
            .collect();
        let guarded: Vec<&str> = outcome
            .quantities
            .iter()
            .map(|quantity| quantity.name.as_str())
            .collect();
        let vanished = moved.iter().filter(|name| !guarded.contains(name));
        for name in guarded.iter().chain(vanished) {
            let subject = subject_of_number(outcome, name);
            study.count(&subject, moved.contains(name), !any_judged);
        }
        votes.append(&mut study.votes);
    }
    votes
}

/// The votes of one study, one for each set of settings.
struct StudyVotes<'s> {
    study: Option<&'s (dyn Study + 's)>,
    header: &'s Header,
    votes: Vec<Vote>,
}

impl StudyVotes<'_> {
    /// Adds an item to the vote of its settings; a ratio of two methods to the votes of both.
    ///
    /// * `counts`: whether it is one of the items that the diagnosis counts; others only decide
    ///   whether the vote fails.
    fn count(&mut self, subject: &Subject, fails: bool, counts: bool) {
        for side in subject.sides() {
            let settings = match self.study {
                Some(study) => study.settings(&side),
                None => header::of_file(self.header, &side),
            };
            self.count_with(settings, fails, counts);
        }
    }

    fn count_with(&mut self, settings: Vec<SettingWords>, fails: bool, counts: bool) {
        let known = self.votes.iter().position(|vote| vote.settings == settings);
        let place = known.unwrap_or(self.votes.len());
        if known.is_none() {
            self.votes.push(Vote {
                settings,
                fails: false,
                failing: PartOf::default(),
            });
        }
        let vote = &mut self.votes[place];
        vote.fails |= fails;
        vote.failing.part += usize::from(fails && counts);
        vote.failing.of += usize::from(counts);
    }
}

/// What a guarded number is about; its name stands in for a quantity that is not known.
fn subject_of_number(outcome: &Outcome, name: &str) -> Subject {
    let known = outcome.quantities.iter().find(|known| known.name == name);
    let subject = known.map_or_else(Subject::default, |known| known.subject.clone());
    Subject {
        quantity: subject.quantity_or(name).to_owned(),
        ..subject
    }
}

/// The claim of several checks, if it is the same.
fn common_claim(checks: &[&Check]) -> Option<String> {
    let (first, rest) = checks.split_first()?;
    rest.iter()
        .all(|check| check.claim == first.claim)
        .then(|| first.claim.to_string())
}

/// The quantities of failing checks, each with the number of checks, the commonest first; in the
/// words of the claim if all of these claim the same.
fn checks(failing: &[&Finished]) -> Vec<(String, usize)> {
    let checks = failing
        .iter()
        .flat_map(|study| &study.outcome.checks)
        .filter(|check| !check.verdict.is_pass());
    let groups = grouped(checks.map(|check| (check.quantity(), check)));
    let mut claims: Vec<(String, usize)> = groups
        .into_iter()
        .map(|(quantity, checks)| (common_claim(&checks).unwrap_or(quantity), checks.len()))
        .collect();
    claims.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    claims.truncate(2 * NAMED);
    claims
}

/// The clearest failures: by the distance of a rate from its order, in units of its tolerance; then
/// studies with failing checks.
fn clearest(failing: &[&Finished]) -> Vec<String> {
    let mut failing = failing.to_vec();
    failing.sort_by(|one, next| {
        let distance = largest_distance(&next.outcome);
        distance.total_cmp(&largest_distance(&one.outcome))
    });
    failing
        .into_iter()
        .take(NAMED)
        .map(|study| study.header.id.clone())
        .collect()
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

/// Moved numbers of passing studies: those of the same field that changed by the same factor have
/// one cause.
fn groups_of_moved_numbers(finished: &[Finished], changes: &[GuardedChange]) -> Vec<String> {
    let mut moved = vec![];
    for Finished {
        header, outcome, ..
    } in finished
    {
        if !outcome.verdict.is_pass() {
            continue;
        }
        for change in moved_numbers(changes, &header.id) {
            let field = subject_of_number(outcome, &change.name).quantity;
            let movement = movement_in_words(&change.movement);
            moved.push((format!("{field} {movement}"), header.id.as_str()));
        }
    }
    let mut groups = grouped(moved);
    groups.sort_by_key(|(_, studies)| std::cmp::Reverse(studies.len()));
    let mut lines = vec![];
    for (group, mut studies) in groups {
        let count = studies.len();
        studies.dedup();
        let more = and_more(studies.len(), 2);
        studies.truncate(2);
        lines.push(format!("{group}: {count} of {}{more}", studies.join(", ")));
    }
    lines
}

/// `by +1e-3 %`, or what else has happened to a number.
fn movement_in_words(movement: &Movement) -> String {
    match movement {
        Movement::Moved { from, to, .. } => {
            let change = (to - from) / from.abs();
            if change.is_finite() {
                format!("by {}", signed_percent(change))
            } else {
                format!("from {} to {}", short_text(*from), short_text(*to))
            }
        }
        Movement::Vanished { .. } => "gone".to_owned(),
        _ => "another tolerance".to_owned(),
    }
}

/// The first of several items, and how many more there are.
fn list_of_first(mut items: Vec<String>, what: &str) -> String {
    let more = items.len().saturating_sub(NAMED);
    items.truncate(NAMED);
    if more > 0 {
        items.push(format!("and {more} more{what}"));
    }
    items.join("; ")
}

impl Diagnosis {
    /// The known facts about the cause, in words: a keyword, and its text.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![];
        if !self.claims.is_empty() {
            lines.push((
                "claims",
                format!("changed: {}", list_of_first(self.claims.clone(), "")),
            ));
        }
        lines.extend(self.lines_of_contrast());
        if !self.first.is_empty() {
            let named: Vec<String> = self
                .first
                .iter()
                .take(NAMED)
                .map(WrongField::words)
                .collect();
            let rest = if self.first.len() > NAMED {
                ", then the rest"
            } else {
                ""
            };
            lines.push(("first", named.join(", then ") + rest));
        }
        if !self.checks.is_empty() {
            let mut claims = vec![];
            for (claim, count) in &self.checks {
                claims.push(match count {
                    1 => claim.clone(),
                    count => format!("{claim} ({count} times)"),
                });
            }
            lines.push(("also fails", list_of_first(claims, "")));
        }
        if !self.moved.is_empty() {
            lines.push((
                "moved",
                format!(
                    "in studies that pass {}",
                    list_of_first(self.moved.clone(), " groups")
                ),
            ));
        }
        if !self.look_at.is_empty() {
            lines.push(("look at", self.look_at.join("; ")));
        }
        lines
    }

    fn lines_of_contrast(&self) -> Vec<(&'static str, String)> {
        let Contrast {
            settings,
            shared,
            failing,
            others,
            ..
        } = &self.contrast;
        let mut lines = vec![];
        let what = if !settings.is_empty() {
            let settings = settings.iter().map(|setting| self.contrast.words(setting));
            settings.collect::<Vec<_>>().join(", ")
        } else if failing.part == failing.of {
            "everything".to_owned()
        } else {
            "here and there: no setting separates it from what passes".to_owned()
        };
        let shared: Vec<&str> = shared.iter().map(|(_, value)| value.as_str()).collect();
        let all_with = if shared.is_empty() {
            String::new()
        } else {
            format!("; all with {}", shared.join(", "))
        };
        let count = if failing.part == 0 {
            "numbers moved".to_owned()
        } else {
            failing.to_string()
        };
        lines.push(("fails", format!("{what}: {count}{all_with}")));
        if !others.is_empty() {
            let groups: Vec<String> = others
                .iter()
                .map(|known| format!("{}: {}", known.name, known.passing))
                .collect();
            lines.push(("passes", groups.join("; ")));
        }
        lines
    }
}

impl WrongField {
    fn words(&self) -> String {
        let rate = self
            .rate
            .map(|rate| format!("rate {} for {}", decimals(rate.observed, 3), rate.claimed));
        let times = short_text(self.factor);
        let factor = match self.factor.is_finite() {
            true => (times != "1").then(|| format!("by a factor up to {times}")),
            false => Some("no longer zero".to_owned()),
        };
        let words: Vec<String> = rate.into_iter().chain(factor).collect();
        if words.is_empty() {
            self.name.clone()
        } else {
            format!("{} ({})", self.name, words.join(", "))
        }
    }
}
