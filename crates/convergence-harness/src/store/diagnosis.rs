//! What a failing run says about its cause: which settings separate failing from passing items,
//! which fields moved first, which known mistake it resembles, and where to look.

mod contrast;
mod fields;
mod fingerprint;

use serde::{Deserialize, Serialize};

use crate::judge::verdict::Verdict;
use crate::project::Project;
use crate::run::Finished;
use crate::store::{Change, Movement};
use crate::study::{Check, Origin, Outcome, Subject};
use crate::text::json;
use crate::text::lists::{and_more, grouped};
use crate::text::number::short_text;
use contrast::{Vote, contrast};

pub use contrast::Contrast;
pub use fingerprint::{Fingerprint, Fingerprints, Known, Resembling};

/// How many of the clearest failures, of fields, and of groups of moved numbers are named.
const NAMED: usize = 3;

/// The known facts about the cause of a failure, as data; [`Diagnosis::lines`] puts them in words.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Claims that changed, in words. They may be the cause: then no known mistake of the solver is
    /// named, and no place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub claims: Vec<String>,
    /// Which settings separate failing from passing items.
    pub contrast: Contrast,
    /// Wrong fields, ordered by how much they moved within their studies.
    pub first: Vec<Field>,
    /// Claims of failing checks, the commonest first, and how many fail.
    pub checks: Vec<(String, usize)>,
    /// Known mistakes with similar failures and movements.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub resembles: Vec<Resembling>,
    /// Where to look.
    pub look_at: Vec<String>,
    /// The studies with the clearest failures, the worst first.
    pub clearest: Vec<String>,
    /// Moved numbers of passing studies, grouped by field and factor.
    pub moved: Vec<String>,
}

/// A field that is wrong.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its share of the movement, on the finest levels, summed over studies.
    #[serde(deserialize_with = "json::nan")]
    pub share: f64,
    /// The farthest rate that does not pass, with its order.
    #[serde(deserialize_with = "json::nan_pair")]
    pub rate: Option<[f64; 2]>,
    /// The largest factor by which one of its errors grew, or by which another number changed.
    #[serde(deserialize_with = "json::nan")]
    pub factor: f64,
}

/// Diagnoses a run that does not pass; `None` for one that passes.
///
/// * `changes`: differences from the baseline.
/// * `known`: mistakes that were planted earlier.
pub fn diagnose(
    project: &Project,
    finished: &[Finished],
    changes: &[Change],
    known: &Fingerprints,
) -> Option<Diagnosis> {
    let fails = |study: &&Finished| study.outcome.verdict != Verdict::Pass;
    let failing: Vec<&Finished> = finished.iter().filter(fails).collect();
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
        .filter(|change| change.movement.needs_a_reason());
    let claims: Vec<String> = claims.map(Change::words).collect();
    let contrast = contrast(&votes(project, finished, changes));
    let first = fields::first(finished, changes);
    let clearest = clearest(&failing);
    let look_at = if claims.is_empty() {
        places(project, &contrast, first.first())
    } else {
        vec![]
    };
    let resembles = if claims.is_empty() {
        known.nearest(&Fingerprint::of(finished, changes))
    } else {
        vec![]
    };
    Some(Diagnosis {
        claims,
        contrast,
        first,
        checks: checks(&failing),
        resembles,
        look_at,
        clearest,
        moved: moved(finished, changes),
    })
}

