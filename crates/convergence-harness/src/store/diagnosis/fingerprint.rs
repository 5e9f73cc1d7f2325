//! The effect of a mistake on a run: which items fail, which fields move, and in which direction.
//! Similar runs agree in these.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::subject_of_number;
use crate::run::Finished;
use crate::store::{Change, Movement, read_if_there};

/// Logarithm of the ratio that weighs as much as a failure.
const LARGE: f64 = 2.0;

/// End of an item that stands for a failure; other items are numbers.
const FAILS: &str = " fails";

/// The numbers and the failures that count of each run and of each mistake. More of them name the
/// module of a mistake no better (of 153 mistakes, 107 by all items, 108 by these), and people
/// commit the file.
const MOST_NUMBERS: usize = 20;
const MOST_FAILURES: usize = 12;

/// What fails and moves: study and field, and how much, from -1 to 1.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Fingerprint(BTreeMap<String, f64>);

impl Fingerprint {
    /// That of a run: 1 for each field with a rate or check that does not pass; for a moved field
    /// the logarithm of its ratio.
    pub fn of(finished: &[Finished], changes: &[Change]) -> Self {
        let mut items = BTreeMap::new();
        for Finished {
            header, outcome, ..
        } in finished
        {
            let rates = outcome
                .rates
                .iter()
                .map(|named| (named.subject.quantity.clone(), named.rate.verdict));
            let checks = outcome
                .checks
                .iter()
                .map(|check| (check.quantity().to_owned(), check.verdict));
            let failing = rates
                .chain(checks)
                .filter(|(_, verdict)| !verdict.is_pass());
            items.extend(failing.map(|(field, _)| (format!("{}: {field}{FAILS}", header.id), 1.0)));
        }
        for Change {
            study,
            name,
            movement,
        } in changes
        {
            let Movement::Moved { from, to, .. } = movement else {
                continue;
            };
            let log = (to / from).abs().ln();
            let size = if log.is_nan() {
                1.0
            } else {
                (log / LARGE).clamp(-1.0, 1.0)
            };
            // With two digits, because people commit the file.
            let least = if size < 0.0 { -0.1 } else { 0.1 };
            let size = if size.abs() < 0.1 {
                least
            } else {
                (100.0 * size).round() / 100.0
            };
            let mut studies = finished.iter();
            let field = match studies.find(|finished| finished.header.id == *study) {
                Some(finished) => subject_of_number(&finished.outcome, name).quantity,
                None => name.clone(),
            };
            items.insert(format!("{study}: {field}"), size);
        }
        Self(items)
    }

    /// The numbers that move most, and the first failures by name; of equal numbers, the first by
    /// name. A failure without a number, and a run in which only numbers move, find their like.
    fn shortened(&self) -> Self {
        let (failures, mut numbers): (Vec<_>, Vec<_>) = self
            .0
            .iter()
            .map(|(item, size)| (item.clone(), *size))
            .partition(|(item, _)| item.ends_with(FAILS));
        numbers.sort_by(|(_, one), (_, next)| next.abs().total_cmp(&one.abs()));
        let failures = failures.into_iter().take(MOST_FAILURES);
        Self(
            numbers
                .into_iter()
                .take(MOST_NUMBERS)
                .chain(failures)
                .collect(),
        )
    }

    /// Without failures: only the numbers that move.
    fn numbers(&self) -> Self {
        Self(
            self.0
                .iter()
                .filter(|(item, _)| !item.ends_with(FAILS))
                .map(|(item, size)| (item.clone(), *size))
                .collect(),
        )
    }

    /// Cosine of the angle between two: 1 if they are alike, 0 if they share nothing.
    pub fn likeness(&self, other: &Self) -> f64 {
        let both: f64 = self
            .0
            .iter()
            .filter_map(|(item, size)| Some(size * other.0.get(item)?))
            .sum();
        let product = self.norm() * other.norm();
        if product > 0.0 { both / product } else { 0.0 }
    }

    /// The root of the sum of squares.
    fn norm(&self) -> f64 {
        self.0.values().map(|size| size * size).sum::<f64>().sqrt()
    }
}

