//! A kind of study, typed for its author; its computations, and the result of each or the reason
//! why it is missing.

use std::path::Path;

use super::left_out::{NO_RESULT, left_out};
use super::outcome::{Check, Outcome, settle};
#[cfg(feature = "files")]
use super::settings;
use super::settings::Setting;
use super::subject::Subject;
use super::variants::Variants;
use crate::text::lists::{and_more, grouped};
use convergence_judge::verdict::Verdict;

/// One computation of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<D> {
    /// What distinguishes it from the study's other cases, such as `n = 64, 20 steps`.
    pub label: String,
    /// Estimate of the work, in a unit common to all studies of a project: the runner starts with
    /// the costliest case.
    pub cost: f64,
    /// The input of the computation.
    pub data: D,
    /// What it says of itself: the leaves of a value.
    pub settings: Vec<Setting>,
}

impl<D> Case<D> {
    /// A computation with its label and the estimate of its work.
    pub fn new(label: impl Into<String>, cost: f64, data: D) -> Self {
        Self {
            label: label.into(),
            cost,
            data,
            settings: vec![],
        }
    }

    /// The same, described by a value: a diagnosis names the leaves that failing cases share.
    #[cfg(feature = "files")]
    #[must_use]
    pub fn described(self, value: &impl serde::Serialize) -> Self {
        let settings = settings::leaves(value);
        Self { settings, ..self }
    }

    /// The same without its input.
    pub(super) fn listed(&self) -> Case<()> {
        Case {
            settings: self.settings.clone(),
            ..Case::new(&self.label, self.cost, ())
        }
    }
}

/// A case after its run: its data, and its result.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran<D, F> {
    /// The case.
    pub case: Case<D>,
    /// Its result.
    pub found: Result<F, CaseFailure>,
}

impl<D, F> Ran<D, F> {
    /// What the case found, if it completed.
    pub fn ok(&self) -> Option<&F> {
        self.found.as_ref().ok()
    }
}

/// Why a case has no result: an error of the computation, a panic caught by the runner, or the time
/// limit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CaseFailure {
    /// In words, with step, time and numbers.
    pub reason: String,
    /// What to do about it, which a study says once, with its first case that has any; may be
    /// empty.
    pub advice: String,
}

impl CaseFailure {
    /// * `reason`: in words, with step, time and numbers.
    pub fn new(reason: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
            advice: String::new(),
        }
    }
}

impl<E: std::error::Error> From<E> for CaseFailure {
    fn from(error: E) -> Self {
        Self::new(error.to_string())
    }
}

/// The reasons of failed cases; the first case with advice has it behind its reason.
pub(crate) fn reasons(failures: Vec<CaseFailure>) -> Vec<String> {
    let mut has_advice = false;
    let mut reasons = vec![];
    for CaseFailure { reason, advice } in failures {
        if advice.is_empty() || has_advice {
            reasons.push(reason);
        } else {
            reasons.push(format!("{reason}; {advice}"));
            has_advice = true;
        }
    }
    reasons
}

/// Cases without a result in words, `label: reason`; those with the same reason share one line,
/// which counts them.
///
/// * `failed`: label and reason of each.
fn by_reason<'f>(failed: impl IntoIterator<Item = (&'f str, &'f str)>) -> Vec<String> {
    let reasons = grouped(failed.into_iter().map(|(label, reason)| (reason, label)));
    reasons
        .into_iter()
        .map(|(reason, labels)| format!("{}: {reason}", cases_in_words(&labels)))
        .collect()
}

/// The first of several cases, and how many more there are.
pub(crate) fn cases_in_words(labels: &[&str]) -> String {
    let first = labels.first().copied().unwrap_or_default();
    format!("{first}{}", and_more(labels.len(), 1))
}