impl Diagnosis {
    /// Adds the command that repeats the clearest failure of a run of `verify`, which finds studies
    /// by their ids.
    pub fn add_repetition(&mut self, project: &Project, changes: &[Change]) {
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
fn places(project: &Project, contrast: &Contrast, first: Option<&Field>) -> Vec<String> {
    let field = first.map(|field| field.name.as_str());
    let words = contrast.values().chain(field);
    let place = |word| project.places.iter().find(|(known, _)| *known == word);
    words
        .filter_map(place)
        .map(|(_, place)| (*place).to_owned())
        .collect()
}

/// Whether a number has moved or vanished: a new one has no cause.
fn is_number(change: &Change) -> bool {
    !change.movement.needs_a_reason() && change.movement.weight() > 0.0
}

/// The numbers of a study that moved or vanished.
fn numbers<'c>(
    changes: &'c [Change],
    study: &'c str,
) -> impl Iterator<Item = (&'c str, &'c Movement)> {
    let is_of_study = move |change: &&Change| change.study == study && is_number(change);
    changes
        .iter()
        .filter(is_of_study)
        .map(|change| (change.name.as_str(), &change.movement))
}

/// One vote for each study and set of settings.
fn votes(project: &Project, finished: &[Finished], changes: &[Change]) -> Vec<Vote> {
    let any_judged = finished
        .iter()
        .any(|study| study.outcome.verdict != Verdict::Pass);
    let mut votes = vec![];
    for Finished {
        header, outcome, ..
    } in finished
    {
        let mut own: Vec<Vote> = vec![];
        let mut count = |subject: &Subject, fails: bool, counts: bool| {
            let settings = project.settings(header, subject);
            let new = [usize::from(fails && counts), usize::from(counts)];
            match own.iter_mut().find(|vote| vote.settings == settings) {
                Some(Vote {
                    fails: any, count, ..
                }) => {
                    *any |= fails;
                    *count = [count[0] + new[0], count[1] + new[1]];
                }
                None => own.push(Vote {
                    settings,
                    fails,
                    count: new,
                }),
            }
        };
        outcome.rates.iter().for_each(|(norm, rate)| {
            let subject = outcome.subject_of_rate(norm);
            count(&subject, !rate.verdict.is_pass(), any_judged);
        });
        let checks = outcome
            .checks
            .iter()
            .filter(|check| check.origin != Origin::Completion || !check.verdict.is_pass());
        checks.for_each(|check| {
            let subject = Subject {
                quantity: check.quantity().to_owned(),
                ..check.subject.clone()
            };
            count(&subject, !check.verdict.is_pass(), any_judged);
        });
        let moved: Vec<&str> = numbers(changes, &header.id).map(|(name, _)| name).collect();
        let kept = outcome
            .quantities
            .iter()
            .map(|quantity| quantity.name.as_str());
        let gone = moved
            .iter()
            .copied()
            .filter(|name| !outcome.quantities.iter().any(|known| known.name == *name));
        kept.chain(gone).for_each(|name| {
            let subject = subject_of_number(outcome, name);
            count(&subject, moved.contains(&name), !any_judged);
        });
        votes.append(&mut own);
    }
    votes
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
fn common_claim<'c>(checks: &[&'c Check]) -> Option<&'c str> {
    let (first, rest) = checks.split_first()?;
    rest.iter()
        .all(|check| check.claim == first.claim)
        .then_some(&first.claim)
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
        .map(|(words, count)| (words.to_owned(), count))
        .collect();
    claims.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    claims.truncate(2 * NAMED);
    claims
}

/// The clearest failures: by the distance of a rate from its order, in units of its tolerance; then
/// studies with failing checks.
fn clearest(failing: &[&Finished]) -> Vec<String> {
    let distance = |study: &Finished| {
        let missed = study
            .outcome
            .rates
            .iter()
            .filter(|(_, rate)| !rate.verdict.is_pass());
        let distances =
            missed.filter_map(|(_, rate)| Some((rate.fitted? - rate.order).abs() / rate.tolerance));
        distances.fold(0.0, f64::max)
    };
    let mut clear: Vec<(f64, &str)> = failing
        .iter()
        .map(|study| (distance(study), study.header.id.as_str()))
        .collect();
    clear.sort_by(|(one, _), (next, _)| next.total_cmp(one));
    clear
        .into_iter()
        .take(NAMED)
        .map(|(_, id)| id.to_owned())
        .collect()
}

/// Moved numbers of passing studies: those of the same field that changed by the same factor have
/// one cause.
fn moved(finished: &[Finished], changes: &[Change]) -> Vec<String> {
    let passing = finished
        .iter()
        .filter(|study| study.outcome.verdict == Verdict::Pass);
    let moved = passing.flat_map(
        |Finished {
             header, outcome, ..
         }| {
            numbers(changes, &header.id).map(|(name, movement)| {
                let how = match movement {
                    Movement::Moved { from, to, .. } => {
                        let change = 100.0 * (to - from) / from.abs();
                        format!("by {}{change:.0e} %", if change > 0.0 { "+" } else { "" })
                    }
                    Movement::Vanished { .. } => "gone".to_owned(),
                    _ => "another tolerance".to_owned(),
                };
                let field = subject_of_number(outcome, name).quantity;
                (format!("{field} {how}"), header.id.as_str())
            })
        },
    );
    let mut groups = grouped(moved);
    groups.sort_by_key(|(_, studies)| std::cmp::Reverse(studies.len()));
    let line = |(group, mut studies): (String, Vec<&str>)| {
        let count = studies.len();
        studies.dedup();
        let more = and_more(studies.len(), 2);
        studies.truncate(2);
        format!("{group}: {count} of {}{more}", studies.join(", "))
    };
    groups.into_iter().map(line).collect()
}