/// A mistake that was planted, and its effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// The mistake in a few words.
    pub mistake: String,
    /// The file that it was planted in.
    pub file: String,
    /// Its effect.
    pub items: Fingerprint,
}

/// All of them, with the least likeness for naming one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct Fingerprints {
    /// Found by leaving each one out: above this, the nearest is more often than not in the same
    /// file.
    pub threshold: f64,
    /// The mistakes.
    pub known: Vec<Known>,
}

/// The file: names of items once, and of each mistake those that count.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    threshold: f64,
    #[serde(default)]
    names: Vec<String>,
    known: Vec<StoredKnown>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredKnown {
    mistake: String,
    file: String,
    items: Items,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Items {
    /// Place of the name in the list, and hundredths.
    Listed(Vec<(usize, i8)>),
    /// All items by name: the form of earlier files.
    Named(Fingerprint),
}

impl From<Fingerprints> for Stored {
    fn from(all: Fingerprints) -> Self {
        let prints: Vec<Fingerprint> = all
            .known
            .iter()
            .map(|known| known.items.shortened())
            .collect();
        let names: BTreeSet<&String> = prints.iter().flat_map(|print| print.0.keys()).collect();
        let places: BTreeMap<&String, usize> = names.iter().copied().zip(0..).collect();
        let mut mistakes = vec![];
        for (known, print) in all.known.iter().zip(&prints) {
            let items = print.0.iter();
            let items = items.map(|(name, size)| (places[name], (100.0 * size).round() as i8));
            mistakes.push(StoredKnown {
                mistake: known.mistake.clone(),
                file: known.file.clone(),
                items: Items::Listed(items.collect()),
            });
        }
        Self {
            threshold: all.threshold,
            known: mistakes,
            names: names.into_iter().cloned().collect(),
        }
    }
}

impl TryFrom<Stored> for Fingerprints {
    type Error = String;

    fn try_from(stored: Stored) -> Result<Self, String> {
        let mut mistakes = vec![];
        for known in stored.known {
            mistakes.push(Known {
                mistake: known.mistake,
                file: known.file,
                items: known.items.with_names(&stored.names)?,
            });
        }
        Ok(Self {
            threshold: stored.threshold,
            known: mistakes,
        })
    }
}

impl Items {
    /// The items by name.
    ///
    /// # Errors
    /// A message about an item of a name that is not in the list.
    fn with_names(self, names: &[String]) -> Result<Fingerprint, String> {
        let list = match self {
            Self::Named(items) => return Ok(items),
            Self::Listed(list) => list,
        };
        let mut items = BTreeMap::new();
        for (place, hundredths) in list {
            let name = names.get(place).ok_or_else(|| {
                let count = names.len();
                format!("found an item of the name {place}; expected one of 0 to {count} - 1")
            })?;
            items.insert(name.clone(), f64::from(hundredths) / 100.0);
        }
        Ok(Fingerprint(items))
    }
}

/// A known mistake that a run resembles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Resembling {
    /// The mistake.
    pub mistake: String,
    /// The file that it was planted in.
    pub file: String,
    /// Cosine of the angle.
    pub likeness: f64,
}

impl Fingerprints {
    /// Reads the file; without a file no mistakes are known.
    pub fn read(path: &Path) -> io::Result<Self> {
        let expected = "remove it: `dev regressions --write` makes it anew";
        Ok(read_if_there(path, None, [expected; 2])?.unwrap_or_default())
    }

    /// The two most alike, if they are alike enough. Where nothing fails in the run, those that
    /// move numbers alike. Of each the items that count are compared, which are those in the file.
    pub fn nearest(&self, run: &Fingerprint) -> Vec<Resembling> {
        let known = self.known.iter().map(|known| Known {
            items: known.items.shortened(),
            ..known.clone()
        });
        let all = Self {
            threshold: self.threshold,
            known: known.collect(),
        };
        all.nearest_by_all(&run.shortened())
    }

