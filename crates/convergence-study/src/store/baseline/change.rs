//! Differences between a baseline and a run: in numbers, and in the claims of study files, value by
//! value.

use std::collections::{BTreeMap, HashSet};
use std::fmt;

use serde::{Deserialize, Serialize};

use super::Guarded;
use crate::run::Finished;
use crate::study::Header;
use crate::study::outcome::Quantity;
use crate::text::json;
use crate::text::number::{pair_text, plain_text};

/// A guarded number or a claim that changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GuardedChange {
    /// The study.
    pub study: String,
    /// The quantity, or the dotted path of the claim.
    pub name: String,
    /// What happened to it.
    pub movement: Movement,
}

impl GuardedChange {
    pub(super) fn new(study: &str, name: &str, movement: Movement) -> Self {
        Self {
            study: study.to_owned(),
            name: name.to_owned(),
            movement,
        }
    }

    /// What changed, in words: the quantity, or `claim PATH`.
    pub fn subject(&self) -> String {
        if self.movement.is_of_one_claim() {
            format!("claim {}", self.name)
        } else {
            self.name.clone()
        }
    }

    /// The name of the change: study, colon, number or `claim PATH`.
    pub fn id(&self) -> String {
        format!("{}:{}", self.study, self.subject())
    }

    /// The change of a claim for people: `ID: deleted`, or `ID, L2: tolerance 0.02, now 0.003`; any
    /// other change as displayed.
    pub fn words(&self) -> String {
        let Self {
            study,
            name,
            movement,
        } = self;
        match movement {
            Movement::VanishedFile { .. } => format!("{study}: deleted"),
            Movement::Claim { from, to, entry } => {
                let key = name.rsplit_once('.').map_or(name.as_str(), |(_, key)| key);
                let what = entry.as_ref().map_or(format!("{study}: {name}"), |entry| {
                    format!("{study}, {entry}: {key}")
                });
                match (from, to) {
                    (Some(from), Some(to)) => format!("{what} {from}, now {to}"),
                    (Some(from), None) => format!("{what} {from} removed"),
                    (None, to) => format!("{what} {} added", to.as_deref().unwrap_or_default()),
                }
            }
            _ => self.to_string(),
        }
    }
}

/// What happened to a guarded number or to a claim.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Movement {
    /// It changed by more than the tolerance.
    Moved {
        /// The baseline's value.
        #[serde(deserialize_with = "json::nan")]
        from: f64,
        /// The new value.
        #[serde(deserialize_with = "json::nan")]
        to: f64,
        /// The relative change tolerated.
        #[serde(deserialize_with = "json::nan")]
        tolerance: f64,
    },
    /// Its tolerance differs: a guard must not be loosened unnoticed.
    Tolerance {
        /// The baseline's tolerance.
        #[serde(deserialize_with = "json::nan")]
        from: f64,
        /// The new tolerance.
        #[serde(deserialize_with = "json::nan")]
        to: f64,
    },
    /// The baseline lacks it.
    New {
        /// Its value.
        #[serde(deserialize_with = "json::nan")]
        value: f64,
    },
    /// The run lacks it.
    Vanished {
        /// The baseline's value.
        #[serde(deserialize_with = "json::nan")]
        value: f64,
    },
    /// A value of the study's file differs, is new or has vanished.
    Claim {
        /// The blessed value; `None` if there was none.
        from: Option<String>,
        /// The value in the file; `None` if there is none.
        to: Option<String>,
        /// The subject of the list entry that holds the value, such as the norm of `expect[0]`;
        /// `None` if no value gives it.
        entry: Option<String>,
    },
    /// The baseline has no claim of the study.
    NewFile {
        /// How many values its file has.
        values: usize,
        /// How many numbers of the study the baseline guards nevertheless; more than 0 if its
        /// claims were removed.
        guarded: usize,
    },
    /// The study's file no longer exists.
    VanishedFile {
        /// How many values it had.
        values: usize,
    },
}

impl Movement {
    /// Whether it concerns one value of a study file.
    pub fn is_of_one_claim(&self) -> bool {
        matches!(self, Self::Claim { .. })
    }

    /// Whether a blessing needs a reason: a claim was changed, withdrawn with its study, or is
    /// missing although numbers are guarded.
    pub fn needs_a_reason(&self) -> bool {
        matches!(
            self,
            Self::Claim { .. } | Self::VanishedFile { .. } | Self::NewFile { guarded: 1.., .. }
        )
    }