/// The first of several items, and how many more there are.
fn first_named(mut items: Vec<String>, what: &str) -> String {
    let more = items.len().saturating_sub(NAMED);
    items.truncate(NAMED);
    if more > 0 {
        items.push(format!("and {more} more{what}"));
    }
    items.join("; ")
}

impl Diagnosis {
    /// The planted mistakes with a similar effect, in words; empty if there are none.
    pub fn alike(&self) -> String {
        let words =
            |one: &Resembling| format!("\"{}\" ({:.2}) in {}", one.mistake, one.likeness, one.file);
        self.resembles
            .iter()
            .map(words)
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// The known facts about the cause, in words: a keyword, and its text.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![];
        if !self.claims.is_empty() {
            lines.push((
                "claims",
                format!("changed: {}", first_named(self.claims.clone(), "")),
            ));
        }
        lines.extend(self.contrasted());
        if !self.first.is_empty() {
            let named: Vec<String> = self.first.iter().take(NAMED).map(Field::words).collect();
            let rest = if self.first.len() > NAMED {
                ", then the rest"
            } else {
                ""
            };
            lines.push(("first", named.join(", then ") + rest));
        }
        if !self.checks.is_empty() {
            let one = |(claim, count): &(String, usize)| {
                if *count > 1 {
                    format!("{claim} ({count} times)")
                } else {
                    claim.clone()
                }
            };
            lines.push((
                "not so",
                first_named(self.checks.iter().map(one).collect(), ""),
            ));
        }
        for (
            count,
            Resembling {
                mistake,
                file,
                likeness,
                ..
            },
        ) in self.resembles.iter().enumerate()
        {
            lines.push((
                if count == 0 { "resembles" } else { "" },
                format!("\"{mistake}\" ({likeness:.2})  {file}"),
            ));
        }
        if !self.moved.is_empty() {
            lines.push((
                "moved",
                format!(
                    "in studies that pass {}",
                    first_named(self.moved.clone(), " groups")
                ),
            ));
        }
        if !self.look_at.is_empty() {
            lines.push(("look at", self.look_at.join("; ")));
        }
        lines
    }

    fn contrasted(&self) -> Vec<(&'static str, String)> {
        let Contrast {
            settings,
            shared,
            fails: [failed, all],
            passes,
            ..
        } = &self.contrast;
        let mut lines = vec![];
        let what = if !settings.is_empty() {
            let settings = settings.iter().map(|named| self.contrast.words(named));
            settings.collect::<Vec<_>>().join(", ")
        } else if failed == all {
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
        let count = if *failed == 0 {
            "numbers moved".to_owned()
        } else {
            format!("{failed} of {all}")
        };
        lines.push(("fails", format!("{what}: {count}{all_with}")));
        if !passes.is_empty() {
            let group = |(name, [passing, all]): &(String, [usize; 2])| {
                format!("{name}: {passing} of {all}")
            };
            lines.push((
                "passes",
                passes.iter().map(group).collect::<Vec<_>>().join("; "),
            ));
        }
        lines
    }
}

impl Field {
    fn words(&self) -> String {
        let rate = self
            .rate
            .map(|[rate, order]| format!("rate {rate:.3} for {order}"));
        let times = if self.factor.is_finite() {
            short_text(self.factor)
        } else {
            "infinity".to_owned()
        };
        let factor = (times != "1").then(|| format!("by a factor up to {times}"));
        let words: Vec<String> = rate.into_iter().chain(factor).collect();
        if words.is_empty() {
            self.name.clone()
        } else {
            format!("{} ({})", self.name, words.join(", "))
        }
    }
}
