//! Which settings separate failing from passing items: spectrum-based fault localisation by
//! Ochiai's coefficient.
//!
//! For failing items F and items S with a setting the coefficient is |F ∩ S| / √(|F| |S|): 1 if
//! exactly those with the setting fail.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::study::header::{STUDY, SettingWords};

/// Subtracted for a second setting: it must explain more than it costs to read.
const SECOND: f64 = 0.02;

/// Subtracted if a study is named: a setting that separates as well says more.
const ALONE: f64 = 0.06;

/// How much better a conjunction must be than no setting at all.
const GAIN: f64 = 0.04;

/// The key of a study's kind among its settings.
const KIND: &str = "kind";

/// How many of the best single settings are combined in pairs: long files have many settings.
const COMBINED: usize = 80;

/// Most groups of passing items that are named.
const GROUPS: usize = 3;

/// A setting shared by all failing items says something if at most this share of all items has it.
const RARE: f64 = 0.8;

/// Most settings shared by all failing items that are named.
const SHARED: usize = 3;

/// Items of one study with the same settings: one vote, whatever the number of levels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vote {
    /// The settings that they exercise.
    pub(super) settings: Vec<SettingWords>,
    /// Whether any of them fails, or has moved.
    pub(super) fails: bool,
    /// Those that fail, of how many there are.
    pub(super) failing: PartOf,
}

/// Some of a number of items.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct PartOf {
    /// How many.
    pub part: usize,
    /// Of how many.
    pub of: usize,
}

impl PartOf {
    fn add(&mut self, other: Self) {
        self.part += other.part;
        self.of += other.of;
    }

    /// Those that are not in the part.
    fn rest(self) -> Self {
        Self {
            part: self.of - self.part,
            ..self
        }
    }
}

impl fmt::Display for PartOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.part, self.of)
    }
}

/// Items without the settings of a contrast that share one alternative setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Others {
    /// The setting.
    pub name: String,
    /// Those that pass.
    pub passing: PartOf,
}

/// The conjunction of at most two settings that best separates failing from passing items; empty if
/// nothing separates them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Contrast {
    /// The settings; empty if none separates.
    pub settings: Vec<SettingWords>,
    /// The kind of the study that is named, if one is, and others are of another kind: it says
    /// where to look.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
    /// Ochiai's coefficient of the conjunction, 0.02 less for a second setting, 0.06 less for a
    /// study.
    pub score: f64,
    /// Items with these settings: those that fail.
    pub failing: PartOf,
    /// Other settings that every failing item has, but not most of all items: the rarest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shared: Vec<SettingWords>,
    /// Items without them, by their alternative settings.
    pub others: Vec<Others>,
}

impl Contrast {
    /// The values of the settings, and the kind of the study that is named.
    pub fn values(&self) -> impl Iterator<Item = &str> {
        let settings = self.settings.iter().map(|(_, value)| value);
        settings.chain(&self.kind).map(String::as_str)
    }

    /// A setting in words: `ID alone (KIND)`, or its value.
    pub(super) fn words(&self, (key, value): &SettingWords) -> String {
        match &self.kind {
            Some(kind) if key == STUDY => format!("{value} ({kind})"),
            _ => value.clone(),
        }
    }
}

/// A set of votes, and how well it agrees with the failing ones.
struct Set<'v> {
    settings: Vec<&'v SettingWords>,
    holds: Vec<bool>,
    score: f64,
}

/// Votes that share these settings, and their score.
fn set<'v>(votes: &[Vote], settings: Vec<&'v SettingWords>, holds: Vec<bool>) -> Set<'v> {
    let failing = votes.iter().filter(|vote| vote.fails).count() as f64;
    let with = holds.iter().filter(|holds| **holds).count() as f64;
    let both = votes
        .iter()
        .zip(&holds)
        .filter(|(vote, holds)| vote.fails && **holds)
        .count() as f64;
    let second = if settings.len() > 1 { SECOND } else { 0.0 };
    let alone = if settings.iter().any(|(key, _)| key == STUDY) {
        ALONE
    } else {
        0.0
    };
    let score = if both == 0.0 {
        0.0
    } else {
        both / (failing * with).sqrt()
    };
    Set {
        settings,
        holds,
        score: score - second - alone,
    }
}

