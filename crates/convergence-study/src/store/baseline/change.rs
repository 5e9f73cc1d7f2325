//! Differences between a baseline and a run: in numbers, in the claims about them, and in the
//! settings of studies.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::Guarded;
use crate::run::Finished;
use crate::study::{Must, TableOrigin};
use crate::text::json;
use crate::text::number::{counted, pair_text, plain_text, significant};
use convergence_judge::verdict::Verdict;

/// What changed of a study as a whole.
pub(super) const STUDY: &str = "study";
/// What changed if its settings did.
pub(super) const SETTINGS: &str = "settings";
/// What changed if the files of its table did.
pub(super) const SOURCES: &str = "sources";
/// What changed if its guard did.
pub(super) const GUARD: &str = "guard";

/// Something guarded that changed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GuardedChange {
    /// The study.
    pub study: String,
    /// The quantity, or `study`, `settings`, `guard`.
    pub name: String,
    /// What happened to it.
    pub movement: Movement,
}

impl GuardedChange {
    /// A number that moved by more than a thousandth of itself.
    #[cfg(test)]
    pub(crate) fn moved(study: &str, name: &str, [from, to]: [f64; 2]) -> Self {
        let tolerance = 1e-3;
        let movement = Movement::Moved {
            from,
            to,
            tolerance,
        };
        Self::new(study, name, movement)
    }

    pub(super) fn new(study: &str, name: &str, movement: Movement) -> Self {
        Self {
            study: study.to_owned(),
            name: name.to_owned(),
            movement,
        }
    }
}

/// What happened to something guarded.
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
    /// The baseline lacks it, or a claim about it, but has it in its hash: somebody has deleted it.
    DeletedLine,
    /// The run lacks it.
    Vanished {
        /// The baseline's value.
        #[serde(deserialize_with = "json::nan")]
        value: f64,
    },
    /// What is claimed of the number differs.
    Claim {
        /// The blessed claim; `None` if there was none.
        from: Option<Must>,
        /// The claim of the run; `None` if there is none.
        to: Option<Must>,
    },
    /// The tolerance of all numbers of a study differs.
    Guard {
        /// The blessed one; `None` if each number had its own.
        from: Option<f64>,
        /// That of the study's file; `None` if it has none.
        to: Option<f64>,
    },
    /// A value of the study's file, or a label of its cases, is not what it was.
    Settings {
        /// The blessed hash; `None` if the baseline has none, although it guards the study.
        from: Option<String>,
        /// The hash now.
        to: String,
    },
    /// A table is what it was, but not the files that it was made from: it is of another version.
    Stale {
        /// These files.
        inputs: Vec<String>,
    },
    /// A table and the files that it was made from are others: whether it was made from these,
    /// only who made it knows. Unless that is blessed, no later change of the files is noticed.
    Remade {
        /// These files.
        inputs: Vec<String>,
    },
    /// The baseline does not have the study.
    NewStudy,
    /// The study is in code, and this program has no studies in code.
    Elsewhere,
    /// The study no longer exists.
    VanishedStudy {
        /// How many numbers of it were guarded.
        numbers: usize,
    },
}

impl Movement {
    /// Whether it concerns what is claimed, and not what was computed.
    pub fn is_of_claims(&self) -> bool {
        matches!(
            self,
            Self::Claim { .. }
                | Self::Guard { .. }
                | Self::Settings { .. }
                | Self::DeletedLine
                | Self::Elsewhere
                | Self::VanishedStudy { .. }
        )
    }

    /// What it makes of a run: what is not known to be of this version is no failure.
    pub(crate) fn verdict(&self) -> Verdict {
        match self {
            Self::Stale { .. } | Self::Remade { .. } | Self::Elsewhere => Verdict::Inconclusive,
            _ => Verdict::Fail,
        }
    }

    /// What is new to a study whose lines somebody has deleted is what was deleted.
    pub(super) fn name_deletion(&mut self) {
        if matches!(self, Self::New { .. } | Self::Claim { from: None, .. }) {
            *self = Self::DeletedLine;
        }
    }