/// A study of one kind, read and validated: its cases, how to compute one, how to judge all.
///
/// A case is a pure function of its data, so the study has the same outcome for any number of
/// threads.
///
/// ```
/// use convergence_study::{Case, CaseFailure, Kind, Must, Outcome, Ran, Sheet, measured, run_one};
///
/// /// Sums of the series 1 + 1/2 + 1/4 + ..., which tends to 2.
/// struct Series;
///
/// impl Kind for Series {
///     type Data = i32;
///     type Found = f64;
///
///     fn cases(&self) -> Vec<Case<i32>> {
///         [10, 20].map(|n| Case::new(format!("n = {n}"), f64::from(n), n)).to_vec()
///     }
///
///     fn run(&self, n: &i32) -> Result<f64, CaseFailure> {
///         if *n == 0 {
///             return Err(CaseFailure::new("a sum of no terms"));
///         }
///         Ok((0..*n).map(|k| 0.5_f64.powi(k)).sum())
///     }
///
///     fn judge(&self, ran: &[Ran<i32, f64>]) -> Outcome {
///         Outcome::of_complete(self, ran, |shown| {
///             let rests = shown.iter().map(|(n, sum)| {
///                 measured(format!("n = {n}"), "2 - sum", 2.0 - **sum)
///                     .must_be(Must::AtMost(2.0_f64.powi(1 - **n)))
///                     .recorded("2 - sum", 1e-12)
///             });
///             Outcome::of_sheets([Sheet::new("What is left of the series", "terms", rests)], "2 - sum")
///         })
///     }
/// }
///
/// assert!(run_one(&Series).verdict.is_pass());
/// ```
pub trait Kind: Send + Sync {
    /// The input of a case.
    type Data: Clone + Send + Sync;
    /// The result of a case.
    type Found: Send;

    /// The computations, in the order in which they are judged.
    fn cases(&self) -> Vec<Case<Self::Data>>;

    /// Another case after all earlier ones have run, such as a finer level while the rates decide
    /// nothing; called repeatedly until it returns `None`.
    ///
    /// * `ran`: all results so far, in the order of the cases.
    fn more(&self, _ran: &[Ran<Self::Data, Self::Found>]) -> Option<Case<Self::Data>> {
        None
    }

    /// Computes one case: the same result on every thread, at every time.
    fn run(&self, data: &Self::Data) -> Result<Self::Found, CaseFailure>;

    /// Why a result counts as a failed case although part of it counts: a required number is
    /// missing. `None` for a complete one.
    fn failure(&self, _found: &Self::Found) -> Option<CaseFailure> {
        None
    }

    /// Names of the numbers of a result that are NaN or infinite, for [`Outcome::of_complete`].
    fn not_finite(&self, _data: &Self::Data, _found: &Self::Found) -> Vec<String> {
        vec![]
    }

    /// Judges the results, one for each case in the order of [`Kind::cases`]. A failed case must
    /// show in the outcome.
    fn judge(&self, ran: &[Ran<Self::Data, Self::Found>]) -> Outcome;

    /// Runs all cases on this thread, one after the other: for tests that change a result.
    fn run_here(&self) -> Vec<Ran<Self::Data, Self::Found>> {
        let run = |case: Case<Self::Data>| Ran {
            found: self.run(&case.data),
            case,
        };
        let mut ran: Vec<_> = self.cases().into_iter().map(run).collect();
        while let Some(case) = self.more(&ran) {
            ran.push(run(case));
        }
        ran
    }

    /// What a run with these results finds: as [`Kind::judge`], its cases counted, and no better
    /// than its parts.
    fn outcome_of(&self, ran: &[Ran<Self::Data, Self::Found>]) -> Outcome
    where
        Self: Sized,
    {
        settle("study", judge(self, ran))
    }

    /// Says where answers of expensive cases are kept, if the study keeps any.
    ///
    /// * `may_reuse`: whether they may take the place of runs.
    fn keep_answers(&self, _folder: &Path, _may_reuse: bool) {}

    /// The file of `manufacture` whose module gives the study's program its solution.
    fn manufactured(&self) -> Option<&Path> {
        None
    }

    /// The variants of the study's own solution, for `--where`.
    fn variants(&self) -> Option<Variants> {
        None
    }

    /// The same study with a variant of its solution, judged by itself. `None` without variants.
    fn with_variant(&self, _variant: &str) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// The number of levels, if there can be fewer or more.
    fn levels(&self) -> Option<usize> {
        None
    }

    /// The same study with so many levels, the coarsest ones and finer ones that are added, as far
    /// as time permits. `None` where their number is fixed.
    fn with_levels(&self, _count: usize) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// What a passing study fails to test, found by trial; only `study` requests it, because it may
    /// take longer than the study.
    fn untested(&self) -> Vec<Untested> {
        vec![]
    }
}

/// Something that a study seems to test but does not.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Untested {
    /// Its name, such as that of a coefficient.
    pub what: String,
    /// Why an error in it would go unnoticed.
    pub why: String,
}

/// Judges the results of a study, and counts its cases in addition to what its kind counts.
///
/// * `ran`: one result for each case, in the order of [`Kind::cases`].
pub(crate) fn judge<K: Kind>(kind: &K, ran: &[Ran<K::Data, K::Found>]) -> Outcome {
    let mut outcome = kind.judge(ran);
    let reasons = ran.iter().map(|ran| match ran.ok() {
        // A result counts as a failed case where part of it is missing.
        Some(result) if kind.failure(result).is_none() => None,
        _ => Some(NO_RESULT),
    });
    outcome.left_out.extend(left_out("cases", reasons));
    outcome
}