    /// By how many times its tolerance a number has moved, for listing the largest changes first:
    /// infinite if old and new value cannot be compared, 0 for new ones.
    pub fn weight(&self) -> f64 {
        match *self {
            Self::Moved {
                from,
                to,
                tolerance,
            } => {
                let times = (to - from).abs() / (tolerance * from.abs());
                if times.is_nan() { f64::INFINITY } else { times }
            }
            Self::New { .. } | Self::NewFile { guarded: 0, .. } => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// How many numbers there are to accept if the baseline has nothing of the studies that were run;
/// `None` if it has some of it, or if something else has changed.
pub(crate) fn without_baseline(finished: &[Finished], changes: &[GuardedChange]) -> Option<usize> {
    let of_new_files = changes
        .iter()
        .filter(|change| matches!(change.movement, Movement::NewFile { guarded: 0, .. }));
    let numbers = changes
        .iter()
        .filter(|change| matches!(change.movement, Movement::New { .. }))
        .count();
    let all: usize = finished
        .iter()
        .map(|study| study.outcome.quantities.len())
        .sum();
    let claims = finished
        .iter()
        .filter(|study| !study.header.settings.is_empty())
        .count();
    let files = of_new_files.count();
    let is_all_new = numbers == all && files >= claims && numbers + files == changes.len();
    (is_all_new && !changes.is_empty()).then_some(numbers)
}

/// Whether two values agree within a finite tolerance; NaN and infinity agree with nothing.
pub(super) fn meets(from: f64, to: f64, tolerance: f64) -> bool {
    tolerance.is_finite() && (to - from).abs() <= tolerance * from.abs()
}

/// The changes of one study: in the run's order, then those that have vanished.
pub(super) fn of_numbers(
    study: &str,
    expected: &BTreeMap<String, Guarded>,
    found: &[Quantity],
) -> Vec<GuardedChange> {
    let mut changes = Vec::new();
    for quantity in found {
        let movement = match expected.get(&quantity.name) {
            Some(guarded) => movement(guarded, quantity),
            None => Some(Movement::New {
                value: quantity.value,
            }),
        };
        changes
            .extend(movement.map(|movement| GuardedChange::new(study, &quantity.name, movement)));
    }
    let names: HashSet<&str> = found
        .iter()
        .map(|quantity| quantity.name.as_str())
        .collect();
    let vanished = expected
        .iter()
        .filter(|(name, _)| !names.contains(name.as_str()));
    for (name, guarded) in vanished {
        let value = guarded.value;
        changes.push(GuardedChange::new(
            study,
            name,
            Movement::Vanished { value },
        ));
    }
    changes
}

fn movement(from: &Guarded, to: &Quantity) -> Option<Movement> {
    if !meets(from.value, to.value, from.tolerance) {
        Some(Movement::Moved {
            from: from.value,
            to: to.value,
            tolerance: from.tolerance,
        })
    } else if from.tolerance != to.tolerance {
        Some(Movement::Tolerance {
            from: from.tolerance,
            to: to.tolerance,
        })
    } else {
        None
    }
}

impl fmt::Display for GuardedChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let colon = if self.movement.is_of_one_claim() {
            ":"
        } else {
            ""
        };
        write!(
            f,
            "{}: {}{colon} {}",
            self.study,
            self.subject(),
            self.movement
        )
    }
}

impl fmt::Display for Movement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Moved {
                from,
                to,
                tolerance,
            } => moved(f, *from, *to, *tolerance),
            Self::Tolerance { from, to } => {
                write!(f, "has another tolerance: was {from:e}, is {to:e}")
            }
            Self::New { value } => write!(f, "is new: {}", plain_text(*value)),
            Self::Vanished { value } => write!(f, "has vanished: was {}", plain_text(*value)),
            Self::Claim { from, to, .. } => {
                let [from, to] = [from, to].map(|value| value.as_deref().unwrap_or("absent"));
                write!(f, "was {from}, is {to}")
            }
            Self::NewFile { values, guarded: 0 } => write!(f, "is new: {values} values"),
            Self::NewFile { values, guarded } => {
                write!(
                    f,
                    "has no claims in the baseline, which guards {guarded} of its numbers: {values} values"
                )
            }
            Self::VanishedFile { values } => write!(f, "was deleted: it had {values} values"),
        }
    }
}

fn moved(f: &mut fmt::Formatter<'_>, from: f64, to: f64, tolerance: f64) -> fmt::Result {
    let [before, after] = pair_text([from, to]);
    write!(f, "moved from {before} to {after}")?;
    let change = (to - from) / from.abs();
    if change.is_finite() {
        write!(
            f,
            ", by {}, tolerated {}",
            signed_percent(change),
            percent(tolerance)
        )
    } else if from == 0.0 && to.is_finite() {
        write!(f, ", and nothing but 0 is tolerated")
    } else {
        write!(f, ", which is not finite and matches nothing")
    }
}