/// The best conjunction of at most two settings. Of equals, the first named.
pub(super) fn contrast(votes: &[Vote]) -> Contrast {
    let mut singles: Vec<Set<'_>> = vec![];
    for setting in votes.iter().flat_map(|vote| &vote.settings) {
        if singles.iter().all(|known| known.settings[0] != setting) {
            let holds: Vec<bool> = votes
                .iter()
                .map(|vote| vote.settings.contains(setting))
                .collect();
            // Two settings with the same votes are equivalent.
            if singles.iter().all(|known| known.holds != holds) {
                singles.push(set(votes, vec![setting], holds));
            }
        }
    }
    let nothing = set(votes, vec![], vec![true; votes.len()]);
    singles.sort_by(|one, next| next.score.total_cmp(&one.score));
    singles.truncate(COMBINED);
    let mut best = set(votes, vec![], nothing.holds.clone());
    best.score += GAIN;
    for (k, one) in singles.iter().enumerate() {
        let pairs = singles[k + 1..]
            .iter()
            .filter(|other| other.settings[0].0 != one.settings[0].0)
            .map(|other| {
                let holds = one
                    .holds
                    .iter()
                    .zip(&other.holds)
                    .map(|(a, b)| *a && *b)
                    .collect();
                set(votes, vec![one.settings[0], other.settings[0]], holds)
            });
        let single = set(votes, one.settings.clone(), one.holds.clone());
        for next in std::iter::once(single).chain(pairs) {
            if next.score > best.score + 1e-9 {
                best = next;
            }
        }
    }
    contrast_of(votes, &best, nothing.score)
}

/// The contrast of the best set, with what passes instead.
fn contrast_of(votes: &[Vote], best: &Set<'_>, nothing: f64) -> Contrast {
    let mut failing = PartOf::default();
    let mut others: Vec<Others> = vec![];
    for (vote, holds) in votes.iter().zip(&best.holds) {
        if *holds {
            failing.add(vote.failing);
            continue;
        }
        let missing = best
            .settings
            .iter()
            .find(|setting| !vote.settings.contains(setting));
        let alternative = match missing {
            // There would be too many names.
            Some((key, _)) if key != STUDY => vote.settings.iter().find(|(other, _)| other == key),
            _ => None,
        };
        let name = alternative.map_or("the others", |(_, value)| value);
        let passing = vote.failing.rest();
        match others.iter_mut().find(|known| known.name == name) {
            Some(known) => known.passing.add(passing),
            None => others.push(Others {
                name: name.to_owned(),
                passing,
            }),
        }
    }
    others.sort_by_key(|known| std::cmp::Reverse(known.passing.part));
    others.truncate(GROUPS);
    others.retain(|known| known.passing.part > 0);
    let settings: Vec<SettingWords> = best
        .settings
        .iter()
        .map(|setting| (*setting).clone())
        .collect();
    let score = if settings.is_empty() {
        nothing
    } else {
        best.score
    };
    let mut contrast = Contrast {
        kind: kind_of_study(votes, &settings),
        shared: vec![],
        settings,
        score,
        failing,
        others,
    };
    contrast.shared = shared(votes, &contrast);
    contrast
}

/// The kind of the study among these settings, unless all studies are of that kind.
fn kind_of_study(votes: &[Vote], settings: &[SettingWords]) -> Option<String> {
    let study = settings.iter().find(|(key, _)| key == STUDY)?;
    let vote = votes.iter().find(|vote| vote.settings.contains(study))?;
    let kind = vote.settings.iter().find(|(key, _)| key == KIND)?;
    let distinguishes = votes.iter().any(|vote| !vote.settings.contains(kind));
    distinguishes.then(|| kind.1.clone())
}

/// The settings of all failing votes, except those that the contrast names and those that most of
/// all items have.
fn shared(votes: &[Vote], contrast: &Contrast) -> Vec<SettingWords> {
    let failing: Vec<&Vote> = votes.iter().filter(|vote| vote.fails).collect();
    // One item shares everything with itself.
    let [first, others @ ..] = &failing[..] else {
        return vec![];
    };
    if others.is_empty() {
        return vec![];
    }
    let mut shared: Vec<RareSetting<'_>> = vec![];
    for setting in &first.settings {
        let (key, value) = setting;
        let is_named = key == STUDY || contrast.values().any(|other| other == value);
        if is_named || !others.iter().all(|vote| vote.settings.contains(setting)) {
            continue;
        }
        let share = share_with(votes, setting);
        if share <= RARE {
            shared.push(RareSetting { setting, share });
        }
    }
    shared.sort_by(|one, next| one.share.total_cmp(&next.share));
    // A method without the choice has the same name under several keys.
    shared.dedup_by(|one, previous| one.setting.1 == previous.setting.1);
    shared
        .into_iter()
        .take(SHARED)
        .map(|rare| rare.setting.clone())
        .collect()
}

/// A setting of all failing votes, and the share of all items that has it.
struct RareSetting<'v> {
    setting: &'v SettingWords,
    share: f64,
}