impl Outcome {
    /// The outcome of a study of which nothing is judged unless every case has a result.
    ///
    /// * `judge`: what the results show, each beside the input of its case, in the order of the
    ///   cases.
    pub fn of_complete<K: Kind>(
        study: &K,
        ran: &[Ran<K::Data, K::Found>],
        judge: impl FnOnce(&[(&K::Data, &K::Found)]) -> Self,
    ) -> Self {
        let named = ran.iter().map(|Ran { case, found }| Ran {
            case: case.listed(),
            found: match found {
                Ok(found) => Ok(study.not_finite(&case.data, found)),
                Err(failure) => Err(failure.clone()),
            },
        });
        let mut completion = Check::completion(&named.collect::<Vec<_>>(), Vec::clone);
        let shown: Vec<_> = ran
            .iter()
            .filter_map(|ran| Some((&ran.case.data, ran.ok()?)))
            .collect();
        let [have, all] = [shown.len(), study.cases().len()];
        let mut outcome = if have < all || have == 0 {
            // A case that was not run fails as one without a result does.
            completion.verdict = Verdict::Fail;
            let words = format!("{have} of {all} runs have a result, so nothing else is judged");
            Self::new(words, vec![], vec![])
        } else {
            judge(&shown)
        };
        outcome.verdict = Verdict::worst([outcome.verdict, completion.verdict]);
        outcome.checks.insert(0, completion);
        outcome
    }
}

/// Most reasons that a check of completion lists.
const MOST_REASONS: usize = 8;

impl Check {
    /// Fails unless every case has a result with finite numbers only.
    ///
    /// * `not_finite`: names of the numbers of a result that are NaN or infinite.
    pub fn completion<D, F>(ran: &[Ran<D, F>], not_finite: impl Fn(&F) -> Vec<String>) -> Self {
        let failed: Vec<_> = ran
            .iter()
            .filter_map(|Ran { case, found }| Some((case, found.as_ref().err()?)))
            .collect();
        let reasons = reasons(
            failed
                .iter()
                .map(|(_, failure)| (*failure).clone())
                .collect(),
        );
        let labels = failed.iter().map(|(case, _)| case.label.as_str());
        let mut complaints = by_reason(labels.zip(reasons.iter().map(String::as_str)));
        for (case, found) in ran
            .iter()
            .filter_map(|Ran { case, found }| Some((case, found.as_ref().ok()?)))
        {
            complaints.extend(
                not_finite(found)
                    .iter()
                    .map(|name| format!("{}: {name} is not finite", case.label)),
            );
        }
        let completed = ran.iter().filter(|ran| ran.found.is_ok()).count();
        let mut evidence = format!("{completed} of {} cases completed", ran.len());
        for complaint in complaints.iter().take(MOST_REASONS) {
            evidence += &format!("; {complaint}");
        }
        if complaints.len() > MOST_REASONS {
            evidence += &format!("; and {} more", complaints.len() - MOST_REASONS);
        }
        let is_complete = complaints.is_empty() && !ran.is_empty();
        let claim = "every case completes, with finite numbers";
        Self {
            is_completion: true,
            ..Self::that(is_complete, claim, evidence).about(Subject::of("completion"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_told_once_and_its_cases_are_counted() {
        let lines = by_reason([("a", "lost"), ("b", "NaN"), ("c", "lost"), ("d", "lost")]);
        assert_eq!(lines, ["a and 2 more: lost", "b: NaN"]);
        assert!(by_reason([]).is_empty());
    }

    #[test]
    fn a_failed_case_or_a_nan_fails_the_completion() {
        let verdict = |found: Vec<Result<f64, CaseFailure>>| {
            let case = || Case::new("n = 8", 1.0, ());
            let ran: Vec<_> = found
                .into_iter()
                .map(|found| Ran {
                    case: case(),
                    found,
                })
                .collect();
            let names = |value: &f64| {
                if value.is_finite() {
                    vec![]
                } else {
                    vec!["error".to_owned()]
                }
            };
            Check::completion(&ran, names).verdict
        };
        assert_eq!(verdict(vec![Ok(1.0)]), Verdict::Pass);
        assert_eq!(verdict(vec![Ok(f64::NAN)]), Verdict::Fail);
        assert_eq!(
            verdict(vec![Ok(1.0), Err(CaseFailure::new("diverged"))]),
            Verdict::Fail
        );
        assert_eq!(verdict(vec![]), Verdict::Fail);
    }
}