/// The same with its sign.
pub(crate) fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// A share as a percentage with two significant digits.
fn percent(share: f64) -> String {
    let value = 100.0 * share;
    let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
    if (1e-4..1e6).contains(&rounded.abs()) || rounded == 0.0 {
        format!("{rounded} %")
    } else {
        format!("{rounded:e} %")
    }
}

/// The name under which a study file is new or has vanished as a whole.
const WHOLE_FILE: &str = "study file";

/// The value that stands for a whole file after it has vanished.
pub(super) const ID: &str = "study.id";

/// A blessed value of a study file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlessedClaim {
    /// Its text in the form of [`Header::settings`]; `null` if it was withdrawn.
    pub value: Option<String>,
    /// Why it was changed or withdrawn; `None` for the first value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// The claims of one study, by the dotted path of the value.
pub(super) type Claims = BTreeMap<String, BlessedClaim>;

/// Differences between the blessed claims and the current file, by path; a new file is one change.
///
/// * `guarded`: how many numbers of the study are guarded.
pub(super) fn of_claims(
    header: &Header,
    blessed: Option<&Claims>,
    guarded: usize,
) -> Vec<GuardedChange> {
    let Header { id, settings, .. } = header;
    let standing = standing(blessed);
    if standing.is_empty() {
        let new = GuardedChange::new(
            id,
            WHOLE_FILE,
            Movement::NewFile {
                values: settings.len(),
                guarded,
            },
        );
        return if settings.is_empty() {
            vec![]
        } else {
            vec![new]
        };
    }
    let mut paths: BTreeMap<&str, [Option<&str>; 2]> = standing
        .into_iter()
        .map(|(path, value)| (path, [Some(value), None]))
        .collect();
    for (path, value) in settings {
        paths.entry(path).or_default()[1] = Some(value);
    }
    let mut changes = vec![];
    for (path, [from, to]) in &paths {
        if from != to {
            let movement = Movement::Claim {
                from: from.map(str::to_owned),
                to: to.map(str::to_owned),
                entry: entry(path, &paths),
            };
            changes.push(GuardedChange::new(id, path, movement));
        }
    }
    changes
}

/// Keys that give the subject of a list entry.
const ENTRY_KEYS: [&str; 5] = ["norm", "error", "value", "quantity", "name"];

/// The subject of the list entry that holds a value, given by another value of the same entry.
///
/// * `paths`: the previous and the current value by path.
fn entry(path: &str, paths: &BTreeMap<&str, [Option<&str>; 2]>) -> Option<String> {
    let (entry, _) = path
        .rsplit_once('.')
        .filter(|(entry, _)| entry.ends_with(']'))?;
    let [from, to] = ENTRY_KEYS
        .iter()
        .find_map(|key| paths.get(format!("{entry}.{key}").as_str()))?;
    to.or(*from).map(|value| value.trim_matches('"').to_owned())
}

/// The change of a study whose file has vanished; `None` if its claims were withdrawn earlier.
pub(super) fn vanished(id: &str, blessed: &Claims) -> Option<GuardedChange> {
    let values = standing(Some(blessed)).len();
    (values > 0).then(|| GuardedChange::new(id, WHOLE_FILE, Movement::VanishedFile { values }))
}

/// The values that have not been withdrawn.
fn standing(blessed: Option<&Claims>) -> Vec<(&str, &str)> {
    let claims = blessed.into_iter().flatten();
    claims
        .filter_map(|(path, claim)| Some((path.as_str(), claim.value.as_deref()?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tolerance_is_relative_to_a_number_of_any_size() {
        for size in [1e-12, 1e-3, 1.0, 1e6] {
            for from in [size, -size] {
                assert!(meets(from, 1.0009 * from, 1e-3), "{from:e}");
                assert!(!meets(from, 1.0011 * from, 1e-3), "{from:e}");
                assert!(!meets(from, -from, 1e-3), "{from:e}");
            }
        }
        assert!(meets(0.0, 0.0, 1e-3) && !meets(0.0, 1e-300, 1e-3));
    }

    #[test]
    fn a_number_that_vanishes_is_a_change_whatever_else_the_run_has() {
        let guarded = |value| Guarded {
            value,
            tolerance: 1e-3,
            reason: None,
        };
        let expected = BTreeMap::from([
            ("kept".to_owned(), guarded(1.0)),
            ("gone".to_owned(), guarded(2.0)),
        ]);
        let gone = GuardedChange::new("study", "gone", Movement::Vanished { value: 2.0 });
        let kept = GuardedChange::new("study", "kept", Movement::Vanished { value: 1.0 });
        let found = Quantity::new("kept", 1.0, 1e-3);
        assert_eq!(of_numbers("study", &expected, &[]), [gone.clone(), kept]);
        assert_eq!(of_numbers("study", &expected, &[found]), [gone]);
    }
}