    /// The same by all items: for judging what is lost without some of them.
    pub fn nearest_by_all(&self, run: &Fingerprint) -> Vec<Resembling> {
        let only_moves = run.numbers() == *run;
        let mut all = vec![];
        for Known {
            mistake,
            file,
            items,
        } in &self.known
        {
            let likeness = if only_moves {
                items.numbers().likeness(run)
            } else {
                items.likeness(run)
            };
            all.push(Resembling {
                mistake: mistake.clone(),
                file: file.clone(),
                likeness: (100.0 * likeness).round() / 100.0,
            });
        }
        all.sort_by(|one, next| next.likeness.total_cmp(&one.likeness));
        all.retain(|one| one.likeness >= self.threshold.max(0.01));
        all.truncate(2);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fingerprint(items: &[(&str, f64)]) -> Fingerprint {
        Fingerprint(
            items
                .iter()
                .map(|(item, size)| ((*item).to_owned(), *size))
                .collect(),
        )
    }

    /// A file in the form of earlier ones is read too; what is written has the items that count.
    #[test]
    fn the_file_has_each_name_once_and_the_items_that_count() {
        let moves: Vec<(String, f64)> = (0..30)
            .map(|k| {
                (
                    format!("s: n{k:02}"),
                    if k == 7 {
                        -0.9
                    } else {
                        0.01 * f64::from(k + 10)
                    },
                )
            })
            .collect();
        let fails = (0..30).map(|k| (format!("s: f{k:02} fails"), 1.0));
        let all = Fingerprint(moves.iter().cloned().chain(fails).collect());
        let known = ["one", "two"].map(|mistake| Known {
            mistake: mistake.into(),
            file: "f.rs".into(),
            items: all.clone(),
        });
        let full = Fingerprints {
            threshold: 0.5,
            known: known.to_vec(),
        };
        let text = serde_json::to_string(&full).unwrap();
        assert_eq!(text.matches("s: n07").count(), 1, "{text}");
        let read: Fingerprints = serde_json::from_str(&text).unwrap();
        let kept = &read.known[1].items;
        assert_eq!(kept.0.len(), MOST_NUMBERS + MOST_FAILURES);
        assert_eq!((kept.0["s: n07"], kept.0["s: n29"]), (-0.9, 0.39));
        assert!(!kept.0.contains_key("s: n10") && kept.0.contains_key("s: f11 fails"));
        assert_eq!(read.nearest(&all), full.nearest(&all));
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        let named =
            r#"{"threshold":0.5,"known":[{"mistake":"one","file":"f.rs","items":{"s: u":0.25}}]}"#;
        let named: Fingerprints = serde_json::from_str(named).unwrap();
        assert_eq!(named.known[0].items.0["s: u"], 0.25);
        let torn = text.replace("[[0,", "[[99,");
        let error = serde_json::from_str::<Fingerprints>(&torn).unwrap_err();
        assert!(error.to_string().contains("the name 99"), "{error}");
    }

    /// Most of what the mistake does in the dictionary are failures; a run with only its moved
    /// numbers resembles it all the same.
    #[test]
    fn moved_numbers_are_compared_with_the_moved_numbers_of_mistakes_that_also_fail() {
        let moves = [("s: u", 0.5), ("s: v", -0.2)];
        let fails =
            ["a: u fails", "b: u fails", "c: u fails", "d: u fails"].map(|item| (item, 1.0));
        let known = |mistake: &str, items: Fingerprint| Known {
            mistake: mistake.into(),
            file: "f.rs".into(),
            items,
        };
        let other = fingerprint(&[("s: u", -0.5), ("t: w", 1.0)]);
        let both = fingerprint(&[&moves[..], &fails].concat());
        let all = Fingerprints {
            threshold: 0.6,
            known: vec![known("other", other), known("one", both)],
        };
        let names = |run: &[(&str, f64)]| -> Vec<(String, f64)> {
            all.nearest(&fingerprint(run))
                .into_iter()
                .map(|one| (one.mistake, one.likeness))
                .collect()
        };
        assert_eq!(names(&moves), [("one".to_owned(), 1.0)]);
        assert_eq!(names(&[("u: u", 1.0)]), []);
        // Another failure is no reason to name it.
        assert_eq!(names(&[&moves[..], &[("e: u fails", 1.0)]].concat()), []);
        assert_eq!(names(&fails), [("one".to_owned(), 0.97)]);
    }
}