/// The share of items that have a setting.
fn share_with(votes: &[Vote], setting: &SettingWords) -> f64 {
    let items = |vote: &Vote| vote.failing.of;
    let with = votes.iter().filter(|vote| vote.settings.contains(setting));
    let all: usize = votes.iter().map(items).sum();
    with.map(items).sum::<usize>() as f64 / all as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vote(settings: &[(&str, &str)], [part, of]: [usize; 2]) -> Vote {
        let settings = settings
            .iter()
            .map(|(key, value)| ((*key).to_owned(), (*value).to_owned()))
            .collect();
        Vote {
            settings,
            fails: part > 0,
            failing: PartOf { part, of },
        }
    }

    #[test]
    fn two_settings_are_named_where_one_does_not_separate() {
        let votes = [
            vote(&[("method", "one step"), ("coupling", "a > 0")], [60, 62]),
            vote(&[("method", "one step"), ("coupling", "a = 0")], [0, 31]),
            vote(&[("method", "any order"), ("coupling", "a > 0")], [0, 24]),
        ];
        let found = contrast(&votes);
        let values: Vec<&str> = found
            .settings
            .iter()
            .map(|(_, value)| value.as_str())
            .collect();
        assert_eq!(values, ["one step", "a > 0"]);
        assert_eq!(found.failing, PartOf { part: 60, of: 62 });
        let others = found.others.iter();
        let others: Vec<String> = others
            .map(|known| format!("{}: {}", known.name, known.passing))
            .collect();
        assert_eq!(others, ["a = 0: 31 of 31", "any order: 24 of 24"]);
        assert!((found.score - 0.98).abs() < 1e-12);
        // A second setting that adds nothing is not named.
        let one = contrast(&votes[..2]);
        assert_eq!(one.settings, [("coupling".to_owned(), "a > 0".to_owned())]);
    }

    #[test]
    fn what_all_failing_items_share_is_named_where_few_of_the_others_have_it() {
        let votes = [
            vote(
                &[("method", "any order"), ("mesh", "graded"), ("field", "u")],
                [1, 1],
            ),
            vote(
                &[("method", "any order"), ("mesh", "graded"), ("field", "v")],
                [1, 1],
            ),
            vote(
                &[("method", "any order"), ("mesh", "uniform"), ("field", "u")],
                [0, 1],
            ),
            vote(
                &[("method", "one step"), ("mesh", "graded"), ("field", "u")],
                [0, 1],
            ),
            vote(
                &[("method", "one step"), ("mesh", "uniform"), ("field", "u")],
                [0, 9],
            ),
        ];
        let values = |contrast: &Contrast| -> Vec<String> {
            let shared = shared(&votes, contrast).into_iter();
            shared.map(|(_, value)| value).collect()
        };
        let nothing = Contrast::default();
        assert_eq!(values(&nothing), ["any order", "graded"]);
        // What 76 of 86 items have says nothing of the two that fail.
        let common = vote(&[("method", "any order")], [0, 73]);
        let votes_with = [&votes[..], &[common]].concat();
        let names = |votes: &[Vote]| shared(votes, &nothing).len();
        assert_eq!(names(&votes_with), 1);
        let named = Contrast {
            settings: vec![("method".to_owned(), "any order".to_owned())],
            ..Contrast::default()
        };
        assert_eq!(values(&named), ["graded"]);
        let of_study = Contrast {
            settings: vec![("study".to_owned(), "a alone".to_owned())],
            kind: Some("any order".to_owned()),
            ..Contrast::default()
        };
        assert_eq!(values(&of_study), ["graded"]);
        assert!(shared(&votes[..2], &nothing).is_empty() && shared(&[], &nothing).is_empty());
    }

    #[test]
    fn a_study_that_is_named_has_its_kind() {
        let votes = [
            vote(&[("study", "a alone"), ("kind", "energy")], [1, 1]),
            vote(&[("study", "b alone"), ("kind", "energy")], [0, 1]),
            vote(&[("study", "c alone"), ("kind", "space")], [0, 1]),
        ];
        let of_a = contrast(&votes);
        assert_eq!(of_a.values().collect::<Vec<_>>(), ["a alone", "energy"]);
        assert_eq!(of_a.words(&of_a.settings[0]), "a alone (energy)");
        assert_eq!(contrast(&votes[..2]).kind, None, "all are of that kind");
        let of_kind = contrast(&votes.map(|vote| Vote {
            fails: vote.settings[1].1 == "energy",
            ..vote
        }));
        assert_eq!(of_kind.values().collect::<Vec<_>>(), ["energy"]);
    }

    #[test]
    fn where_everything_fails_or_nothing_separates_no_setting_is_named() {
        let all = [
            vote(&[("method", "one step")], [2, 2]),
            vote(&[("method", "any order")], [1, 1]),
        ];
        let found = contrast(&all);
        assert_eq!(found.settings, []);
        assert_eq!(found.failing, PartOf { part: 3, of: 3 });
        let mixed = ["one step", "any order"]
            .map(|method| [0, 1].map(|failed| vote(&[("method", method)], [failed, 1])));
        assert_eq!(contrast(&mixed.concat()).settings, []);
        assert_eq!(
            contrast(&[]),
            Contrast {
                score: contrast(&[]).score,
                ..Contrast::default()
            }
        );
    }
}