    /// Whether less is guarded or claimed than before, so that a blessing must be asked for it: a
    /// claim or a tolerance is looser, a number or a study is gone, or the settings are others, of
    /// which no hash can tell.
    pub fn is_loosened(&self) -> bool {
        match self {
            Self::Claim { from, to } => match (from, to) {
                (Some(from), Some(to)) => to.is_looser_than(*from),
                (from, _) => from.is_some(),
            },
            // A tolerance that is NaN is no tighter one.
            Self::Tolerance { from, to } => to > from || to.is_nan(),
            Self::Guard { from, to } => to.unwrap_or(0.0) > from.unwrap_or(0.0),
            Self::DeletedLine
            | Self::Vanished { .. }
            | Self::Settings { .. }
            | Self::Stale { .. }
            | Self::VanishedStudy { .. } => true,
            Self::Moved { .. }
            | Self::New { .. }
            | Self::Remade { .. }
            | Self::Elsewhere
            | Self::NewStudy => false,
        }
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
            Self::New { .. } | Self::NewStudy => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// How many numbers there are to accept if the baseline has nothing of the studies that were run;
/// `None` if it has some of it, or if something else has changed.
pub(crate) fn without_baseline(finished: &[Finished], changes: &[GuardedChange]) -> Option<usize> {
    let mut numbers = 0;
    let mut studies = 0;
    for GuardedChange { movement, .. } in changes {
        match movement {
            Movement::New { .. } => numbers += 1,
            Movement::NewStudy => studies += 1,
            _ => return None,
        }
    }
    let all: usize = finished
        .iter()
        .map(|study| study.outcome.quantities.len())
        .sum();
    (studies > 0 && numbers == all && studies >= finished.len()).then_some(numbers)
}

/// Numbers of a study with a guard may change as if they were at least this large: what is computed
/// as a sum in any order scatters about zero by the size of its terms.
const NEAR_ZERO: f64 = 1e-10;

/// Whether a value agrees with a guarded number within a finite tolerance; NaN and infinity agree
/// with nothing.
///
/// * `guard`: the tolerance of the study, if it has one.
pub(super) fn meets(from: &Guarded, guard: Option<f64>, to: f64) -> bool {
    let Guarded {
        value, tolerance, ..
    } = *from;
    let [share, size] = match guard {
        Some(guard) => [tolerance.max(guard), value.abs().max(NEAR_ZERO)],
        None => [tolerance, value.abs()],
    };
    // `max` would ignore NaN.
    tolerance.is_finite()
        && value.is_finite()
        && share.is_finite()
        && (to - value).abs() <= share * size
}

/// What happened to a number.
///
/// * `from`: as it was blessed; `None` if it is new.
/// * `guard`: the blessed tolerance of the study, if it has one.
/// * `to`: as it is now; `None` if it is gone.
pub(super) fn of_number(
    from: Option<&Guarded>,
    guard: Option<f64>,
    to: Option<&Guarded>,
) -> Vec<Movement> {
    let [blessed, to] = match (from, to) {
        (Some(from), Some(to)) => [from, to],
        (None, to) => {
            return to
                .map(|to| Movement::New { value: to.value })
                .into_iter()
                .collect();
        }
        (Some(from), None) => return vec![Movement::Vanished { value: from.value }],
    };
    let mut movements = vec![];
    let Guarded {
        value,
        tolerance,
        claim,
    } = *blessed;
    if !meets(blessed, guard, to.value) {
        movements.push(Movement::Moved {
            from: value,
            to: to.value,
            tolerance: guard.map_or(tolerance, |guard| guard.max(tolerance)),
        });
    }
    if tolerance != to.tolerance {
        movements.push(Movement::Tolerance {
            from: tolerance,
            to: to.tolerance,
        });
    }
    if claim != to.claim {
        movements.push(Movement::Claim {
            from: claim,
            to: to.claim,
        });
    }
    movements
}

/// What happened to a table and the files that it was made from, if anything did.
///
/// * `from`: as they were blessed; `to`: as they are now, `None` for a study without a table.
pub(super) fn of_sources(from: Option<&TableOrigin>, to: Option<&TableOrigin>) -> Option<Movement> {
    let to = to?;
    let Some(from) = from else {
        return Some(Movement::DeletedLine);
    };
    let inputs = to.changed_inputs(from);
    match to.table.hash == from.table.hash {
        _ if inputs.is_empty() => None,
        true => Some(Movement::Stale { inputs }),
        false => Some(Movement::Remade { inputs }),
    }
}

impl fmt::Display for GuardedChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            study,
            name,
            movement,
        } = self;
        write!(f, "{study}: {name} {movement}")
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
            Self::DeletedLine => write!(
                f,
                "was deleted from the baseline, which has it in its hash; restore the line"
            ),
            Self::Vanished { value } => write!(f, "has vanished: was {}", plain_text(*value)),
            Self::Claim { from, to } => {
                let [from, to] =
                    [from, to].map(|must| must.map_or("none".to_owned(), String::from));
                let how = if self.is_loosened() {
                    "looser"
                } else {
                    "tighter"
                };
                write!(f, "has a {how} claim: was {from}, is {to}")
            }
            Self::Guard { from, to } => {
                let [from, to] = [from, to]
                    .map(|guard| guard.map_or("none".to_owned(), |guard| format!("{guard:e}")));
                write!(f, "was {from}, is {to}")
            }
            Self::Settings { from, to } => match from {
                Some(from) => write!(f, "have changed: hash {from}, now {to}"),
                None => write!(
                    f,
                    "have no hash in the baseline, which guards the study; now {to}"
                ),
            },
            Self::Stale { inputs } => write!(
                f,
                "are newer than the table: {} changed, and the table did not; make it anew, or accept it by --bless --loosened",
                inputs.join(", ")
            ),
            Self::Remade { inputs } => write!(
                f,
                "are others, and so is the table: {} changed; if the table was made from them, accept it by --bless",
                inputs.join(", ")
            ),
            Self::NewStudy => write!(f, "is new"),
            Self::Elsewhere => write!(
                f,
                "is in code, and this program has no studies in code; run that of the project which has them"
            ),
            Self::VanishedStudy { numbers } => {
                write!(
                    f,
                    "was deleted: it had {}",
                    counted(*numbers, "guarded number")
                )
            }
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
fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// A share as a percentage with two significant digits.
fn percent(share: f64) -> String {
    let rounded = significant(100.0 * share, 2);
    if (1e-4..1e6).contains(&rounded.abs()) || rounded == 0.0 {
        format!("{rounded} %")
    } else {
        format!("{rounded:e} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn guarded(value: f64, tolerance: f64) -> Guarded {
        Guarded {
            value,
            tolerance,
            claim: None,
        }
    }

    #[test]
    fn a_tolerance_is_relative_to_a_number_of_any_size() {
        let meets = |from: f64, to: f64| meets(&guarded(from, 1e-3), None, to);
        for size in [1e-12, 1e-3, 1.0, 1e6] {
            for from in [size, -size] {
                assert!(meets(from, 1.0009 * from), "{from:e}");
                assert!(!meets(from, 1.0011 * from), "{from:e}");
                assert!(!meets(from, -from), "{from:e}");
            }
        }
        assert!(meets(0.0, 0.0) && !meets(0.0, 1e-300));
    }

    #[test]
    fn a_guard_widens_a_tolerance_and_is_absolute_near_zero() {
        let guarded_by =
            |from: f64, tolerance: f64, to: f64| meets(&guarded(from, tolerance), Some(1e-4), to);
        for from in [-2.0, 1e-9] {
            assert!(guarded_by(from, 1e-6, 1.00009 * from), "{from:e}");
            assert!(!guarded_by(from, 1e-6, 1.00011 * from), "{from:e}");
            assert!(guarded_by(from, 1e-2, 1.009 * from), "{from:e}");
        }
        assert!(guarded_by(0.0, 1e-6, 0.9e-14) && !guarded_by(0.0, 1e-6, 1.1e-14));
        assert!(guarded_by(1e-16, 1e-6, -1e-15) && !guarded_by(1e-16, 1e-6, 1e-13));
        for broken in [f64::NAN, f64::INFINITY] {
            assert!(!guarded_by(broken, 1e-6, broken), "{broken}");
            assert!(!meets(&guarded(broken, 1e-6), None, broken), "{broken}");
            assert!(!guarded_by(1.0, broken, 1.0), "{broken}");
            assert!(!meets(&guarded(1.0, 1e-6), Some(broken), 2.0), "{broken}");
        }
    }
}
